# SPDX-License-Identifier: BSD-3-Clause
"""What a map says about positions: shares of orientations, slices, volumes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from iksel_cpp import Status

from iksel._base.arrays import as_floats, reject
from iksel.reach._cells import UNKNOWN
from iksel.reach._grid import Grid, z_rotations

if TYPE_CHECKING:
    from collections.abc import Iterator

    from iksel._base.arrays import FloatArray, IntArray
    from iksel.reach._job import Arrays


class Space(ABC):
    """Positions of a map; the base class of Map, which knows the cells."""

    @property
    @abstractmethod
    def grid(self) -> Grid:
        """The cells."""

    @abstractmethod
    def chunks(self) -> Iterator[tuple[tuple[slice, ...], Arrays]]:
        """The chunks one by one: where each lies, and its arrays."""

    @abstractmethod
    def take(self, cells: IntArray) -> Arrays:
        """The values of cells (n, axes), by name of the array."""

    @cached_property
    def fraction(self) -> FloatArray:
        """Share of the orientations at each position that can be reached.

        The usual reachability index; of the shape of the positions, NaN where a chunk
        is missing.
        """
        at = len(self.grid.positions.counts)
        axes = tuple(range(at, len(self.grid.shape)))
        total = np.zeros(self.grid.positions.counts)
        for block, arrays in self.chunks():
            status = arrays["status"]
            solved = (status == Status.solved).sum(axis=axes)
            unknown = (status == UNKNOWN).any(axis=axes)
            total[block[:at]] += np.where(unknown, np.nan, solved)
        return total / self.grid.orientations.size

    @property
    def volume(self) -> float:
        """Volume of the positions that are reached with any orientation [m^3]."""
        return float(self.grid.positions.volumes()[self.fraction > 0].sum())

    @property
    def dexterous_volume(self) -> float:
        """Volume of the positions that are reached with every orientation [m^3]."""
        return float(self.grid.positions.volumes()[self.fraction == 1].sum())

    def fraction_at(self, points: npt.ArrayLike) -> FloatArray:
        """`fraction` of the cells that points lie in.

        Args:
            points: In the base frame, (..., 3) [m].

        Returns:
            Shares, (...); 0 outside the grid.
        """
        given = as_floats("points", points, (3,))
        frame = self.grid.T_base_grid
        local = (given.reshape(-1, 3) - frame[:3, 3]) @ frame[:3, :3]
        cells, inside = self.grid.positions.index(local)
        found = np.where(inside, self.fraction[tuple(cells.T)], 0.0)
        return np.asarray(found.reshape(given.shape[:-1]))

    def rotations_at(self, point: npt.ArrayLike) -> FloatArray:
        """Orientations that are reached at a point, those of the cell that it lies in.

        Args:
            point: In the base frame, (3,) [m].

        Returns:
            Rotations of the tool in the base frame, (n, 3, 3); none outside the grid.
        """
        frame = self.grid.T_base_grid
        local = frame[:3, :3].T @ (as_floats("point", point, (3,)) - frame[:3, 3])
        place, inside = self.grid.positions.index(local[None])
        counts = self.grid.orientations.counts
        turns = np.stack([m.ravel() for m in np.indices(counts)], axis=-1)
        cells = np.concatenate([np.repeat(place, len(turns), axis=0), turns], axis=-1)
        solved = self.take(cells)["status"] == Status.solved
        azimuth = np.arctan2(local[1], local[0]) if self.grid.positions.rings else 0.0
        turn = frame[:3, :3] @ z_rotations(np.array([azimuth]))[0]
        return np.asarray(turn @ self.grid.orientations.rotations[solved & inside])

    def axes(self, spacing: float | None = None) -> list[FloatArray]:
        """x, y and z of a box of cells in the base frame around the whole map [m].

        Args:
            spacing: Edge of its cells [m]; None: the map's.
        """
        step = self.grid.positions.spacing if spacing is None else spacing
        corners = self._corners()
        centre = (corners.min(axis=0) + corners.max(axis=0)) / 2
        counts = np.ceil(np.ptp(corners, axis=0) / step - 1e-9).astype(int)
        return [
            c + step * (np.arange(n) - (n - 1) / 2)
            for c, n in zip(centre, counts, strict=True)
        ]

    def box(self, spacing: float | None = None) -> tuple[list[FloatArray], FloatArray]:
        """`fraction` over a box in the base frame, also of a map of rings.

        Args:
            spacing: Edge of its cells [m]; None: the map's.

        Returns:
            x, y and z of the cells' centres [m], and the shares (x, y, z).
        """
        axes = self.axes(spacing)
        mesh = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
        return axes, self.fraction_at(mesh)

    def slice(
        self, axis: str, at: float = 0.0, spacing: float | None = None
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """`fraction` over a plane of the base frame.

        Args:
            axis: "x", "y" or "z", which stands upright on the plane.
            at: Where on that axis [m].
            spacing: Distance of the samples [m]; None: the map's.

        Returns:
            The two other coordinates (n,) and (m,) [m], and the shares (n, m).
        """
        if axis not in ("x", "y", "z"):
            reject("axis", f"{axis!r} is none of x, y, z")
        place = "xyz".index(axis)
        axes = self.axes(spacing)
        axes[place] = np.array([float(at)])
        shares = self.fraction_at(np.stack(np.meshgrid(*axes, indexing="ij"), -1))
        others = [a for i, a in enumerate(axes) if i != place]
        return others[0], others[1], np.asarray(shares.squeeze(axis=place))

    def _corners(self) -> FloatArray:
        """Corners of the map in the base frame, (8, 3) [m]."""
        positions = self.grid.positions
        low = np.array(positions.lower)
        high = low + positions.spacing * np.array(positions.counts)
        if positions.rings:
            radius = high[0]
            low, high = (
                np.array([-radius, -radius, low[1]]),
                np.array([radius, radius, high[1]]),
            )
        corners = np.stack(np.meshgrid(*zip(low, high, strict=True)), -1).reshape(-1, 3)
        frame = self.grid.T_base_grid
        return np.asarray(corners @ frame[:3, :3].T + frame[:3, 3])
