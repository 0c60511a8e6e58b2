# SPDX-License-Identifier: BSD-3-Clause
"""Poses from and to quaternions, rotation vectors and Euler angles.

A pose is a 4x4 homogeneous matrix T_base_tip: it takes coordinates in the TCP's frame
to coordinates in the base frame; lengths are metres, angles radians. Quaternions are
(w, x, y, z). Every function works on one pose or on arrays of them: leading axes are
kept, and those of two arguments are broadcast against each other.

A pose may be given in any form that `as_pose` lists, and may be rounded: one whose
rotation is off by RIGID_TOLERANCE (1e-3) or less stands for the nearest rigid one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import iksel_cpp
import numpy as np

from iksel._base import rotations
from iksel._base.angles import warn_of_degrees
from iksel._base.arrays import (
    FloatArray,
    as_floats,
    broadcast_leading,
    first_index,
    index_text,
    reject,
)
from iksel._base.rigid import PoseLike, check_pose, is_rigid, orthonormalized

if TYPE_CHECKING:
    import numpy.typing as npt

__all__ = [
    "PoseLike",
    "QuaternionOrder",
    "as_pose",
    "check_pose",
    "euler_from_pose",
    "is_rigid",
    "orthonormalized",
    "pose_error",
    "pose_from_euler",
    "pose_from_matrix",
    "pose_from_quaternion",
    "pose_from_rotation_vector",
    "quaternion_from_pose",
    "rotation_vector_from_pose",
]

QuaternionOrder = Literal["wxyz", "xyzw"]
"""Whether the scalar of a quaternion comes first or last."""

UNIT_TOLERANCE = 1e-3
"""Largest deviation of a quaternion's norm from 1 that is normalised away."""


def pose_from_matrix(position: npt.ArrayLike, rotation: npt.ArrayLike) -> FloatArray:
    """Pose from a position and a rotation matrix.

    Args:
        position: Origin of the TCP in the base frame, (..., 3) [m].
        rotation: R_base_tip, (..., 3, 3); its columns are the TCP's axes. One that is
            off by RIGID_TOLERANCE or less is projected to the nearest rotation.

    Returns:
        T_base_tip, (..., 4, 4).

    Raises:
        InvalidArgumentError: Wrong shape, not finite, or no rotation.
    """
    matrix = as_floats("rotation", rotation, (3, 3))
    return check_pose(_assemble(position, "rotation", matrix), "rotation")


def pose_from_quaternion(
    position: npt.ArrayLike,
    quaternion: npt.ArrayLike,
    order: QuaternionOrder = "wxyz",
) -> FloatArray:
    """Pose from a position and a quaternion.

    Args:
        position: Origin of the TCP in the base frame, (..., 3) [m].
        quaternion: Rotation, (..., 4). A norm up to 1e-3 away from 1 is normalised; q
            and -q are the same rotation.
        order: "wxyz": the scalar first (Eigen's constructor, MuJoCo, Pinocchio's text);
            "xyzw": last (ROS, scipy, Bullet).

    Returns:
        T_base_tip, (..., 4, 4).

    Raises:
        InvalidArgumentError: Wrong shape, not finite, not of unit length, or another
            order.
    """
    name = "quaternion"
    _check_order(order)
    q = as_floats(name, quaternion, (4,))
    with np.errstate(over="ignore"):
        norm = np.linalg.norm(q, axis=-1)
    off = ~(np.abs(norm - 1.0) <= UNIT_TOLERANCE)
    if off.any():
        index = first_index(off)
        got = f"{norm[index]} at index {index_text(index)}" if index else norm[index]
        reject(name, f"expected norm 1 within {UNIT_TOLERANCE}, got {got}")
    q = q / norm[..., None]
    if order == "xyzw":
        q = q[..., [3, 0, 1, 2]]
    return _assemble(position, name, rotations.from_quaternion(q))


def pose_from_rotation_vector(
    position: npt.ArrayLike, rotation_vector: npt.ArrayLike
) -> FloatArray:
    """Pose from a position and a rotation vector (axis times angle).

    Args:
        position: Origin of the TCP in the base frame, (..., 3) [m].
        rotation_vector: Axis times angle in the base frame, (..., 3) [rad].

    Returns:
        T_base_tip, (..., 4, 4).

    Raises:
        InvalidArgumentError: Wrong shape or not finite.
    """
    vector = as_floats("rotation_vector", rotation_vector, (3,))
    q = rotations.quaternion_from_vector(vector)
    return _assemble(position, "rotation_vector", rotations.from_quaternion(q))


def pose_from_euler(position: npt.ArrayLike, rpy: npt.ArrayLike) -> FloatArray:
    """Pose from a position and roll, pitch, yaw as in a URDF: R = Rz(y) Ry(p) Rx(r).

    Args:
        position: Origin of the TCP in the base frame, (..., 3) [m].
        rpy: Roll, pitch and yaw, (..., 3) [rad]. Whole numbers beyond 2 pi look like
            degrees: an AngleUnitWarning.

    Returns:
        T_base_tip, (..., 4, 4).

    Raises:
        InvalidArgumentError: Wrong shape or not finite.
    """
    angles = as_floats("rpy", rpy, (3,))
    warn_of_degrees("rpy", angles)
    return _assemble(position, "rpy", rotations.from_euler(angles))


