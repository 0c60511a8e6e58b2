# SPDX-License-Identifier: BSD-3-Clause
"""Poses and parts of poses that make no sense, and errors that say which and why."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import iksel

Array = npt.NDArray[np.float64]


def spoilt(row: int, column: int, value: float) -> Array:
    pose = np.eye(4)
    pose[row, column] = value
    return pose


NOT_RIGID = {
    "scaled": np.diag([2.0, 2.0, 2.0, 1.0]),
    "sheared": spoilt(0, 1, 1.1e-3),
    "mirrored": np.diag([1.0, 1.0, -1.0, 1.0]),
    "last row": spoilt(3, 0, 1e-3),
    "last element": spoilt(3, 3, 2.0),
    "NaN rotation": spoilt(1, 1, math.nan),
    "NaN position": spoilt(0, 3, math.nan),
    "infinite position": spoilt(2, 3, math.inf),
    "infinite rotation": spoilt(2, 2, -math.inf),
    "huge": spoilt(0, 1, 1e200),
    "zero": np.zeros((4, 4)),
}


@pytest.mark.parametrize("culprit", NOT_RIGID)
def test_what_is_not_rigid_is_refused(culprit: str) -> None:
    bad = NOT_RIGID[culprit]
    assert not iksel.is_rigid(bad)
    with pytest.raises(iksel.InvalidArgumentError, match=r"^pose: not (rigid|finite)"):
        iksel.check_pose(bad)
    many = np.stack([np.eye(4), np.eye(4), bad])
    assert iksel.is_rigid(many).tolist() == [True, True, False]
    with pytest.raises(iksel.InvalidArgumentError, match=r"goal(\[2\]|: .*\(2, )"):
        iksel.check_pose(many, "goal")
    with pytest.raises(iksel.InvalidArgumentError, match="target"):
        iksel.pose_error(bad, np.eye(4))


BAD_CALLS: list[tuple[Callable[..., Any], tuple[Any, ...], str]] = [
    (
        iksel.pose_from_quaternion,
        ([0, 0, 0], [1, 0, 0]),
        "quaternion: expected shape (..., 4), got (3,)",
    ),
    (
        iksel.pose_from_quaternion,
        ([0, 0, 0], [1, 0, 0, 1]),
        "quaternion: expected norm 1 within 0.001, got 1.414",
    ),
    (
        iksel.pose_from_quaternion,
        ([0, 0, 0], [0, 0, 0, 0]),
        "quaternion: expected norm 1 within 0.001, got 0.0",
    ),
    (
        iksel.pose_from_quaternion,
        ([0, 0, 0], [[1, 0, 0, 0], [0, 2, 0, 0]]),
        "got 2.0 at index 1",
    ),
    (
        iksel.pose_from_quaternion,
        ([0, 0, 0], [math.nan, 0, 0, 0]),
        "quaternion: not finite: nan at index 0",
    ),
    (
        iksel.pose_from_euler,
        ([0, 0], [0, 0, 0]),
        "position: expected shape (..., 3), got (2,)",
    ),
    (
        iksel.pose_from_euler,
        ([0, 0, 0], [0, math.inf, 0]),
        "rpy: not finite: inf at index 1",
    ),
    (
        iksel.pose_from_rotation_vector,
        ([0, 0, 0], 1.0),
        "rotation_vector: expected shape (..., 3), got ()",
    ),
    (
        iksel.pose_from_rotation_vector,
        (np.zeros((2, 3)), np.zeros((4, 3))),
        "position and rotation_vector: the leading axes (2,) and (4,) do not match",
    ),
    (
        iksel.pose_from_matrix,
        ([0, 0, 0], np.eye(4)),
        "rotation: expected shape (..., 3, 3), got (4, 4)",
    ),
    (
        iksel.pose_from_matrix,
        ([0, 0, 0], -np.eye(3)),
        "rotation: not rigid, det R is negative (a reflection)",
    ),
    (
        iksel.euler_from_pose,
        (np.eye(3),),
        "pose: expected shape (..., 4, 4), got (3, 3)",
    ),
    (
        iksel.rotation_vector_from_pose,
        (["a"] * 4,),
        "pose: expected shape (..., 4, 4), got (4,)",
    ),
    (
        iksel.pose_from_euler,
        (["a", "b", "c"], [0, 0, 0]),
        "position: expected real numbers, got an array of",
    ),
    (
        iksel.pose_from_euler,
        ([1j, 0, 0], [0, 0, 0]),
        "position: expected real numbers, got an array of complex128",
    ),
    (
        iksel.pose_from_euler,
        ([[1], [2, 3]], [0, 0, 0]),
        "position: expected numbers of shape (..., 3), got a ragged sequence",
    ),
    (iksel.is_rigid, ([1, 2],), "pose: expected shape (..., 4, 4), got (2,)"),
]


@pytest.mark.parametrize(("function", "arguments", "message"), BAD_CALLS)
def test_errors_name_argument_and_shape(
    function: Callable[..., Any], arguments: tuple[Any, ...], message: str
) -> None:
    with pytest.raises(iksel.InvalidArgumentError, match=re.escape(message)):
        function(*arguments)


def test_invalid_arguments_are_value_errors() -> None:
    with pytest.raises(ValueError, match="position"):
        iksel.pose_from_euler([0, 0], [0, 0, 0])
