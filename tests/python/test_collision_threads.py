# SPDX-License-Identifier: BSD-3-Clause
"""Self-collision asked by many threads at once, as a batch with a filter does."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np
import pytest
from tubes import NAMES, URDF

import iksel

coal = pytest.importorskip("coal")
collision = pytest.importorskip("iksel.collision")


@pytest.mark.parametrize("margin", [0.0, 0.05])
def test_an_answer_does_not_depend_on_questions_in_between(
    monkeypatch: pytest.MonkeyPatch, margin: float
) -> None:
    arm = iksel.Robot.from_urdf(URDF, base_link="l0", tip_link="l6")
    q = arm.random_configurations(200, 7)
    expected = collision.SelfCollision(URDF, arm, samples=0, margin=margin)(q)
    assert 0 < expected.sum() < len(q)
    touching = q[~expected][0]
    between = True  # not while pairs are looked for

    class Interrupted:
        """A test before which another thread comes to ask."""

        def __init__(self, *shapes: Any) -> None:
            self.test = compute(*shapes)

        def __call__(self, *arguments: Any) -> Any:
            nonlocal between
            if not between:
                between = True
                assert not asked(touching)
                between = False
            return self.test(*arguments)

    compute = coal.ComputeCollision
    monkeypatch.setattr(coal, "ComputeCollision", Interrupted)
    asked = collision.SelfCollision(URDF, arm, samples=0, margin=margin)
    between = False
    np.testing.assert_array_equal(asked(q), expected)


def test_the_first_question_keeps_the_margin_for_all(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    arm = iksel.Robot.from_urdf(URDF, base_link="l0", tip_link="l6")
    q = arm.random_configurations(400, 7)
    keep = collision.SelfCollision(URDF, arm, samples=0, margin=0.05).pairs
    known = {
        "margin": 0.05,
        "keep": keep,
        "ignore": [pair for pair in combinations(NAMES, 2) if pair not in keep],
    }
    expected = collision.SelfCollision(URDF, arm, samples=0, **known)(q)
    answers = []

    class Interrupted(coal.CollisionRequest):  # type: ignore[misc]
        """A request before whose margin is set another thread comes to ask."""

        def __setattr__(self, name: str, value: Any) -> None:
            if name == "security_margin" and not answers:
                answers.append(None)
                answers[0] = asked(q)
            super().__setattr__(name, value)

    monkeypatch.setattr(coal, "CollisionRequest", Interrupted)
    asked = collision.SelfCollision(URDF, arm, samples=0, **known)
    np.testing.assert_array_equal(asked(q), expected)
    np.testing.assert_array_equal(answers[0], expected)
