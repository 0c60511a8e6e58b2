# SPDX-License-Identifier: BSD-3-Clause
"""The command `no`."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from bench.arguments import add_count, add_kept, add_robots, add_seed
from bench.plan import chosen
from bench.plans.no import NO_ARMS, NO_RIVALS, no_jobs
from bench.sections import no
from bench.size import FULL, QUICK
from bench.view import View, tell_section

if TYPE_CHECKING:
    import argparse
    from collections.abc import Collection

    from bench.size import Job, Size
    from bench.view import Report


def add(commands: Any) -> None:
    """Its arguments."""
    command = commands.add_parser(
        "no",
        help="the report's section on poses without an answer, printed",
        description="Measures what a yes and a no cost each solver, how many are "
        "right, and all answers and the nearest. Results are kept as the report's are.",
    )
    add_robots(command, NO_ARMS)
    add_kept(command)
    command.add_argument(
        "--solvers",
        nargs="+",
        metavar="SOLVER",
        choices=NO_RIVALS,
        help=f"only these ({', '.join(map(repr, NO_RIVALS))})",
    )
    add_count(command, "--targets", None, "targets of each kind, for the fast solvers")
    add_seed(command)


def jobs_of(
    options: argparse.Namespace, installed: Collection[str]
) -> tuple[list[Job], Size]:
    """What is to be measured, and how much."""
    size = QUICK if options.quick else FULL
    size = replace(size, no=options.targets or size.no, no_seed=options.seed)
    wanted = [name for name in options.solvers or NO_RIVALS if name in installed]
    return chosen(no_jobs(size, options.robots), rivals=wanted), size


def tell(report: Report) -> int:
    """Print the section; the exit status is 1 if IKSel or a proof is wrong."""
    view = View(report)
    failed = bool(report["failures"])
    return tell_section(no.text(view), wrong=no.wrong(view), failed=failed)
