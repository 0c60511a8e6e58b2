# SPDX-License-Identifier: BSD-3-Clause
"""EAIK: analytic solutions for the families that have one."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

import numpy as np

from bench.rivals.axes import axes_of
from bench.rivals.base import PythonRival, UnsupportedError

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array


class Eaik(PythonRival):
    """All branches of one pose."""

    name = "EAIK"
    distribution = "EAIK"
    settings = "all branches, double precision; limits are not its business"
    keeps_limits = False
    share = 10.0

    def __init__(self, arm: Arm) -> None:
        """Find the decomposition."""
        module = importlib.import_module("eaik.IK_HP")
        self._axes = axes_of(arm)
        robot = module.HPRobot(self._axes.h, self._axes.p)
        if not robot.hasKnownDecomposition():
            raise UnsupportedError(
                f"no known decomposition of {arm.name} ({robot.getKinematicFamily()})"
            )
        self._lower, self._upper = arm.chain.lower, arm.chain.upper
        self.call = robot.IK  # type: ignore[method-assign]
        self.batch = robot.IK_batched

    def prepare(self, pose: Array, start: Array) -> tuple[Any, ...]:
        """The pose without the tip's own rotation."""
        del start
        turned = pose.copy()
        turned[:3, :3] = self._axes.rotation_for(pose)
        return (turned,)

    def call(self, *arguments: Any) -> Any:
        """Solve; replaced by the bound method itself."""
        raise NotImplementedError

    def answers(self, returned: Any) -> list[Array]:
        """The exact branches (a least-squares one says that there is none)."""
        exact = ~np.asarray(returned.is_LS, dtype=bool)
        return list(np.asarray(returned.Q)[exact]) if exact.size else []
