# SPDX-License-Identifier: BSD-3-Clause
"""TRAC-IK by pytracik."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.rivals.base import PythonRival

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array


class TracIk(PythonRival):
    """TRAC-IK in a wheel without ROS."""

    name = "TRAC-IK (pytracik)"
    distribution = "pytracik"
    settings = "Speed, 5 ms, epsilon 1e-6, random start"

    def __init__(self, arm: Arm) -> None:
        """Hand it the chain's URDF."""
        module = importlib.import_module("pytracik")
        self._ik = module.ik
        self._solver = module.TRAC_IK(
            arm.base_link, arm.tip_link, arm.urdf, 5e-3, 1e-6, module.SolveType.Speed
        )

    def prepare(self, pose: Array, start: Array) -> tuple[Any, ...]:
        """Position and quaternion x y z w."""
        w, x, y, z = iksel.quaternion_from_pose(pose)
        return (start, *pose[:3, 3], x, y, z, w)

    def call(self, *arguments: Any) -> Any:
        """Solve."""
        return self._ik(self._solver, *arguments)

    def answers(self, returned: Any) -> list[Array]:
        """The first number is the status; not negative is success."""
        return [np.asarray(returned[1:])] if returned[0] >= 0 else []
