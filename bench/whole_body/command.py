# SPDX-License-Identifier: BSD-3-Clause
"""The command `whole_body`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench.arguments import add_kept, add_robots, add_seed, check_robots
from bench.size import FULL, QUICK, Job
from bench.view import tell_section
from bench.whole_body import table
from bench.whole_body.robots import ROBOTS, file_key, targets_of
from bench.whole_body.solvers import SOLVERS

if TYPE_CHECKING:
    import argparse
    from collections.abc import Collection

    from bench.size import Size
    from bench.store import Settings
    from bench.view import Report

QUICK_TARGETS = 200
LIMIT_S, QUICK_S = 30.0, 1.0
"""Time after which no call of a loop is begun any more [s]."""
OURS_S = 600.0
"""The same for IKSel [s]."""


def add(commands: Any) -> None:
    """Its arguments."""
    command = commands.add_parser(
        "whole_body",
        help="robots with a torso and two arms, both hands at once, beside loops",
        description="One table: goals of six degrees of freedom on both hands, what an "
        "answer costs and how many are missed, beside loops by Pinocchio, pink and "
        "mink. Most robots are those of example-robot-data, from PyPI. Results are "
        "kept as the report's are.",
    )
    add_robots(command, ROBOTS)
    command.add_argument(
        "--solvers",
        nargs="+",
        metavar="SOLVER",
        choices=list(SOLVERS),
        default=list(SOLVERS),
        help=f"only these ({', '.join(SOLVERS)})",
    )
    counts = ", ".join(f"{name} {targets_of(name):,}" for name in ROBOTS)
    command.add_argument(
        "--targets", type=int, metavar="N", help=f"of each robot (default: {counts})"
    )
    add_seed(command)
    command.add_argument(
        "--limit",
        type=float,
        metavar="S",
        help=f"no call of a loop is begun after so many seconds (default {LIMIT_S:g}; "
        f"IKSel: {OURS_S:g})",
    )
    add_kept(command, f"{QUICK_TARGETS} targets, {QUICK_S:g} s for each loop")


def jobs_of(
    options: argparse.Namespace, installed: Collection[str]
) -> tuple[list[Job], Size]:
    """A process for each solver and robot: what one does there, no other feels."""
    check_robots("whole_body", options.robots, tuple(ROBOTS))
    jobs = [
        Job(table.job_name(robot, name), "whole_body", [cell_of(robot, name, options)])
        for robot in options.robots
        for name in options.solvers
        if name in installed
    ]
    return jobs, QUICK if options.quick else FULL


def cell_of(robot: str, name: str, options: argparse.Namespace) -> Settings:
    """One solver on one robot."""
    quick = options.quick
    count = options.targets or (QUICK_TARGETS if quick else targets_of(robot))
    limit_s = options.limit or (QUICK_S if quick else LIMIT_S)
    return {
        "cell": "whole_body",
        "robot": robot,
        "file": file_key(robot),
        "rival": name,
        "count": count,
        "seed": options.seed,
        "limit_s": OURS_S if name == table.OURS else limit_s,
    }


def tell(report: Report) -> int:
    """Print the table; the exit status is 1 if IKSel is wrong or ends."""
    # What ends a rival's process is a row of the table.
    ended = any(key.startswith(f"{table.OURS} on") for key in report["failures"])
    return tell_section(table.text(report), wrong=table.wrong(report), failed=ended)
