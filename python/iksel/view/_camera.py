# SPDX-License-Identifier: BSD-3-Clause
"""Where the camera stands at first."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from iksel._base.arrays import FloatArray
    from iksel.view.skeleton import Skeleton

VIEW_FROM = np.array([0.75, -1.0, 0.45])
"""Direction from the robot to the camera."""
FIELD_OF_VIEW = np.deg2rad(40.0)
"""From the upper edge of the picture to the lower; narrow, so that the robot's
proportions are little changed by perspective."""
FARTHEST_IN_VIEW = 2.0
"""How far from the robot the picture goes at first for a map or obstacles [reaches]."""


def look_at(
    camera: Any, skeleton: Skeleton, body: FloatArray, others: FloatArray
) -> None:
    """Have viser's camera see the robot and other points, and little else.

    Args:
        camera: Viser's.
        skeleton: Of the robot.
        body: Points of the robot, (m, 3).
        others: Points of obstacles or a map, (n, 3); those far away are left out.
    """
    away = np.linalg.norm(others - skeleton.centre, axis=-1)
    near = others[away < FARTHEST_IN_VIEW * skeleton.reach]
    points = np.concatenate([body, near])
    lowest, highest = points.min(axis=0), points.max(axis=0)
    centre = (lowest + highest) / 2
    # The targets' handles stick out.
    radius = np.linalg.norm(points - centre, axis=1).max() + 0.12 * skeleton.reach
    distance = radius / np.sin(FIELD_OF_VIEW / 2)
    direction = VIEW_FROM / np.linalg.norm(VIEW_FROM)
    camera.fov = float(FIELD_OF_VIEW)
    camera.position = centre + distance * direction
    camera.look_at = centre
