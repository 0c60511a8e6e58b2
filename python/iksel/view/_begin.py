# SPDX-License-Identifier: BSD-3-Clause
"""The configuration that a viewer begins with."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from iksel_cpp import JointType

from iksel._base.qualities import limit_distance, manipulability
from iksel.view._camera import VIEW_FROM

if TYPE_CHECKING:
    from iksel_cpp import Scene, Solver

    from iksel._base.arrays import FloatArray

SAMPLES = 4096  # of configurations to choose from


def open_configuration(solver: Solver, scene: Scene | None) -> FloatArray:
    """Of some random configurations one that shows the robot well.

    It is manipulable, far from limits, and free; no link is below the base's floor,
    where that is possible; and the arm stands up, with its tools before it (along x),
    pointing down and, of several, apart as the camera sees them.
    """
    robot = solver.robot
    some = robot.random_configurations(SAMPLES, seed=0)
    if scene is not None:
        free = np.asarray(scene.is_free(some))
        some = some[free] if free.any() else some
    heights = robot.link_poses(some)[..., 2, 3]
    lowest = heights.min(axis=1)
    above = lowest >= min(0.0, lowest.max()) - 1e-9
    some, heights = some[above], heights[above]
    tools = robot.fk(some).reshape(len(some), robot.tips, 4, 4)
    places = tools[..., :3, 3]
    sideways = places[..., :2]
    one, other = np.triu_indices(robot.tips, 1)
    between = np.cross(places[:, one] - places[:, other], VIEW_FROM)
    gaps = np.maximum(np.linalg.norm(between, axis=-1), 1e-9)
    away = np.maximum(np.linalg.norm(sideways, axis=-1), 1e-9)
    before = sideways[..., 0] / away
    quality = (
        manipulability(robot, some)
        * limit_distance(robot, some)
        * np.maximum(heights.mean(axis=1) - heights[:, 0].min(), 1e-9) ** 2
        * ((1.2 + before) * (1.5 - tools[..., 2, 2])).prod(axis=1)
        * (gaps**3).prod(axis=1)
    )
    q = some[np.argmax(quality)]
    # Of joints that can turn further than once around, the least turn.
    turns = np.array([kind != JointType.prismatic for kind in robot.joint_types])
    least = np.where(turns, (q + np.pi) % (2 * np.pi) - np.pi, q)
    inside = (robot.lower <= least) & (least <= robot.upper)
    return np.asarray(np.where(inside, least, q))
