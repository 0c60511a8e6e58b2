# SPDX-License-Identifier: BSD-3-Clause
"""Grids over positions and orientations, and the cell that a pose lies in."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from iksel.reach import _healpix

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from iksel._base.arrays import BoolArray, FloatArray, IntArray

Triple = tuple[float, float, float]
Z: Triple = (0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Positions:
    """Cubes of a box, or rings around the z axis of the grid's frame.

    A ring's cells have a square section; it is stored where its azimuth is 0.
    """

    spacing: float
    """Edge of a cell [m]."""
    lower: tuple[float, ...]
    """Where the first cell begins, (x, y, z) or (radius, height) [m]."""
    counts: tuple[int, ...]
    """Cells along each axis."""

    @property
    def rings(self) -> bool:
        """Whether positions are rings: (radius, height) in the place of (x, y, z)."""
        return len(self.counts) == 2

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the axes."""
        return ("radius", "height") if self.rings else ("x", "y", "z")

    def centres(self, axis: int) -> FloatArray:
        """Centres of the cells along an axis [m]."""
        steps = np.arange(self.counts[axis]) + 0.5
        return np.asarray(self.lower[axis] + self.spacing * steps)

    def points(self, block: Sequence[slice]) -> FloatArray:
        """Centres of the cells of a block in the grid's frame, (n, 3) [m]."""
        axes = [self.centres(i)[part] for i, part in enumerate(block)]
        mesh = [m.ravel() for m in np.meshgrid(*axes, indexing="ij")]
        if self.rings:
            mesh.insert(1, np.zeros_like(mesh[0]))
        return np.stack(mesh, axis=-1)

    def volumes(self) -> FloatArray:
        """What each cell holds [m^3], of shape `counts`."""
        volume = np.full(self.counts, self.spacing**3)
        if self.rings:
            around = 2 * np.pi * self.centres(0)[:, None]
            volume = np.broadcast_to(around * self.spacing**2, self.counts).copy()
        return volume

    def index(self, points: FloatArray) -> tuple[IntArray, BoolArray]:
        """Cells that points (n, 3) in the grid's frame lie in.

        Returns:
            Indices (n, axes), and which of them are inside (n,); others are clipped.
        """
        if self.rings:
            radius = np.hypot(points[:, 0], points[:, 1])
            points = np.stack([radius, points[:, 2]], axis=-1)
        steps = np.floor((points - np.array(self.lower)) / self.spacing)
        most = np.array(self.counts) - 1
        inside = np.all((steps >= 0) & (steps <= most), axis=-1)
        return np.clip(steps, 0, most).astype(np.int64), inside


@dataclass(frozen=True)
class Orientations:
    """Directions of an axis of the tool, each with spins about it or with any spin.

    Directions are the centres of HEALPix pixels; with n equal spins in Hopf coordinates
    they are an even grid over all rotations (Yershova et al., "Generating Uniform
    Incremental Grids on SO(3) Using the Hopf Fibration", IJRR 29 (2010)).
    """

    nside: int
    """HEALPix resolution: 12 nside^2 directions."""
    spins: int
    """Spins per direction; 0: the spin does not matter."""
    axis: Triple = Z
    """The axis of the tool whose direction is meant, in the tool's frame."""

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the axes."""
        return ("direction", "spin") if self.spins else ("direction",)

    @property
    def counts(self) -> tuple[int, ...]:
        """Cells along each axis."""
        directions = _healpix.count(self.nside)
        return (directions, self.spins) if self.spins else (directions,)

    @property
    def size(self) -> int:
        """Number of orientations."""
        return math.prod(self.counts)

    @cached_property
    def directions(self) -> FloatArray:
        """Directions of the axis in the grid's frame, unit vectors (n, 3)."""
        return _healpix.centres(self.nside)

    @cached_property
    def spin_angles(self) -> FloatArray:
        """Spins about the axis [rad], (max(spins, 1),)."""
        n = max(self.spins, 1)
        return np.asarray(np.arange(n) * (2 * np.pi / n))

    @cached_property
    def _rotation_to_z(self) -> FloatArray:
        """The least rotation that turns the tool's axis into z, (3, 3)."""
        return np.asarray(least_rotations(np.array([self.axis]))[0].T)

    @cached_property
    def rotations(self) -> FloatArray:
        """Rotations of the tool in the grid's frame, (size, 3, 3)."""
        tilts = least_rotations(self.directions)
        turns = z_rotations(self.spin_angles) @ self._rotation_to_z
        return np.asarray((tilts[:, None] @ turns[None]).reshape(-1, 3, 3))

    def index(self, rotations: FloatArray) -> IntArray:
        """Cells (n, axes) that rotations (n, 3, 3) in the grid's frame lie in."""
        direction = rotations @ np.array(self.axis)
        pixel = _healpix.pixel(self.nside, direction)
        if not self.spins:
            return pixel[:, None]
        tilts = least_rotations(self.directions)[pixel]
        rest = np.swapaxes(tilts, -1, -2) @ rotations @ self._rotation_to_z.T
        angle = np.arctan2(rest[:, 1, 0] - rest[:, 0, 1], rest[:, 0, 0] + rest[:, 1, 1])
        spin = np.rint(angle * (self.spins / (2 * np.pi))).astype(np.int64)
        return np.stack([pixel, spin % self.spins], axis=-1)


