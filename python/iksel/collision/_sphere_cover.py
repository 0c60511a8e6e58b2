# SPDX-License-Identifier: BSD-3-Clause
"""Spheres that cover a solid, as few as an error bound allows.

The solid is sampled, so densely that each of its points has a sample within `gap`.
Spheres that reach each sample, their radii then enlarged by `gap`, cover it all. A
sphere around a point whose distance from the surface is d sticks out by its radius - d
at most.
"""

from __future__ import annotations

import heapq
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from iksel._base.arrays import BoolArray, FloatArray, IntArray

_MOST_CANDIDATES = 1_500
_CHUNK = 2_000_000  # distances at a time


class Mesh(NamedTuple):
    """Triangles around a solid."""

    vertices: FloatArray  # (n, 3) [m]
    triangles: IntArray  # (m, 3)


def cover(meshes: Sequence[Mesh], balls: FloatArray, max_error: float) -> FloatArray:
    """Spheres that cover a body, and stick out of it by `max_error` [m] at most.

    The inside of a mesh is where a line parallel to z has crossed it an odd number of
    times; of one that is not closed, at least the surface is covered.

    Args:
        meshes: Parts of the body, which may overlap.
        balls: Further parts, (n, 4), that are spheres already.
        max_error: How far spheres may stick out [m].

    Returns:
        (n, 4), rows of centre and radius [m]: first the balls.
    """
    gap = max_error / 3
    surface = np.concatenate(
        [_surface_samples(mesh, np.sqrt(3) * gap / 2) for mesh in meshes]
    )
    inside = np.concatenate(
        [_inside_samples(mesh, gap / np.sqrt(3)) for mesh in meshes]
    )
    bare = _outside(
        np.concatenate([surface] + [_ball_samples(b, gap / 2) for b in balls]), balls
    )
    samples = np.concatenate([surface, inside])
    for x, y, z, r in balls:
        samples = samples[np.linalg.norm(samples - [x, y, z], axis=1) > r - gap]
    centres = _some(inside, _MOST_CANDIDATES)
    # Samples of the surface are gap / 2 apart from any of its points.
    depth = np.maximum(_distances_to_nearest(centres, bare) - gap / 2, 0.0)
    at_surface = _some(surface, _MOST_CANDIDATES // 3)
    centres = np.concatenate([centres, at_surface])
    radius = np.append(depth, np.zeros(len(at_surface))) + max_error
    chosen, left = _choose(centres, radius - gap, samples)
    filled = _fill(left, max_error - gap)  # what no candidate reaches
    spheres = [balls, np.column_stack([centres[chosen], radius[chosen]])]
    spheres.append(np.column_stack([filled, np.full(len(filled), max_error)]))
    return np.concatenate(spheres)


def _outside(points: FloatArray, balls: FloatArray) -> FloatArray:
    """Points of a surface that are the body's surface too."""
    for x, y, z, r in balls:
        points = points[np.linalg.norm(points - [x, y, z], axis=1) >= r * (1 - 1e-9)]
    return points


def _ball_samples(ball: FloatArray, spacing: float) -> FloatArray:
    """Points on a ball, about so far apart (a Fibonacci lattice)."""
    count = int(np.ceil(4 * np.pi * (ball[3] / spacing) ** 2)) + 8
    i = np.arange(count) + 0.5
    z = 1 - 2 * i / count
    turn = np.pi * (1 + np.sqrt(5)) * i
    across = np.sqrt(1 - z**2)
    unit = np.column_stack([across * np.cos(turn), across * np.sin(turn), z])
    placed: FloatArray = ball[:3] + ball[3] * unit
    return placed


def _some(points: FloatArray, most: int) -> FloatArray:
    """At most so many of the points, evenly."""
    if len(points) <= most:
        return points
    chosen: FloatArray = points[np.linspace(0, len(points) - 1, most).astype(int)]
    return chosen


def _surface_samples(mesh: Mesh, longest: float) -> FloatArray:
    """Corners of the triangles, cut until no edge is longer [m].

    Any point of a triangle is then within `longest` / sqrt(3) of a corner.
    """
    done = []
    corners = mesh.vertices[mesh.triangles]
    while len(corners):
        edges = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
        long = edges.max(axis=1) > longest
        done.append(corners[~long].reshape(-1, 3))
        corners, edges = corners[long], edges[long]
        # Halve the longest edge, which is made the first.
        turn = (edges.argmax(axis=1)[:, None] + np.arange(3)) % 3
        a, b, c = np.moveaxis(np.take_along_axis(corners, turn[..., None], 1), 1, 0)
        middle = (a + b) / 2
        corners = np.concatenate(
            [np.stack([a, middle, c], 1), np.stack([middle, b, c], 1)]
        )
    # Rounded, corners that triangles share are one.
    return np.unique(np.concatenate(done).round(9), axis=0)


def _inside_samples(mesh: Mesh, spacing: float) -> FloatArray:
    """Points of a grid that lie inside."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    counts = np.ceil((high - low) / spacing).astype(int) + 1
    # Off the corners, which models like to put at round numbers.
    start = low + spacing * np.array([0.4142, 0.2718, 0.5]) / 2
    x, y, z = (start[i] + spacing * np.arange(counts[i]) for i in range(3))
    odd = np.zeros((len(x), len(y), len(z)), dtype=bool)
    for corners in mesh.vertices[mesh.triangles]:
        _cross(corners, x, y, z, odd)
    i, j, k = np.nonzero(odd)
    return np.column_stack([x[i], y[j], z[k]])


def _cross(
    corners: FloatArray, x: FloatArray, y: FloatArray, z: FloatArray, odd: BoolArray
) -> None:
    """Flip the points of a grid above a triangle."""
    a, b, c = corners
    area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    if area == 0:
        return
    i0, i1 = np.searchsorted(x, [corners[:, 0].min(), corners[:, 0].max()])
    j0, j1 = np.searchsorted(y, [corners[:, 1].min(), corners[:, 1].max()])
    px, py = np.meshgrid(x[i0:i1], y[j0:j1], indexing="ij")
    v = ((px - a[0]) * (c[1] - a[1]) - (py - a[1]) * (c[0] - a[0])) / area
    w = ((b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0])) / area
    within = (v >= 0) & (w >= 0) & (v + w <= 1)
    height = a[2] + v * (b[2] - a[2]) + w * (c[2] - a[2])
    odd[i0:i1, j0:j1] ^= within[..., None] & (z > height[..., None])


def _distances_to_nearest(points: FloatArray, others: FloatArray) -> FloatArray:
    """Distance of each point from the nearest of the others."""
    step = max(1, _CHUNK // len(others))
    squares = (others**2).sum(axis=1)
    parts = [
        (squares - 2 * part @ others.T).min(axis=1) + (part**2).sum(axis=1)
        for part in np.split(points, range(step, len(points), step))
    ]
    distances: FloatArray = np.sqrt(np.maximum(np.concatenate(parts), 0.0))
    return distances


def _choose(
    centres: FloatArray, radii: FloatArray, samples: FloatArray
) -> tuple[IntArray, FloatArray]:
    """Choose balls that hold samples, each time the one that holds most of those left.

    What a ball holds of those left only becomes less, so that it is counted again only
    where it could still be the most.

    Returns:
        Indices of the balls, and the samples that are in none, (n, 3).
    """
    sorted_samples = _Sorted(samples)
    holds = [sorted_samples.within(*ball) for ball in zip(centres, radii, strict=True)]
    left = np.ones(len(samples), dtype=bool)
    chosen: list[int] = []
    counted = np.zeros(len(holds), dtype=int)  # how many were chosen by then
    heap = [(-len(held), ball) for ball, held in enumerate(holds)]
    heapq.heapify(heap)
    while heap and heap[0][0] < 0:
        gain, ball = heap[0]
        if counted[ball] < len(chosen):
            gain = -np.count_nonzero(left[holds[ball]])
            counted[ball] = len(chosen)
            heapq.heapreplace(heap, (gain, ball))
            continue
        heapq.heappop(heap)
        chosen.append(ball)
        left[holds[ball]] = False
    return np.array(chosen, dtype=int), samples[left]


def _fill(samples: FloatArray, radius: float) -> FloatArray:
    """Some of the samples, so that each is within a radius of one of them."""
    sorted_samples = _Sorted(samples)
    left = np.ones(len(samples), dtype=bool)
    centres = []
    for sample, centre in enumerate(samples):
        if left[sample]:
            centres.append(centre)
            left[sorted_samples.within(centre, radius)] = False
    return np.array(centres).reshape(-1, 3)


class _Sorted:
    """Points by their x, so that those near a place are soon found."""

    def __init__(self, points: FloatArray) -> None:
        self._order = np.argsort(points[:, 0], kind="stable").astype(np.int32)
        self._points = points[self._order]
        self._x = np.ascontiguousarray(self._points[:, 0])

    def within(self, centre: FloatArray, radius: float) -> IntArray:
        """Indices of the points within a radius."""
        first, last = np.searchsorted(self._x, [centre[0] - radius, centre[0] + radius])
        away = self._points[first:last] - centre
        held = np.einsum("ij,ij->i", away, away) <= radius**2
        found: IntArray = self._order[first:last][held]
        return found
