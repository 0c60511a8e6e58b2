# SPDX-License-Identifier: BSD-3-Clause
"""Whether random cells hold what solving their poses one by one gives."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import iksel
from bench.reach.plans import ROBOT, SEED, large_plan
from iksel import reach

if TYPE_CHECKING:
    from pathlib import Path

    from bench.chain import Array
    from iksel._base.arrays import IntArray
    from iksel.reach._grid import Grid

CELLS = 10_000


def show_cells(folder: Path) -> None:
    """The part `cells`."""
    robot = iksel.load_robot(ROBOT)
    rng = np.random.default_rng(SEED)
    for symmetry in (False, True):
        plan = large_plan(robot, symmetry=symmetry, spacing=0.1)
        path = folder / f"cells{symmetry:d}.zarr"
        reach.create(plan, path)
        reach.run(path)
        found = reach.open(path)
        cells = np.stack([rng.integers(0, n, CELLS) for n in plan.shape], axis=-1)
        first, last = rng.uniform(-np.pi, np.pi, (2, CELLS)) * symmetry
        poses = independent_poses(plan.grid, cells, first, last)
        solver = iksel.Solver(robot)
        answers = [solver.solve(pose) for pose in poses]
        success = np.array([a.success for a in answers])
        stored = found.take(cells)
        same = (stored["status"] == [a.status for a in answers]).sum()
        proofs = (stored["proof"] == [a.proof for a in answers]).sum()
        reached = robot.fk(np.array([a.q for a in answers if a.success]))
        off = np.abs(reached - poses[success]).max()
        print(
            f"symmetry {symmetry}: of {CELLS:,} cells {success.sum():,} solved; equal "
            f"status {same:,}, equal proof {proofs:,}; answers off by {off:.1e} at most"
        )


def independent_poses(grid: Grid, cells: IntArray, first: Array, last: Array) -> Array:
    """Poses of cells, turned by angles [rad], from what the grid's fields say alone.

    For a grid whose frame is the base's, and whose axis is the tool's z.
    """
    place, turns = grid.positions, grid.orientations
    at = len(place.counts)
    centres = np.array(place.lower) + place.spacing * (cells[:, :at] + 0.5)
    if place.rings:
        centres = np.insert(centres, 1, 0.0, axis=1)
    x, y, z = turns.directions[cells[:, at]].T
    spin = last + (2 * np.pi / turns.spins * cells[:, at + 1] if turns.spins else 0)
    azimuth = np.arctan2(y, x)
    rotation = about_z(azimuth) @ about_y(np.arccos(z)) @ about_z(spin - azimuth)
    poses = np.tile(np.eye(4), (len(cells), 1, 1))
    poses[:, :3, :3] = rotation
    poses[:, :3, 3] = centres
    return np.asarray(about_z(first, 4) @ poses)


def about_z(angle: Array, size: int = 3) -> Array:
    """Rotations about z, (n, size, size)."""
    return np.array([iksel.pose_from_euler([0, 0, 0], [0, 0, a]) for a in angle])[
        :, :size, :size
    ]


def about_y(angle: Array) -> Array:
    """Rotations about y, (n, 3, 3)."""
    return np.array([iksel.pose_from_euler([0, 0, 0], [0, a, 0]) for a in angle])[
        :, :3, :3
    ]
