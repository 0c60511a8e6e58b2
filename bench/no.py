# SPDX-License-Identifier: BSD-3-Clause
"""What a no costs, beside a yes, and how many of them are proven.

Two kinds of targets per robot (bench.targets): `uniform`, which can all be reached, and
`any_rotation`, reachable positions with rotations at random, of which many cannot.
Times are of calls from Python in one thread.
"""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.arms import load_arm
from bench.check import right
from bench.machine import cpu_name
from bench.markdown import NONE, microseconds, table
from bench.requests import LIMIT_S
from bench.targets import make_targets
from bench.timing import time_calls

if TYPE_CHECKING:
    from collections.abc import Sequence

ROBOTS = (
    "ur3",
    "ur10e",
    "irb120",
    "vs060",
    "cvr038",
    "panda",
    "iiwa14",
    "xarm7",
    "baxter_right",
)
"""Of every structure some."""
KINDS = ("uniform", "any_rotation")
HEADER = (
    "robot",
    "structure",
    "targets",
    "solved",
    "no: proven",
    "by sweep",
    "searched",
    "most steps",
    "yes",
    "no",
    "solve_all",
    "near",
    "unit",
)


def no(robots: Sequence[str], count: int, seed: int) -> int:
    """Print a table; the exit status is 1 if an answer or a proof is wrong."""
    rows = [measure(name, kind, count, seed) for name in robots for kind in KINDS]
    sys.stdout.write(
        f"{count:,} targets of each kind, seed {seed}; tolerances 1e-6 m and 1e-6 rad; "
        f"one thread, from Python; SIMD {iksel.simd_level()}, {cpu_name()} "
        f"({os.cpu_count()} cores). Times [us]: mean, median (mean in units); a unit "
        "is one KDL FK + Jacobian.\n\n"
    )
    sys.stdout.write(table(HEADER, map(_shown, rows)) + "\n")
    wrong = [row for row in rows if row["wrong"]]
    for row in wrong:
        sys.stdout.write(f"{row['robot']}, {row['kind']}: {row['wrong']} are wrong\n")
    return 1 if wrong else 0


def measure(name: str, kind: str, count: int, seed: int) -> dict[str, Any]:
    """A robot's figures on targets of one kind; times [us]."""
    arm = load_arm(name)
    goals = make_targets(arm, kind, count, seed)
    solver = iksel.Solver(arm.robot)
    poses = [(pose,) for pose in goals.poses]
    times, results = time_calls(solver.solve, poses, LIMIT_S)
    goals = goals.first(len(results))
    near = list(zip(goals.poses, goals.starts, strict=True))
    solved = np.array([result.success for result in results])
    proven = np.array([result.proven for result in results])
    swept = np.array([result.proof == iksel.Proof.sweep for result in results])
    # An answer that is none, and a proof against a target made by joint values.
    wrong = proven & np.isfinite(goals.witnesses).all(axis=1)
    answers = np.array([r.q for r in results if r.success]).reshape(-1, arm.chain.dof)
    wrong[solved] |= ~right(arm.chain, goals.poses[solved], answers)
    return {
        "robot": name,
        "kind": kind,
        "structure": str(arm.robot.structure.kind),
        "targets": len(results),
        "solved": int(solved.sum()),
        "proven": int(proven.sum()),
        "swept": int(swept.sum()),
        "searched": int((~solved & ~proven & ~swept).sum()),
        "wrong": int(wrong.sum()),
        "most_iterations": max(result.iterations for result in results),
        "yes": _mean_median(times[solved]),
        "no": _mean_median(times[~solved]),
        "solve_all": _mean_median(time_calls(solver.solve_all, poses, LIMIT_S)[0]),
        "near": _mean_median(
            time_calls(lambda pose, q: solver.solve(pose, near=q), near, LIMIT_S)[0]
        ),
        "unit": _unit(solver, seed),
    }


def _unit(solver: iksel.Solver, seed: int) -> float:
    """The least of a few: other work only adds to it, and makes no ratio smaller."""
    return min(iksel.evaluate(solver, 1_000, seed).kdl_fk_jac_us for _ in range(20))


def _mean_median(times_ns: np.ndarray) -> tuple[float, float] | None:
    if len(times_ns) == 0:
        return None
    return float(times_ns.mean()) / 1e3, float(np.median(times_ns)) / 1e3


def _shown(row: dict[str, Any]) -> list[str]:
    def time(what: str) -> str:
        if row[what] is None:
            return NONE
        mean, median = map(microseconds, row[what])
        return f"{mean}, {median} ({row[what][0] / row['unit']:.1f})"

    counts = ("solved", "proven", "swept", "searched", "most_iterations")
    return [
        row["robot"],
        row["structure"],
        row["kind"],
        *(f"{row[what]:,}" for what in counts),
        *(time(what) for what in ("yes", "no", "solve_all", "near")),
        microseconds(row["unit"]),
    ]
