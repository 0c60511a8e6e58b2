# SPDX-License-Identifier: BSD-3-Clause
"""A cell: one solver on one arm, asked in every way that it has."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import iksel
from bench.branches import (
    SAME_MOVE,
    compared,
    distinct,
    judged,
    near_of,
    nearest_turns,
)
from bench.check import (
    LIMIT_SLACK,
    POSITION_TOLERANCE,
    ROTATION_TOLERANCE,
    errors,
)
from bench.rivals import ENUMERATORS
from bench.rivals.enumerator import WAYS
from bench.timing import PASSES, least_times, mean_median

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    from bench.arms import Arm
    from bench.chain import Array, Chain
    from bench.rivals.base import Run
    from bench.rivals.enumerator import Enumerator
    from bench.store import Settings
    from bench.targets import Targets


@dataclass(frozen=True)
class Asked:
    """A solver with an arm's targets and a posture beside each, (N, dof)."""

    rival: Enumerator
    chain: Chain
    goals: Targets
    near: Array


class Given(NamedTuple):
    """What a solver gave in one way."""

    times: npt.NDArray[np.int64]
    """Time of each call, (N,) [ns]."""
    right: list[Array]
    """Per target those of its answers that are some, in its order, (n, dof)."""
    wrong: int
    """Answers that are none: off the target, or outside limits that it keeps."""


def asked(arm: Arm, goals: Targets, settings: Settings) -> dict[str, Any]:
    """Times, and what was missed and wrong, of each way."""
    rival = ENUMERATORS[settings["rival"]](arm)
    near = near_of(goals, settings["seed"])
    this = Asked(rival, arm.chain, goals, near)
    ways = [way for way in WAYS if way in rival.requests]
    solver = iksel.Solver(arm.robot)
    if settings["kind"] == "any_rotation":
        return _noes(solver, goals, ask(this, ways[:1], settings["limit_s"])[ways[0]])
    given = ask(this, ways, settings["limit_s"])
    result = {way: _figures(given[way]) for way in ways}
    if "every" in given:
        result["every"] |= _branches(arm, solver, goals, given["every"])
    if "nearest" in given:
        result["nearest"] |= _moves(solver, goals, near, given["nearest"])
    return result


def ask(this: Asked, ways: Sequence[str], limit_s: float) -> dict[str, Given]:
    """Each way a few times in turns; one that does not end in time only once."""

    def ask(way: str) -> Run:
        return this.rival.ask(way, this.goals, this.near, limit_s)

    runs = {way: [ask(way)] for way in ways}
    for _ in range(PASSES - 1):
        for way, done in runs.items():
            if len(done[0].times_ns) == len(this.goals):
                done.append(ask(way))
    given = {}
    for way, done in runs.items():
        times = least_times([run.times_ns for run in done])
        answers = done[0].answers[: len(times)]
        given[way] = Given(times, *judged_answers(this, way, answers))
    return given


def judged_answers(
    this: Asked, way: str, answers: Sequence[Sequence[Array]]
) -> tuple[list[Array], int]:
    """The right ones of each target, and how many are wrong.

    Of a solver without limits, what has no turn inside them is left out.
    """
    chain = this.chain
    middle = np.tile(chain.middle(), (len(this.near), 1))
    beside = this.near if way == "nearest" else middle
    right, wrong = [], 0
    for pose, turn, some in zip(this.goals.poses, beside, answers, strict=False):
        q = np.array(some, dtype=float).reshape(-1, chain.dof)
        position, rotation = errors(chain, np.tile(pose, (len(q), 1, 1)), q)
        # Comparisons with NaN are false.
        good = (position <= POSITION_TOLERANCE) & (rotation <= ROTATION_TOLERANCE)
        if this.rival.keeps_limits:
            good &= chain.within_limits(q, LIMIT_SLACK)
            kept = q[good]
        else:
            kept = nearest_turns(chain, q[good], turn)
            kept = kept[np.isfinite(kept).all(axis=1)]
        wrong += int(np.count_nonzero(~good))
        right.append(kept)
    return right, wrong


def _figures(given: Given) -> dict[str, Any]:
    """Of reachable targets: each without a right answer is missed."""
    return {
        "count": len(given.times),
        "us": mean_median(given.times),
        "missed": sum(not len(q) for q in given.right),
        "wrong": given.wrong,
    }


def _branches(
    arm: Arm, solver: iksel.Solver, goals: Targets, given: Given
) -> dict[str, Any]:
    """How many, and of six joints how the sets differ from IKSel's."""
    found = [distinct(q) for q in given.right]
    result: dict[str, Any] = {"branches": sum(map(len, found))}
    if arm.chain.dof != 6:
        return result
    poses = goals.poses[: len(found)]
    ours = judged(arm.chain, poses, [list(solver.solve_all(p).q) for p in poses])
    sets = compared(ours.right, found)
    # Named from the rival's side.
    return {**result, "lacks": sets["more"], "has_more": sets["fewer"]}


def _moves(
    solver: iksel.Solver, goals: Targets, near: Array, given: Given
) -> dict[str, Any]:
    """How many moves are longer than the least that IKSel and the solver know."""
    longer = 0
    for pose, q, right in zip(goals.poses, near, given.right, strict=False):
        if not len(right):
            continue
        ours = solver.solve(pose, near=q)
        move = float(np.linalg.norm(right[0] - q))
        least = float(np.linalg.norm(ours.q - q)) if ours.success else np.inf
        longer += move > least + SAME_MOVE
    return {"longer": longer}


def _noes(solver: iksel.Solver, goals: Targets, given: Given) -> dict[str, Any]:
    """What targets cost for which neither IKSel nor the solver has an answer."""
    yes = np.array([len(q) > 0 for q in given.right], dtype=bool)
    ours = np.array([solver.solve(p).success for p in goals.poses[: len(yes)]])
    return {
        "count": len(yes),
        "noes": int(np.count_nonzero(~yes & ~ours)),
        "us": mean_median(given.times[~yes & ~ours]),
        "missed": int(np.count_nonzero(~yes & ours)),
        "only": int(np.count_nonzero(yes & ~ours)),
        "wrong": given.wrong,
    }
