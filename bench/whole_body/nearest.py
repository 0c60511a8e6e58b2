# SPDX-License-Identifier: BSD-3-Clause
"""Moves by `near` of both hands, beside brute force."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.branches import SAME_MOVE
from bench.moves import APART
from bench.timing import time_calls
from bench.tips import changed
from bench.whole_body.brute import Brute

if TYPE_CHECKING:
    from bench.whole_body.robots import Body

STARTS = {"beside": 0.1, "any": None}
"""Where moves start: beside a configuration at the target, so large a part of each
joint's range about it, or anywhere inside the limits."""
SHOWN = 10
"""Of the moves that are longer, so many are named."""
LIMIT_S = 600.0
"""No call is begun after this time."""


def nearest(body: Body, start: str, count: int, seed: int) -> dict[str, Any]:
    """How many moves are longer than those of brute force, on one robot.

    Args:
        body: The robot.
        start: One of STARTS.
        count: Reachable targets.
        seed: Of targets and starts; that of brute force follows.
    """
    q = body.random_configurations(count, seed)
    poses, part = body.fk(q), STARTS[start]
    if part is None:
        near = body.random_configurations(count, seed + APART)
    else:
        near = changed(body.robot, q, part, seed)
    solver, brute = iksel.Solver(body.robot), Brute(body)
    times, results = time_calls(
        lambda pose, here: solver.solve(pose, near=here),
        list(zip(poses, near, strict=True)),
        LIMIT_S,
    )
    moves = np.array([result.move if result else np.inf for result in results])
    least = np.array(
        [brute.least_move(poses[i], near[i], seed + 1 + i) for i in range(len(results))]
    )
    given = np.flatnonzero(np.isfinite(moves))
    answers = np.array([results[i].q for i in given])
    longer = np.flatnonzero(~(moves <= least + SAME_MOVE))
    return {
        "cases": len(results),
        "none": len(results) - len(given),
        "wrong": int(np.count_nonzero(~body.right(poses[given], answers))),
        "longer": len(longer),
        "longest": float(np.max(moves - least, where=np.isfinite(least), initial=0.0)),
        "shorter": int(np.count_nonzero(moves < least - SAME_MOVE)),
        "mean_us": float(times.mean()) / 1e3,
        "named": longer[:SHOWN].tolist(),
    }
