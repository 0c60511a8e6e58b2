# SPDX-License-Identifier: BSD-3-Clause
"""The command `learned`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench.arguments import add_kept, add_robots
from bench.arms import PAPER_ARMS
from bench.learned.plan import MODELS, learned_jobs
from bench.plan import chosen
from bench.sections import learned
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
        "learned",
        help="the report's section on learned seeds, printed",
        description="Seeds from the committed weights of models that are learned: a "
        "mixture density network, a normalizing flow, a diffusion. Needs jax and "
        "equinox (the extra bench-learned). Results are kept as the report's are.",
    )
    add_robots(command, PAPER_ARMS)
    command.add_argument(
        "--models", nargs="+", choices=MODELS, default=MODELS, help="only these"
    )
    add_kept(command, "half the targets")


def jobs_of(
    options: argparse.Namespace,
    installed: Collection[str],  # noqa: ARG001
) -> tuple[list[Job], Size]:
    """What is to be measured, and how much."""
    size = QUICK if options.quick else FULL
    return chosen(learned_jobs(size, options.models), options.robots), size


def tell(report: Report) -> int:
    """Print the section; the exit status is 1 if something failed."""
    return tell_section(learned.text(View(report)), failed=bool(report["failures"]))
