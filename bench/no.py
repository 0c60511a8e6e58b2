# SPDX-License-Identifier: BSD-3-Clause
"""A cell on yes and no: what each costs a solver, and how many are right.

Of two kinds of targets (bench.targets): `uniform`, which can all be reached, and
`any_rotation`, reachable positions with rotations at random, of which many cannot.
"""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.arms import load_arm
from bench.branches import ROUNDING, TOLERANCE, nearest_turns
from bench.check import judge, right
from bench.rivals import RIVALS
from bench.timing import least_times, mean_median, time_calls

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    from bench.arms import Arm
    from bench.chain import Array, Chain
    from bench.rivals.base import Rival
    from bench.store import Settings
    from bench.targets import Targets

PASSES = 3
"""Runs of a solver through all targets; of each the least time counts."""
NO_LIMIT_S = 2.0
"""No call that asks for a proof is begun after this time of a pass [s]."""
SHORT_S = 1.0
"""A solver whose first run takes longer gets no second one [s]."""
UNIT_RUNS = 20
"""Runs for the least time of one KDL FK + Jacobian."""


def answered(arm: Arm, goals: Targets, settings: Settings) -> dict[str, Any]:
    """A solver's yes and no, judged beside IKSel's and the known solutions."""
    rival = RIVALS[settings["rival"]](arm)
    times, given = _run(rival, goals)
    goals = goals.first(len(times))
    claims = given if rival.keeps_limits else [_inside(arm.chain, q) for q in given]
    verdict = judge(arm.chain, goals.poses, claims)
    solver = iksel.Solver(arm.robot)
    ours = [solver.solve(pose, prove=True) for pose in goals.poses]
    solved = _solved(arm.chain, goals, ours)
    known = np.isfinite(goals.witnesses).all(axis=1)
    # At the tolerances of the default preset: what is right to the judge alone would be
    # no answer of IKSel's.
    exact = _exact(arm.chain, goals.poses, claims)
    proven = np.array([result.proven for result in ours], dtype=bool)
    result = {
        "count": len(goals),
        "yes": int(verdict.right.sum()),
        "false": verdict.false_claims,
        "missed": int(np.count_nonzero(~verdict.right & (solved | known))),
        "only": int(np.count_nonzero(exact & ~solved)),
        # Proofs that this solver's answers could have refuted, and those that they did.
        "proofs": int(np.count_nonzero(proven)),
        "disproved": int(np.count_nonzero(proven & (exact | known))),
        "yes_us": mean_median(times[verdict.claimed]),
        "no_us": mean_median(times[~verdict.claimed]),
    }
    if settings["rival"] == "IKSel":
        result |= _proofs(arm, ours) | {"unit_us": _unit(arm.name)}
        noes = [
            pose for pose, given in zip(goals.poses, ours, strict=True) if not given
        ]
        result["proven_us"] = mean_median(_time_proofs(solver, noes))
        result["proven_unasked"] = sum(solver.solve(pose).proven for pose in noes)
    return result


def _run(
    rival: Rival, goals: Targets
) -> tuple[npt.NDArray[np.int64], list[list[Array]]]:
    """Times and answers; the least times of a few runs where those are short."""
    run = rival.run(goals)
    runs = [run]
    if run.times_ns.sum() < SHORT_S * 1e9:
        runs += [rival.run(goals) for _ in range(PASSES - 1)]
    times = least_times([again.times_ns for again in runs])
    return times, run.answers[: len(times)]


def _inside(chain: Chain, branches: Sequence[Array]) -> list[Array]:
    """Those that lie inside the limits at some whole turns."""
    if not branches:
        return []
    turned = nearest_turns(chain, np.array(branches), chain.middle())
    return list(turned[np.isfinite(turned).all(axis=1)])


def _time_proofs(solver: iksel.Solver, noes: list[Array]) -> npt.NDArray[np.int64]:
    """Least times of calls that ask for a proof [ns]."""
    prove = functools.partial(solver.solve, prove=True)
    calls = [(pose,) for pose in noes]
    return least_times([time_calls(prove, calls, NO_LIMIT_S)[0] for _ in range(PASSES)])


def _exact(
    chain: Chain, poses: Array, claims: Sequence[Sequence[Array]]
) -> npt.NDArray[np.bool_]:
    tolerance = TOLERANCE + ROUNDING
    owner = np.repeat(np.arange(len(claims)), [len(q) for q in claims])
    flat = np.array([q for some in claims for q in some], dtype=float)
    flat = flat.reshape(-1, chain.dof)
    good = right(chain, poses[owner], flat, tolerance, tolerance, slack=0.0)
    result = np.zeros(len(claims), dtype=bool)
    np.logical_or.at(result, owner, good)
    return result


def _solved(
    chain: Chain, goals: Targets, results: Sequence[iksel.Result]
) -> npt.NDArray[np.bool_]:
    """Where an answer of IKSel's is one."""
    claims = [[result.q] if result.success else [] for result in results]
    return judge(chain, goals.poses, claims).right


def _proofs(arm: Arm, results: Sequence[iksel.Result]) -> dict[str, Any]:
    """How certain each no is."""
    noes = [result for result in results if not result.success]
    swept = sum(result.proof == iksel.Proof.sweep for result in noes)
    proven = sum(result.proven for result in noes)
    return {
        "structure": arm.robot.structure.kind.name,
        "proven": proven,
        "swept": swept,
        "searched": len(noes) - proven - swept,
        "most_iterations": max(result.iterations for result in results),
    }


@functools.cache
def _unit(robot: str) -> float:
    """The least of a few: other work only adds to it, and makes no ratio smaller."""
    model = load_arm(robot).robot
    return min(iksel.time_kdl_fk_jacobian(model) for _ in range(UNIT_RUNS))
