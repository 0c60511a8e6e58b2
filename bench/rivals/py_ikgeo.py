# SPDX-License-Identifier: BSD-3-Clause
"""py-ikgeo-kinematics: IK-Geo's families of six joints in Rust, with a check by FK."""

from __future__ import annotations

import importlib
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from bench.rivals.axes import axes_of
from bench.rivals.enumerator import Enumerator, Request

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array


class PyIkGeo(Enumerator):
    """The package's class Robot on axes and offsets."""

    name = "py-ikgeo"
    distribution = "py-ikgeo-kinematics"
    settings = (
        "axes and offsets, the family that it detects at its own tolerance (1e-9), "
        "radians; all branches in one call; nearest: the first inside the limits as it "
        "sorts them; limits are not its business"
    )
    keeps_limits = False

    def ways(self, arm: Arm) -> dict[str, Request]:
        """All branches, sorted by distance from a posture if there is one."""
        module = importlib.import_module("py_ikgeo_kinematics")
        rigid = importlib.import_module("scipy.spatial.transform").RigidTransform
        axes = axes_of(arm)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            robot = module.Robot(
                module.KinematicModel(axes.h.T, axes.p.T), degrees=False
            )
        self.family = robot.family

        def alone(pose: Array, near: Array) -> tuple[Any, ...]:
            del near
            turned = pose.copy()
            turned[:3, :3] = axes.rotation_for(pose)
            return (rigid.from_matrix(turned),)

        def both(pose: Array, near: Array) -> tuple[Any, ...]:
            return *alone(pose, near), tuple(map(float, near))

        return {
            "every": Request(alone, robot.inverse, _rows),
            "nearest": Request(both, robot.inverse, _rows),
        }


def _rows(returned: Any) -> list[Array]:
    return [np.array(q) for q in returned]
