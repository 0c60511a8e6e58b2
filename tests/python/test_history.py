# SPDX-License-Identifier: BSD-3-Clause
"""What was asked before leaves nothing behind: the same question, the same bits."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import iksel

# More of them try harder: IKSEL_TEST_CASES=1000.
POSES = int(os.environ.get("IKSEL_TEST_CASES", "40"))

Question = Callable[[iksel.Solver, np.ndarray, np.ndarray], Any]


def of_result(result: iksel.Result) -> tuple[Any, ...]:
    q = None if result.q is None else result.q.tobytes()
    counts = (result.attempts, result.iterations)
    return result.status, q, counts, result.proof, result.position_error


QUESTIONS: dict[str, Question] = {
    "solve": lambda s, pose, _: of_result(s.solve(pose)),
    "near": lambda s, pose, q: of_result(s.solve(pose, near=q)),
    "closest": lambda s, pose, _: of_result(s.solve(pose, closest=True)),
    "task": lambda s, pose, _: of_result(
        s.solve(pose, task=iksel.Task.position_only())
    ),
    "solve_all": lambda s, pose, _: s.solve_all(pose, max=8).q.tobytes(),
    "self_motion": lambda s, pose, _: (
        [arc.q.tobytes() for arc in s.self_motion(pose)] if s.robot.dof == 7 else None
    ),
    "solve_batch": lambda s, pose, _: s.solve_batch(np.stack([pose] * 3)).q.tobytes(),
}


@pytest.mark.parametrize(
    "name", ["xarm5", "irb120", "cvr038", "gen3_6dof", "ur5e", "panda", "iiwa14"]
)
def test_answers_do_not_depend_on_what_was_asked_before(name: str) -> None:
    robot = iksel.load_robot(name)
    solver = iksel.Solver(robot)
    near = robot.random_configurations(POSES, seed=1)
    pose = robot.fk(robot.random_configurations(POSES, seed=2))
    pose[::3, :3, :3] = pose[::3, :3, :3].transpose(0, 2, 1)  # most without an answer
    asked = [(kind, i) for kind in QUESTIONS for i in range(POSES)]
    first = {(kind, i): QUESTIONS[kind](solver, pose[i], near[i]) for kind, i in asked}
    rng = np.random.default_rng(3)
    for at in rng.permutation(len(asked)):
        kind, i = asked[at]
        again = QUESTIONS[kind](solver, pose[i], near[i])
        assert repr(again) == repr(first[kind, i]), (kind, i)
