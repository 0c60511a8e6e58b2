# SPDX-License-Identifier: BSD-3-Clause
"""Cells on arms drawn at random: success, noes, proofs and moves, a build at a time.

The arms are those of bench.random_arms; their seeds are used for nothing else, so that
no constant was chosen by them.
"""

from __future__ import annotations

import time
from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench import random_arms
from bench.branches import (
    ROUNDING,
    TOLERANCE,
    branches_by_restarts,
    nearest_turns,
)
from bench.check import right
from bench.lost import lost_of_random
from bench.moves import LONGER, along_arcs
from bench.size import Job, Size
from bench.targets import make_targets
from bench.timing import PASSES, least_times, time_calls

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    import numpy.typing as npt

    from bench.arms import Arm
    from bench.chain import Array
    from bench.store import Settings

RESTARTS = 300
"""Random seeds of brute force, for each no and each move."""
LIMIT_S = 60.0
"""No further call of an arm is timed after this [s]."""
APART = 1_000_003
"""Between the seeds of an arm's kinds of targets."""
SUMS = (
    *("targets", "lost", "false"),
    *("yes", "yes_ns", "noes", "no_ns", "proven", "swept"),
    *("tried", "tried_proofs", "found", "refuted"),
    *("moves", "longer"),
)
"""What is counted of each arm, and added up."""
BAD = ("lost", "false", "found", "refuted", "longer")
"""Counts that should be 0: the arms where they are not are named."""


def random_cell(build: str, size: Size) -> Settings:
    """The random arms of a build."""
    return {
        "cell": "random_arms",
        "robot": build,
        "count": size.random_arms,
        "targets": size.random_targets,
        "asked": size.random_asked,
        "brute": size.random_brute,
        "seed": size.random_seed,
        "limit_s": size.random_s,
    }


def random_jobs(
    size: Size, builds: Collection[str] = tuple(random_arms.BUILDS)
) -> list[Job]:
    """A process for all builds."""
    cells = [random_cell(build, size) for build in builds]
    return [Job("random arms", "random", cells)]


def measured(settings: Settings) -> dict[str, Any]:
    """The counts of a build's arms; none is begun after the time that they have."""
    total = Counter(dict.fromkeys(SUMS, 0))
    culprits: dict[str, list[list[int]]] = {what: [] for what in BAD}
    end = time.monotonic() + settings["limit_s"]
    arms = 0
    for seed in range(settings["seed"], settings["seed"] + settings["count"]):
        if arms and time.monotonic() > end:
            break
        arm = random_arms.random_arm(settings["robot"], seed)
        row = of_arm(arm, seed, settings)
        total.update(row)
        arms += 1
        for what in BAD:
            if row[what]:
                culprits[what].append([seed, row[what]])
    sums = dict(total)
    yes_ns, no_ns = sums.pop("yes_ns"), sums.pop("no_ns")
    return {
        "arms": arms,
        **sums,
        "yes_us": yes_ns / 1e3 / sums["yes"] if sums["yes"] else None,
        "no_us": no_ns / 1e3 / sums["noes"] if sums["noes"] else None,
        "culprits": {what: seeds for what, seeds in culprits.items() if seeds},
    }


def of_arm(arm: Arm, seed: int, settings: Settings) -> Counter[str]:
    """The SUMS of one arm."""
    solver = iksel.Solver(arm.robot)
    row: Counter[str] = Counter(dict.fromkeys(SUMS, 0))
    batch = lost_of_random(arm, settings["targets"], seed, solver)
    row.update({what: batch[what] for what in ("targets", "lost", "false")})
    row["refuted"] += batch["proven"] - batch["swept"]
    _reachable(arm, solver, settings["asked"], seed + APART, row)
    noes = _any_rotation(arm, solver, settings["asked"], seed + APART, row)
    _restarted(solver, noes[: settings["brute"]], seed, row)
    _moves(arm, solver, settings["brute"], seed + 2 * APART, row)
    return row


def _timed(
    solver: iksel.Solver, poses: Array
) -> tuple[npt.NDArray[np.int64], Sequence[iksel.Result]]:
    """Least times [ns] and results of single calls, in order."""
    calls = [(pose,) for pose in poses]
    runs = [time_calls(solver.solve, calls, LIMIT_S) for _ in range(PASSES)]
    times = least_times([run[0] for run in runs])
    return times, runs[0][1][: len(times)]


