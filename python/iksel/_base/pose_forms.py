# SPDX-License-Identifier: BSD-3-Clause
"""Poses as people hold them, told by what they can do and not by their type.

The core calls `to_matrices` about what does not end with axes of 4 and 4.
"""

from __future__ import annotations

import math
from typing import Any, NoReturn

import numpy as np
from iksel_cpp import RIGID_TOLERANCE, InvalidArgumentError, _describe

from iksel._base import rotations

ARRAYS = (np.ndarray, list, tuple)
ORDERLESS = (
    "a position and a quaternion do not say in which order the quaternion is; name it: "
    'iksel.as_pose(value, order="wxyz") or order="xyzw"'
)


def to_matrices(value: Any, name: str) -> Any:
    """`value` as matrices (..., 4, 4), if it is a pose or several; else what it is.

    (..., 3, 4) matrices; a pair (position, rotation), (..., 3) and (..., 3, 3) or an
    object with as_matrix(); an object with as_matrix(), .homogeneous or .A: scipy's
    Rotation and RigidTransform, Pinocchio's SE3, spatialmath's SE3 and UnitQuaternion;
    a message with named fields, as ROS has them; a list of such.

    Raises:
        InvalidArgumentError: A quaternion, whose order is not known, or which is none.
    """
    if not isinstance(value, ARRAYS):
        try:
            return _matrices_of_object(value, name)
        except RecursionError:  # it holds itself
            _refuse(name, "a pose", value)
    if pair := _pair(value):
        if not _ends_with(pair[1], 3, 3):
            raise InvalidArgumentError(f"{name}: {ORDERLESS}")
        return _assemble(*pair)
    if isinstance(value, (list, tuple)) and value and _is_pose(value[0], name):
        return [to_matrices(item, name) for item in value]
    numbers = _numbers(value)
    if _ends_with(numbers, 3, 4):
        below = np.broadcast_to([0.0, 0.0, 0.0, 1.0], (*numbers.shape[:-2], 1, 4))
        return np.concatenate((numbers, below), axis=-2)
    if _ends_with(numbers, 7):
        raise InvalidArgumentError(f"{name}: {ORDERLESS}")
    return numbers if numbers.size > 0 else value


def _matrices_of_object(value: Any, name: str) -> Any:
    if (message := _matrix_of_message(value, name)) is not None:
        return message
    if (poses := _field(value, "poses")) is not None:  # of ROS's PoseArray and Path
        return to_matrices(list(poses), name)
    if (matrix := _own_matrix(value)) is value:
        numbers = _numbers(value)
        return to_matrices(numbers, name) if numbers.size > 0 else value
    if _ends_with(_numbers(matrix), 3, 3):
        _refuse(name, "a pose, or a pair (position, rotation)", value)
    return to_matrices(matrix, name)


def _refuse(name: str, expected: str, value: Any) -> NoReturn:
    text = f"{name}: expected {expected}, got {_describe(value)}"
    raise InvalidArgumentError(text) from None


def _ends_with(array: Any, *shape: int) -> bool:
    return bool(array.shape[-len(shape) :] == shape)


def _numbers(value: Any) -> Any:
    """An array; an empty one if these are no numbers, as of a ragged list."""
    try:
        array = np.asarray(value)
    except Exception:  # noqa: BLE001 - whatever another library raises
        return np.zeros(0)
    is_none = array.dtype.kind == "O" and array is not value
    return np.zeros(0) if is_none else array


def _field(value: Any, name: str) -> Any:
    """What an object, or a mapping, has under a name, unless that is a method."""
    if isinstance(value, dict):
        return value.get(name)
    try:
        found = None if isinstance(value, ARRAYS) else getattr(value, name, None)
    except Exception:  # noqa: BLE001 - a property of another library
        return None
    return None if callable(found) else found


def _numbers_of(value: Any, names: str, argument: str) -> list[float] | None:
    """The numbers that a message has under names of one letter, if all are there."""
    numbers = [_field(value, name) for name in names]
    if any(number is None for number in numbers):
        return None
    for number in numbers:
        if isinstance(number, (bool, str)) or not hasattr(number, "__float__"):
            _refuse(argument, "a number", number)
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
        if p is None or q is None:
            continue
        norm = math.hypot(*q)
        if not abs(norm - 1) <= RIGID_TOLERANCE:
            empty = ", as in a message that was not filled in" if norm == 0 else ""
            text = f"its {second} is no unit quaternion: x, y, z, w = {q}{empty}"
            raise InvalidArgumentError(f"{argument}: {text}")
        unit = np.array((q[3], *q[:3])) / norm
        return _assemble(np.array(p), rotations.from_quaternion(unit))
    return None


def _own_matrix(value: Any) -> Any:
    """The matrix that an object of another library has for itself, or what it is."""
    if isinstance(value, ARRAYS):
        return value
    if callable(as_matrix := getattr(value, "as_matrix", None)):
        return as_matrix()
    # A quaternion's A are its four numbers, a scalar and a vector.
    is_quaternion = all(_field(value, name) is not None for name in "svR")
    for name in ("homogeneous", "R" if is_quaternion else "A"):
        if (matrix := _field(value, name)) is not None:
            return matrix
    return value


def _pair(value: Any) -> tuple[Any, Any] | None:
    """Position and rotation or quaternion, of one pose or several, if it is a pair."""
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        return None
    position, rotation = _numbers(value[0]), _numbers(_own_matrix(value[1]))
    if not _ends_with(position, 3):
        return None
    is_single = rotation.ndim <= position.ndim
    # Two matrices (3, 3) are no pair; three positions with rotations are.
    is_two = _ends_with(position, 3, 3) and is_single and isinstance(value[1], ARRAYS)
    is_matrix = _ends_with(rotation, 3, 3) and not is_two
    is_quaternion = _ends_with(rotation, 4) and is_single
    return (position, rotation) if is_matrix or is_quaternion else None


def _is_pose(value: Any, name: str) -> bool:
    if isinstance(value, ARRAYS):
        return _pair(value) is not None
    is_message = _matrix_of_message(value, name) is not None
    return is_message or _own_matrix(value) is not value


def _assemble(p: Any, rotation: Any) -> Any:
    """Poses (..., 4, 4) from positions (..., 3) and rotation matrices (..., 3, 3)."""
    lead = p.shape[:-1]
    if lead != rotation.shape[:-2]:
        lead = np.broadcast_shapes(lead, rotation.shape[:-2])
    poses = np.zeros((*lead, 4, 4))
    poses[..., :3, :3] = rotation
    poses[..., :3, 3] = p
    poses[..., 3, 3] = 1.0
    return poses
