# SPDX-License-Identifier: BSD-3-Clause
"""Laws of the spheres around boxes, cylinders and capsules: they cover them closely."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from iksel.collision._primitive_cover import cover_box, cover_cylinder
from iksel.collision._shapes import Shape, spheres_around
from iksel.pose import pose_from_euler

SEED = 20261124
CASES = 16
ROUNDING = 1e-6
"""Relative to the error that spheres may have."""


def lengths(rng: np.random.Generator, count: int) -> np.ndarray:
    """From thin to wide, 5 mm to 20 cm."""
    return 10 ** rng.uniform(-2.3, -0.7, count)


def are_covered(points: np.ndarray, rows: np.ndarray) -> bool:
    """Whether each of the points (n, 3) lies in one of the spheres."""
    parts = np.array_split(points, len(points) * len(rows) // 4_000_000 + 1)
    return all(
        (np.linalg.norm(part[:, None] - rows[:, :3], axis=2) <= rows[:, 3])
        .any(axis=1)
        .all()
        for part in parts
    )


def points_on(rows: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Points on the spheres, (n, 3)."""
    directions = rng.normal(size=(len(rows), 40, 3))
    directions /= np.linalg.norm(directions, axis=2, keepdims=True)
    return (rows[:, None, :3] + directions * rows[:, None, 3:]).reshape(-1, 3)


def test_boxes() -> None:
    rng = np.random.default_rng(SEED)
    for case in range(CASES):
        half = lengths(rng, 3)
        error = 10 ** rng.uniform(-3, -1.7)
        rows = cover_box(half, error)
        # Inside, on faces, on edges, and the corners.
        points = rng.uniform(-1, 1, (9_000, 3))
        for first, fixed in ((3_000, 1), (6_000, 2)):
            axes = rng.permuted(np.tile(np.arange(3), (3_000, 1)), axis=1)[:, :fixed]
            some = points[first : first + 3_000]
            np.put_along_axis(some, axes, rng.choice([-1.0, 1.0], axes.shape), axis=1)
        corners = np.array(list(product((-1.0, 1.0), repeat=3)))
        points = np.concatenate([points, corners]) * half
        assert are_covered(points, rows), (SEED, case, half, error)
        outside = np.maximum(np.abs(points_on(rows, rng)) - half, 0)
        most = np.linalg.norm(outside, axis=1).max()
        assert most <= error * (1 + ROUNDING), (SEED, case, half, error)


@pytest.mark.parametrize("bare", list(product((False, True), repeat=2)))
def test_cylinders(bare) -> None:
    """Where an end is not bare, there is a ball as thick around its centre."""
    rng = np.random.default_rng(SEED)
    for case in range(CASES):
        radius, half = lengths(rng, 2)
        error = 10 ** rng.uniform(-3.3, -1.7)
        where = (SEED, case, radius, half, error)
        rows = cover_cylinder(radius, half, error, bare=bare)
        turn = rng.uniform(0, 2 * np.pi, 12_000)
        r = radius * np.sqrt(rng.uniform(0, 1, turn.size))
        z = half * rng.uniform(-1, 1, turn.size)
        # The side, the edges of both ends, the ends, and inside.
        r[:6_000] = radius
        z[3_000:9_000] = half * np.sign(z[3_000:9_000])
        points = np.column_stack([r * np.cos(turn), r * np.sin(turn), z])
        assert are_covered(points, rows), where
        on = points_on(rows, rng)
        across = np.maximum(np.hypot(on[:, 0], on[:, 1]) - radius, 0)
        outside = np.hypot(across, np.maximum(np.abs(on[:, 2]) - half, 0))
        for side, is_bare in zip((-1, 1), bare, strict=True):
            if not is_bare:
                from_ball = np.linalg.norm(on - [0, 0, side * half], axis=1) - radius
                outside = np.minimum(outside, from_ball)
        assert outside.max() <= error * (1 + ROUNDING), where


def test_what_is_flat_or_thin_is_covered() -> None:
    """Plates, discs, rods and points: a side or a radius may be 0."""
    error = 0.01
    for half in product((0.0, 0.05), repeat=3):
        corners = np.array(list(product((-1.0, 1.0), repeat=3))) * half
        assert are_covered(corners, cover_box(np.array(half), error)), half
    for radius, half, bare in product((0.0, 0.05), (0.0, 0.1), (False, True)):
        rows = cover_cylinder(radius, half, error, bare=(bare, True))
        turn = np.linspace(0, 2 * np.pi, 100)
        side = [radius * np.cos(turn), radius * np.sin(turn)]
        rims = [np.column_stack([*side, np.full(100, z)]) for z in (-half, half)]
        assert are_covered(np.concatenate(rims), rows), (radius, half, bare)


def test_few_are_enough() -> None:
    """A tenth of the error takes some ten times as many, not a thousand times."""
    coarse = len(cover_box(np.array([0.1, 0.1, 0.1]), 0.01))
    fine = len(cover_box(np.array([0.1, 0.1, 0.1]), 0.001))
    assert 5 * coarse < fine < 50 * coarse
    assert len(cover_cylinder(0.06, 0.14, 5e-4, bare=(False, False))) < 30
    assert len(cover_cylinder(0.04, 0.07, 5e-4, bare=(False, True))) < 1_000


def test_spheres_cover_capsules() -> None:
    coal = pytest.importorskip("coal")
    rng = np.random.default_rng(SEED)
    for _ in range(CASES):
        radius, length = lengths(rng, 2)
        error = radius * 10 ** rng.uniform(-2, -0.5)
        pose = pose_from_euler(rng.normal(size=3), rng.normal(size=3))
        capsule = coal.Capsule(radius, length)
        shape = Shape("link", capsule, capsule, pose)
        none = np.empty((0, 4))
        rows = spheres_around(shape, none, of_box=error, of_cylinder=error)
        assert rows is not None
        rows = np.column_stack([(rows[:, :3] - pose[:3, 3]) @ pose[:3, :3], rows[:, 3]])
        ends = np.array([[0, 0, -length / 2, radius], [0, 0, length / 2, radius]])
        along = rng.uniform(-length / 2, length / 2, 200)[:, None] * [0, 0, 1]
        around = rng.normal(size=(200, 3)) * [1, 1, 0]
        around *= radius / np.linalg.norm(around, axis=1, keepdims=True)
        inside = np.concatenate([points_on(ends, rng), along + around])
        assert are_covered(inside * (1 - ROUNDING), rows)
        found = points_on(rows, rng)
        found[:, 2] -= np.clip(found[:, 2], -length / 2, length / 2)
        off = np.linalg.norm(found, axis=1) - radius
        assert off.max() <= error * (1 + ROUNDING) + 1e-12
