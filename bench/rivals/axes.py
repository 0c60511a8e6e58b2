# SPDX-License-Identifier: BSD-3-Clause
"""An arm as the analytic solvers want it: axes and offsets at zero joint values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from bench.rivals.base import UnsupportedError

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array

PARALLEL = 1e-9
"""Axes whose cross product is shorter than this are parallel; nearer, they meet [m]."""


@dataclass(frozen=True)
class Axes:
    """A product of exponentials: R = R1..Rn, p = p0 + R1 p1 + ... + R1..Rn pn."""

    h: Array
    """Unit joint axes in the base frame, (dof, 3)."""
    p: Array
    """From each joint's origin to the next, base first and tip last, (dof + 1, 3)."""
    tip_rotation: Array
    """Rotation of the tip at zero, (3, 3); the solvers take it to be none."""

    def rotation_for(self, pose: Array) -> Array:
        """The rotation to ask such a solver for, so that the tip gets the pose's."""
        return np.ascontiguousarray(pose[:3, :3] @ self.tip_rotation.T)

    def parallel(self, first: int, second: int) -> bool:
        """Whether two joints, counted from 0, have parallel axes."""
        cross = np.cross(self.h[first], self.h[second])
        return bool(np.linalg.norm(cross) < PARALLEL)


def axes_of(arm: Arm) -> Axes:
    """The axes of an arm with 6 revolute joints.

    The origins of neighbouring axes that intersect are put on the intersection, as the
    subproblem decompositions expect.

    Raises:
        UnsupportedError: It is another arm.
    """
    chain = arm.chain
    if chain.dof != 6 or chain.prismatic.any():
        raise UnsupportedError(f"6 revolute joints only; {arm.name} has {chain.dof}")
    frames, tip = chain.joint_frames(np.zeros((1, 6)))
    h = frames[:, 0, :3, 2]
    origins = frames[:, 0, :3, 3].copy()
    # From the tip backwards: the wrist's intersections matter most.
    free = [True] * 6
    wrist = meeting_point(h[3:], origins[3:])
    if wrist is not None:
        origins[3:] = wrist
        free[3:] = [False] * 3
    for i in reversed(range(5)):
        point = _intersection(origins[i], h[i], origins[i + 1], h[i + 1])
        if point is not None and free[i] and free[i + 1]:
            origins[i] = origins[i + 1] = point
            free[i] = free[i + 1] = False
    points = np.vstack([np.zeros(3), origins, tip[0, :3, 3]])
    return Axes(h, np.diff(points, axis=0), tip[0, :3, :3])


def meeting_point(h: Array, p: Array) -> Array | None:
    """Where the lines through p along unit h, (n, 3) each, meet, if they do."""
    across = np.eye(3) - h[:, :, None] * h[:, None, :]
    gaps = np.einsum("nij,nj->ni", across, p)
    point, *_ = np.linalg.lstsq(across.reshape(-1, 3), gaps.ravel(), rcond=None)
    far = np.abs(across @ point - gaps).max()
    return np.asarray(point) if far < PARALLEL else None


def _intersection(a: Array, u: Array, b: Array, v: Array) -> Array | None:
    """Where the lines a + s u and b + t v meet, if they do."""
    normal = np.cross(u, v)
    if np.linalg.norm(normal) < PARALLEL or abs(np.dot(b - a, normal)) > PARALLEL:
        return None
    s, _ = np.linalg.lstsq(np.column_stack([u, -v]), b - a, rcond=None)[0]
    return np.asarray(a + s * u)
