# SPDX-License-Identifier: BSD-3-Clause
"""What can be measured: one function per kind of cell, from settings to a result.

Cells run in worker processes (bench.worker). Settings and results are plain data.
"""

from __future__ import annotations

import functools
import time
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.analytic.cells import asked
from bench.analytic.counted import counted
from bench.arms import load_arm
from bench.branches import all_branches, judged, near_branches
from bench.check import judge, right
from bench.ikgeo.cells import enumerated, packaged, searched
from bench.no import answered
from bench.paper import newer, paired, seeds_shown
from bench.paper.artefact import singular_first
from bench.random_builds import measured as random_builds
from bench.requests import near_moves, path
from bench.restarts import restarts
from bench.rivals import RIVALS
from bench.rivals.base import UnsupportedError, least_run
from bench.seed_makers import first_attempt
from bench.settings import make_solver, targets_of
from bench.tails.beside import beside, threads
from bench.tails.fresh import fresh
from bench.tails.slowest import calls
from bench.timing import PASSES, summary
from bench.whole_body import cells as whole_body_cells

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from bench.arms import Arm
    from bench.chain import Array
    from bench.rivals.base import Rival
    from bench.store import Settings
    from bench.targets import Targets

CEILING_ATTEMPTS = 100
"""Attempts of the paper's near-optimal line."""


def targets(settings: Settings) -> dict[str, Any]:
    """Make the targets that others will read."""
    return {"count": len(targets_of(settings))}


def evaluate(settings: Settings) -> dict[str, Any]:
    """The paper's protocol by iksel.evaluate, timed inside C++."""
    solver = make_solver(settings)
    count, seed = settings["count"], settings["seed"]
    figures = iksel.evaluate(solver, count, seed, settings.get("stages", False))
    database = solver.database
    return {**figures.to_dict(), "samples": len(database), "bytes": database.nbytes}


def attempts(settings: Settings) -> dict[str, Any]:
    """Targets solved within 1, 2, ... attempts, from one run with many.

    An attempt does not know how many may follow it, so a run that is allowed r attempts
    solves just what a longer run has solved by its attempt r.
    """
    solver = make_solver(settings)
    arm = load_arm(settings["robot"])
    q = arm.robot.random_configurations(settings["count"], settings["seed"])
    # To the last bit the targets of iksel.evaluate.
    poses = arm.robot.fk(q, iksel.Kinematics.kdl)
    result = solver.solve_batch(poses)
    longest = solver.options.max_attempts
    by_attempt = np.bincount(result.attempts[result.success], minlength=longest + 1)
    outside = np.count_nonzero(result.status == int(iksel.Status.outside_limits))
    return {
        "solved": np.cumsum(by_attempt)[1:].tolist(),
        "converged_outside_limits": int(outside),
        "count": settings["count"],
        "samples": len(solver.database),
    }


def rival(settings: Settings) -> dict[str, Any]:
    """One solver on one kind of targets, judged by bench.check."""
    arm = load_arm(settings["robot"])
    try:
        solver = _rival(settings["robot"], settings["rival"])
    except UnsupportedError as reason:
        return {"unsupported": str(reason)}
    goals = targets_of(settings)
    run = least_run(solver, goals)
    done = len(run.answers)
    verdict = judge(arm.chain, goals.poses[:done], run.answers)
    result = {
        "count": done,
        "right": int(verdict.right.sum()),
        "claimed": int(verdict.claimed.sum()),
        "false_claims": verdict.false_claims,
        **summary(run.times_ns),
    }
    # Success over time: the times of the right answers alone.
    quantiles = summary(run.times_ns[verdict.right]) if verdict.right.any() else {}
    result["right_quantiles_us"] = quantiles.get("quantiles_us", [])
    return result


@functools.lru_cache(maxsize=1)
def _rival(robot: str, name: str) -> Rival:
    return RIVALS[name](load_arm(robot))


