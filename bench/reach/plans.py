# SPDX-License-Identifier: BSD-3-Clause
"""The maps that are measured."""

from __future__ import annotations

from typing import Any

import iksel
from iksel import reach

ROBOT = "ur5e"
SEED = 15


def large_plan(robot: iksel.Robot, **settings: Any) -> reach.Plan:
    """5 cm x 1,008 orientations, in all dimensions."""
    fixed: dict[str, Any] = {"spacing": 0.05, "orientations": 1000, "symmetry": False}
    return reach.plan(robot, **fixed | settings)


def small_plan() -> reach.Plan:
    """A map that takes some seconds, for what need not be large."""
    return large_plan(
        iksel.load_robot(ROBOT),
        spacing=0.1,
        orientations=300,
        qualities=["branches", "q"],
        chunk_cells=1 << 15,
    )
