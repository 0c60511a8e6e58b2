# SPDX-License-Identifier: BSD-3-Clause
"""The plan of a map: which cells, what of each, in which chunks."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from iksel_cpp import Axis, Robot, Scene, Solver, SolverOptions, Task, TaskFrame

from iksel._base.arrays import reject
from iksel.reach._cells import QUALITIES, array_specs, solve_cells
from iksel.reach._errors import check_tips
from iksel.reach._grid import Grid, Orientations
from iksel.reach._job import (
    Arrays,
    ArraySpec,
    Filter,
    Job,
    common_data,
    filter_name,
)
from iksel.reach._layout import chunking, cover, resolution
from iksel.reach._scene_data import scene_data, scene_of_data
from iksel.reach._symmetry import first_axis, last_axis

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from iksel._base.arrays import FloatArray

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

    @cached_property
    def scene(self) -> Scene | None:
        """What the arm may not collide with, in the base frame."""
        data = self._data.get("scene")
        return None if data is None else scene_of_data(self.robot(), data)

    def request(self, filter: Filter | None = None) -> dict[str, Any]:  # noqa: A002
        """Keywords of all solves: the plan's scene and filter, if it has any.

        Args:
            filter: The one that the plan names.

        Raises:
            PlanMismatchError: The plan names another, or none.
        """
        request = super().request(filter)
        return request if self.scene is None else {**request, "scene": self.scene}

    def compute(
        self, index: int, solver: Solver, request: Mapping[str, Any] | None = None
    ) -> Arrays:
        """The chunk of that number, an array for each spec.

        Args:
            index: Of the chunk.
            solver: As solver() makes it.
            request: What request() gives; None: that of a plan without a filter.
        """
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
            self.request() if request is None else request,
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
    scene: Scene | None = None,
    filter: Filter | None = None,  # noqa: A002 (as in solve)
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
        scene: What the arm may not collide with, of a robot of the same chain; the plan
            holds a copy. Turns then change what is reached, and none is left out.
        filter: Which configurations may be answers, as in Solver.solve; no turn is left
            out either. The plan holds its name alone: give it to run() and open() too.
        chunk_cells: Cells of a chunk, about; None: a 256th, 65,536 to 16,777,216.

    Raises:
        InvalidArgumentError: An argument out of range, qualities that the robot has
            not, a scene of another robot, or a robot with several tips.
    """
    check_tips(robot)
    symmetry = symmetry and scene is None and filter is None
    options = SolverOptions() if options is None else options
    wanted = _checked_qualities(robot, tuple(qualities), options, free_spin=free_spin)
    kept_axis = _axis(axis)
    if free_spin:
        if not options.task.is_full_pose:
            reject("free_spin", "the options' task frees axes of its own")
        options = options.replace(task=Task.free_spin(axis))
    first = _first(robot, options, wanted) if symmetry else None
    last = _last(robot, options, wanted) if symmetry and not free_spin else None
    cubes = cover(robot, spacing, box, first)
    if last is not None:
        kept_axis = last
    flat = free_spin or last is not None
    nside, spins = resolution(orientations, angle, flat=flat, reduced=last is not None)
    frame = np.eye(4) if first is None else first
    grid = Grid(
        cubes,
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
        **_refusing(robot, scene, filter),
        **chunking(grid, chunk_cells),
    }
    return Plan(data)


def _refusing(
    robot: Robot,
    scene: Scene | None,
    filter: Filter | None,  # noqa: A002 (as in solve)
) -> dict[str, Any]:
    """What refuses configurations; nothing where nothing does."""
    data: dict[str, Any] = {}
    if scene is not None:
        # Raises if the chains differ.
        Solver(robot).solve(
            robot.fk(robot.random_configurations(1, seed=0)[0]), scene=scene
        )
        data["scene"] = scene_data(scene)
    if filter is not None:
        data["filter"] = filter_name(filter)
    return data


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


def _lists(value: Any) -> Any:
    """Tuples as lists, as they come back from JSON."""
    if isinstance(value, dict):
        return {key: _lists(item) for key, item in value.items()}
    return list(map(_lists, value)) if isinstance(value, list | tuple) else value
