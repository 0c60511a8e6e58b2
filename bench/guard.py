# SPDX-License-Identifier: BSD-3-Clause
"""Fails when IKSel has become slower or solves less than bench/guard.json says.

Speed is compared by `ratio`, mean time of a call over one KDL forward kinematics plus
Jacobian in the same run, which moves little between machines. A shared machine still
disturbs it, so the least of a few runs counts, and the margin is wide: this is to catch
the loss of a kernel, not of a percent.
"""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.arms import load_arm
from bench.branches import LIMIT_S, near_of
from bench.check import right
from bench.machine import facts
from bench.markdown import table
from bench.settings import solver_options
from bench.store import write_json
from bench.targets import make_targets
from bench.timing import time_calls

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable

    from bench.arms import Arm
    from bench.targets import Targets

PATH = Path(__file__).with_name("guard.json")

RUNS = 3
"""Runs for the least ratio; a row that fails gets as many again."""
UPDATE_RUNS = 9
"""Runs for the middle ratio, which is committed."""
SLOWER = 1.6
"""A ratio may be this many times the committed one."""
SEED = 1

PRESETS = ("default", "paper")
"""What solve is run by; the rest are other calls."""
ROWS: tuple[dict[str, Any], ...] = (
    {"robot": "ur3", "what": "default", "targets": 20_000, "points": 0.02},
    {"robot": "panda", "what": "default", "targets": 20_000, "points": 0.02},
    {"robot": "cvr038", "what": "default", "targets": 20_000, "points": 0.02},
    {
        "robot": "valkyrie_waist_right_arm",
        "what": "default",
        "targets": 10_000,
        "points": 0.05,
    },
    {"robot": "ur3_wrs", "what": "paper", "targets": 1_000, "points": 0.5},
    {"robot": "cvr038", "what": "paper", "targets": 1_000, "points": 0.5},
    {"robot": "ur3", "what": "solve_all", "targets": 2_000, "points": 0.5},
    {"robot": "ur3", "what": "near", "targets": 2_000, "points": 0.1},
    {"robot": "panda", "what": "near", "targets": 500, "points": 0.1},
    # Of each class one: closed form, two of the swept ones, searched.
    {"robot": "ur3", "what": "no", "targets": 5_000, "points": 0.05},
    {"robot": "cvr038", "what": "no", "targets": 1_000, "points": 0.2},
    {"robot": "panda", "what": "no", "targets": 1_000, "points": 0.2},
    {"robot": "irb14050", "what": "no", "targets": 300, "points": 0.4},
)
"""What is run: solve by a preset, or another call by the default one; of `no` only the
poses that have no answer are timed. `points` is how far `per_100` may fall. The same
targets every time, so only the code and the last bits of the arithmetic can move it."""

LEVELS = ("scalar", "sse2", "neon", "avx2", "avx512")
"""Instruction sets; the committed ratios are of one of them."""


def add(commands: Any) -> None:
    """The command `guard`."""
    command = commands.add_parser(
        "guard",
        help="compare speed and success with bench/guard.json",
        description=__doc__,
    )
    command.add_argument(
        "--update", action="store_true", help="write bench/guard.json instead"
    )


def run(args: argparse.Namespace) -> int:
    """Compare, or write what to compare with; the exit status."""
    if args.update:
        rows = [_measured(row) for row in ROWS]
        write_json(PATH, {"machine": facts(), "rows": rows}, indent=1)
        sys.stdout.write(f"wrote {PATH}\n")
        return 0
    committed = json.loads(PATH.read_text(encoding="utf-8"))
    level = iksel.simd_level()
    comparable = _as_wide(level, committed["machine"]["simd"])
    lines, failed = [], []
    for row, before in zip(ROWS, committed["rows"], strict=True):
        now = _measured(row, SLOWER * before["ratio"] if comparable else math.inf)
        name = f"{row['robot']}, {row['what']}"
        reasons = _reasons(row, before, now, comparable=comparable)
        failed += [f"{name}: {reason}" for reason in reasons]
        lines.append(
            [
                name,
                f"{now['ratio']:.2f}",
                f"{before['ratio']:.2f}",
                f"{now['per_100']:.3f}",
                f"{before['per_100']:.3f}",
                "FAILED" if reasons else "ok",
            ]
        )
    header = ["guard", "ratio", "committed", "of 100", "committed", ""]
    sys.stdout.write(table(header, lines) + "\n")
    if not comparable:
        sys.stdout.write(f"ratios not compared: lanes here are {level}\n")
    for reason in failed:
        sys.stdout.write(f"guard: {reason}\n")
    return 1 if failed else 0


