# SPDX-License-Identifier: BSD-3-Clause
"""Poses that are rigid, or stand for rigid ones."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import iksel_cpp
from iksel_cpp import RIGID_TOLERANCE

from iksel._base.arrays import BoolArray, FloatArray, as_floats

if TYPE_CHECKING:
    import numpy as np

PoseLike = Any
"""A pose in one of the forms that `as_pose` lists."""


def is_rigid(
    pose: PoseLike, tolerance: float = RIGID_TOLERANCE
) -> np.bool_ | BoolArray:
    """Whether poses are finite and rigid: R^T R = I, det R > 0, last row 0 0 0 1.

    Args:
        pose: Matrices, (..., 4, 4); elements may be NaN or infinite.
        tolerance: Largest element of |R^T R - I|; by default that up to which a pose is
            accepted.

    Returns:
        One truth value per pose, of the leading shape.

    Raises:
        InvalidArgumentError: Not numbers of shape (..., 4, 4).
    """
    matrix = as_floats("pose", iksel_cpp.pose_matrices(pose), (4, 4), finite=False)
    rigid: np.bool_ | BoolArray = iksel_cpp.rigid_deviation(matrix)[()] <= tolerance
    return rigid


def check_pose(pose: PoseLike, name: str = "pose") -> FloatArray:
    """Give the rigid transforms that poses stand for.

    A pose that is rigid to rounding (|R^T R - I| <= 1e-12) is kept bit for bit; one
    whose rotation is off by RIGID_TOLERANCE (1e-3) or less, as when it was printed with
    a few decimals, is projected to the nearest. Every pose that iksel is given goes
    through this.

    Args:
        pose: T_base_tip, (..., 4, 4), or another form that `as_pose` lists.
        name: Name of the argument, for the error message.

    Returns:
        T_base_tip as float64, (..., 4, 4).

    Raises:
        InvalidArgumentError: Wrong shape, not finite or not rigid; the message says
            which pose and why.
    """
    matrix = as_floats(name, iksel_cpp.pose_matrices(pose, name), (4, 4))
    return iksel_cpp.check_pose(matrix, name)


def orthonormalized(pose: PoseLike) -> FloatArray:
    """Give the rigid transforms nearest to poses, however far off they are.

    For matrices that `check_pose` refuses: scaled, sheared, rounded to two decimals.
    The rotation is the orthogonal polar factor, the nearest by the sum of squares.

    Args:
        pose: T_base_tip, (..., 4, 4), or another form that `as_pose` lists.

    Returns:
        T_base_tip, (..., 4, 4).

    Raises:
        InvalidArgumentError: Wrong shape, not finite, singular or mirrored, or a last
            row other than (0, 0, 0, 1).
    """
    matrix = as_floats("pose", iksel_cpp.pose_matrices(pose), (4, 4))
    return iksel_cpp.orthonormalized(matrix)
