# SPDX-License-Identifier: BSD-3-Clause
"""Poses as people hold them, told by what they can do and not by their type.

The core calls `to_matrices` about what is no (4, 4) array.
"""

from __future__ import annotations

import math
from typing import Any, NoReturn

import numpy as np
from iksel_cpp import RIGID_TOLERANCE, InvalidArgumentError, _describe

from iksel import _rotations as rotations

Array = np.ndarray[Any, Any]


def to_matrices(value: Any, name: str) -> Any:  # noqa: PLR0911 - a form each
    """`value` as matrices (..., 4, 4), if it is a pose or several; else what it is.

    (..., 3, 4) matrices; a pair (position, rotation), (..., 3) and (..., 3, 3) or an
    object with as_matrix(); an object with as_matrix(), .homogeneous or .A: scipy's
    Rotation and RigidTransform, Pinocchio's SE3, spatialmath's SE3 and UnitQuaternion;
    a message with named fields, as ROS has them; a list of such.

    Raises:
        InvalidArgumentError: A quaternion, whose order is not known, or which is none.
    """
    if _is_pair(value):
        rotation = _rotation_of(value[1])
        if not _ends_with(rotation, 3, 3):
            _refuse_quaternion(name)
        return _assemble(_numbers(value[0]), rotation)
    if (message := _matrix_of_message(value, name)) is not None:
        return message
    if (poses := _field(value, "poses")) is not None:  # of ROS's PoseArray and Path
        return to_matrices(list(poses), name)
    if (matrix := _own_matrix(value)) is not None:
        if _ends_with(_numbers(matrix), 3, 3):
            raise InvalidArgumentError(
                f"{name}: expected a pose, or a pair (position, rotation), "
                f"got {_describe(value)}"
            )
        return to_matrices(matrix, name)
    if isinstance(value, (list, tuple)) and value and _is_pose(value[0], name):
        return [to_matrices(item, name) for item in value]
    numbers = _numbers(value)
    if _ends_with(numbers, 3, 4):
        below = np.broadcast_to([0.0, 0.0, 0.0, 1.0], (*numbers.shape[:-2], 1, 4))
        return np.concatenate((numbers, below), axis=-2)
    if _ends_with(numbers, 7):
        _refuse_quaternion(name)
    return numbers if numbers.size > 0 else value


def _ends_with(array: Array, *shape: int) -> bool:
    return bool(array.shape[-len(shape) :] == shape)


def _numbers(value: Any) -> Array:
    """An array; an empty one if these are no numbers, as of a ragged list."""
    try:
        array = np.asarray(value)
    except Exception:  # noqa: BLE001 - whatever another library raises
        return np.zeros(0)
    is_none = array.dtype.kind == "O" and not isinstance(value, np.ndarray)
    return np.zeros(0) if is_none else array


def _attribute(value: Any, name: str) -> Any:
    try:
        return getattr(value, name, None)
    except Exception:  # noqa: BLE001 - a property of another library
        return None


def _field(value: Any, name: str) -> Any:
    """What a message, or a mapping, has under a name, unless that is a method."""
    if isinstance(value, np.ndarray):
        return None
    found = value.get(name) if isinstance(value, dict) else _attribute(value, name)
    return None if callable(found) else found


def _numbers_of(value: Any, names: str, argument: str) -> list[float] | None:
    """The numbers that a message has under names of one letter, if all are there."""
    numbers = [_field(value, name) for name in names]
    if any(number is None for number in numbers):
        return None
    for number in numbers:
        is_text = isinstance(number, (bool, str, bytes))
        if is_text or not hasattr(type(number), "__float__"):
            raise InvalidArgumentError(
                f"{argument}: expected a number, got {_describe(number)}"
            )
    return [float(number) for number in numbers]


def _matrix_of_message(value: Any, argument: str) -> Any:
    """The matrix of ROS's Pose or Transform, or of what holds one of them."""
    for inner in ("pose", "transform"):
        if (message := _field(value, inner)) is not None:
            return _matrix_of_message(message, argument)
    for first, second in (("position", "orientation"), ("translation", "rotation")):
        position, rotation = _field(value, first), _field(value, second)
        if position is None or rotation is None:
            continue
        p = _numbers_of(position, "xyz", argument)
        q = _numbers_of(rotation, "xyzw", argument)
        if not p or not q:
            continue
        norm = math.hypot(*q)
        if not abs(norm - 1) <= RIGID_TOLERANCE:
            empty = ", as in a message that was not filled in" if norm == 0 else ""
            raise InvalidArgumentError(
                f"{argument}: its {second} is no unit quaternion: "
                f"x, y, z, w = {q}{empty}"
            )
        unit = np.array((q[3], *q[:3])) / norm
        return _assemble(np.array(p), rotations.from_quaternion(unit))
    return None


def _own_matrix(value: Any) -> Any:
    """The matrix that an object of another library has for itself."""
    if isinstance(value, (np.ndarray, list, tuple)):
        return None
    if (as_matrix := _attribute(value, "as_matrix")) is not None:
        return as_matrix()
    if (homogeneous := _attribute(value, "homogeneous")) is not None:
        return homogeneous
    # A quaternion's A are its four numbers, a scalar and a vector.
    is_quaternion = all(_attribute(value, name) is not None for name in "svR")
    return _attribute(value, "R" if is_quaternion else "A")


def _rotation_of(value: Any) -> Array:
    matrix = _own_matrix(value)
    return _numbers(value if matrix is None else matrix)


def _is_pair(value: Any) -> bool:
    """Whether it is (position, rotation or quaternion): one pose or several."""
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        return False
    position, rotation = _numbers(value[0]), _rotation_of(value[1])
    if not _ends_with(position, 3):
        return False
    if _ends_with(rotation, 4):
        return rotation.ndim <= position.ndim
    if not _ends_with(rotation, 3, 3):
        return False
    # Two matrices (3, 3) are no pair; three positions with rotations are.
    is_matrix = isinstance(value[1], (np.ndarray, list, tuple))
    is_two = _ends_with(position, 3, 3) and rotation.ndim <= position.ndim and is_matrix
    return not is_two


def _is_pose(value: Any, name: str) -> bool:
    return (
        _is_pair(value)
        or _own_matrix(value) is not None
        or _matrix_of_message(value, name) is not None
    )


def _assemble(p: Array, rotation: Array) -> Any:
    """Poses (..., 4, 4) from positions (..., 3) and rotation matrices (..., 3, 3)."""
    lead = np.broadcast_shapes(p.shape[:-1], rotation.shape[:-2])
    poses = np.zeros((*lead, 4, 4))
    poses[..., :3, :3] = rotation
    poses[..., :3, 3] = p
    poses[..., 3, 3] = 1.0
    return poses


def _refuse_quaternion(name: str) -> NoReturn:
    raise InvalidArgumentError(
        f"{name}: a position and a quaternion do not say in which order the quaternion "
        'is; name it: iksel.as_pose(value, order="wxyz") or order="xyzw"'
    )
