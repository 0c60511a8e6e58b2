# SPDX-License-Identifier: BSD-3-Clause
"""The slowest of many single calls, and why: the target, or what else ran.

The slowest are called again at once, and several times: what a target needs, it needs
each time. Where others become the slowest by this, they are called again as well. Of
those that are told of: the time of each stage, and whether poses around have answers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.arms import load_arm
from bench.targets import make_targets
from bench.timing import least_times, tail, time_calls

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    from bench.chain import Array
    from bench.store import Settings

CHUNK = 10_000
"""Targets at a time."""
SLOWEST = 0.002
"""Part of the calls that are called again: twice what p99.9 leaves out."""
LEAST = 20
"""As many of them at least."""
AGAIN = 10
"""How often."""
ROUNDS = 20
"""Others become the slowest when some were so by the machine; so often at most."""
LIMIT_S = 600.0
OTHERS = 2.0
"""A call that took so many times its least is not slow by its target."""
SHOWN = 5
"""Calls that are told of, the slowest first."""
AROUND = 20
"""Poses around each of these."""
AROUND_M, AROUND_RAD = 1e-3, 1e-3
"""How far from it, in random directions and about random axes."""
EDGES = 50
"""Targets, the slowest and others, that are asked whether they lie at an edge."""


def calls(settings: Settings) -> dict[str, Any]:
    """Quantiles as they came and by the least times, and the slowest calls of both."""
    arm = load_arm(settings["robot"])
    solver = iksel.Solver(arm.robot)
    came, least, slow, others = [], [], [], np.empty((0, 4, 4))
    for first in range(0, settings["count"], CHUNK):
        n = min(CHUNK, settings["count"] - first)
        seed = settings["seed"] + first
        poses = make_targets(arm, settings["of"], n, seed).poses
        times, results = time_calls(solver.solve, [(p,) for p in poses], LIMIT_S)
        mended, asked = _mended(solver, poses, times)
        slow += [
            _told(results[i], [seed, int(i)], int(times[i]), int(mended[i]))
            | {"pose": poses[i]}
            for i in np.flatnonzero(asked)
        ]
        others = poses[:EDGES] if first == 0 else others
        came.append(times)
        least.append(mended)
    by_machine = sum(call["us"] > OTHERS * call["again_us"] for call in slow)
    return {
        "came": tail(np.concatenate(came)),
        "least": tail(np.concatenate(least)),
        "again": len(slow),
        "by_machine": by_machine,
        "slowest": _first(solver, slow, "us"),
        "slowest_again": _first(solver, slow, "again_us"),
        "edges": _edges(solver, slow, others),
        "stages": _stages(solver, settings),
    }


def _mended(
    solver: iksel.Solver, poses: Array, times: npt.NDArray[np.int64]
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.bool_]]:
    """Times with the least ones of calls that are among the slowest by these, too.

    Returns:
        The times [ns], and which were called again.
    """
    mended = times.copy()
    asked = np.zeros(len(times), dtype=bool)
    count = max(LEAST, round(SLOWEST * len(times)))
    for _ in range(ROUNDS):
        worst = np.argsort(mended)[-count:]
        worst = worst[~asked[worst]]
        if not len(worst):
            break
        mended[worst] = np.minimum(times[worst], _again(solver, poses[worst]))
        asked[worst] = True
    return mended, asked


def _again(solver: iksel.Solver, poses: Array) -> npt.NDArray[np.int64]:
    """The least times of some more calls [ns]."""
    asked = [(pose,) for pose in poses]
    return np.asarray(
        least_times([time_calls(solver.solve, asked, LIMIT_S)[0] for _ in range(AGAIN)])
    )


def _told(
    result: iksel.Result, where: list[int], time_ns: int, least_ns: int
) -> dict[str, Any]:
    return {
        "us": time_ns / 1e3,
        "again_us": least_ns / 1e3,
        "where": where,
        "answer": result.success,
        "proof": result.proof.name,
        "attempts": result.attempts,
        "iterations": result.iterations,
    }


def _first(
    solver: iksel.Solver, slow: Sequence[dict[str, Any]], by: str
) -> list[dict[str, Any]]:
    """The slowest by a time, with what tells why."""
    told = []
    for call in sorted(slow, key=lambda call: -float(call[by]))[:SHOWN]:
        pose, seed = call["pose"], sum(call["where"])
        told.append(call | explained(solver, pose, seed))
        del told[-1]["pose"]
    return told


def explained(solver: iksel.Solver, pose: Array, seed: int) -> dict[str, Any]:
    """Times of the stages [us] of the fastest of some calls, and what lies around."""
    runs = [iksel.stage_times(solver, pose) for _ in range(AGAIN)]
    least = min(runs, key=lambda stages: sum(stages.values()))
    around = poses_around(pose, seed)
    answers = sum(solver.solve(each).success for each in around)
    median = float(np.median(_again(solver, around))) / 1e3
    return {
        "stages": least,
        "around": {"count": AROUND, "answers": answers, "median_us": median},
    }


def _edges(
    solver: iksel.Solver, slow: Sequence[dict[str, Any]], others: Array
) -> dict[str, int]:
    """How many of the slowest targets, and of others, lie at an edge.

    So that poses around have answers, and others have none.
    """
    slowest = sorted(slow, key=lambda call: -float(call["again_us"]))[: len(others)]
    return {
        "looked": len(slowest),
        "slow": sum(is_at_edge(solver, call["pose"]) for call in slowest),
        "others": sum(is_at_edge(solver, pose) for pose in others[: len(slowest)]),
    }


def is_at_edge(solver: iksel.Solver, pose: Array) -> bool:
    """Whether some of the poses around have an answer, and some have none."""
    return len({solver.solve(each).success for each in poses_around(pose, 0)}) > 1


def poses_around(pose: Array, seed: int) -> Array:
    """AROUND poses that are AROUND_M and AROUND_RAD from one, (n, 4, 4)."""
    ways = np.random.default_rng(seed).normal(size=(2, AROUND, 3))
    ways /= np.linalg.norm(ways, axis=2, keepdims=True)
    moved = []
    for shift, axis in zip(AROUND_M * ways[0], AROUND_RAD * ways[1], strict=True):
        turn = iksel.pose_from_rotation_vector(np.zeros(3), axis)[:3, :3]
        each = pose.copy()
        each[:3, :3] = turn @ pose[:3, :3]
        each[:3, 3] += shift
        moved.append(each)
    return np.array(moved)


def _stages(solver: iksel.Solver, settings: Settings) -> list[float]:
    """Mean times of query, seeds and iterations over reachable targets [us]."""
    count = min(CHUNK, settings["count"])
    figures = iksel.evaluate(solver, count, settings["seed"], stages=True)
    return [figures.query_us, figures.rank_us, figures.iterate_us]
