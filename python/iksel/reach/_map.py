# SPDX-License-Identifier: BSD-3-Clause
"""A map that has been computed: what it says about poses, positions and volumes."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from iksel_cpp import BatchResult, Robot, Solver, Status

from iksel._base.arrays import IntArray, as_floats, reject
from iksel.reach._errors import IncompleteMapError, PlanMismatchError, need
from iksel.reach._grid import Grid, least_rotations, z_rotations
from iksel.reach._plan import Plan
from iksel.reach._space import Space
from iksel.reach._store import Store

if TYPE_CHECKING:
    from collections.abc import Iterator

    from iksel._base.arrays import BoolArray, FloatArray
    from iksel.reach._job import Arrays, ArraySpec, Filter
    from iksel.reach._location import StrPath

CACHE_BYTES = 1 << 30
"""How much of a map is kept in memory once it has been read."""
AT_ONCE = 1 << 18
"""Poses that are looked up at once."""


@dataclass(frozen=True)
class Answers:
    """What a map says about n poses."""

    cells: IntArray
    """The cell that each pose lies in, (n, axes)."""
    inside: BoolArray
    """Whether it lies in the grid at all, (n,)."""
    values: Arrays
    """By name of the array the cells' values, (n, ...); unknown outside the grid."""
    exact: BatchResult | None = None
    """Inverse kinematics of the poses themselves, if it was asked for."""

    @property
    def solvable(self) -> BoolArray:
        """Whether there is a solution, (n,): exactly, or at the centre of the cell."""
        if self.exact is not None:
            return np.asarray(self.exact.success)
        return np.asarray(self.values["status"] == Status.solved)