def batch(settings: Settings) -> dict[str, Any]:
    """Many poses in one call: time per pose, best of three.

    With "every" all branches of each: IKSel has no such call, so it is asked pose by
    pose, on each thread a part of them. EAIK has no other.
    """
    arm = load_arm(settings["robot"])
    goals = targets_of(settings)
    threads = settings["threads"]
    solver = iksel.Solver(arm.robot)
    call: Callable[[], Any]
    if settings["rival"] == "EAIK":
        eaik: Any = _rival(settings["robot"], "EAIK")
        poses = np.array([eaik.prepare(pose, None)[0] for pose in goals.poses])
        call = functools.partial(eaik.batch, poses, threads)
    elif settings.get("every"):
        call = functools.partial(each, solver.solve_all, list(goals.poses), threads)
    else:
        call = functools.partial(solver.solve_batch, goals.poses, threads=threads)
    returned: Any = call()
    times = []
    for _ in range(PASSES):
        begin = time.perf_counter_ns()
        returned = call()
        times.append(time.perf_counter_ns() - begin)
    result = {"count": len(goals), "us_per_pose": min(times) / 1e3 / len(goals)}
    if settings["rival"] != "EAIK" and not settings.get("every"):
        solved = int(right(arm.chain, goals.poses, returned.q).sum())
        return {**result, "right": solved}
    if settings["rival"] == "EAIK":
        answers = [eaik.answers(solution) for solution in returned]
    else:
        answers = [list(solution.q) for solution in returned]
    inside = judged(arm.chain, goals.poses, answers).right
    return {
        **result,
        "right": int(judge(arm.chain, goals.poses, answers).right.sum()),
        "branches": sum(map(len, inside)),
    }


def each(call: Callable[..., Any], poses: Sequence[Array], threads: int) -> list[Any]:
    """A call on every pose, in the order of these: on each thread a part of them."""
    if threads == 1:
        return [call(pose) for pose in poses]
    size = -(-len(poses) // threads)
    parts = [poses[i : i + size] for i in range(0, len(poses), size)]
    with ThreadPoolExecutor(threads) as pool:
        done = pool.map(lambda part: each(call, part, 1), parts)
        return [returned for some in done for returned in some]


def artefact(settings: Settings) -> dict[str, Any]:
    """How often a singular sample ranks first; bench.paper.artefact."""
    solver = make_solver(settings)
    arm = load_arm(settings["robot"])
    q = arm.robot.random_configurations(settings["count"], settings["seed"])
    return singular_first(solver, arm.chain.fk(q))


def learned(settings: Settings) -> dict[str, Any]:
    """Outputs of a learned model, and they as seeds; bench.learned.evaluate."""
    try:
        from bench.learned.evaluate import measured  # noqa: PLC0415 - needs jax
    except ModuleNotFoundError as missing:
        return {"unsupported": f"{missing.name} is not installed"}
    return measured(settings)


def whole_body(settings: Settings) -> dict[str, Any]:
    """Both hands of a robot with a torso; bench.whole_body.cells."""
    try:
        return whole_body_cells.measured(settings)
    except UnsupportedError as reason:
        return {"unsupported": str(reason)}


ON_TARGETS: dict[str, Callable[[Arm, Targets, Settings], dict[str, Any]]] = {
    "no": answered,
    "near_branches": near_branches,
    "near_moves": near_moves,
    "all_branches": all_branches,
    "restarts": restarts,
    "ikgeo_search": searched,
    "ikgeo_package": packaged,
    "ikgeo_enumeration": enumerated,
    "first_attempt": first_attempt,
    "asked": asked,
    "counted": counted,
}
"""Functions of an arm, its targets and settings, by the names under "cell"."""


def _on_targets(name: str, settings: Settings) -> dict[str, Any]:
    """One of ON_TARGETS, or why there is no such solver."""
    try:
        return ON_TARGETS[name](
            load_arm(settings["robot"]), targets_of(settings), settings
        )
    except UnsupportedError as reason:
        return {"unsupported": str(reason)}


CELLS: dict[str, Callable[[Settings], dict[str, Any]]] = {
    "targets": targets,
    "evaluate": evaluate,
    "attempts": attempts,
    "rival": rival,
    "batch": batch,
    "artefact": artefact,
    "learned": learned,
    "newer": newer.measured,
    "paired": paired.paired,
    "seeds_shown": seeds_shown.measured,
    "tree_file": paired.tree_file,
    **{name: functools.partial(_on_targets, name) for name in ON_TARGETS},
    "path": path,
    "random_arms": random_builds,
    "tail_calls": calls,
    "tail_beside": beside,
    "tail_threads": threads,
    "tail_fresh": fresh,
    "whole_body": whole_body,
}
"""The functions by the names that settings have under "cell"."""
