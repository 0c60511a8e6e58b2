# SPDX-License-Identifier: BSD-3-Clause
"""What `iksel plot` draws, and the numbers behind it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from iksel_cpp import Status

from iksel._base.figures import COLOURS, make_figure
from iksel._base.qualities import manipulability
from iksel.cli._angles import turning

if TYPE_CHECKING:
    from iksel_cpp import PathResult, Robot, Solver

    from iksel._base.arrays import FloatArray, IntArray
    from iksel.cli._angles import Angles

CELLS = 72
"""Cells of a picture along its longer side."""

PANELS = (("x", "z", "from the side"), ("x", "y", "from above"))
WIDE = (11.0, 5.0)  # [inch]
ROW = (8.0, 1.5)  # of one joint [inch]
MOST_SOLUTIONS = 64
"""Of a pose, that are drawn; an arm with six joints has 16 or fewer."""


class Branches(NamedTuple):
    """All solutions of the poses of a path, and the way that solve_path() takes."""

    waypoint: IntArray
    """Which pose a solution belongs to, (N,)."""
    q: FloatArray
    """The solutions, (N, dof) [rad or m]."""
    status: IntArray
    """iksel.Status of each pose, (poses,)."""
    path: PathResult


def find_branches(solver: Solver, poses: FloatArray) -> Branches:
    """All solutions of poses (N, 4, 4), or of k tips (N, k, 4, 4), and a path."""
    waypoint, q, status = [], [np.empty((0, solver.robot.dof))], []
    for index, pose in enumerate(poses):
        found = solver.solve_all(pose, MOST_SOLUTIONS)
        waypoint += [index] * len(found)
        status.append(int(found.status))
        if found.success:
            q.append(found.q)
    return Branches(
        np.array(waypoint, dtype=np.int64),
        np.concatenate(q),
        np.array(status),
        solver.solve_path(poses),
    )


def workspace_figure(robot: Robot, q: FloatArray) -> Any:
    """How many of the configurations (N, dof) put the TCP, or one of several, where."""

    def share(across: FloatArray, along: FloatArray, edges: Any) -> FloatArray:
        counts = np.histogram2d(across, along, edges)[0]
        return np.where(counts > 0, counts / counts.max(), np.nan)

    return _panels(robot, q, share, "configurations, share of the fullest cell")


def manipulability_figure(robot: Robot, q: FloatArray) -> Any:
    """The largest manipulability of the configurations (N, dof), by TCP."""
    values = np.repeat(manipulability(robot, q), robot.tips)

    def best(across: FloatArray, along: FloatArray, edges: Any) -> FloatArray:
        return largest_in_cells(across, along, values, edges)

    return _panels(robot, q, best, "largest manipulability found")


def largest_in_cells(
    across: FloatArray, along: FloatArray, values: FloatArray, edges: Any
) -> FloatArray:
    """The largest of the values (N,) of the points in each cell; NaN without points."""
    shape = tuple(len(edge) - 1 for edge in edges)
    cells = tuple(
        np.clip(np.searchsorted(edge, x, side="right") - 1, 0, size - 1)
        for x, edge, size in zip((across, along), edges, shape, strict=True)
    )
    best = np.full(shape, -np.inf)
    np.maximum.at(best, cells, values)
    return np.where(best > -np.inf, best, np.nan)


def branches_figure(robot: Robot, branches: Branches, angles: Angles) -> Any:
    """Each joint over the path: solutions as dots, the path's way as a line, limits."""
    figure = make_figure((ROW[0], ROW[1] * robot.dof + 0.8))
    panels = figure.subplots(robot.dof, sharex=True, squeeze=False)[:, 0]
    way = angles.show(robot, branches.path.q)
    limits = angles.show(robot, np.stack([robot.lower, robot.upper]))
    units = angles.units(robot)
    without = np.flatnonzero(branches.status != int(Status.solved))
    for joint, axes in enumerate(panels):
        for index in without:
            axes.axvspan(index - 0.5, index + 0.5, color="tab:red", alpha=0.15, lw=0)
        for limit in limits[:, joint]:
            if math.isfinite(limit):
                axes.axhline(limit, color="tab:gray", lw=0.8, ls="--")
        waypoint, values = whole_turns(robot, joint, branches)
        values = angles.show_joint(robot, joint, values)
        axes.plot(waypoint, values, ".", ms=3, color="tab:blue")
        axes.plot(np.arange(len(way)), way[:, joint], color="tab:orange", lw=1.2)
        axes.set_ylabel(f"{robot.joint_names[joint]}\n[{units[joint]}]", fontsize=7)
        axes.tick_params(labelsize=7)
    panels[-1].set_xlabel("waypoint")
    panels[-1].set_xlim(-0.5, len(branches.status) - 0.5)
    lost = f"; {len(without)} without, in red" if len(without) else ""
    figure.suptitle(
        f"{robot.name}: solutions (dots), the path's (line), limits (dashed){lost}",
        fontsize=9,
    )
    return figure


def whole_turns(
    robot: Robot, joint: int, branches: Branches
) -> tuple[IntArray, FloatArray]:
    """The waypoints and values of a joint in all solutions, (N,) [rad or m].

    Also those that are whole turns away and inside the limits; a joint without limits,
    which has endlessly many, and one that slides have no others.
    """
    values = branches.q[:, joint]
    lower, upper = robot.lower[joint], robot.upper[joint]
    if not (turning(robot)[joint] and math.isfinite(upper - lower)):
        return branches.waypoint, values
    most = math.ceil((upper - lower) / (2 * math.pi))
    copies = values + 2 * math.pi * np.arange(-most, most + 1)[:, None]
    inside = (copies >= lower) & (copies <= upper)
    return np.broadcast_to(branches.waypoint, copies.shape)[inside], copies[inside]


def _panels(robot: Robot, q: FloatArray, value: Any, label: str) -> Any:
    """Where the TCP is, from the side and from above, coloured by a value per cell."""
    position = robot.fk(q)[..., :3, 3].reshape(-1, 3)
    figure = make_figure(WIDE)
    step = max(float(np.ptp(position, axis=0).max()), 1e-9) / CELLS
    for axes, (first, second, where) in zip(figure.subplots(1, 2), PANELS, strict=True):
        points = [position[:, "xyz".index(name)] for name in (first, second)]
        edges = [_edges(x, step) for x in points]
        image = axes.pcolormesh(
            *edges, value(*points, edges).T, cmap=COLOURS, rasterized=True
        )
        figure.colorbar(image, ax=axes, label=label, shrink=0.8)
        axes.plot(0, 0, "k+", markersize=10)
        axes.set(
            xlabel=f"{first} [m]", ylabel=f"{second} [m]", aspect="equal", title=where
        )
    figure.suptitle(
        f"{robot.name}: {robot.base_link} (+) to {', '.join(robot.tip_links)}, "
        f"{len(q):,} configurations"
    )
    return figure


def _edges(x: FloatArray, step: float) -> FloatArray:
    """Edges of cells that hold all x (N,)."""
    count = int(np.ptp(x) / step) + 1
    middle = (x.max() + x.min()) / 2
    return np.asarray(middle + step * (np.arange(count + 1) - count / 2))
