# SPDX-License-Identifier: BSD-3-Clause
"""What is lost of what is known to be there.

Targets that can be reached, as poses of configurations inside the limits
(bench.targets): uniform ones, ones at limits and ones near singularities. Each is
solved one at a time, in a batch, and as near as can be to a random configuration, and
every answer is judged by numpy. For arms whose solutions are isolated, the branches of
solve_all beside those that random restarts of the iteration find.

With --random, so many random arms of each build, and uniform targets in batches only;
what a batch loses is asked again in every other way. With --off, these are moved and
turned by up to that share of the tolerances, as rounding in a file does.
"""

from __future__ import annotations

import json
import time
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench import random_arms
from bench.arguments import add_count, add_robots, add_seed
from bench.arms import load_arm
from bench.branches import (
    ROUNDING,
    TOLERANCE,
    branches_by_restarts,
    compared,
    judged,
)
from bench.check import right
from bench.targets import make_targets

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator

    from bench.arms import Arm
    from bench.chain import Array
    from bench.targets import Targets

ROBOTS = (
    "ur3",
    "ur10e",
    "irb120",
    "vs060",
    "cvr038",
    "cvrb1213",
    "gen3_6dof",
    "xarm6",
    "panda",
    "iiwa14",
    "xarm7",
    "pr2_right_arm",
)
KINDS = ("near_limits", "near_singular")
CHUNK = 100_000
"""Targets at a time."""
WAYS = ("solve", "near", "solve_all", "diagnose")
"""What finds an answer where a batch says no."""


def chunks(arm: Arm, kind: str, count: int, seed: int) -> Iterator[Targets]:
    """So many targets of a kind, some at a time."""
    for first in range(0, count, CHUNK):
        yield make_targets(arm, kind, min(CHUNK, count - first), seed + first)


def reached(arm: Arm, kind: str, count: int, seed: int) -> dict[str, Any]:
    """How many of the targets are solved, and how many answers are false."""
    solver = iksel.Solver(arm.robot)
    ways = ("", "_by_batch", "_near")
    row = {"targets": 0, "called_a_proven_no": 0}
    row.update({what + way: 0 for way in ways for what in ("lost", "false")})
    tolerance = TOLERANCE + ROUNDING
    for targets in chunks(arm, kind, count, seed):
        poses = targets.poses
        single = [solver.solve(pose) for pose in poses]
        near = [
            solver.solve(pose, near=start)
            for pose, start in zip(poses, targets.starts, strict=True)
        ]
        batch = solver.solve_batch(poses)
        row["targets"] += len(poses)
        row["called_a_proven_no"] += sum(
            not result.success and result.proven for result in [*single, *near]
        )
        found = {"_by_batch": batch.success}
        answers = {"_by_batch": batch.q[batch.success]}
        for way, results in (("", single), ("_near", near)):
            found[way] = np.array([result.success for result in results])
            q = [result.q for result in results if result.success]
            answers[way] = np.array(q, dtype=float).reshape(-1, arm.chain.dof)
        for way, solved in found.items():
            good = right(arm.chain, poses[solved], answers[way], tolerance, tolerance)
            row["lost" + way] += int(np.count_nonzero(~solved))
            row["false" + way] += int(np.count_nonzero(~good))
    return row


def moved(poses: Array, off: float, seed: int) -> Array:
    """Poses (N, 4, 4) off by a random way and angle of up to `off` [m, rad]."""
    random = np.random.default_rng(seed)
    ways = random.normal(size=(2, len(poses), 3))
    ways *= random.uniform(0.0, off, (2, len(poses), 1)) / np.linalg.norm(
        ways, axis=2, keepdims=True
    )
    out = poses @ iksel.pose_from_rotation_vector(np.zeros(3), ways[1])
    out[:, :3, 3] += ways[0]
    return np.asarray(out)


def lost_of_random(
    arm: Arm,
    count: int,
    seed: int,
    solver: iksel.Solver | None = None,
    off: float = 0.0,
) -> dict[str, int]:
    """How many of so many uniform targets a batch loses, and what contradicts it.

    Of `proven` noes `swept` ones are those by a sweep. The solver is the arm's, made if
    none is given. Targets are off by up to that share of the tolerances.
    """
    if solver is None:
        solver = iksel.Solver(arm.robot)
    row = dict.fromkeys(("targets", "lost", "proven", "swept", *WAYS, "false"), 0)
    tolerance = TOLERANCE + ROUNDING
    for first in range(0, count, CHUNK):
        n = min(CHUNK, count - first)
        q = arm.robot.random_configurations(n, seed + first)
        poses = arm.robot.fk(q)
        if off > 0.0:
            poses = moved(poses, off * TOLERANCE, seed + first)
        batch = solver.solve_batch(poses)
        good = right(
            arm.chain,
            poses[batch.success],
            batch.q[batch.success],
            tolerance,
            tolerance,
        )
        row["targets"] += n
        row["false"] += int(np.count_nonzero(~good))
        for i in np.flatnonzero(~batch.success):
            row["lost"] += 1
            row["proven"] += int(batch.proof[i] != int(iksel.Proof.none))
            row["swept"] += int(batch.proof[i] == int(iksel.Proof.sweep))
            row["solve"] += solver.solve(poses[i]).success
            row["near"] += solver.solve(poses[i], near=q[i]).success
            row["solve_all"] += bool(len(solver.solve_all(poses[i])))
            row["diagnose"] += bool(solver.diagnose(poses[i]).q_is_solution)
    return row


