# SPDX-License-Identifier: BSD-3-Clause
"""The command `text`."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from bench.arguments import add_count, add_kept, add_robots
from bench.paper.choices import choice_jobs
from bench.paper.published import ROBOTS
from bench.plan import chosen
from bench.sections import choices
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
        "text",
        help="what the paper's text says of its choices, claim by claim, printed",
        description="Each choice of the paper beside others on the same targets, the "
        "sizes of its files, and the stages' times of rows whose order it gives. "
        "Results are kept as the report's are.",
    )
    add_robots(command, ROBOTS)
    add_kept(command)
    add_count(command, "--targets", None, "targets of each row")


def jobs_of(
    options: argparse.Namespace, installed: Collection[str]
) -> tuple[list[Job], Size]:
    """What is to be measured, and how much."""
    del installed
    size = QUICK if options.quick else FULL
    size = replace(size, paper=options.targets or size.paper)
    return chosen(choice_jobs(size), options.robots), size


def tell(report: Report) -> int:
    """Print the section; the exit status is 1 if a measurement failed."""
    return tell_section(choices.text(View(report)), failed=bool(report["failures"]))
