# SPDX-License-Identifier: BSD-3-Clause
"""The command `analytic`."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from bench.analytic.plan import analytic_jobs, arms, job_name
from bench.arguments import add_count, add_kept, add_robots, add_seed
from bench.plan import chosen
from bench.rivals import ENUMERATORS
from bench.sections import analytic
from bench.size import FULL, QUICK
from bench.view import View, tell_section

if TYPE_CHECKING:
    import argparse
    from collections.abc import Collection

    from bench.size import Job, Size
    from bench.view import Report


def add(commands: Any) -> None:
    """Its arguments."""
    names = ", ".join(repr(name) for name in ENUMERATORS)
    command = commands.add_parser(
        "analytic",
        help="the report's section on solvers that enumerate, printed",
        description="One table: what one answer, all branches, the nearest and a no "
        "cost IKSel and the solvers that enumerate, what they miss, and what they "
        "answer wrongly. Results are kept as the report's are.",
    )
    add_robots(command, arms())
    add_kept(command)
    command.add_argument(
        "--solvers",
        nargs="+",
        metavar="SOLVER",
        choices=list(ENUMERATORS),
        help=f"only these ({names})",
    )
    add_count(command, "--targets", None, "targets of each kind")
    add_seed(command)


def jobs_of(
    options: argparse.Namespace, installed: Collection[str]
) -> tuple[list[Job], Size]:
    """What is to be measured, and how much."""
    size = QUICK if options.quick else FULL
    count = options.targets or size.analytic
    size = replace(size, analytic=count, no_seed=options.seed)
    wanted = [name for name in options.solvers or ENUMERATORS if name in installed]
    return chosen(analytic_jobs(size, options.robots), rivals=wanted), size


def tell(report: Report) -> int:
    """Print the section; the exit status is 1 if IKSel is wrong or fails."""
    view = View(report)
    # What ends a rival's process is a row of the table.
    ended = any(
        key.startswith(f"{job_name(analytic.OURS)},") for key in report["failures"]
    )
    return tell_section(analytic.text(view), wrong=analytic.wrong(view), failed=ended)
