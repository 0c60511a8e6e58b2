# SPDX-License-Identifier: BSD-3-Clause
"""The default preset beside its rivals, and batches of poses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bench.arms import RIVAL_ARMS
from bench.plans.shared import at_level, other_level, target_cell
from bench.rivals import RIVALS
from bench.size import Job, Size

if TYPE_CHECKING:
    from bench.store import Settings


def rival_count(size: Size, name: str, kind: str) -> int:
    """Targets of a kind for a solver."""
    return max(1, round(size.rivals[kind] * RIVALS[name].share))


def rival_cell(robot: str, name: str, kind: str, size: Size) -> Settings:
    """One solver on one kind of targets."""
    count = rival_count(size, name, kind)
    return {**target_cell(robot, kind, count), "cell": "rival", "rival": name}


def batch_cell(robot: str, name: str, threads: int, size: Size) -> Settings:
    """Many poses in one call."""
    cell = target_cell(robot, "uniform", size.batch)
    return {**cell, "cell": "batch", "rival": name, "threads": threads}


def every_cell(robot: str, threads: int, size: Size) -> Settings:
    """All branches of many poses, pose by pose: beside EAIK's batches."""
    return {**batch_cell(robot, "IKSel", threads, size), "every": True}


BATCHES = (("ur3_wrs", "EAIK"), *((robot, "IKSel") for robot in RIVAL_ARMS))
"""Robots and solvers of the batches."""

BATCH_THREADS = (1, 2)


def rival_jobs(size: Size) -> list[Job]:
    """Each solver on all kinds of targets, batches, and IKSel at another level."""
    jobs = [
        Job(
            name,
            "rivals",
            [
                rival_cell(robot, name, kind, size)
                for robot in RIVAL_ARMS
                for kind in size.rivals
            ],
        )
        for name in RIVALS
    ]
    batches = [
        batch_cell(robot, name, threads, size)
        for robot, name in BATCHES
        for threads in BATCH_THREADS
    ]
    batches += [every_cell(BATCHES[0][0], threads, size) for threads in BATCH_THREADS]
    jobs.append(Job("batches", "rivals", batches))
    if level := other_level():
        cells = [
            at_level(rival_cell(robot, "IKSel", kind, size), level)
            for robot in RIVAL_ARMS
            for kind in size.rivals
        ]
        jobs.append(Job(f"IKSel, {level}", "rivals", cells))
    return jobs
