# SPDX-License-Identifier: BSD-3-Clause
"""Which calls are looked at one by one, and of which robots."""

from __future__ import annotations

from typing import TYPE_CHECKING

import iksel
from bench.arms import RIVAL_ARMS
from bench.size import SEED, Job, Size

if TYPE_CHECKING:
    from collections.abc import Collection

    from bench.store import Settings

KINDS = ("uniform", "any_rotation")
"""Targets that can all be reached, and targets of which many cannot."""
TEN = (
    *("ur3", "ur10e", "irb120", "cvr038", "xarm6"),
    *("panda", "iiwa14", "xarm7", "irb14050", "pr2_right_arm"),
)
"""Robots that are solved for in turn: of every structure some."""


def calls_cell(robot: str, kind: str, size: Size) -> Settings:
    """Single calls, of which the slowest are explained."""
    count = size.tail_calls if kind == KINDS[0] else size.tail_noes
    cell = {"cell": "tail_calls", "robot": robot, "of": kind, "count": count}
    return {**cell, "seed": SEED}


def beside_cell(robot: str, size: Size) -> Settings:
    """Calls that follow other robots' and other memory's use of the caches."""
    others = [name for name in TEN if name != robot][: len(TEN) - 1]
    cell = {"cell": "tail_beside", "robot": robot, "others": others}
    return {**cell, "count": size.tail_beside, "seed": SEED}


def threads_cell(robot: str, size: Size) -> Settings:
    """Calls while another thread solves."""
    cell = {"cell": "tail_threads", "robot": robot, "count": size.tail_noes}
    return {**cell, "limit_s": size.tail_s, "seed": SEED}


def fresh_cell(robot: str) -> Settings:
    """What comes before the first answer in a new process."""
    return {"cell": "tail_fresh", "robot": robot, "count": 2, "seed": SEED}


def tail_jobs(size: Size, robots: Collection[str] | None = None) -> list[Job]:
    """A process for each table."""
    arms = RIVAL_ARMS if robots is None else robots
    every = iksel.robot_names() if robots is None else robots
    cells = {
        "slowest calls": [calls_cell(r, kind, size) for r in arms for kind in KINDS],
        "calls beside other work": [beside_cell(robot, size) for robot in arms],
        "calls beside a thread": [threads_cell(robot, size) for robot in arms],
        "first calls": [fresh_cell(robot) for robot in every],
    }
    return [Job(name, "tails", of_table) for name, of_table in cells.items()]
