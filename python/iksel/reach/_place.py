# SPDX-License-Identifier: BSD-3-Clause
"""Where a robot's base may stand so that it reaches given poses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from iksel._base.arrays import FloatArray, IntArray, as_floats, reject
from iksel.reach._grid import z_rotations
from iksel.reach._scene_data import at_base

if TYPE_CHECKING:
    from iksel_cpp import Scene

    from iksel._base.arrays import BoolArray
    from iksel.reach._job import Filter
    from iksel.reach._map import Map

AT_ONCE = 1 << 18
"""Poses that are looked up at once."""


@dataclass(frozen=True)
class Placement:
    """A pose of the base, and what can be reached from there."""

    T_world_base: FloatArray
    """Pose of the base link, (4, 4)."""
    reached: int
    """How many of the poses have a solution, by exact inverse kinematics."""
    by_map: int
    """How many have one by the map."""
    fraction: float
    """Mean share of the orientations that are reached at the poses' positions."""
    q: FloatArray
    """Solutions, (n, dof) [rad or m]; NaN for poses that cannot be reached."""

    @property
    def reachable(self) -> BoolArray:
        """Which poses have a solution, (n,)."""
        return np.asarray(np.isfinite(self.q).all(axis=-1))


def place_base(
    reach_map: Map,
    poses: npt.ArrayLike,
    *,
    bases: npt.ArrayLike | None = None,
    spacing: float = 0.05,
    yaws: int = 24,
    height: float = 0.0,
    checked: int = 10,
    scene: Scene | None = None,
    filter: Filter | None = None,  # noqa: A002 (as in solve)
) -> list[Placement]:
    """Rank poses of the base by how many poses of the tool it reaches from there.

    All candidates are ranked by the map: by the number of poses in cells that can be
    reached, then by the mean share of orientations that are reached at the poses'
    positions, which is larger away from the border. The best are solved exactly.

    Args:
        reach_map: A map of the robot with its tool.
        poses: T_world_tcp, (n, 4, 4) [m].
        bases: Candidates T_world_base, (k, 4, 4); None: upright on a grid of x and y
            around the poses, as far as the map reaches, and of yaw.
        spacing: Distance of that grid's candidates [m].
        yaws: Candidates per place that differ by their yaw; one is enough, and taken,
            where the map leaves out the turn of a first joint whose axis is the base's
            z axis.
        height: z of the base link's frame in that grid [m].
        checked: How many of the best are solved exactly and returned.
        scene: What the arm may not collide with where the best are solved: obstacles in
            the world's frame, where they stay; the robot's body and what it carries go
            with the base. What no joint moves, as the base link, is not held against
            them. None: the scene of the map's plan, which goes with the base.
        filter: Which configurations may be answers there, as in Solver.solve; None:
            the one that the map was opened with.

    Returns:
        Placements, the best first: by `reached`, then `by_map`, then `fraction`.

    Raises:
        InvalidArgumentError: Wrong shapes, a number out of range, or a scene of another
            robot.
        PlanMismatchError: The map's plan names a filter, and there is none.
    """
    wanted = as_floats("poses", poses, (4, 4)).reshape(-1, 4, 4)
    if len(wanted) == 0:
        reject("poses", "there are none")
    if checked < 1:
        reject("checked", f"{checked} is less than 1")
    if bases is None:
        candidates = _candidates(reach_map, wanted, spacing, yaws, height)
    else:
        candidates = as_floats("bases", bases, (4, 4)).reshape(-1, 4, 4)
    counts, shares = _scores(reach_map, candidates, wanted)
    order = np.lexsort((-shares, -counts))[:checked]
    if filter is None:
        request = reach_map.request
    else:
        request = {"scene": reach_map.plan.scene, "filter": filter}
    placements = []
    for i in order:
        if scene is not None:
            request["scene"] = at_base(scene, candidates[i])
        local = np.linalg.inv(candidates[i]) @ wanted
        result = reach_map.solver.solve_batch(local, **request)
        placements.append(
            Placement(
                candidates[i],
                result.solved,
                int(counts[i]),
                float(shares[i]),
                np.array(result.q),
            )
        )
    # Stable: those that are equal in it stay in the map's order.
    return sorted(placements, key=lambda placement: -placement.reached)


def _candidates(
    reach_map: Map, poses: FloatArray, spacing: float, yaws: int, height: float
) -> FloatArray:
    """Upright poses of the base around the poses of the tool."""
    if not (np.isfinite(spacing) and spacing > 0):
        reject("spacing", f"{spacing} is no positive length")
    if yaws < 1:
        reject("yaws", f"{yaws} is less than 1")
    if _turns_about_z(reach_map):
        yaws = 1
    far = max(np.abs(axis).max() for axis in reach_map.axes()[:2])
    lower = poses[:, :2, 3].min(axis=0) - far
    upper = poses[:, :2, 3].max(axis=0) + far
    x, y = (
        np.arange(np.floor(a / spacing), np.ceil(b / spacing) + 1) * spacing
        for a, b in zip(lower, upper, strict=True)
    )
    yaw = np.arange(yaws) * (2 * np.pi / yaws)
    mesh = np.stack(np.meshgrid(x, y, yaw, indexing="ij"), -1).reshape(-1, 3)
    bases = np.tile(np.eye(4), (len(mesh), 1, 1))
    bases[:, :2, 3] = mesh[:, :2]
    bases[:, 2, 3] = height
    bases[:, :3, :3] = z_rotations(mesh[:, 2])
    return bases


def _turns_about_z(reach_map: Map) -> bool:
    """Whether turning the base about its z axis changes nothing."""
    frame = reach_map.grid.T_base_grid
    on_axis = abs(frame[2, 2]) == 1 and not frame[:2, 3].any()
    return reach_map.plan.first_turn and bool(on_axis)


def _scores(
    reach_map: Map, bases: FloatArray, poses: FloatArray
) -> tuple[IntArray, FloatArray]:
    """By the map: how many poses each base reaches, and the mean share, (k,)."""
    counts = np.empty(len(bases), np.int64)
    shares = np.empty(len(bases))
    step = max(1, AT_ONCE // len(poses))
    for i in range(0, len(bases), step):
        some = slice(i, i + step)
        local = np.linalg.inv(bases[some])[:, None] @ poses
        shape = local.shape[:2]
        answers = reach_map.query(local.reshape(-1, 4, 4))
        at = len(reach_map.grid.positions.counts)
        fraction = reach_map.fraction[tuple(answers.cells[:, :at].T)]
        counts[some] = answers.solvable.reshape(shape).sum(axis=1)
        kept = np.where(answers.inside, fraction, 0.0).reshape(shape)
        shares[some] = kept.mean(axis=1)
    return counts, shares