def _as_wide(level: str, committed: str) -> bool:
    """Whether lanes are no narrower than those that the committed ratios are of."""
    return LEVELS.index(level) >= LEVELS.index(committed)


def _reasons(
    row: dict[str, Any],
    before: dict[str, Any],
    now: dict[str, Any],
    *,
    comparable: bool,
) -> list[str]:
    reasons = []
    if before["robot"] != row["robot"] or before["what"] != row["what"]:
        return [
            "bench/guard.json has another row here; run python -m bench guard --update"
        ]
    if now["false_success"]:
        reasons.append(f"{now['false_success']} false successes")
    if now["per_100"] < before["per_100"] - row["points"]:
        reasons.append(
            f"{now['per_100']:.3f} of 100, committed {before['per_100']:.3f}, "
            f"margin {row['points']}"
        )
    if comparable and now["ratio"] > SLOWER * before["ratio"]:
        reasons.append(
            f"ratio {now['ratio']:.2f}, committed {before['ratio']:.2f}, margin "
            f"{SLOWER} times"
        )
    return reasons


def _measured(row: dict[str, Any], limit: float | None = None) -> dict[str, Any]:
    """A row's figures; `per_100` targets are solved, or that many solutions found.

    With a limit the least ratio of RUNS runs, of twice as many if it is above the
    limit; without, the middle one of UPDATE_RUNS.
    """
    measure = _solve(row) if row["what"] in PRESETS else _request(row)
    runs = [measure() for _ in range(UPDATE_RUNS if limit is None else RUNS)]
    ratios = sorted(run["ratio"] for run in runs)
    if limit is not None and ratios[0] > limit:
        runs += [measure() for _ in range(RUNS)]
        ratios = sorted(run["ratio"] for run in runs)
    return {
        "robot": row["robot"],
        "what": row["what"],
        # To compare with: the middle one, for noise makes some too small as well.
        "ratio": round(ratios[len(ratios) // 2] if limit is None else ratios[0], 3),
        "per_100": round(runs[0]["per_100"], 4),
        "false_success": max(run["false_success"] for run in runs),
    }


def _solve(row: dict[str, Any]) -> Callable[[], dict[str, Any]]:
    """One run of solve by a preset; the solver is made once."""
    robot = iksel.load_robot(row["robot"])
    solver = iksel.Solver(robot, solver_options(row["what"], {}))

    def measure() -> dict[str, Any]:
        run = iksel.evaluate(solver, row["targets"], SEED)
        return {
            "ratio": run.ratio,
            "per_100": run.success_percent,
            "false_success": run.false_success,
        }

    return measure


def _request(row: dict[str, Any]) -> Callable[[], dict[str, Any]]:
    """One run of another call; the solver and its targets are made once."""
    arm = load_arm(row["robot"])
    kind = "any_rotation" if row["what"] == "no" else "uniform"
    goals = make_targets(arm, kind, row["targets"], SEED)
    solver = iksel.Solver(arm.robot)
    arguments: list[tuple[Any, ...]] = [(pose,) for pose in goals.poses]
    call: Callable[..., Any] = solver.solve
    if row["what"] == "near":
        arguments = list(zip(goals.poses, near_of(goals, SEED), strict=True))

        def call(pose: Any, near: Any) -> iksel.Result:
            return solver.solve(pose, near=near)

    elif row["what"] == "solve_all":
        call = solver.solve_all

    def measure() -> dict[str, Any]:
        times, answers = time_calls(call, arguments, LIMIT_S)
        found = [list(np.atleast_2d(a.q)) if a else [] for a in answers]
        if row["what"] == "no":
            times = times[[not a for a in answers]]
        kdl_us = iksel.evaluate(solver, 1_000, SEED).kdl_fk_jac_us
        return {
            "ratio": float(times.mean()) / 1e3 / kdl_us,
            "per_100": 100.0 * sum(map(len, found)) / len(goals),
            "false_success": _wrong(arm, goals, found),
        }

    return measure


def _wrong(arm: Arm, goals: Targets, found: list[list[Any]]) -> int:
    """Answers that are none."""
    owner = np.repeat(np.arange(len(found)), list(map(len, found)))
    q = np.array([q for some in found for q in some]).reshape(-1, arm.chain.dof)
    return int(np.count_nonzero(~right(arm.chain, goals.poses[owner], q)))
