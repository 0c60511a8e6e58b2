# SPDX-License-Identifier: BSD-3-Clause
"""Turns of a robot's first and last joint that change nothing about reachability.

With the first joint turned by any angle, all poses turn about its axis; where its range
is a whole turn or more, a pose can be reached if and only if all of its turns can. The
same holds for the last joint and the tool, which it turns about its own axis. Whether
it is so is measured by forward kinematics, mimic joints and tools included.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from iksel_cpp import JointType, Robot

from iksel.reach._grid import least_rotations, z_rotations

if TYPE_CHECKING:
    from iksel._base.arrays import FloatArray

SAMPLES = 16
SEED = 1
TOLERANCE = 1e-9
"""How exactly a turn of the joint has to be a turn of the pose [m, rad]."""


def turns_freely(robot: Robot, joint: int) -> bool:
    """Whether the joint is revolute with a range of a whole turn or more.

    Not if it may be in a coupled limit: its turns change the sum then, and where that
    is of a mimic joint, the source has another name.
    """
    if robot.joint_types[joint] == JointType.prismatic:
        return False
    others = set(robot.joint_names) - {robot.joint_names[joint]}
    if any(set(limit.coefficients) - others for limit in robot.coupled_limits):
        return False
    return not robot.upper[joint] - robot.lower[joint] < 2 * np.pi


def first_axis(robot: Robot) -> FloatArray | None:
    """The axis of the first joint, if poses may be turned about it.

    Returns:
        T_base_axis, (4, 4), with z along the axis: the base frame itself where its z
        axis is the joint's, up to the sign; None: the turn is no symmetry.
    """
    if not turns_freely(robot, 0):
        return None
    q = robot.random_configurations(1, seed=SEED)[0]
    linear, angular = np.split(robot.jacobian(q)[:, 0], 2)
    # linear = angular x arm, with the arm from the axis to the TCP.
    frame = _frame(robot.fk(q)[:3, 3] - np.cross(linear, angular), angular)
    return frame if _is_turn(robot, frame) else None


def last_axis(robot: Robot) -> FloatArray | None:
    """The axis of the last joint in the tool's frame, if the tool may be spun about it.

    Returns:
        A unit vector, (3,), of the two the one whose largest part is positive; None:
        the spin is no symmetry, or moves the TCP, which does not lie on the axis.
    """
    if not turns_freely(robot, robot.dof - 1):
        return None
    q = robot.random_configurations(1, seed=SEED)[0]
    linear, angular = np.split(robot.jacobian(q)[:, -1], 2)
    if np.linalg.norm(linear) > TOLERANCE:
        return None
    axis = _rounded(robot.fk(q)[:3, :3].T @ angular)
    axis = axis if axis[np.argmax(np.abs(axis))] > 0 else -axis
    return axis if _is_spin(robot, axis) else None


def _frame(point: FloatArray, axis: FloatArray) -> FloatArray:
    """T_base_axis, (4, 4): z along the axis, the origin next to the base's."""
    axis = _rounded(axis)
    axis = axis if axis[np.argmax(np.abs(axis))] > 0 else -axis
    frame = np.eye(4)
    frame[:3, :3] = least_rotations(axis[None])[0]
    frame[:3, 3] = _rounded(point - axis * (axis @ point))
    return frame


def _rounded(vector: FloatArray) -> FloatArray:
    """Without the rounding errors that would make it another than a simple vector."""
    simple = np.rint(vector) + 0.0
    return simple if np.abs(vector - simple).max() < TOLERANCE else vector


def _is_turn(robot: Robot, frame: FloatArray) -> bool:
    """Whether the first joint turns the pose about the frame's z axis."""
    q, angles = _samples(robot)
    moved = q.copy()
    moved[:, 0] += angles
    turn = np.tile(np.eye(4), (len(q), 1, 1))
    turn[:, :3, :3] = z_rotations(angles)
    back = np.linalg.inv(frame)
    expected = [
        frame @ (sign @ (back @ robot.fk(q))) for sign in (turn, _inverse(turn))
    ]
    poses = robot.fk(moved)
    return any(np.abs(poses - e).max() < TOLERANCE for e in expected)


def _is_spin(robot: Robot, axis: FloatArray) -> bool:
    """Whether the last joint turns the tool about that axis of it."""
    q, angles = _samples(robot)
    moved = q.copy()
    moved[:, -1] += angles
    to_axis = least_rotations(axis[None])[0]
    spin = np.tile(np.eye(4), (len(q), 1, 1))
    spin[:, :3, :3] = to_axis @ z_rotations(angles) @ to_axis.T
    poses = robot.fk(moved)
    return any(
        np.abs(poses - robot.fk(q) @ e).max() < TOLERANCE
        for e in (spin, _inverse(spin))
    )


def _samples(robot: Robot) -> tuple[FloatArray, FloatArray]:
    """Configurations and angles to try."""
    q = robot.random_configurations(SAMPLES, seed=SEED)
    return q, np.linspace(-np.pi, np.pi, SAMPLES)


def _inverse(turns: FloatArray) -> FloatArray:
    return np.swapaxes(turns, -1, -2)
