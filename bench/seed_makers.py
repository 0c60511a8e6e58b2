# SPDX-License-Identifier: BSD-3-Clause
"""Everything that makes seeds, and what the first of them is worth.

A maker is made for an arm and gives for a pose T_base_tip, (4, 4), its seeds, best
first, (n, dof); none where it has none. The first is iterated from once, as the paper
iterates, and nothing follows. What selects from a database does so inside the solver.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import iksel
from bench.check import right
from bench.ikgeo.search import Search
from bench.timing import time_calls

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    from bench.arms import Arm
    from bench.chain import Array
    from bench.store import Settings
    from bench.targets import Targets

SeedMaker = Callable[["Array"], "Array"]

LIMIT_S = 120.0
"""No further call is timed after this [s]."""


@dataclass(frozen=True)
class Maker:
    """One that is asked outside the solver."""

    language: str
    """What it is written in."""
    make: Callable[[Arm], SeedMaker]
    """Raises UnsupportedError where it cannot be had for an arm."""


@dataclass(frozen=True)
class Selection:
    """One that the solver asks itself: database and rank."""

    database: iksel.DatabaseOptions
    strategy: dict[str, Any]
    """Changes to the paper's strategy."""
    language: str = "C++"


@dataclass(frozen=True)
class Learned:
    """A trained model: what its own section measures has the same targets."""

    model: str
    output: str
    """Which of its outputs: "first" or "best"."""
    language: str = "JAX"


def _uniform(arm: Arm) -> SeedMaker:
    random = np.random.default_rng(0)
    lower, upper = arm.robot.lower, arm.robot.upper

    def make(pose: Array) -> Array:
        del pose
        return random.uniform(lower, upper)[None]

    return make


PAPER = iksel.DatabaseOptions.paper()
REDUCED = iksel.DatabaseOptions()
AWARE = {"limit_aware": True, "rotation_difference": "geodesic"}
"""As the default preset ranks: what would leave the limits comes last."""

MAKERS: dict[str, Maker | Selection | Learned] = {
    "random": Maker("numpy", _uniform),
    "paper's database, nearest, Eq. (2)": Selection(PAPER, {"ranking": "nearest"}),
    "paper's database, Eq. (5)": Selection(PAPER, {}),
    "paper's database, Eq. (5), limits": Selection(PAPER, AWARE),
    "reduced database, Eq. (5)": Selection(REDUCED, {}),
    "reduced database, Eq. (5), limits": Selection(REDUCED, AWARE),
    "IK-Geo, 36 values of q4": Maker("numpy", lambda arm: Search(arm, 36, "lower end")),
    "MDN": Learned("mdn", "first"),
    "flow, first": Learned("flow", "first"),
    "flow, best of 32": Learned("flow", "best"),
    "diffusion, first": Learned("diffusion", "first"),
    "diffusion, best of 32": Learned("diffusion", "best"),
}
"""All of them by name, in the order of the table."""


def paper_solver(arm: Arm, attempts: int) -> iksel.Solver:
    """The paper's iteration from so many given seeds, in the order of Eq. (5)."""
    strategy = iksel.Paper(reselection="none" if attempts == 1 else "next")
    options = iksel.SolverOptions.paper().replace(
        strategy=strategy, max_attempts=attempts
    )
    return iksel.Solver(arm.robot, options)


class Attempts(NamedTuple):
    """What came of iterating, for N poses."""

    right: npt.NDArray[np.bool_]
    """Answers within the solver's tolerances and the limits, by bench.check, (N,)."""
    attempts: npt.NDArray[np.int64]
    """Seeds that were iterated from, (N,)."""
    iterations: npt.NDArray[np.int64]
    """Steps of all of them together, (N,)."""
    times_ns: npt.NDArray[np.int64]
    """(N,) [ns]; 0 where there was no seed."""


def from_seeds(
    solver: iksel.Solver, arm: Arm, poses: Array, seeds: Sequence[Array]
) -> Attempts:
    """Iterate from given seeds, (n, dof) for each of the first poses, and no others."""

    def solve(pose: Array, q: Array) -> iksel.Result:
        return solver.solve(pose, seeds=q, database_seeds=False)

    has = np.array([len(q) > 0 for q in seeds], dtype=bool)
    asked = [(pose, q) for pose, q in zip(poses, seeds, strict=False) if len(q) > 0]
    times, results = time_calls(solve, asked, LIMIT_S)
    every = np.zeros(len(seeds), dtype=np.int64)
    every[has] = times
    return _judged(solver, arm, poses, has, results)._replace(times_ns=every)


def _judged(
    solver: iksel.Solver,
    arm: Arm,
    poses: Array,
    has: npt.NDArray[np.bool_],
    results: Sequence[iksel.Result],
) -> Attempts:
    """Results for those poses that were asked for; the others failed."""
    q = np.full((len(has), arm.chain.dof), np.nan)
    attempts, iterations = np.zeros((2, len(has)), dtype=np.int64)
    for i, result in zip(np.flatnonzero(has), results, strict=True):
        attempts[i], iterations[i] = result.attempts, result.iterations
        if result.success:
            q[i] = result.q
    tolerances = solver.options.position_tolerance, solver.options.rotation_tolerance
    good = right(arm.chain, poses[: len(has)], q, *tolerances)
    return Attempts(good, attempts, iterations, np.zeros(len(has), dtype=np.int64))


def first_attempt(arm: Arm, goals: Targets, settings: Settings) -> dict[str, Any]:
    """One attempt from the first seed of a maker.

    Raises:
        UnsupportedError: There is no such maker for the arm.
        RuntimeError: More than one seed was iterated from.
    """
    maker = MAKERS[settings["maker"]]
    measure = _inside if isinstance(maker, Selection) else _outside
    result = measure(maker, arm, goals)  # type: ignore[arg-type]
    attempts: Attempts = result.pop("attempts")
    if attempts.attempts.max() > 1:
        raise RuntimeError(f"{attempts.attempts.max()} attempts from one seed")
    made = attempts.attempts > 0
    return {
        **result,
        "count": len(made),
        "without_seed": int(np.count_nonzero(~made)),
        "iterations": float(attempts.iterations[made].mean()) if made.any() else 0.0,
        "right": int(attempts.right.sum()),
    }


def _outside(maker: Maker, arm: Arm, goals: Targets) -> dict[str, Any]:
    make = maker.make(arm)
    times, seeds = time_calls(make, [(pose,) for pose in goals.poses], LIMIT_S)
    first = [q[:1] for q in seeds]
    return {
        "attempts": from_seeds(paper_solver(arm, 1), arm, goals.poses, first),
        "seeds": float(np.mean([len(q) for q in seeds])),
        "seeds_us": float(times.mean()) / 1e3,
    }


def _inside(selection: Selection, arm: Arm, goals: Targets) -> dict[str, Any]:
    """Times are of the stages before the iteration, by iksel.evaluate."""
    strategy = iksel.Paper(reselection="none", **selection.strategy)
    options = iksel.SolverOptions.paper().replace(
        database=selection.database, strategy=strategy, max_attempts=1
    )
    solver = iksel.Solver(arm.robot, options)
    results = [solver.solve(pose) for pose in goals.poses]
    stages = iksel.evaluate(solver, len(goals), goals.seed, stages=True)
    every = np.ones(len(goals), dtype=bool)
    return {
        "attempts": _judged(solver, arm, goals.poses, every, results),
        "seeds": float(strategy.neighbours),
        "seeds_us": stages.query_us + stages.rank_us,
        "samples": len(solver.database),
    }
