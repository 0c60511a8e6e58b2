# SPDX-License-Identifier: BSD-3-Clause
"""Subproblems 1, 3 and 4: angles about one axis, in closed form.

Source: Elias and Wen, "IK-Geo: Unified robot inverse kinematics using subproblem
decomposition", Mechanism and Machine Theory 209, 2025 (arXiv 2211.05737). Each
minimises an error; where the least is not zero, the angle is a least-squares solution
and says so.

Vectors are (..., 3) and broadcast against each other; k is a unit vector. With the
angle t, R(k, t) p = k (k . p) + sin(t) k x p - cos(t) k x (k x p).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    from bench.chain import Array

TOLERANCE = 1e-8
"""An error up to this, relative to what is compared, is none."""


class One(NamedTuple):
    """The angle of a subproblem that has one."""

    angle: Array
    """[rad], (...)."""
    least_squares: npt.NDArray[np.bool_]
    """Where no angle makes the error zero, (...)."""


class Two(NamedTuple):
    """The angles of a subproblem that has up to two, each once or both the same."""

    angles: Array
    """[rad], (2, ...). Where the error cannot be made zero, its minimiser twice."""
    least_squares: npt.NDArray[np.bool_]
    """Where no angle makes the error zero, (...)."""


def dot(a: Array, b: Array) -> Array:
    """Inner products, (...)."""
    return np.asarray(np.einsum("...i,...i", a, b))


def cross(a: Array, b: Array) -> Array:
    """Cross products, (..., 3)."""
    x = a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1]
    y = a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2]
    z = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return np.stack([x, y, z], axis=-1)


def turned(k: Array, angle: Array, p: Array) -> Array:
    """R(k, angle) p, (..., 3)."""
    across = cross(k, p)
    sine, cosine = np.sin(angle)[..., None], np.cos(angle)[..., None]
    return np.asarray(p + sine * across + (1.0 - cosine) * cross(k, across))


def subproblem_1(p1: Array, p2: Array, k: Array) -> One:
    """The angle that minimises |R(k, t) p1 - p2|."""
    across = cross(k, p1)
    angle = np.arctan2(dot(across, p2), -dot(cross(k, across), p2))
    length, along = np.sqrt(dot(p1, p1)), dot(k, p1)
    off = np.abs(length - np.sqrt(dot(p2, p2)))
    off = np.maximum(off, np.abs(along - dot(k, p2)))
    return One(angle, off > TOLERANCE * np.maximum(length, 1.0))


def subproblem_3(p1: Array, p2: Array, k: Array, d: Array) -> Two:
    """The angles that minimise | |R(k, t) p1 - p2| - d |."""
    return subproblem_4(p2, p1, k, 0.5 * (dot(p1, p1) + dot(p2, p2) - d * d))


def subproblem_4(h: Array, p: Array, k: Array, d: Array) -> Two:
    """The angles that minimise |h . R(k, t) p - d|.

    The error is a sin(t) + b cos(t) - c.
    """
    across = cross(k, p)
    a, b = dot(h, across), -dot(h, cross(k, across))
    c = d - dot(h, k) * dot(k, p)
    amplitude = a * a + b * b
    rest = amplitude - c * c
    root = np.sqrt(np.maximum(rest, 0.0))
    sign = np.array([1.0, -1.0]).reshape(2, *[1] * rest.ndim)
    angles = np.arctan2(a * c + sign * b * root, b * c - sign * a * root)
    return Two(angles, rest < 0.0)
