# SPDX-License-Identifier: BSD-3-Clause
"""Cells on branches: all of a pose's, and the nearest, beside another's or brute force.

A branch is a solution without its whole turns. Every one that counts is judged by
bench.chain at the tolerances of the solver that is measured, and inside the limits.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import iksel
from bench.check import LIMIT_SLACK, right
from bench.nearby import RIGHT, is_least_nearby
from bench.rivals import RIVALS
from bench.rivals.base import UnsupportedError
from bench.timing import PASSES, least_times, time_calls

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bench.arms import Arm
    from bench.chain import Array, Chain
    from bench.rivals.base import Rival
    from bench.store import Settings
    from bench.targets import Targets

NOISE = 0.3
"""Deviation of `near` from a solution, every joint [rad]."""
SAME_MOVE = 1e-3
"""Moves that differ by less are the same [rad]: near a singularity answers within the
tolerances of the pose are that far apart."""
APART = 0.01
"""Branches differ by at least this in some joint [rad]: `min_distance`."""
TOLERANCE = 1e-6
"""Of the default preset [m, rad]."""
ROUNDING = 1e-9
"""By which two ways to compute an error may differ [m, rad]."""
RESTARTS = 1_000
"""Random restarts that a branch count is compared with."""
LIMIT_S = 300.0
"""No further call is timed after this [s]."""
SHOWN = 50
"""Differences kept by the number of their target."""
TURN = 2.0 * np.pi


def near_of(goals: Targets, seed: int) -> Array:
    """A solution of each pose with normal noise on every joint, (N, dof) [rad].

    Where no solution is known, any configuration inside the limits.
    """
    noise = np.random.default_rng(seed).normal(0.0, NOISE, goals.witnesses.shape)
    known = np.isfinite(goals.witnesses)
    return np.where(known, goals.witnesses + noise, goals.starts)


def nearest_turns(chain: Chain, q: Array, near: Array) -> Array:
    """Each row of q, (n, dof), at the whole turns nearest to `near` inside the limits.

    Returns:
        Rows in the same order, (n, dof); NaN where there is none inside the limits.
    """
    turning = ~chain.prismatic
    least = np.ceil((chain.lower - LIMIT_SLACK - q) / TURN)
    most = np.floor((chain.upper + LIMIT_SLACK - q) / TURN)
    turns = np.clip(np.round((near - q) / TURN), least, most)
    turned = np.where(turning, q + TURN * turns, q)
    turned[(turning & (least > most)).any(axis=1)] = np.nan
    return np.asarray(turned)


def gap(a: Array, b: Array) -> Array:
    """Largest joint difference without whole turns, (n, dof), (m, dof) -> (n, m)."""
    difference = a[:, None, :] - b[None, :, :]
    difference -= TURN * np.round(difference / TURN)
    return np.asarray(np.abs(difference).max(axis=2))


def distinct(q: Array) -> Array:
    """One of each group of rows that lie nearer than APART, (n, dof) -> (m, dof)."""
    kept: list[Array] = []
    rest = q
    while len(rest):
        kept.append(rest[0])
        rest = rest[gap(rest[:1], rest)[0] >= APART]
    return np.array(kept).reshape(-1, q.shape[1])


class Branches(NamedTuple):
    """What a solver gave as the branches of many poses."""

    right: list[Array]
    """Per pose those that are solutions, at a turn inside the limits, (n, dof)."""
    wrong: int
    """Others, which are none."""


def judged(chain: Chain, poses: Array, given: Sequence[Sequence[Array]]) -> Branches:
    """The branches of each pose, judged at the tolerances of the default preset."""
    counts = [len(q) for q in given]
    flat = np.array([q for some in given for q in some], dtype=float)
    flat = flat.reshape(-1, chain.dof)
    owner = np.repeat(np.arange(len(given)), counts)
    turned = nearest_turns(chain, flat, chain.middle())
    tolerance = TOLERANCE + ROUNDING
    good = right(chain, poses[owner], turned, tolerance, tolerance)
    ends = np.cumsum(counts)[:-1]
    return Branches(
        [
            q[kept]
            for q, kept in zip(
                np.split(turned, ends), np.split(good, ends), strict=True
            )
        ],
        int(np.count_nonzero(~good)),
    )


def without(some: Array, others: Array) -> Array:
    """The rows of `some` that no row of `others` is the same branch as."""
    if not len(some) or not len(others):
        return some
    # Two that lie APART or nearer may be one to either.
    return np.asarray(some[gap(some, others).min(axis=1) >= 2 * APART])


def _analytic(arm: Arm, settings: Settings) -> Rival | None:
    """The solver that is to be compared with, if it can be had for the arm."""
    name = settings.get("beside")
    if name is None:
        return None
    try:
        RIVALS[name].version()
        return RIVALS[name](arm)
    except UnsupportedError:
        return None


def all_branches(arm: Arm, goals: Targets, settings: Settings) -> dict[str, Any]:
    """The set of solve_all, and how long it takes; beside an analytic solver's."""
    rival = _analytic(arm, settings)
    solver = iksel.Solver(arm.robot)
    poses = [(pose,) for pose in goals.poses]
    ours, theirs = [], []
    # In turns: what the machine does meanwhile is then in both.
    for _ in range(PASSES):
        ours.append(time_calls(solver.solve_all, poses, LIMIT_S))
        if rival is not None:
            theirs.append(rival.run(goals))
    times = least_times([run[0] for run in ours])
    done = goals.first(len(times))
    found = judged(arm.chain, done.poses, [list(run.q) for run in ours[0][1]])
    result = {
        "count": len(done),
        "wrong": found.wrong,
        "branches": sum(map(len, found.right)),
        "mean_us": float(times.mean()) / 1e3,
        "p99_us": float(np.quantile(times, 0.99)) / 1e3,
    }
    if rival is None:
        return result
    given = judged(arm.chain, goals.poses, theirs[0].answers)
    rival_times = least_times([run.times_ns for run in theirs])
    return {
        **result,
        **compared(found.right, given.right),
        "rival_mean_us": float(rival_times.mean()) / 1e3,
    }