class Map(Space):
    """A reachability map; open() gives it.

    Every chunk is checked against its receipt when it is first read.
    """

    def __init__(
        self,
        store: Store,
        plan: Plan,
        filter: Filter | None = None,  # noqa: A002 (as in solve)
    ) -> None:
        self._store = store
        self._filter = filter
        self._chunks: OrderedDict[int, Arrays] = OrderedDict()
        self._done = store.done()
        self.plan = plan

    def __repr__(self) -> str:
        done = f"{int(self._done.sum())} of {self.plan.chunks} chunks"
        return f"Map('{self._store.path}', {self.plan!r}, {done})"

    @property
    def grid(self) -> Grid:
        """The cells."""
        return self.plan.grid

    @cached_property
    def robot(self) -> Robot:
        """The robot that it is of."""
        return self.plan.robot()

    @cached_property
    def solver(self) -> Solver:
        """A solver as it was computed with."""
        return self.plan.solver()

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the arrays."""
        return tuple(spec.name for spec in self._store.specs)

    @property
    def request(self) -> dict[str, Any]:
        """Keywords of the solves that it was computed by: a scene, a filter.

        Raises:
            PlanMismatchError: The plan names a filter that open() was not given.
        """
        return self.plan.request(self._filter)

    @property
    def missing(self) -> int:
        """Number of chunks that have not been computed."""
        return int((~self._done).sum())

    def chunks(self) -> Iterator[tuple[tuple[slice, ...], Arrays]]:
        """The chunks one by one: where each lies, and its arrays."""
        for index in range(self.plan.chunks):
            yield self.plan.block(index), self._chunk(index)

    def array(self, name: str) -> np.ndarray[Any, Any]:
        """All values of an array, of the grid's shape; `status` by values of Status."""
        shape, dtype = self.layout(name)
        whole = np.empty(shape, dtype)
        for block, arrays in self.chunks():
            whole[block] = arrays[name]
        return whole

    def layout(self, name: str) -> tuple[tuple[int, ...], str]:
        """Shape and dtype of an array."""
        spec = self._spec(name)
        return self.grid.shape + spec.shape, spec.dtype

    def take(self, cells: IntArray) -> Arrays:
        """The values of cells (n, axes), by name of the array."""
        values: Arrays = {
            spec.name: np.full((len(cells), *spec.shape), spec.fill, spec.dtype)
            for spec in self._store.specs
        }
        size = np.array(self.plan.chunk)
        numbers = np.ravel_multi_index(tuple((cells // size).T), self.plan.chunk_grid)
        for index in np.unique(numbers):
            rows = np.flatnonzero(numbers == index)
            within = tuple((cells[rows] % size).T)
            for name, chunk in self._chunk(int(index)).items():
                values[name][rows] = chunk[within]
        return values

    def query(self, poses: npt.ArrayLike, *, exact: bool = False) -> Answers:
        """What the map says about poses.

        Args:
            poses: T_base_tcp, (n, 4, 4) [m].
            exact: Solve for the poses themselves besides.

        Raises:
            InvalidArgumentError: Another shape, or not finite.
            PlanMismatchError: Exact, of a map with a filter that open() was not given.
        """
        given = as_floats("poses", poses, (4, 4)).reshape(-1, 4, 4)
        parts = [
            self._query(given[i : i + AT_ONCE])
            for i in range(0, max(len(given), 1), AT_ONCE)
        ]
        values = {
            name: np.concatenate([part.values[name] for part in parts])
            for name in self.names
        }
        result = self.solver.solve_batch(given, **self.request) if exact else None
        return Answers(
            np.concatenate([part.cells for part in parts]),
            np.concatenate([part.inside for part in parts]),
            values,
            result,
        )

    def poses(
        self,
        cells: npt.ArrayLike,
        *,
        first: npt.ArrayLike = 0.0,
        last: npt.ArrayLike = 0.0,
    ) -> FloatArray:
        """Poses T_base_tcp of cells, (n, 4, 4).

        Args:
            cells: Indices, (n, axes).
            first: Turns about the first joint's axis [rad], (n,) or a number, of a map
                that leaves these out.
            last: Spins of the tool about the last joint's axis, likewise.

        Raises:
            InvalidArgumentError: Indices out of range, or turns that are not left out.
        """
        index = np.asarray(cells, np.int64).reshape(-1, len(self.grid.shape))
        if ((index < 0) | (index >= np.array(self.grid.shape))).any():
            reject("cells", f"not all inside the grid's shape {self.grid.shape}")
        poses = self.grid.poses(index)
        for name, value, free in (
            ("first", first, self.plan.first_turn),
            ("last", last, self.plan.last_turn or self.plan.free_spin),
        ):
            angles = np.broadcast_to(np.asarray(value, float), len(poses))
            if not angles.any():
                continue
            if not free:
                reject(name, "the map does not leave out these turns")
            turns = np.tile(np.eye(4), (len(poses), 1, 1))
            turns[:, :3, :3] = z_rotations(angles)
            if name == "first":
                frame = self.grid.T_base_grid
                poses = frame @ turns @ np.linalg.inv(frame) @ poses
            else:
                to_axis = np.eye(4)
                axis = np.array([self.grid.orientations.axis])
                to_axis[:3, :3] = least_rotations(axis)[0]
                poses = poses @ to_axis @ turns @ to_axis.T
        return np.asarray(poses)

    def to_xarray(self) -> Any:
        """The arrays as an xarray.Dataset, read when they are used and unchecked."""
        dataset = need("xarray").open_zarr(
            self._store.path, consolidated=False, zarr_format=3
        )
        return dataset.drop_vars("receipt")

    def _query(self, poses: FloatArray) -> Answers:
        cells, inside = self.grid.index(poses)
        values = self.take(cells)
        for spec in self._store.specs:
            values[spec.name][~inside] = np.array(spec.fill).astype(spec.dtype)
        return Answers(cells, inside, values)

    def _chunk(self, index: int) -> Arrays:
        """A chunk from memory or from the store; unknown values if it is missing."""
        if index in self._chunks:
            self._chunks.move_to_end(index)
            return self._chunks[index]
        if self._done[index]:
            arrays = self._store.read(index)
        else:
            shape = tuple(part.stop - part.start for part in self.plan.block(index))
            arrays = {
                spec.name: np.full(shape + spec.shape, spec.fill, spec.dtype)
                for spec in self._store.specs
            }
        self._chunks[index] = arrays
        size = sum(array.nbytes for array in arrays.values())
        while len(self._chunks) > max(1, CACHE_BYTES // size):
            self._chunks.popitem(last=False)
        return arrays

    def _spec(self, name: str) -> ArraySpec:
        for spec in self._store.specs:
            if spec.name == name:
                return spec
        return reject("name", f"{name!r} is none of {', '.join(self.names)}")


def open(  # noqa: A001 (as zarr's)
    path: StrPath,
    *,
    partial: bool = False,
    filter: Filter | None = None,  # noqa: A002 (as in solve)
) -> Map:
    """Open a map.

    Args:
        path: What create() wrote and run() computed: a path, or a URL of fsspec.
        partial: Open it though chunks are missing; their cells are unknown.
        filter: The one that the plan names, for exact queries.

    Raises:
        MapIoError: There is none, or it cannot be read.
        PlanMismatchError: A data set, or a chunk belongs to another plan.
        IncompleteMapError: Chunks are missing.
    """
    store = Store(path)
    if not isinstance(store.job, Plan):
        raise PlanMismatchError(f"'{store.path}' is a {store.job.kind}, not a map")
    found = Map(store, store.job, filter)
    missing = found.missing
    if missing and not partial:
        raise IncompleteMapError(
            f"'{store.path}': {missing} of {store.job.chunks} chunks are missing; "
            f"compute them by 'iksel reach run {store.path}', or open it by "
            "partial=True"
        )
    return found
