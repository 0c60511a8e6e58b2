# SPDX-License-Identifier: BSD-3-Clause
"""What inverse kinematics says about cells: status and proof, and qualities."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import Proof, Solver, Status

from iksel._base.qualities import limit_distance, manipulability
from iksel.reach._job import Arrays, ArraySpec

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from iksel._base.arrays import FloatArray

UNKNOWN = 255
"""Status and proof of a cell that has not been computed."""
QUALITIES = ("branches", "manipulability", "limit_distance", "q")
BATCH = 1 << 13
"""Cells that are solved at once; their poses fit into a core's cache."""
MOST_BRANCHES = 254


def array_specs(qualities: Sequence[str], dof: int) -> list[ArraySpec]:
    """The arrays of a map with these qualities."""
    nan = float("nan")
    every = {
        "branches": ArraySpec(
            "branches",
            "uint8",
            UNKNOWN,
            attributes={"long_name": "number of solutions, whole turns not counted"},
        ),
        "manipulability": ArraySpec(
            "manipulability",
            "float32",
            nan,
            attributes={"long_name": "largest sqrt(det(J J^T)) of the solutions"},
        ),
        "limit_distance": ArraySpec(
            "limit_distance",
            "float32",
            nan,
            attributes={
                "long_name": "largest distance of the solutions from the joint limits, "
                "relative to each joint's range"
            },
        ),
        "q": ArraySpec(
            "q",
            "float64",
            nan,
            ("joint",),
            (dof,),
            {"long_name": "a solution [rad or m]; the most manipulable, if known"},
        ),
    }
    return [
        ArraySpec("status", "uint8", UNKNOWN, attributes=flags(Status)),
        ArraySpec("proof", "uint8", UNKNOWN, attributes=flags(Proof)),
        *(every[name] for name in qualities),
    ]


def solve_cells(
    solver: Solver,
    points: FloatArray,
    rotations: FloatArray,
    qualities: Sequence[str] = (),
    request: Mapping[str, Any] = MappingProxyType({}),
) -> Arrays:
    """Solve for all rotations at all points, on one thread.

    Args:
        solver: Its options say what is asked.
        points: Positions in the base frame, (p, 3) [m].
        rotations: Rotations of the tool in the base frame, (r, 3, 3).
        qualities: Some of QUALITIES.
        request: Keywords of all solves: a scene, a filter.

    Returns:
        For each array_specs() an array (p * r, ...), with all rotations of the first
        point first.
    """
    total = len(points) * len(rotations)
    cells: Arrays = {
        spec.name: np.full((total, *spec.shape), spec.fill, spec.dtype)
        for spec in array_specs(qualities, solver.robot.dof)
    }
    count = min(len(rotations), BATCH)
    rows = max(1, BATCH // count)
    poses = np.zeros((rows, count, 4, 4))
    poses[..., 3, 3] = 1
    for first in range(0, len(rotations), count):
        part = rotations[first : first + count]
        poses[:, : len(part), :3, :3] = part
        for row in range(0, len(points), rows):
            some = points[row : row + rows]
            poses[: len(some), :, :3, 3] = some[:, None]
            batch = poses[: len(some), : len(part)].reshape(-1, 4, 4)
            places = np.add.outer(
                np.arange(row, row + len(some)) * len(rotations),
                np.arange(first, first + len(part)),
            ).ravel()
            _solve_batch(
                solver, batch, places, cells, qualities=qualities, request=request
            )
    return cells


def _solve_batch(
    solver: Solver,
    poses: FloatArray,
    places: np.ndarray[Any, Any],
    cells: Arrays,
    *,
    qualities: Sequence[str],
    request: Mapping[str, Any],
) -> None:
    """Solve poses, and put what is asked into the places of the cells."""
    result = solver.solve_batch(poses, threads=1, **request)
    cells["status"][places] = result.status
    cells["proof"][places] = result.proof
    if "q" in qualities:
        cells["q"][places] = result.q
    asked = [name for name in qualities if name != "q"]
    if not asked:
        return
    if "branches" in asked:
        cells["branches"][places] = 0
    solved = np.flatnonzero(result.success)
    if len(solved):
        values = _qualities(solver, poses[solved], result.q[solved], asked, request)
        for name, array in values.items():
            if name in cells:
                cells[name][places[solved]] = array


def _qualities(
    solver: Solver,
    poses: FloatArray,
    fallback: FloatArray,
    asked: Sequence[str],
    request: Mapping[str, Any],
) -> Arrays:
    """Qualities of poses that have a solution, and the best one by manipulability."""
    every = [solver.solve_all(pose, **request).q for pose in poses]
    # solve_all finds what solve found; where it should not, that is the one solution.
    every = [q if len(q) else fallback[i : i + 1] for i, q in enumerate(every)]
    counts = np.array([len(q) for q in every])
    starts = np.cumsum(counts) - counts
    q = np.concatenate(every)
    found: Arrays = {"branches": np.minimum(counts, MOST_BRANCHES).astype(np.uint8)}
    if "limit_distance" in asked:
        distance = limit_distance(solver.robot, q)
        found["limit_distance"] = np.maximum.reduceat(distance, starts)
    if "manipulability" in asked:
        value = manipulability(solver.robot, q)
        best = np.maximum.reduceat(value, starts)
        found["manipulability"] = best
        # The first of each pose that has the best value.
        first = np.flatnonzero(value == np.repeat(best, counts))
        owner = np.repeat(np.arange(len(counts)), counts)[first]
        found["q"] = q[first[np.unique(owner, return_index=True)[1]]]
    return found


def flags(members: Any) -> dict[str, Any]:
    """What the values mean, by the CF conventions."""
    return {
        "flag_values": [int(member) for member in members],
        "flag_meanings": " ".join(member.name for member in members),
    }
