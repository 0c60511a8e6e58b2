# SPDX-License-Identifier: BSD-3-Clause
"""What makes a matrix a rotation or a pose, and errors that say what is missing."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from iksel._arrays import first_index, reject

if TYPE_CHECKING:
    from iksel._arrays import BoolArray, FloatArray

RIGID_TOLERANCE = 1e-6
"""Largest element of |R^T R - I| that still counts as rigid, as in the C++ core."""


def rotation_problems(
    rotation: FloatArray, tolerance: float = RIGID_TOLERANCE
) -> dict[str, BoolArray]:
    """For each way not to be a rotation, which matrices are so."""
    with np.errstate(invalid="ignore", over="ignore"):
        gram = np.swapaxes(rotation, -1, -2) @ rotation - np.eye(3)
        reflection = np.linalg.det(rotation) < 0
    return {
        f"R^T R differs from the identity by more than {tolerance}": np.asarray(
            ~(np.abs(gram).max(axis=(-2, -1)) <= tolerance)
        ),
        "det R is negative (a reflection)": np.asarray(reflection),
    }


def pose_problems(
    pose: FloatArray, tolerance: float = RIGID_TOLERANCE
) -> dict[str, BoolArray]:
    """For each way not to be rigid, which poses are so."""
    row = (pose[..., 3, :] == np.array([0.0, 0.0, 0.0, 1.0])).all(axis=-1)
    finite = np.isfinite(pose[..., :3, 3]).all(axis=-1)
    return {
        "the last row is not (0, 0, 0, 1)": np.asarray(~row),
        "the position is not finite": np.asarray(~finite),
        **rotation_problems(pose[..., :3, :3], tolerance),
    }


def require_none(name: str, matrix: FloatArray, problems: dict[str, BoolArray]) -> None:
    """Raise about the first of `problems` that any of `matrix` (..., n, n) has."""
    for problem, bad in problems.items():
        if bad.any():
            index = first_index(bad)
            which = f"{name}[{', '.join(map(str, index))}]" if index else name
            reject(which, f"not rigid, {problem}: {matrix[index].tolist()}")
