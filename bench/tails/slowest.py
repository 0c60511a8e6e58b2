# SPDX-License-Identifier: BSD-3-Clause
"""The slowest of many single calls, and why: the target, or what else ran.

The slowest are called again at once, and several times: what a target needs, it needs
each time. Where others become the slowest by this, they are called again as well.
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


def calls(settings: Settings) -> dict[str, Any]:
    """Quantiles as they came and by the least times, and the slowest calls of both."""
    arm = load_arm(settings["robot"])
    solver = iksel.Solver(arm.robot)
    came, least, slow = [], [], []
    for first in range(0, settings["count"], CHUNK):
        n = min(CHUNK, settings["count"] - first)
        seed = settings["seed"] + first
        poses = make_targets(arm, settings["of"], n, seed).poses
        times, results = time_calls(solver.solve, [(p,) for p in poses], LIMIT_S)
        mended, asked = _mended(solver, poses, times)
        slow += [
            _told(results[i], [seed, int(i)], int(times[i]), int(mended[i]))
            for i in np.flatnonzero(asked)
        ]
        came.append(times)
        least.append(mended)
    by_machine = sum(call["us"] > OTHERS * call["again_us"] for call in slow)
    return {
        "came": tail(np.concatenate(came)),
        "least": tail(np.concatenate(least)),
        "again": len(slow),
        "by_machine": by_machine,
        "slowest": _first(slow, "us"),
        "slowest_again": _first(slow, "again_us"),
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


def _first(slow: Sequence[dict[str, Any]], by: str) -> list[dict[str, Any]]:
    return sorted(slow, key=lambda call: -float(call[by]))[:SHOWN]


def _stages(solver: iksel.Solver, settings: Settings) -> list[float]:
    """Mean times of query, seeds and iterations over reachable targets [us]."""
    count = min(CHUNK, settings["count"])
    figures = iksel.evaluate(solver, count, settings["seed"], stages=True)
    return [figures.query_us, figures.rank_us, figures.iterate_us]
