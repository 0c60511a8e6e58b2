# SPDX-License-Identifier: BSD-3-Clause
"""Equal-area pixels on the sphere: HEALPix in the ring scheme, for any resolution.

Gorski et al., "HEALPix: A Framework for High-Resolution Discretization and Fast
Analysis of Data Distributed on the Sphere", ApJ 622 (2005), section 5. Written out
here because libraries either take powers of two only as resolutions or are under the
GPL, and both bring packages a hundred times as large.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from iksel._base.arrays import FloatArray, IntArray


def count(nside: int) -> int:
    """Number of pixels, all of the same area."""
    return 12 * nside * nside


def spacing(nside: int) -> float:
    """Side of a square of a pixel's area [rad]."""
    return math.sqrt(4 * math.pi / count(nside))


def centres(nside: int) -> FloatArray:
    """Unit vectors to the pixels' centres, (count, 3), from the north pole south."""
    rows = [_ring(nside, i) for i in range(1, 4 * nside)]
    return np.concatenate(rows)


def pixel(nside: int, direction: FloatArray) -> IntArray:
    """The pixel that each direction lies in.

    Args:
        nside: Resolution, >= 1.
        direction: Vectors of any length but 0, (..., 3).

    Returns:
        Numbers of pixels, (...).
    """
    x, y, z = np.moveaxis(
        direction / np.linalg.norm(direction, axis=-1)[..., None], -1, 0
    )
    turn = np.mod(np.arctan2(y, x) / (np.pi / 2), 4.0)  # azimuth in [0, 4)
    turn = np.where(turn >= 4.0, 0.0, turn)
    # 1 - |z| without the cancellation at the poles.
    cap = (x * x + y * y) / (1 + np.abs(z))
    belt = np.abs(z) <= 2 / 3
    return np.where(
        belt, _belt_pixel(nside, turn, z), _cap_pixel(nside, turn, cap, z > 0)
    )


def _ring(nside: int, i: int) -> FloatArray:
    """Centres on ring i = 1 ... 4 nside - 1."""
    north = min(i, 4 * nside - i)
    if north < nside:
        z = 1 - north * north / (3 * nside * nside)
        n, shift = 4 * north, 0.5
    else:
        z = 4 / 3 - 2 * north / (3 * nside)
        n, shift = 4 * nside, ((north - nside + 1) % 2) / 2
    azimuth = (np.arange(n) + shift) * (2 * np.pi / n)
    radius = math.sqrt((1 - z) * (1 + z))
    height = np.full(n, z if i <= 2 * nside else -z)
    return np.stack([radius * np.cos(azimuth), radius * np.sin(azimuth), height], -1)


def _belt_pixel(nside: int, turn: FloatArray, z: FloatArray) -> IntArray:
    """Pixels between the polar caps; turn is the azimuth in quarter turns."""
    along, across = nside * (0.5 + turn), nside * 0.75 * z
    # Numbers of the lines that ascend and descend to the east.
    rising = np.floor(along - across).astype(np.int64)
    falling = np.floor(along + across).astype(np.int64)
    ring = nside + 1 + rising - falling  # 1 ... 2 nside + 1
    shift = 1 - ring % 2
    place = (rising + falling - nside + shift + 1) // 2 % (4 * nside)
    return np.asarray(2 * nside * (nside - 1) + (ring - 1) * 4 * nside + place)


def _cap_pixel(
    nside: int, turn: FloatArray, cap: FloatArray, north: np.ndarray
) -> IntArray:
    """Pixels of the polar caps; cap is 1 - |z|."""
    part = turn - np.floor(turn)
    size = nside * np.sqrt(3 * cap)
    rising = np.floor(part * size).astype(np.int64)
    falling = np.floor((1 - part) * size).astype(np.int64)
    ring = np.minimum(rising + falling + 1, nside)  # counted from the pole
    place = np.floor(turn * ring).astype(np.int64) % (4 * ring)
    first = np.where(
        north, 2 * ring * (ring - 1), 12 * nside * nside - 2 * ring * (ring + 1)
    )
    return np.asarray(first + place)
