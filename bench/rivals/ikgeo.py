# SPDX-License-Identifier: BSD-3-Clause
"""IK-Geo by the Rust package ik-geo."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

import numpy as np

from bench.rivals.axes import Axes, axes_of
from bench.rivals.base import PythonRival

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array


def family(axes: Axes) -> str:
    """The decomposition that fits, by its name in the package."""
    if np.linalg.norm(axes.p[4:6]) < 1e-9:
        if axes.parallel(1, 2):
            return "spherical_two_parallel"
        meet = np.linalg.norm(axes.p[1]) < 1e-9
        return "spherical_two_intersecting" if meet else "spherical"
    if axes.parallel(1, 2) and axes.parallel(2, 3):
        intersect = np.linalg.norm(axes.p[5]) < 1e-9
        return "three_parallel_two_intersecting" if intersect else "three_parallel"
    if axes.parallel(1, 2):
        return "two_parallel"
    return "gen_six_dof"


PANIC = None
"""What IkGeo.call returns where the package panicked."""


class IkGeo(PythonRival):
    """All branches by subproblems, in closed form or with a search over one joint."""

    name = "IK-Geo"
    distribution = "ik-geo"
    settings = "the family that fits, all branches; limits are not its business"
    keeps_limits = False
    limit_s = 1.0

    def __init__(self, arm: Arm, name: str | None = None) -> None:
        """Take a family by its name in the package; None: choose one."""
        module = importlib.import_module("ik_geo")
        self._axes = axes_of(arm)
        self.family = name or family(self._axes)
        make = getattr(module.Robot, self.family)
        robot = make(self._axes.h.tolist(), self._axes.p.tolist())
        self._get_ik = robot.get_ik

    def prepare(self, pose: Array, start: Array) -> tuple[Any, ...]:
        """Rotation without the tip's own, and position.

        The package reads rotations column by column, so it gets the transpose.
        """
        del start
        turned = np.ascontiguousarray(self._axes.rotation_for(pose).T)
        return (turned, np.ascontiguousarray(pose[:3, 3]))

    def call(self, *arguments: Any) -> Any:
        """Solve; PANIC where the package panics."""
        try:
            return self._get_ik(*arguments)
        except BaseException as error:
            # pyo3's PanicException is no Exception, and its class has no import path.
            if type(error).__name__ != "PanicException":
                raise
            return PANIC

    def answers(self, returned: Any) -> list[Array]:
        """The exact branches (a least-squares one says that there is none)."""
        if returned is PANIC:
            return []
        return [np.asarray(q) for q, least_squares in returned if not least_squares]
