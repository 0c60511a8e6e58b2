# SPDX-License-Identifier: BSD-3-Clause
"""Denavit and Hartenberg's parameters of an arm of six joints that turn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from bench.rivals.axes import PARALLEL
from bench.rivals.base import UnsupportedError

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array


@dataclass(frozen=True)
class DhTable:
    """Rows of Rot(z, theta + q) Trans(z, d) Trans(x, a) Rot(x, alpha), (6,) each.

    Base and tool frames are left to bench.rivals.enumerator.fit_frames.
    """

    a: Array
    d: Array
    alpha: Array
    theta: Array


def dh_table(arm: Arm) -> DhTable:
    """The parameters of an arm.

    Raises:
        UnsupportedError: It has no six joints that turn.
    """
    chain = arm.chain
    if chain.dof != 6 or chain.prismatic.any():
        raise UnsupportedError(f"6 revolute joints only; {arm.name} has {chain.dof}")
    frames, _ = chain.joint_frames(np.zeros((1, 6)))
    h, points = frames[:, 0, :3, 2], frames[:, 0, :3, 3]
    rows = []
    x_before, origin = None, points[0]
    for i in range(5):
        x, first, second = _normal(points[i], h[i], points[i + 1], h[i + 1], origin)
        # The first frame is placed where the first normal starts.
        x_before, start = (x, first) if x_before is None else (x_before, origin)
        d = float((first - start) @ h[i])
        a = float((second - first) @ x)
        rows.append([a, d, _angle(h[i], h[i + 1], x), _angle(x_before, x, h[i])])
        x_before, origin = x, second
    rows.append([0.0, 0.0, 0.0, 0.0])
    return DhTable(*np.array(rows).T)


def _normal(
    p: Array, u: Array, q: Array, v: Array, near: Array
) -> tuple[Array, Array, Array]:
    """Direction and both ends of the common normal of the lines p + s u and q + t v.

    Of parallel lines it is the one through `near`, which lies on the first.
    """
    cross = np.cross(u, v)
    if np.linalg.norm(cross) < PARALLEL:
        second = q + ((near - q) @ v) * v
        across = second - near
        if np.linalg.norm(across) < PARALLEL:
            raise UnsupportedError("two neighbouring axes are the same")
        return across / np.linalg.norm(across), near, second
    s, t, _ = np.linalg.solve(np.column_stack([u, -v, cross]), q - p)
    return cross / np.linalg.norm(cross), p + s * u, q + t * v


def _angle(a: Array, b: Array, about: Array) -> float:
    """From a to b, both perpendicular to an axis, about it."""
    return float(np.arctan2(np.cross(a, b) @ about, a @ b))