def quaternion_from_pose(pose: PoseLike) -> FloatArray:
    """Rotation of a pose as a unit quaternion (w, x, y, z) with w >= 0.

    Args:
        pose: T_base_tip, (..., 4, 4).

    Returns:
        Quaternions, (..., 4). At w = 0 the first of x, y, z that is not 0 is positive.

    Raises:
        InvalidArgumentError: Wrong shape, not finite, or not rigid.
    """
    return rotations.quaternion_from_matrix(check_pose(pose)[..., :3, :3])


def rotation_vector_from_pose(pose: PoseLike) -> FloatArray:
    """Rotation of a pose as axis times angle, the angle in [0, pi].

    Args:
        pose: T_base_tip, (..., 4, 4).

    Returns:
        Rotation vectors in the base frame, (..., 3) [rad].

    Raises:
        InvalidArgumentError: Wrong shape, not finite, or not rigid.
    """
    q = rotations.quaternion_from_matrix(check_pose(pose)[..., :3, :3])
    return rotations.vector_from_quaternion(q)


def euler_from_pose(pose: PoseLike) -> FloatArray:
    """Rotation of a pose as roll, pitch, yaw of a URDF: R = Rz(y) Ry(p) Rx(r).

    Args:
        pose: T_base_tip, (..., 4, 4).

    Returns:
        Roll in [-pi, pi], pitch in [-pi/2, pi/2] and yaw in [-pi, pi], (..., 3) [rad].
        Where the pitch is +-pi/2, only roll and yaw together are determined; the
        returned ones still give the same rotation.

    Raises:
        InvalidArgumentError: Wrong shape, not finite, or not rigid.
    """
    return rotations.euler_from_matrix(check_pose(pose)[..., :3, :3])


def as_pose(value: PoseLike, order: QuaternionOrder | None = None) -> FloatArray:
    """Turn a pose as other libraries hold it into a matrix.

    All but quaternions without names are also taken wherever iksel takes a pose;
    those, whose order differs between libraries, by this function only.

    Args:
        value: One of these, or a list of one of them:

            - a matrix (..., 4, 4) or (..., 3, 4);
            - a pair (position, rotation): (..., 3) and a matrix (..., 3, 3) or an
              object with as_matrix(), such as a scipy Rotation, or a spatialmath
              UnitQuaternion;
            - an object with as_matrix() (scipy RigidTransform), .homogeneous
              (Pinocchio SE3) or .A (spatialmath SE3);
            - a message with named fields, as an object or a dict: position and
              orientation (ROS Pose), translation and rotation (ROS Transform), or one
              that holds such under .pose, .transform or, several, .poses;
            - a pair (position, quaternion), (..., 3) and (..., 4);
            - position and quaternion in one row, (..., 7).
        order: Order of a quaternion: "wxyz" or "xyzw".

    Returns:
        T_base_tip, (..., 4, 4), rigid as `check_pose` makes it.

    Raises:
        InvalidArgumentError: None of these, a quaternion without an order, not finite,
            or not rigid.
    """
    if order is None:
        return check_pose(value, "value")
    _check_order(order)
    if isinstance(value, (tuple, list)) and len(value) == 2:
        position, quaternion = value
        if np.shape(quaternion)[-1:] == (4,) and np.shape(position)[-1:] == (3,):
            return pose_from_quaternion(position, quaternion, order)
    row = as_floats("value", value, (7,))
    return pose_from_quaternion(row[..., :3], row[..., 3:], order)


def pose_error(target: PoseLike, pose: PoseLike) -> tuple[FloatArray, FloatArray]:
    """How far `pose` is from `target`.

    Args:
        target: T_base_target, (..., 4, 4).
        pose: T_base_tip, (..., 4, 4).

    Returns:
        The distance of the origins [m] and the angle of R_target R^T, in [0, pi]
        [rad]; each of the leading shape.

    Raises:
        InvalidArgumentError: Wrong shape, not finite, or not rigid.
    """
    a, b = broadcast_leading(
        ("target", "pose"),
        (check_pose(target, "target"), check_pose(pose, "pose")),
        (2, 2),
    )
    errors = iksel_cpp.pose_error(a, b)
    distance = np.linalg.norm(errors[..., :3], axis=-1)
    return np.asarray(distance), np.asarray(np.linalg.norm(errors[..., 3:], axis=-1))


def _check_order(order: str) -> None:
    if order not in ("wxyz", "xyzw"):
        reject("order", f"expected one of wxyz, xyzw, got {order!r}")


def _assemble(position: npt.ArrayLike, name: str, rotation: FloatArray) -> FloatArray:
    """T from a position (..., 3) that is still to be checked and R (..., 3, 3)."""
    p, r = broadcast_leading(
        ("position", name), (as_floats("position", position, (3,)), rotation), (1, 2)
    )
    pose = np.zeros((*p.shape[:-1], 4, 4))
    pose[..., :3, :3] = r
    pose[..., :3, 3] = p
    pose[..., 3, 3] = 1.0
    return pose
