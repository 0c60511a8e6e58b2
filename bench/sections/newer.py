# SPDX-License-Identifier: BSD-3-Clause
"""The authors' newer selection beside the paper's, as text, and the command for it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from bench.arguments import add_count, add_kept
from bench.markdown import NONE, bullets, microseconds, table
from bench.paper import plan, published
from bench.sections.ablations import HEADER, ROBOTS
from bench.settings import command_line
from bench.size import FULL, QUICK
from bench.view import View, tell_section

if TYPE_CHECKING:
    import argparse
    from collections.abc import Collection

    from bench.size import Job, Size
    from bench.view import Report

LABELS = (
    "`paper()`",
    "`paper(2026)`",
    "without the pull to the middle",
    "`paper(2026)` in numpy",
)


def text(view: View) -> str:
    """The section; empty where there are no results."""
    cells = [plan.newer_cells(robot, view.size) for robot in ROBOTS]
    results = [[view.get(cell) for cell in of_robot] for of_robot in cells]
    if not any(of_robot[1] for of_robot in results):
        return ""
    rows = [
        [label, *(_shown(of_robot[i]) for of_robot in results)]
        for i, label in enumerate(LABELS)
    ]
    numpy = cells[0][3]["count"]
    run = [f"{rate:.2f}; {NONE}, {n:.2f}, {NONE}" for rate, n in published.NEWER_RUN]
    asked = f"{published.NEWER_TARGETS:,} targets"
    rows.append([f"the authors' code, {asked}; not of this run, see above", *run])
    header = ["success %; mean time, attempts, steps", *HEADER]
    count = cells[0][0]["count"]
    about = (
        (
            "`SolverOptions.paper(2026)` is what the authors' later repository, "
            "[wanweiwei07/one](https://github.com/wanweiwei07/one) at commit "
            f"{published.NEWER_COMMIT}, does: 2,048 samples by k-means of 200,000 "
            "random configurations, of the 200 nearest the 16 best by Eq. (5) in that "
            "order, 12 configurations each, clamps of 0.1 m and 0.3 rad, truncated "
            "least squares, seven joints towards the middle of their limits in the "
            "null space."
        ),
        (
            "It means to give up when the error grows, but never writes the variable "
            "that it compares with; so there is no such stop. It tests its tolerances "
            "at the flange, and `paper(2026)` at the TCP."
        ),
        (
            f"Targets: {count:,} per robot, uniform in the limits, seed 1; for the row "
            "in numpy, which is written from that description "
            f"(`bench/paper/newer.py`), the first {numpy:,}."
        ),
        (
            f"The last row is that code itself on the first {asked}, run once by hand "
            f"in {published.NEWER_WHEN} (`NEWER_RUN` of `bench/paper/published.py`)."
        ),
        (
            "The repository states no rate. All that it says of time is the title of "
            f'a commit, "{published.NEWER_TITLE}": {published.NEWER_MS:.0f} ms in '
            "Python, on which robot and machine it does not say."
        ),
        (
            f"One row by itself: `{command_line(cells[0][1])}`; this table: `python -m "
            "bench paper2026`."
        ),
    )
    title = "### The authors' newer selection"
    return "\n\n".join([title, bullets(about), table(header, rows)])


def _shown(cell: dict[str, Any] | None) -> str:
    if cell is None:
        return NONE
    time = microseconds(cell["mean_us"])
    attempts, steps = cell["mean_attempts"], cell["mean_iterations"]
    return f"{cell['success_percent']:.2f}; {time} µs, {attempts:.2f}, {steps:.1f}"


def add(commands: Any) -> None:
    """The command's arguments."""
    command = commands.add_parser(
        "paper2026",
        help="the authors' newer selection of seeds beside the paper's, printed",
        description="Success, time, attempts and steps of both on the paper's robots. "
        "Results are kept as the report's are.",
    )
    add_kept(command)
    add_count(command, "--targets", None, "targets of each robot")


def jobs_of(
    options: argparse.Namespace,
    installed: Collection[str],  # noqa: ARG001
) -> tuple[list[Job], Size]:
    """What is to be measured, and how much."""
    size = QUICK if options.quick else FULL
    size = replace(size, paper=options.targets or size.paper)
    return plan.newer_jobs(size), size


def tell(report: Report) -> int:
    """Print the section; the exit status is 1 if something failed."""
    return tell_section(text(View(report)), failed=bool(report["failures"]))
