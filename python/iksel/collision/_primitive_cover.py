# SPDX-License-Identifier: BSD-3-Clause
"""Spheres that cover boxes and cylinders, by formulas.

A sphere whose centre lies d deep below a face, and nowhere nearer to another, sticks
out by e if its radius is d + e. It then holds all that is at most 2 d below a disc on
that face, whose radius w has w^2 = 2 d e + e^2. So faces are cut into cells that such
discs hold, of which the ones near edges are small, and each point of the solid is below
a cell of the face that it is nearest to.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from iksel._base.arrays import FloatArray

_ROUNDING = 1e-9
"""Relative; spheres are larger by so much than they would have to be."""


def cover_box(half: FloatArray, max_error: float) -> FloatArray:
    """Spheres that cover a box and stick out of it by `max_error` [m] at most.

    Args:
        half: Half lengths of its edges, (3,) [m].
        max_error: How far spheres may stick out [m].

    Returns:
        (n, 4), rows of centre and radius [m], in the frame of the box.
    """
    rows = []
    for axis in range(3):
        across = [(axis + 1) % 3, (axis + 2) % 3]
        centres, depths = _face_cells(half[across], float(half[axis]), max_error)
        for side in (-1.0, 1.0):
            of_face = np.empty((len(centres), 4))
            of_face[:, across] = centres
            of_face[:, axis] = side * (half[axis] - depths)
            of_face[:, 3] = depths + max_error
            rows.append(of_face)
    # What is as deep below two faces belongs to both.
    unit = max_error * 1e-6
    found = np.concatenate(rows)
    _, first = np.unique((found / unit).round(), axis=0, return_index=True)
    return found[np.sort(first)]


def _face_cells(
    half: FloatArray, deepest: float, max_error: float
) -> tuple[FloatArray, FloatArray]:
    """Centres of the cells of a rectangle, (n, 2), and how deep each may be, (n,) [m].

    Args:
        half: Half lengths of the rectangle's edges, (2,) [m].
        deepest: The depth where the opposite face is as near [m].
        max_error: How far spheres may stick out [m].
    """
    centres, sizes = np.zeros((1, 2)), np.asarray(half, dtype=float)[None]
    done_centres, done_depths = [], []
    while len(centres):
        depths = np.minimum((half - np.abs(centres)).min(axis=1), deepest)
        held = _reach2(depths, max_error)
        fits = (sizes**2).sum(axis=1) <= held
        done_centres.append(centres[fits])
        done_depths.append(depths[fits])
        centres, sizes = centres[~fits], sizes[~fits]
        # Halved across the longer edge.
        longer = np.eye(2)[sizes.argmax(axis=1)]
        sizes = sizes * (1 - longer / 2)
        step = sizes * longer
        centres = np.concatenate([centres - step, centres + step])
        sizes = np.concatenate([sizes, sizes])
    return np.concatenate(done_centres), np.concatenate(done_depths)


def _reach2(depth: FloatArray, max_error: float) -> FloatArray:
    """The square of the radius of the disc that a sphere holds [m^2]."""
    held: FloatArray = (2 * depth + max_error) * max_error * (1 - _ROUNDING)
    return held


def cover_cylinder(
    radius: float, half: float, max_error: float, *, bare: tuple[bool, bool]
) -> FloatArray:
    """Spheres that cover a cylinder and stick out of it by `max_error` [m] at most.

    Args:
        radius: Of the cylinder [m].
        half: Half its length, along z [m].
        max_error: How far spheres may stick out [m].
        bare: Whether the lower and the upper end are flat; at an end that is not, a
            ball as thick as the cylinder stands around the centre of the end.

    Returns:
        (n, 4), rows of centre and radius [m], in the frame of the cylinder.
    """
    # A sphere may go into the ball at the other end, if there is one.
    deepest = min(radius, half if all(bare) else 2 * half)
    rim = _rim_rings(radius, deepest, max_error)
    rows = []
    for side, is_bare in zip((-1, 1), bare, strict=True):
        if is_bare:
            rows.append(rim * [1, 1, side, 1] + [0, 0, side * half, 0])
    lower = -half + bare[0] * deepest
    upper = half - bare[1] * deepest
    if lower < upper or radius == 0:
        rows.append(_on_axis(radius, lower, upper, max_error))
    return np.concatenate(rows)


def _on_axis(radius: float, lower: float, upper: float, max_error: float) -> FloatArray:
    """Spheres on the axis that hold a cylinder between two heights [m]."""
    longest = np.sqrt(_reach2(np.array(radius), max_error))
    count = max(1, int(np.ceil((upper - lower) / (2 * longest))))
    reach = (upper - lower) / (2 * count)
    z = lower + reach * (2 * np.arange(count) + 1)
    rows = np.zeros((count, 4))
    rows[:, 2] = z
    rows[:, 3] = np.hypot(radius, reach) + _ROUNDING * max_error
    return rows


def _rim_rings(radius: float, deepest: float, max_error: float) -> FloatArray:
    """Spheres in rings along the edge of a flat end at z = 0, the cylinder below it.

    They hold all that is nearer to this end than to the side, and `deepest` below it at
    most; and of what is nearer to the side all above -deepest.
    """
    rows = [np.zeros((0, 4))]
    from_side = 0.0
    e = max_error * (1 - _ROUNDING)
    while from_side < radius:
        # The ring is 2 s wide, for which half of w^2 is spent.
        if from_side < deepest:
            # s^2 = d e + e^2 / 2, where d = from_side + s
            s = (e + np.sqrt(3 * e**2 + 4 * from_side * e)) / 2
            s = min(s, deepest - from_side)
        else:
            s = np.sqrt(deepest * e + e**2 / 2)
        s = min(s, (radius - from_side) / 2)
        depth = min(from_side + s, deepest)
        at = radius - from_side - s  # radius of the ring
        left = 2 * depth * e + e**2 - s**2
        # Between two of the ring's spheres the side is the farthest.
        part = left / (2 * radius * at)
        count = 1 if part >= 2 else int(np.ceil(np.pi / np.arccos(1 - part)))
        turn = 2 * np.pi * np.arange(count) / count
        ring = [at * np.cos(turn), at * np.sin(turn)]
        rest = [np.full(count, -depth), np.full(count, depth + max_error)]
        rows.append(np.column_stack(ring + rest))
        from_side += 2 * s
    return np.concatenate(rows)
