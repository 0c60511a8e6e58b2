# SPDX-License-Identifier: BSD-3-Clause
"""How a map's grid and chunks follow from what is asked for."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from iksel._base.arrays import as_floats, reject
from iksel.reach import _healpix
from iksel.reach._grid import Grid, Positions

if TYPE_CHECKING:
    import numpy.typing as npt
    from iksel_cpp import Robot

    from iksel._base.arrays import FloatArray

CHUNKS = 256
"""How many chunks a map is divided into, as long as they have a reasonable size."""
SMALLEST_CHUNK, LARGEST_CHUNK = 1 << 16, 1 << 24
"""Cells of a chunk."""
LARGEST_SIDE = 1 << 20
"""Cells along one axis, so that a mistyped spacing is an error."""


def cover(
    robot: Robot, spacing: float, box: npt.ArrayLike | None, frame: FloatArray | None
) -> Positions:
    """Cells that cover the box, or what the robot reaches."""
    if not (math.isfinite(spacing) and spacing > 0):
        reject("spacing", f"{spacing} is no positive length")
    if box is None:
        centre, reach = robot.reach_centre, robot.reach
        lower, upper = centre - reach, centre + reach
    else:
        lower, upper = as_floats("box", box, (2, 3)).reshape(2, 3)
        if not (lower < upper).all():
            reject("box", f"the lower corner {lower} is not below {upper}")
    if frame is not None:
        lower, upper = _ring_bounds(robot, frame, box, lower, upper)
    # A whole number of cells around the middle, and no cell more for a rounding error.
    counts = np.maximum(np.ceil((upper - lower) / spacing - 1e-9), 1).astype(int)
    if counts.max() > LARGEST_SIDE:
        reject("spacing", f"{spacing} m makes {counts.max()} cells along one axis")
    start = (lower + upper - counts * spacing) / 2
    if frame is not None:
        start[0] = 0.0
    return Positions(float(spacing), tuple(map(float, start)), tuple(map(int, counts)))


def _ring_bounds(
    robot: Robot,
    frame: FloatArray,
    box: npt.ArrayLike | None,
    lower: FloatArray,
    upper: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Radius and height of the rings that cover a box, or what the robot reaches."""
    back = np.linalg.inv(frame)
    if box is None:
        centre = back[:3, :3] @ robot.reach_centre + back[:3, 3]
        radius = np.hypot(centre[0], centre[1]) + robot.reach
        heights = centre[2] + robot.reach * np.array([-1.0, 1.0])
    else:
        corners = np.stack(
            np.meshgrid(*zip(lower, upper, strict=True)), axis=-1
        ).reshape(-1, 3)
        corners = corners @ back[:3, :3].T + back[:3, 3]
        radius = np.hypot(corners[:, 0], corners[:, 1]).max()
        heights = np.array([corners[:, 2].min(), corners[:, 2].max()])
    return np.array([0.0, heights[0]]), np.array([radius, heights[1]])


def resolution(
    orientations: int | None, angle: float | None, *, flat: bool, reduced: bool
) -> tuple[int, int]:
    """HEALPix resolution, and the number of spins (0 for directions alone)."""
    if orientations is not None and angle is not None:
        reject("orientations", "cannot be given together with angle")
    if angle is None:
        count = orientations
        if count is None:
            count = 100 if flat and not reduced else 1000
        if count < 1:
            reject("orientations", f"{count} is less than 1")
        # As many directions as the whole grid would have, if spins are left out.
        every = reduced or not flat
        angle = (
            (8 * math.pi**2 / count) ** (1 / 3)
            if every
            else math.sqrt(4 * math.pi / count)
        )
        nside = max(1, round(_healpix.spacing(1) / angle))
        return nside, 0 if flat else max(1, round(count / _healpix.count(nside)))
    if not 1e-3 <= angle <= math.pi:
        reject("angle", f"{angle} rad is not between 0.001 and pi")
    nside = math.ceil(_healpix.spacing(1) / angle - 1e-9)
    return nside, 0 if flat else math.ceil(2 * math.pi / angle - 1e-9)


def chunking(grid: Grid, cells: int | None) -> dict[str, list[int]]:
    """How the cells are divided into chunks, and these into what is read at once."""
    if cells is None:
        even = 2 ** max(0, math.ceil(math.log2(grid.size / CHUNKS)))
        cells = min(max(even, SMALLEST_CHUNK), LARGEST_CHUNK)
    elif cells < 1:
        reject("chunk_cells", f"{cells} is less than 1")
    at = len(grid.positions.counts)
    chunk = list(grid.shape)
    # Positions are divided first, the longest side by two; then orientations.
    for axes in (range(at), range(at, len(chunk))):
        while math.prod(chunk) > cells and max(chunk[i] for i in axes) > 1:
            longest = max(axes, key=lambda i: chunk[i])
            chunk[longest] = -(-chunk[longest] // 2)
    inner = [n // 2 if i < at and n % 2 == 0 else n for i, n in enumerate(chunk)]
    return {"chunk": chunk, "inner": inner}
