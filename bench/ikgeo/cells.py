# SPDX-License-Identifier: BSD-3-Clause
"""Cells on IK-Geo: the paper's search, the package, and all solutions beside them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.check import errors, judge
from bench.ikgeo.search import Search
from bench.rivals.ikgeo import PANIC, IkGeo
from bench.seed_makers import from_seeds, paper_solver
from bench.timing import summary, time_calls

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    from bench.arms import Arm
    from bench.chain import Array
    from bench.store import Settings
    from bench.targets import Targets

    Times = npt.NDArray[np.int64]

LIMIT_S = 5.0
"""No further call is timed after this [s]: a search may take a tenth of a second."""
MANY = 64
"""Candidates that are iterated from at most, one after another until one arrives."""


def searched(arm: Arm, goals: Targets, settings: Settings) -> dict[str, Any]:
    """The search over joint 4: what it finds, how far off, and as seeds."""
    search = Search(arm, settings["values"], settings["between"])
    poses = [(pose,) for pose in goals.poses]
    times, found = time_calls(search, poses, LIMIT_S)
    return {**_direct(arm, goals, times, found), **_as_seeds(arm, goals, times, found)}


def packaged(arm: Arm, goals: Targets, settings: Settings) -> dict[str, Any]:
    """The package from PyPI: what it returned, and its branches as seeds."""
    package = IkGeo(arm, settings["family"])
    asked = [
        package.prepare(*each) for each in zip(goals.poses, goals.starts, strict=True)
    ]
    times, returned = time_calls(package.call, asked, LIMIT_S)
    # Its branches are given without regard to limits.
    branches = [np.array(package.answers(value)) for value in returned]
    found = [q[arm.chain.within_limits(q)] if len(q) else q for q in branches]
    return {
        "panics": sum(value is PANIC for value in returned),
        "empty": sum(value is not PANIC and len(value) == 0 for value in returned),
        "least_squares": sum(
            value is not PANIC and len(value) > 0 and len(q) == 0
            for value, q in zip(returned, branches, strict=True)
        ),
        **_direct(arm, goals, times, found),
        **_as_seeds(arm, goals, times, found),
    }


def enumerated(arm: Arm, goals: Targets, settings: Settings) -> dict[str, Any]:
    """All solutions by solve_all with the default options."""
    del settings
    solver = iksel.Solver(arm.robot)
    poses = [(pose,) for pose in goals.poses]
    times, solutions = time_calls(solver.solve_all, poses, LIMIT_S)
    found = [np.array(each.q) for each in solutions]
    kind = arm.robot.structure.kind.name
    return {"structure": kind, **_direct(arm, goals, times, found)}


def _direct(
    arm: Arm, goals: Targets, times: Times, found: Sequence[Array]
) -> dict[str, Any]:
    """What configurations inside the limits are worth as they are."""
    done = len(found)
    counts = [len(q) for q in found]
    owner = np.repeat(np.arange(done), counts)
    q = np.array([each for some in found for each in some])
    position, rotation = errors(
        arm.chain, goals.poses[owner], q.reshape(-1, arm.chain.dof)
    )
    verdict = judge(arm.chain, goals.poses[:done], [list(some) for some in found])
    return {
        "count": done,
        "direct": int(np.count_nonzero(counts)),
        "candidates": len(owner),
        "right": int(verdict.right.sum()),
        "position_mm": _spread(1e3 * position),
        "rotation_deg": _spread(np.degrees(rotation)),
        **summary(times),
    }


def _spread(values: Array) -> dict[str, float] | None:
    """As in the paper's table; None of nothing."""
    if not len(values):
        return None
    low, high = np.quantile(values, [0.25, 0.75])
    return {
        "mean": float(values.mean()),
        "std": float(values.std()),
        "min": float(values.min()),
        "q1": float(low),
        "q3": float(high),
        "max": float(values.max()),
    }


def _as_seeds(
    arm: Arm, goals: Targets, times: Times, found: Sequence[Array]
) -> dict[str, Any]:
    """Success of the paper's iteration from them, and the time of both together."""
    seeded = from_seeds(paper_solver(arm, MANY), arm, goals.poses, found)
    return {
        "seeded": int(seeded.right.sum()),
        "seeded_mean_us": float((times + seeded.times_ns).mean()) / 1e3,
    }
