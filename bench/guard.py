# SPDX-License-Identifier: BSD-3-Clause
"""Fails when IKSel has become slower or solves less than bench/guard.json says.

Speed is compared by `ratio`, mean solve time over one KDL forward kinematics plus
Jacobian in the same run, which moves little between machines. A shared machine still
disturbs it, so the least of a few runs counts, and the margin is wide: this is to catch
the loss of a kernel, not of a percent.
"""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import Any

import iksel
from bench.cells import solver_options
from bench.machine import facts
from bench.markdown import table
from bench.store import write_json

PATH = Path(__file__).with_name("guard.json")

RUNS = 3
"""Runs for the least ratio; a row that fails gets as many again."""
SLOWER = 1.6
"""A ratio may be this many times the committed one."""
SEED = 1

ROWS: tuple[dict[str, Any], ...] = (
    {"robot": "ur3", "preset": "default", "targets": 20_000, "points": 0.02},
    {"robot": "panda", "preset": "default", "targets": 20_000, "points": 0.02},
    {"robot": "cvr038", "preset": "default", "targets": 20_000, "points": 0.02},
    {
        "robot": "valkyrie_waist_right_arm",
        "preset": "default",
        "targets": 10_000,
        "points": 0.05,
    },
    {"robot": "ur3_wrs", "preset": "paper", "targets": 1_000, "points": 0.5},
    {"robot": "cvr038", "preset": "paper", "targets": 1_000, "points": 0.5},
)
"""What is run; `points` is how far success may fall [percent]. The same targets every
time, so only the code and the last bits of the arithmetic can move it."""

LEVELS = ("scalar", "sse2", "neon", "avx2", "avx512")
"""Instruction sets; the committed ratios are of one of them."""


def guard(*, update: bool) -> int:
    """Compare, or write what to compare with; the exit status."""
    if update:
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
        name = f"{row['robot']}, {row['preset']}"
        reasons = _reasons(row, before, now, comparable=comparable)
        failed += [f"{name}: {reason}" for reason in reasons]
        lines.append(
            [
                name,
                f"{now['ratio']:.2f}",
                f"{before['ratio']:.2f}",
                f"{now['success_percent']:.3f}",
                f"{before['success_percent']:.3f}",
                "FAILED" if reasons else "ok",
            ]
        )
    header = ["guard", "ratio", "committed", "success %", "committed", ""]
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
    if before["robot"] != row["robot"] or before["preset"] != row["preset"]:
        return [
            "bench/guard.json has another row here; run python -m bench guard --update"
        ]
    if now["false_success"]:
        reasons.append(f"{now['false_success']} false successes")
    if now["success_percent"] < before["success_percent"] - row["points"]:
        reasons.append(
            f"success {now['success_percent']:.3f} %, committed "
            f"{before['success_percent']:.3f} %, margin {row['points']} points"
        )
    if comparable and now["ratio"] > SLOWER * before["ratio"]:
        reasons.append(
            f"ratio {now['ratio']:.2f}, committed {before['ratio']:.2f}, margin "
            f"{SLOWER} times"
        )
    return reasons


def _measured(row: dict[str, Any], limit: float | None = None) -> dict[str, Any]:
    """A row's figures.

    With a limit the least ratio of RUNS runs, of twice as many if it is above the
    limit; without, the middle one.
    """
    robot = iksel.load_robot(row["robot"])
    solver = iksel.Solver(robot, solver_options(row["preset"], {}))
    runs = [iksel.evaluate(solver, row["targets"], SEED) for _ in range(RUNS)]
    ratios = sorted(run.ratio for run in runs)
    if limit is not None and ratios[0] > limit:
        runs += [iksel.evaluate(solver, row["targets"], SEED) for _ in range(RUNS)]
        ratios = sorted(run.ratio for run in runs)
    return {
        "robot": row["robot"],
        "preset": row["preset"],
        # To compare with: the middle one, for noise makes some too small as well.
        "ratio": round(ratios[len(ratios) // 2] if limit is None else ratios[0], 3),
        "success_percent": round(runs[0].success_percent, 4),
        "false_success": max(run.false_success for run in runs),
    }
