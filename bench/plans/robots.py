# SPDX-License-Identifier: BSD-3-Clause
"""Every built-in robot by the default preset."""

from __future__ import annotations

from typing import TYPE_CHECKING

import iksel
from bench.plans.shared import at_level, other_level
from bench.size import SEED, Job, Size

if TYPE_CHECKING:
    from bench.store import Settings


def all_robots() -> list[str]:
    """The built-in robots that have at least 6 joints."""
    return [name for name in iksel.robot_names() if iksel.robot_info(name).dof >= 6]


def robot_cell(robot: str, size: Size) -> Settings:
    """The default preset by iksel.evaluate, with the time of each stage."""
    return {
        "cell": "evaluate",
        "robot": robot,
        "preset": "default",
        "overrides": {},
        "count": size.robots,
        "seed": SEED,
        "stages": True,
    }


def robots_jobs(size: Size) -> list[Job]:
    """All robots in one process, and in another at another SIMD level."""
    cells = [robot_cell(robot, size) for robot in all_robots()]
    jobs = [Job("every robot", "robots", cells)]
    if level := other_level():
        others = [at_level(cell, level) for cell in cells]
        jobs.append(Job(f"every robot, {level}", "robots", others))
    return jobs
