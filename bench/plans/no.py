# SPDX-License-Identifier: BSD-3-Clause
"""Poses without an answer, all branches, and the nearest."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bench.plans.shared import target_cell
from bench.rivals import RIVALS
from bench.size import Job, Size

if TYPE_CHECKING:
    from collections.abc import Collection

    from bench.store import Settings

NO_KINDS = ("uniform", "any_rotation")
"""Targets that all have an answer, and targets of which many have none."""
BRANCH_RIVAL = "EAIK"
BRANCH_ARMS = ("ur3", "ur3_wrs", "ur10e", "irb120", "vs060")
"""Robots whose branches an analytic solver knows."""
NO_ARMS = (
    *BRANCH_ARMS,
    *("cvr038", "cvrb1213", "gen3_6dof", "xarm6"),
    *("panda", "iiwa14", "xarm7", "pr2_right_arm"),
    *("irb14050", "synthetic10"),
)
"""Of every structure some: closed form; two axes that are parallel or meet; closed form
when one of seven joints is held; none of these."""
NO_RIVALS = (
    "IKSel",
    BRANCH_RIVAL,
    "Robotics Toolbox",
    "OptIK",
    "TRAC-IK (pytracik)",
    "Pinocchio, Python loop",
    "Pinocchio, C++ loop",
    "KDL LMA",
    "KDL NR_JL",
)
MANY = 10.0
"""Share of a solver that is fast enough for all targets of the noes."""


def no_cell(robot: str, name: str, kind: str, size: Size) -> Settings:
    """One solver's yes and no to targets of a kind."""
    count = size.no if RIVALS[name].share >= MANY else size.no_slow
    cell = target_cell(robot, kind, count, size.no_seed)
    return {**cell, "cell": "no", "rival": name}


def branch_cell(cell: str, robot: str, kind: str, size: Size) -> Settings:
    """All branches or the nearest, beside a solver that knows them if there is one."""
    known = robot in BRANCH_ARMS
    count = size.no if known else max(1, size.no // 10)
    settings = {**target_cell(robot, kind, count, size.no_seed), "cell": cell}
    return {**settings, "beside": BRANCH_RIVAL} if known else settings


def no_jobs(size: Size, arms: Collection[str] = NO_ARMS) -> list[Job]:
    """Each solver's yes and no; all branches, and the nearest."""
    answered = {
        name: [no_cell(robot, name, kind, size) for robot in arms for kind in NO_KINDS]
        for name in NO_RIVALS
    }
    branches = {
        title: [
            branch_cell(cell, robot, kind, size) for robot in arms for kind in NO_KINDS
        ]
        for title, cell in (("all", "all_branches"), ("nearest", "near_branches"))
    }
    return [
        Job(f"no, {name}", "no", cells) for name, cells in (answered | branches).items()
    ]
