# SPDX-License-Identifier: BSD-3-Clause
"""Moves from where an arm stands, branches beside restarts, paths."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench.plans.shared import target_cell
from bench.size import Job, Size

if TYPE_CHECKING:
    from bench.store import Settings

RESTART_ARMS = ("cvr038", "cvrb1213")
"""Robots whose branches none of them knows."""
MOVE_ARMS = ("panda", "iiwa14")
MOVE_RIVALS: dict[str, dict[str, Any]] = {
    "Robotics Toolbox": {"rival": "Robotics Toolbox"},
    "OptIK": {"rival": "OptIK"},
    "OptIK, quality": {"rival": "OptIK", "quality": True},
}
"""Solvers that start where they are told, as settings."""
PATHS = (
    ("panda", "line"),
    ("ur3", "flip"),
    ("ur3", "flip_beside"),
    ("ur3", "flip_free"),
)


def request_cell(cell: str, robot: str, count: int) -> Settings:
    """One request on one robot."""
    return {**target_cell(robot, "uniform", count), "cell": cell}


def moves_cell(robot: str, name: str, size: Size) -> Settings:
    """Our moves beside those of a solver; all calls of one take all of its time."""
    rival = MOVE_RIVALS[name]
    count = max(1, size.requests // (50 if rival.get("quality") else 10))
    return {**request_cell("near_moves", robot, count), **rival}


def path_cell(robot: str, name: str) -> Settings:
    """One path of bench.requests."""
    return {"cell": "path", "robot": robot, "path": name}


def request_jobs(size: Size) -> list[Job]:
    """A process for each solver, one for restarts and one for paths."""
    counts = [request_cell("restarts", robot, size.restarts) for robot in RESTART_ARMS]
    paths = [path_cell(robot, name) for robot, name in PATHS]
    moves = [
        Job(
            f"near, {name}",
            "requests",
            [moves_cell(robot, name, size) for robot in MOVE_ARMS],
        )
        for name in MOVE_RIVALS
    ]
    return [
        *moves,
        Job("restarts", "requests", counts),
        Job("paths", "requests", paths),
    ]
