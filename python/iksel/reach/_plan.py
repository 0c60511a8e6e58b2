# SPDX-License-Identifier: BSD-3-Clause
"""The plan of a map: which cells, what of each, in which chunks."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from iksel_cpp import Axis, Robot, Solver, SolverOptions, Task, TaskFrame

from iksel._arrays import as_floats, reject
from iksel.reach import _healpix
from iksel.reach._cells import QUALITIES, array_specs, solve_cells
from iksel.reach._grid import Grid, Orientations, Positions
from iksel.reach._job import Arrays, ArraySpec, Job, common_data
from iksel.reach._symmetry import first_axis, last_axis

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from iksel._arrays import FloatArray

CHUNKS = 256
"""How many chunks a map is divided into, as long as they have a reasonable size."""
SMALLEST_CHUNK, LARGEST_CHUNK = 1 << 16, 1 << 24
"""Cells of a chunk."""
LARGEST_SIDE = 1 << 20
"""Cells along one axis, so that a mistyped spacing is an error."""
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


class Plan(Job):
    """A map that is to be computed; plan() makes it."""

    kind = "map"

    def __init__(self, data: Mapping[str, Any]) -> None:
        super().__init__(data)
        self.grid = Grid.from_dict(data["grid"])

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the axes: of positions, then of orientations."""
        return self.grid.dims

    @property
    def shape(self) -> tuple[int, ...]:
        """Length of each axis."""
        return self.grid.shape

    @property
    def qualities(self) -> tuple[str, ...]:
        """What is computed of each cell besides status and proof."""
        return tuple(self._data["qualities"])

    @property
    def free_spin(self) -> bool:
        """Whether any spin about the tool's axis will do."""
        return bool(self._data["free_spin"])

    @property
    def first_turn(self) -> bool:
        """Whether a cell stands for all turns of its pose about the first axis."""
        return bool(self._data["first_turn"])

    @property
    def last_turn(self) -> bool:
        """Whether a cell stands for all spins of the tool about the last axis."""
        return bool(self._data["last_turn"])

    def specs(self) -> list[ArraySpec]:
        """The arrays of the result."""
        return array_specs(self.qualities, self.dof)

    @property
    def dof(self) -> int:
        """Degrees of freedom of the robot."""
        return int(self._data["dof"])

    def coordinates(self) -> dict[str, tuple[tuple[str, ...], np.ndarray[Any, Any]]]:
        """Names, axes and values of what the axes mean [m, rad]."""
        positions, turns = self.grid.positions, self.grid.orientations
        found: dict[str, tuple[tuple[str, ...], np.ndarray[Any, Any]]] = {
            name: ((name,), positions.centres(i))
            for i, name in enumerate(positions.dims)
        }
        for i, name in enumerate("xyz"):
            found[f"direction_{name}"] = (("direction",), turns.directions[:, i])
        if turns.spins:
            found["spin"] = (("spin",), turns.spin_angles)
        return found

    def compute(self, index: int, solver: Solver) -> Arrays:
        """The chunk of that number, an array for each spec."""
        block = self.block(index)
        at = len(self.grid.positions.counts)
        points = self.grid.positions.points(block[:at])
        turns = self.grid.orientations
        places = np.arange(turns.size).reshape(turns.counts)[block[at:]].ravel()
        frame = self.grid.T_base_grid
        cells = solve_cells(
            solver,
            points @ frame[:3, :3].T + frame[:3, 3],
            frame[:3, :3] @ turns.rotations[places],
            self.qualities,
        )
        shape = tuple(part.stop - part.start for part in block)
        return {
            name: values.reshape(shape + values.shape[1:])
            for name, values in cells.items()
        }