@dataclass(frozen=True)
class Grid:
    """Cells over positions and orientations in a frame that is fixed to the base."""

    positions: Positions
    orientations: Orientations
    frame: tuple[float, ...]
    """T_base_grid, 16 numbers row by row."""

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the axes."""
        return self.positions.dims + self.orientations.dims

    @property
    def shape(self) -> tuple[int, ...]:
        """Cells along each axis."""
        return self.positions.counts + self.orientations.counts

    @property
    def size(self) -> int:
        """Number of cells."""
        return math.prod(self.shape)

    @property
    def T_base_grid(self) -> FloatArray:  # noqa: N802 (a frame)
        """The frame as a matrix, (4, 4)."""
        return np.array(self.frame).reshape(4, 4)

    def poses(self, cells: IntArray) -> FloatArray:
        """T_base_tcp at the centres of cells (n, axes), (n, 4, 4)."""
        at = len(self.positions.counts)
        every = [slice(None)] * at
        points = self.positions.points(every).reshape(*self.positions.counts, 3)
        place = np.ravel_multi_index(tuple(cells[:, at:].T), self.orientations.counts)
        poses = np.tile(np.eye(4), (len(cells), 1, 1))
        poses[:, :3, :3] = self.orientations.rotations[place]
        poses[:, :3, 3] = points[tuple(cells[:, :at].T)]
        return np.asarray(self.T_base_grid @ poses)

    def index(self, poses: FloatArray) -> tuple[IntArray, BoolArray]:
        """Cells that poses T_base_tcp (n, 4, 4) lie in.

        Returns:
            Indices (n, axes), and which of them are inside the grid (n,).
        """
        local = np.linalg.inv(self.T_base_grid) @ poses
        rotations = local[:, :3, :3]
        place, inside = self.positions.index(local[:, :3, 3])
        if self.positions.rings:
            azimuth = np.arctan2(local[:, 1, 3], local[:, 0, 3])
            rotations = z_rotations(-azimuth) @ rotations
        turned = self.orientations.index(rotations)
        return np.concatenate([place, turned], axis=-1), inside

    def to_dict(self) -> dict[str, Any]:
        """Plain data, for JSON."""
        return asdict(self)

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> Grid:
        """The grid of to_dict()."""
        positions, turns = data["positions"], data["orientations"]
        return Grid(
            Positions(
                positions["spacing"],
                tuple(positions["lower"]),
                tuple(positions["counts"]),
            ),
            Orientations(turns["nside"], turns["spins"], tuple(turns["axis"])),
            tuple(data["frame"]),
        )


def z_rotations(angles: FloatArray) -> FloatArray:
    """Rotations about z by angles (n,) [rad], (n, 3, 3)."""
    turns = np.zeros((len(angles), 3, 3))
    turns[:, 0, 0] = turns[:, 1, 1] = np.cos(angles)
    turns[:, 1, 0] = np.sin(angles)
    turns[:, 0, 1] = -turns[:, 1, 0]
    turns[:, 2, 2] = 1
    return turns


def least_rotations(directions: FloatArray) -> FloatArray:
    """The least rotations that turn z into unit vectors (n, 3), (n, 3, 3)."""
    x, y, z = directions.T
    turns = np.empty((len(directions), 3, 3))
    south = z < 0
    # 1 / (1 + z) without the cancellation at the south pole, which itself has no least
    # rotation: half a turn about x.
    square = x * x + y * y
    polar = south & (square == 0)
    factor = np.where(
        south, (1 - z) / np.where(square > 0, square, 1.0), 1 / (1 + np.abs(z))
    )
    turns[:, 0, 0] = 1 - factor * x * x
    turns[:, 1, 1] = 1 - factor * y * y
    turns[:, 0, 1] = turns[:, 1, 0] = -factor * x * y
    turns[:, :, 2] = directions
    turns[:, 2, 0], turns[:, 2, 1] = -x, -y
    turns[polar] = np.diag([1.0, -1.0, -1.0])
    return turns
