# SPDX-License-Identifier: BSD-3-Clause
"""The command `text`."""

from __future__ import annotations

import sys
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from bench.arguments import add_robots
from bench.paper.choices import choice_jobs
from bench.paper.published import ROBOTS
from bench.sections import choices
from bench.size import FULL, QUICK
from bench.view import View

if TYPE_CHECKING:
    import argparse
    from collections.abc import Collection

    from bench.size import Job, Size
    from bench.view import Report


def add(commands: Any) -> None:
    """Its arguments."""
    command = commands.add_parser(
        "text",
        help="what the paper's text says of its choices, claim by claim, printed",
        description="Each choice of the paper beside others on the same targets, the "
        "sizes of its files, and the stages' times of rows whose order it gives. "
        "Results are kept as the report's are.",
    )
    add_robots(command, ROBOTS)
    command.add_argument("--quick", action="store_true", help="fewer targets")
    command.add_argument("--targets", type=int, help="of each row")
    command.add_argument(
        "--fresh", action="store_true", help="measure again what was measured before"
    )


def jobs_of(
    options: argparse.Namespace, installed: Collection[str]
) -> tuple[list[Job], Size]:
    """What is to be measured, and how much."""
    del installed
    size = QUICK if options.quick else FULL
    size = replace(size, paper=options.targets or size.paper)
    jobs = [
        replace(job, cells=[c for c in job.cells if c["robot"] in options.robots])
        for job in choice_jobs(size)
    ]
    return [job for job in jobs if job.cells], size


def tell(report: Report) -> int:
    """Print the section; the exit status is 1 if a measurement failed."""
    sys.stdout.write(choices.text(View(report)) + "\n")
    return 1 if report["failures"] else 0
