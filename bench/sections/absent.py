# SPDX-License-Identifier: BSD-3-Clause
"""What is not in the report's comparisons, and why: solvers, and built-in robots."""

from __future__ import annotations

from typing import TYPE_CHECKING

import iksel
from bench.markdown import listed, text_table

if TYPE_CHECKING:
    from bench.view import View

TRIED = "November 2026, on PyPI and Debian 12"
SOLVERS = {
    "pick_ik, bio_ik": (
        "plugins of MoveIt in C++; neither is on PyPI, nor MoveIt in Debian"
    ),
    "IKFast itself (OpenRAVE)": (
        "not on PyPI or in Debian: no code for another arm can be generated"
    ),
    "`ikfast-pybind` 0.1.2 (has IKFast's Panda)": (
        "does not compile: its CMake file asks for a version that CMake has dropped, "
        "and with that set its own pybind11 is too old for Python 3.11"
    ),
    "`frantik` 0.1 (Panda)": "does not compile: its build downloads CPM.cmake",
    "ssik's prebuilt arms": (
        "the artifact is built from our URDF in their place: their bases, tips and "
        "limits are others"
    ),
    "jaik, cuRobo, EmbodiChain's kernels": (
        "on a GPU, which is not compared with here"
    ),
}
"""Tried by hand: no run of the report can say why there is nothing to run."""
FULL_POSE = 6
"""Joints that it takes to reach poses in general."""


def text(view: View) -> str:
    """The whole section; empty where no solver was asked."""
    if not view.has_any("asked"):
        return ""
    return "\n\n".join(
        [
            "## What is not compared",
            f"Solvers that could not be had ({TRIED}, tried by hand), or are others:",
            text_table(["solver", "why"], SOLVERS.items()),
            small_robots(),
        ]
    )


def small_robots() -> str:
    """The built-in robots that are left out, and why."""
    names = [
        f"`{name}`"
        for name in iksel.robot_names()
        if iksel.robot_info(name).dof < FULL_POSE
    ]
    return (
        f"Built-in robots with fewer than {FULL_POSE} joints, {listed(names)}, are in "
        "no table but that of times before the first answer: a pose at random is out "
        "of reach for them, and most other solvers take six joints or seven."
    )