def run_random(args: argparse.Namespace, conditions: dict[str, Any]) -> int:
    """Count on random arms, and print a line of JSON for each build."""
    bad = 0
    for build in args.builds or random_arms.BUILDS:
        total: dict[str, int] = {}
        worst = 0
        for i in range(args.seed, args.seed + args.random):
            arm = random_arms.random_arm(build, i)
            row = lost_of_random(arm, args.targets, i, off=args.off)
            worst = max(worst, row["lost"])
            for key, value in {"arms": 1, **row}.items():
                total[key] = total.get(key, 0) + value
        bad += total["lost"] + total["false"]
        line = {**conditions, "build": build, **total, "most_of_an_arm": worst}
        print(json.dumps(line), flush=True)
    return 1 if bad else 0


def beside_restarts(arm: Arm, count: int, restarts: int, seed: int) -> dict[str, Any]:
    """The branches of solve_all beside those of random restarts, pose by pose."""
    solver = iksel.Solver(arm.robot)
    poses = make_targets(arm, "uniform", count, seed).poses
    ours = judged(arm.chain, poses, [list(solver.solve_all(pose).q) for pose in poses])
    begin = time.perf_counter()
    theirs = [
        branches_by_restarts(solver, pose, restarts, seed + 1 + i)
        for i, pose in enumerate(poses)
    ]
    restarts_s = time.perf_counter() - begin
    given = judged(arm.chain, poses, [list(q) for q in theirs])
    return {
        "poses": count,
        "restarts": restarts,
        "branches": sum(map(len, ours.right)),
        "branches_by_restarts": sum(map(len, given.right)),
        "wrong": ours.wrong,
        **compared(ours.right, given.right),
        "restarts_s": restarts_s,
    }


def add(commands: Any) -> None:
    """The command `lost`."""
    command = commands.add_parser(
        "lost",
        help="reachable targets and branches that are not found",
        description=__doc__,
    )
    add_robots(command, ROBOTS)
    add_count(command, "--targets", 1_000_000, "uniform targets")
    add_count(
        command, "--hard", 100_000, "targets at limits, and as many near singularities"
    )
    add_count(
        command,
        "--poses",
        0,
        "poses whose branches are compared with those of restarts; only of arms "
        "of which no joint is redundant",
    )
    add_count(command, "--restarts", 10_000, "random seeds of brute force")
    add_count(command, "--random", 0, "random arms of each build")
    command.add_argument(
        "--builds",
        nargs="*",
        choices=tuple(random_arms.BUILDS),
        metavar="BUILD",
        help=f"of random arms: {' '.join(random_arms.BUILDS)}",
    )
    command.add_argument(
        "--off",
        type=float,
        default=0.0,
        metavar="SHARE",
        help="of the tolerances, by which targets of random arms are off, below 1 "
        "(default: %(default)s)",
    )
    add_seed(command)


def run(args: argparse.Namespace) -> int:
    """Measure, and print a line of JSON for each robot.

    The exit status is 1 if anything is lost or false.
    """
    conditions = {"simd": iksel.simd_level(), "seed": args.seed}
    if args.random > 0:
        return run_random(args, {**conditions, "off": args.off})
    bad = 0
    for name in args.robots:
        arm = load_arm(name)
        row: dict[str, Any] = {}
        counts = {"uniform": args.targets, **dict.fromkeys(KINDS, args.hard)}
        for kind, count in counts.items():
            if count > 0:
                row[kind] = reached(arm, kind, count, args.seed)
                bad += sum(row[kind].values()) - row[kind]["targets"]
        if args.poses > 0 and arm.robot.dof <= 6:
            row["restarts"] = beside_restarts(arm, args.poses, args.restarts, args.seed)
            bad += row["restarts"]["fewer"] + row["restarts"]["wrong"]
        print(json.dumps({**conditions, name: row}), flush=True)
    return 1 if bad else 0