def _judged(arm: Arm, poses: Array, results: Sequence[iksel.Result]) -> int:
    """How many answers are none."""
    solved = [i for i, result in enumerate(results) if result.success]
    if not solved:
        return 0
    q = np.array([results[i].q for i in solved])
    tolerance = TOLERANCE + ROUNDING
    good = right(arm.chain, poses[solved], q, tolerance, tolerance)
    return int(np.count_nonzero(~good))


def _reachable(
    arm: Arm, solver: iksel.Solver, count: int, seed: int, row: Counter[str]
) -> None:
    """Single calls at poses that can all be reached."""
    poses = make_targets(arm, "uniform", count, seed).poses
    times, results = _timed(solver, poses)
    solved = np.array([result.success for result in results])
    row["targets"] += len(results)
    row["lost"] += int(np.count_nonzero(~solved))
    row["refuted"] += sum(result.proven for result in results)
    row["false"] += _judged(arm, poses, results)
    row["yes"] += int(np.count_nonzero(solved))
    row["yes_ns"] += int(times[solved].sum())


def _any_rotation(
    arm: Arm, solver: iksel.Solver, count: int, seed: int, row: Counter[str]
) -> list[tuple[Array, bool]]:
    """Single calls at poses of which many have no answer.

    Returns:
        Those that got none, and whether that was proven.
    """
    poses = make_targets(arm, "any_rotation", count, seed).poses
    times, results = _timed(solver, poses)
    missing = [i for i, result in enumerate(results) if not result.success]
    row["false"] += _judged(arm, poses, results)
    row["noes"] += len(missing)
    row["no_ns"] += int(times[missing].sum())
    row["proven"] += sum(results[i].proven for i in missing)
    row["swept"] += sum(results[i].proof == iksel.Proof.sweep for i in missing)
    return [(poses[i], results[i].proven) for i in missing]


def _restarted(
    solver: iksel.Solver,
    noes: Sequence[tuple[Array, bool]],
    seed: int,
    row: Counter[str],
) -> None:
    """Noes asked again of the iteration alone, from random seeds."""
    options = iksel.SolverOptions(max_attempts=RESTARTS)
    patient = iksel.Solver(solver.robot, options, solver.database)
    for i, (pose, proven) in enumerate(noes):
        seeds = solver.robot.random_configurations(RESTARTS, seed + i)
        found = patient.solve(pose, seeds=seeds, database_seeds=False).success
        row["tried"] += 1
        row["tried_proofs"] += proven
        row["found"] += found
        row["refuted"] += found and proven


def _moves(
    arm: Arm, solver: iksel.Solver, count: int, seed: int, row: Counter[str]
) -> None:
    """Moves with `near` from any configuration, beside brute force."""
    known = arm.robot.random_configurations(count, seed)
    starts = arm.robot.random_configurations(count, seed + APART)
    for q, pose, start in zip(known, arm.robot.fk(known), starts, strict=True):
        near = solver.solve(pose, near=start)
        least = shortest_known(arm, solver, (q, pose), start, seed)
        row["moves"] += 1
        row["longer"] += not (near.success and near.move <= least + LONGER)


def shortest_known(
    arm: Arm,
    solver: iksel.Solver,
    known: tuple[Array, Array],
    start: Array,
    seed: int,
) -> float:
    """The shortest move that brute force knows: [rad], of a slide [m].

    That is to the configuration which the pose was made from, all of `solve_all`, and
    along the whole self-motion where it is a curve, else to what random restarts find.

    Args:
        arm: Of the solver.
        solver: What is asked.
        known: A configuration, (dof,), and its pose, (4, 4).
        start: Where the move begins, (dof,).
        seed: Of the restarts.
    """
    q, pose = known
    every = [q, *solver.solve_all(pose).q]
    least = np.inf
    structure = arm.robot.structure.kind
    if arm.robot.dof == 7 and structure == iksel.StructureKind.swept:
        least = along_arcs(solver, pose, start)
    else:
        every += list(branches_by_restarts(solver, pose, RESTARTS, seed))
    turned = nearest_turns(arm.chain, np.array(every), start)
    moves = np.linalg.norm(turned - start, axis=1)
    return min(least, float(np.nanmin(moves)))
