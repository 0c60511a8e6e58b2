# SPDX-License-Identifier: BSD-3-Clause
"""Two maps beside each other: of two robots, or of one with two tools."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from iksel_cpp import Status

from iksel._base.arrays import reject

if TYPE_CHECKING:
    from iksel._base.arrays import FloatArray
    from iksel.reach._map import Map


@dataclass(frozen=True)
class Comparison:
    """How much of a grid two robots reach.

    Volumes are weighted by the share of orientations [m^3]: with all of them a position
    counts as its cell's volume.
    """

    both: float
    """Reached by both."""
    only_first: float
    """Reached by the first alone."""
    only_second: float
    """Reached by the second alone."""
    neither: float
    """Reached by none of them."""
    difference: FloatArray
    """The first's share of the orientations less the second's, per position."""

    @property
    def overlap(self) -> float:
        """What both reach over what one of them does; 1 if none reaches anything."""
        union = self.both + self.only_first + self.only_second
        return self.both / union if union else 1.0


def compare(first: Map, second: Map) -> Comparison:
    """Compare what two robots reach, pose by pose.

    The poses are those of the finer grid's cells: the one that leaves fewer turns out,
    or else the first's. At each the map of that grid is exact, and the other gives the
    cell that the pose lies in; of maps that were planned with the same box, spacing and
    orientations that is the same cell, and the comparison exact. Poses outside a map
    count as not reached.

    Raises:
        InvalidArgumentError: One of them leaves any spin free and the other does not,
            or each leaves out a turn that the other has.
    """
    if first.plan.free_spin != second.plan.free_spin:
        reject("second", "of two maps only one leaves the spin free")
    left_out = [{*_left_out(m)} for m in (first, second)]
    swap = left_out[1] < left_out[0]
    if not (swap or left_out[0] <= left_out[1]):
        reject("second", "each map leaves out a turn that the other has")
    grid, other = (second, first) if swap else (first, second)
    at = len(grid.grid.positions.counts)
    axes = tuple(range(at, len(grid.grid.shape)))
    volumes = grid.grid.positions.volumes()
    size = grid.grid.orientations.size
    sums = np.zeros(3)  # by both, by the grid's alone, by the other alone
    difference = np.zeros(grid.grid.positions.counts)
    for block, arrays in grid.chunks():
        mine = arrays["status"] == Status.solved
        cells = np.stack([m.ravel() for m in np.mgrid[block]], axis=-1)
        theirs = other.query(grid.grid.poses(cells)).solvable.reshape(mine.shape)
        weight = volumes[block[:at]] / size
        for i, mask in enumerate((mine & theirs, mine & ~theirs, theirs & ~mine)):
            sums[i] += (mask.sum(axis=axes) * weight).sum()
        more = mine.sum(axis=axes) - theirs.sum(axis=axes, dtype=np.int64)
        difference[block[:at]] += more / size
    both, alone, others = map(float, sums)
    if swap:
        alone, others, difference = others, alone, -difference
    neither = float(volumes.sum()) - both - alone - others
    return Comparison(both, alone, others, neither, difference)


def _left_out(reach_map: Map) -> list[str]:
    plan = reach_map.plan
    turns = {"first": plan.first_turn, "last": plan.last_turn}
    return [name for name, out in turns.items() if out]