def compared(ours: Sequence[Array], theirs: Sequence[Array]) -> dict[str, Any]:
    """Poses whose sets are the same, and those where either has one more."""
    sets = list(zip(ours, theirs, strict=True))
    fewer = [i for i, (us, them) in enumerate(sets) if len(without(them, us))]
    more = [i for i, (us, them) in enumerate(sets) if len(without(us, them))]
    return {
        "same": len(sets) - len({*fewer, *more}),
        "fewer": len(fewer),
        "more": len(more),
        "missed": fewer[:SHOWN],
        "added": more[:SHOWN],
    }


def near_branches(arm: Arm, goals: Targets, settings: Settings) -> dict[str, Any]:
    """How often `near` finds the nearest of all branches that anything else finds.

    These are those of solve_all, and of an analytic solver if one is given, with all
    their whole turns inside the limits.
    """
    chain = arm.chain
    near = near_of(goals, settings["seed"])
    solver = iksel.Solver(arm.robot)
    asked = list(zip(goals.poses, near, strict=True))

    def solve(pose: Array, q: Array) -> iksel.Result:
        return solver.solve(pose, near=q)

    runs = [time_calls(solve, asked, LIMIT_S) for _ in range(PASSES)]
    times, results = least_times([run[0] for run in runs]), runs[0][1]
    given = [list(solver.solve_all(pose).q) for pose in goals.poses]
    rival = _analytic(arm, settings)
    if rival is not None:
        theirs = rival.run(goals).answers
        given = [ours + more for ours, more in zip(given, theirs, strict=True)]
    truth = judged(chain, goals.poses, given).right
    answers = [[result.q] if result.success else [] for result in results]
    found = judged(chain, goals.poses, answers)
    excess = np.array(
        [
            _excess(chain, result, q, branches)
            for result, q, branches in zip(results, near, truth, strict=True)
        ]
    )
    solvable = np.array([len(branches) > 0 for branches in truth])
    longer = [int(i) for i in np.flatnonzero(excess > SAME_MOVE)]
    redundant = [i for i in longer if results[i].success and chain.dof > RIGHT]
    return {
        "count": len(goals),
        "solvable": int(solvable.sum()),
        "solved": sum(map(len, found.right)),
        "wrong": found.wrong,
        "smallest": int(np.count_nonzero(excess[solvable] <= SAME_MOVE)),
        "shorter": int(np.count_nonzero(excess < -SAME_MOVE)),
        "mean_us": float(times.mean()) / 1e3,
        "p99_us": float(np.quantile(times, 0.99)) / 1e3,
        "missed": longer[:SHOWN],
        # What keeps a redundant arm's move from being the least: another valley.
        "looked_around": len(redundant[:SHOWN]),
        "least_nearby": sum(
            is_least_nearby(arm, goals.poses[i], near[i], results[i].q)
            for i in redundant[:SHOWN]
        ),
    }


def _excess(chain: Chain, result: iksel.Result, near: Array, branches: Array) -> float:
    """By how much an answer's move is more than the least; 0 where both find none."""
    if not len(branches):
        return -np.inf if result.success else 0.0
    if not result.success:
        return np.inf
    moves = np.linalg.norm(nearest_turns(chain, branches, near) - near, axis=1)
    return float(np.linalg.norm(result.q - near) - moves.min())


def branches_by_restarts(
    solver: iksel.Solver, pose: Array, count: int, seed: int
) -> Array:
    """Those that the iteration alone finds from so many random seeds, (n, dof)."""
    answers = (
        solver.solve(pose, seeds=q[None], database_seeds=False)
        for q in solver.robot.random_configurations(count, seed)
    )
    q = np.array([answer.q for answer in answers if answer.success])
    return distinct(q.reshape(-1, solver.robot.dof))
