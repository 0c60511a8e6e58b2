# SPDX-License-Identifier: BSD-3-Clause
"""A cell: one solver on one robot, both hands, and judged."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bench.timing import summary, time_calls
from bench.whole_body.robots import load_body
from bench.whole_body.solvers import SOLVERS

if TYPE_CHECKING:
    from bench.chain import Array
    from bench.store import Settings
    from bench.whole_body.robots import Body

KEPT = 10
"""Of the targets that were missed, so many are named."""


def measured(settings: Settings) -> dict[str, Any]:
    """One solver on one robot.

    Raises:
        UnsupportedError: There is no such robot here.
    """
    body = load_body(settings["robot"])
    solver = SOLVERS[settings["rival"]](body)
    q = body.random_configurations(settings["count"], settings["seed"])
    poses = body.fk(q)
    arguments = [(solver.prepare(tips),) for tips in poses]
    times, returned = time_calls(solver.call, arguments, settings["limit_s"])
    answers = [solver.answer(value) for value in returned]
    figures = judged(body, poses[: len(answers)], answers)
    kept = ("mean_us", "median_us", "p99_us", "max_us")
    spread = summary(times)
    return {
        "dof": body.robot.dof,
        "shared": body.shared,
        **figures,
        **{name: spread[name] for name in kept},
    }


def judged(body: Body, poses: Array, answers: list[Array | None]) -> dict[str, Any]:
    """What the answers to reachable targets are worth.

    Args:
        body: The robot.
        poses: Targets, (N, k, 4, 4).
        answers: For each one (dof,), or None.
    """
    claimed = np.array([answer is not None for answer in answers], dtype=bool)
    right = np.zeros(len(answers), dtype=bool)
    given = [answer for answer in answers if answer is not None]
    if given:
        right[claimed] = body.right(poses[claimed], np.array(given))
    missed = np.flatnonzero(~right)
    return {
        "count": len(answers),
        "missed": len(missed),
        "missed_targets": missed[:KEPT].tolist(),
        "wrong": int(np.count_nonzero(claimed & ~right)),
    }
