# SPDX-License-Identifier: BSD-3-Clause
"""Which solvers are asked what, on which arms."""

from __future__ import annotations

from typing import TYPE_CHECKING

import iksel
from bench.arms import BENCH_ARMS
from bench.rivals import ENUMERATORS
from bench.size import Job, Size

if TYPE_CHECKING:
    from collections.abc import Collection

    from bench.store import Settings

KINDS = ("uniform", "any_rotation")
"""Targets that can all be reached, and targets of which many cannot."""
COUNTED = ("IKSel", "ssik", "frankik", "IKFast")
"""Solvers that can be asked for so many answers of a redundant arm."""
NUMBERS = (16, 64)
"""How many they are asked for."""
HANG_S = 300.0
"""A solver that takes longer for a cell is ended [s]."""
BUILDING = ("ssik", "ssik, no rescue")
"""Solvers that first build something for an arm, which takes minutes: they get what all
workers do."""


def arms() -> list[str]:
    """The built-in robots of at least 6 joints, and those that only the bench has."""
    names = [name for name in iksel.robot_names() if iksel.robot_info(name).dof >= 6]
    return [*names, *BENCH_ARMS]


def asked_cell(robot: str, name: str, kind: str, size: Size) -> Settings:
    """One solver on targets of a kind, asked in all of its ways."""
    cell = {
        "cell": "asked",
        "robot": robot,
        "kind": kind,
        "count": size.analytic,
        "seed": size.no_seed,
        "rival": name,
        "limit_s": size.analytic_s,
    }
    return cell if name in BUILDING else {**cell, "hang_s": HANG_S}


def counted_arms() -> list[str]:
    """The built-in robots of seven joints."""
    return [name for name in iksel.robot_names() if iksel.robot_info(name).dof == 7]


def counted_cell(robot: str, name: str, size: Size) -> Settings:
    """One solver asked for so many answers to reachable targets."""
    cell = asked_cell(robot, name, KINDS[0], size)
    return {**cell, "cell": "counted", "numbers": list(NUMBERS)}


def analytic_jobs(size: Size, robots: Collection[str] | None = None) -> list[Job]:
    """A process for each solver: what ends one, no other feels."""
    wanted = arms() if robots is None else robots
    asked = {
        job_name(name): [
            asked_cell(robot, name, kind, size) for robot in wanted for kind in KINDS
        ]
        for name in ENUMERATORS
    }
    redundant = [robot for robot in counted_arms() if robot in wanted]
    counted = {
        f"{name}, so many answers": [
            counted_cell(robot, name, size) for robot in redundant
        ]
        for name in COUNTED
    }
    return [Job(name, "analytic", cells) for name, cells in (asked | counted).items()]


def job_name(name: str) -> str:
    """How progress and failures call a job."""
    return f"{name} asked"
