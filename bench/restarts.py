# SPDX-License-Identifier: BSD-3-Clause
"""A cell on branches: those of solve_all beside those of many random restarts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.branches import (
    APART,
    LIMIT_S,
    RESTARTS,
    SHOWN,
    branches_by_restarts,
    gap,
    judged,
    without,
)
from bench.timing import PASSES, least_times, time_calls

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array
    from bench.store import Settings
    from bench.targets import Targets

MORE_RESTARTS = 20_000
"""For poses where RESTARTS lack a branch of solve_all: whether they are too few."""


def restarts(arm: Arm, goals: Targets, settings: Settings) -> dict[str, Any]:
    """Poses where solve_all lacks a branch of the restarts, and where it has more.

    Both sets are judged by bench's forward kinematics and the limits; branches of
    solve_all that are none, or the same one twice, are wrong.
    """
    solver = iksel.Solver(arm.robot)
    asked = [(pose,) for pose in goals.poses]
    runs = [time_calls(solver.solve_all, asked, LIMIT_S) for _ in range(PASSES)]
    ours = judged(arm.chain, goals.poses, [list(found.q) for found in runs[0][1]])
    seeds = [settings["seed"] + 1 + i for i in range(len(goals))]
    given = [
        list(branches_by_restarts(solver, pose, RESTARTS, seed))
        for pose, seed in zip(goals.poses, seeds, strict=True)
    ]
    theirs = judged(arm.chain, goals.poses, given)
    sets = list(zip(ours.right, theirs.right, strict=True))
    lacking = [i for i, (us, them) in enumerate(sets) if len(without(them, us))]
    added = {
        i: more for i, (us, them) in enumerate(sets) if len(more := without(us, them))
    }
    return {
        "count": len(goals),
        "lacking": len(lacking),
        "more": len(added),
        "added": sum(map(len, added.values())),
        "wrong": ours.wrong + sum(map(_twice, ours.right)),
        "branches": sum(map(len, ours.right)),
        "mean_us": float(least_times([run[0] for run in runs]).mean()) / 1e3,
        "missed": lacking[:SHOWN],
        "again": _again(solver, goals, dict(list(added.items())[:SHOWN]), seeds),
    }


def _twice(branches: Array) -> int:
    """How many of a pose's branches are the same as one before, (n, dof)."""
    same = gap(branches, branches) < APART
    return int(np.count_nonzero(np.triu(same, 1).any(axis=0)))


def _again(
    solver: iksel.Solver, goals: Targets, added: dict[int, Array], seeds: list[int]
) -> dict[str, int]:
    """Of branches that restarts lack on some poses, how many more restarts find."""
    left = 0
    for i, branches in added.items():
        more = branches_by_restarts(solver, goals.poses[i], MORE_RESTARTS, seeds[i])
        left += len(without(branches, more))
    count = sum(map(len, added.values()))
    return {"poses": len(added), "branches": count, "found": count - left}