def plan(
    robot: Robot,
    *,
    spacing: float = 0.05,
    orientations: int | None = None,
    angle: float | None = None,
    free_spin: bool = False,
    axis: Axis | str = "z",
    box: npt.ArrayLike | None = None,
    qualities: Iterable[str] = (),
    symmetry: bool = True,
    options: SolverOptions | None = None,
    chunk_cells: int | None = None,
) -> Plan:
    """Plan a map of what a robot reaches.

    Args:
        robot: With its tool: cells are poses T_base_tcp.
        spacing: Edge of the cells of positions [m].
        orientations: About how many orientations each position gets; None: by `angle`,
            or 1000 (of directions alone 100).
        angle: Distance between neighbouring orientations [rad].
        free_spin: Cells are directions of `axis`, reached with some spin about it.
        axis: Which axis of the tool directions are of.
        box: Positions in the base frame, ((x, y, z), (x, y, z)) [m]; None: as far as
            the robot reaches.
        qualities: What is computed besides status and proof: "branches", "q",
            "manipulability", "limit_distance".
        symmetry: Leave out the turn of the first joint and the spin of the last one
            where that changes nothing: a cell then stands for all poses that differ
            from it by these. Of the poses in between it says nothing less.
        options: Options of the solver; None: the default.
        chunk_cells: Cells of a chunk, about; None: a 256th, 65,536 to 16,777,216.

    Raises:
        InvalidArgumentError: An argument out of range, or qualities that the robot has
            not.
    """
    options = SolverOptions() if options is None else options
    wanted = _checked_qualities(robot, tuple(qualities), options, free_spin=free_spin)
    kept_axis = _axis(axis)
    if free_spin:
        if not options.task.is_full_pose:
            reject("free_spin", "the options' task frees axes of its own")
        options = options.replace(task=Task.free_spin(axis))
    first = _first(robot, options, wanted) if symmetry else None
    last = _last(robot, options, wanted) if symmetry and not free_spin else None
    positions = _positions(robot, spacing, box, first)
    if last is not None:
        kept_axis = last
    flat = free_spin or last is not None
    nside, spins = _resolution(orientations, angle, flat=flat, reduced=last is not None)
    frame = np.eye(4) if first is None else first
    grid = Grid(
        positions,
        Orientations(nside, spins, kept_axis),
        tuple(frame.ravel().tolist()),
    )
    data = {
        **common_data(robot, options),
        "dof": robot.dof,
        "grid": _lists(grid.to_dict()),
        "qualities": list(wanted),
        "free_spin": free_spin,
        "first_turn": first is not None,
        "last_turn": last is not None,
        **_chunking(grid, chunk_cells),
    }
    return Plan(data)


def _first(
    robot: Robot, options: SolverOptions, qualities: Sequence[str]
) -> FloatArray | None:
    """The first joint's axis, if a map may leave its turn out."""
    task = options.task
    if task.frame == TaskFrame.base and not task.is_full_pose:
        return None
    if "limit_distance" in qualities and np.isfinite(robot.upper[0]):
        return None
    return first_axis(robot)


def _last(
    robot: Robot, options: SolverOptions, qualities: Sequence[str]
) -> tuple[float, float, float] | None:
    """The last joint's axis in the tool's frame, if a map may leave its spin out."""
    if not options.task.is_full_pose:
        return None
    if "limit_distance" in qualities and np.isfinite(robot.upper[-1]):
        return None
    axis = last_axis(robot)
    return None if axis is None else (float(axis[0]), float(axis[1]), float(axis[2]))


def _checked_qualities(
    robot: Robot, names: tuple[str, ...], options: SolverOptions, *, free_spin: bool
) -> tuple[str, ...]:
    for name in names:
        if name not in QUALITIES:
            reject("qualities", f"{name!r} is none of {', '.join(QUALITIES)}")
    fixed = 5 if free_spin else options.task.constrained_axes
    if "branches" in names and robot.dof > fixed:
        reject(
            "qualities",
            f"'branches' of {robot.dof} joints for {fixed} fixed axes: the solutions "
            "of a redundant arm are curves, which cannot be counted",
        )
    return tuple(name for name in QUALITIES if name in names)


def _axis(axis: Axis | str) -> tuple[float, float, float]:
    name = axis.name if isinstance(axis, Axis) else axis
    if name not in AXES:
        reject("axis", f"{name!r} is none of {', '.join(AXES)}")
    return AXES[name]


def _positions(
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


def _resolution(
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


def _chunking(grid: Grid, cells: int | None) -> dict[str, list[int]]:
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


def _lists(value: Any) -> Any:
    """Tuples as lists, as they come back from JSON."""
    if isinstance(value, dict):
        return {key: _lists(item) for key, item in value.items()}
    return list(map(_lists, value)) if isinstance(value, list | tuple) else value
