# SPDX-License-Identifier: BSD-3-Clause
"""Self-collision asked by many threads at once, as a batch with a filter does."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tubes import URDF

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
