# SPDX-License-Identifier: BSD-3-Clause
"""What means hide as text, and the command for it."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from bench.arguments import add_count, add_kept, add_robots
from bench.arms import RIVAL_ARMS
from bench.machine import load_text
from bench.markdown import NONE, microseconds, table
from bench.sections import slowest
from bench.sections.slowest import results_of
from bench.size import FULL, QUICK
from bench.tails.beside import BATCH, CONDITIONS, THREADS, TOUCHED_MB
from bench.tails.fresh import LATER
from bench.tails.plan import (
    beside_cell,
    fresh_cell,
    tail_jobs,
    threads_cell,
)
from bench.view import View, tell_section

if TYPE_CHECKING:
    import argparse
    from collections.abc import Collection

    from bench.size import Job, Size
    from bench.view import Report


def text(view: View) -> str:
    """The whole section; empty where there are no results."""
    parts = [*slowest.parts(view), *_beside(view), *_threads(view), *_fresh(view)]
    if not parts:
        return ""
    facts = view.machine("tails")
    conditions = (
        "Single calls of `solve` from Python, default options, seed 1, garbage "
        "collection off; each table has a process of its own. "
        f"SIMD level {facts['simd']}, {facts['cpu']}, {facts['cores']} cores"
        f"{load_text(facts)}. Made by itself: `python -m bench tails`."
    )
    return "\n\n".join(["## What means hide", conditions, *parts])


def _beside(view: View) -> list[str]:
    rows = [
        [
            f"`{robot}`",
            *(
                f"{microseconds(cell[name]['median_us'])} "
                f"({microseconds(cell[name]['p99_us'])})"
                for name in CONDITIONS
            ),
        ]
        for robot, cell in results_of(
            view, "tail_beside", partial(beside_cell, size=view.size)
        )
    ]
    if not rows:
        return []
    header = [
        "robot",
        "alone",
        "ten robots in turn",
        f"after {BATCH:,} targets of another robot",
        f"after {TOUCHED_MB} MB of other memory",
    ]
    note = (
        f"{view.size.tail_beside:,} reachable targets; what is done before a call is "
        "not timed. In turn: one call each of nine other robots' solvers before."
    )
    title = "### With other data in the caches: median (p99) in µs"
    return [title, table(header, rows), note]


def _threads(view: View) -> list[str]:
    rows = [
        [
            f"`{robot}`",
            *(
                " / ".join(
                    microseconds(cell[name][of])
                    for of in ("mean_us", "p999_us", "max_us")
                )
                for name in THREADS
            ),
        ]
        for robot, cell in results_of(
            view, "tail_threads", partial(threads_cell, size=view.size)
        )
    ]
    if not rows:
        return []
    header = ["robot", "alone", "other thread: one by one", "other thread: a batch"]
    title = "### Beside another busy thread: mean / p99.9 / worst in µs"
    note = (
        f"Up to {view.size.tail_noes:,} reachable targets or {view.size.tail_s:g} s, "
        "one solver in both threads of one Python, whose lock single calls pass to "
        "each other."
    )
    return [title, table(header, rows), note]


def _fresh(view: View) -> list[str]:
    cells = results_of(view, "tail_fresh", fresh_cell)
    if not cells:
        return []
    rows = [
        [
            f"`{robot}`",
            *(f"{cell[of]:.1f}" for of in ("robot_ms", "solver_ms")),
            *(microseconds(cell[of]) for of in ("first_us", "later_us")),
            *(f"{cell[of]:.1f}" for of in ("database_mb", "solver_mb")),
        ]
        for robot, cell in cells
    ]
    header = [
        "robot",
        "`load_robot`, ms",
        "`Solver`, ms",
        "first call, µs",
        "later, µs",
        "database, MB",
        "memory of `Solver`, MB",
    ]
    least = {
        of: min(cell[of] for _, cell in cells)
        for of in ("numpy_ms", "import_ms", "process_mb")
    }
    memory = f"{least['process_mb']:.0f} MB" if least["process_mb"] else NONE
    note = (
        "Each robot in new processes, of each figure the least. Before these: `import "
        f"numpy` {least['numpy_ms']:.0f} ms, then `import iksel` "
        f"{least['import_ms']:.0f} ms; with the solver the smallest process holds "
        f"{memory}. *Later*: the median of {LATER} calls after the first."
    )
    title = "### Before the first answer"
    return [title, table(header, rows), note]


def add(commands: Any) -> None:
    """The command `tails`."""
    command = commands.add_parser(
        "tails",
        help="the slowest calls and their causes, cold caches, first calls, threads",
        description="The report's section on what means hide. Results are kept as the "
        "report's are.",
    )
    add_robots(command, RIVAL_ARMS)
    add_kept(command, "fewer calls")
    add_count(command, "--calls", None, "calls at reachable targets")


def jobs_of(
    options: argparse.Namespace,
    installed: Collection[str],  # noqa: ARG001
) -> tuple[list[Job], Size]:
    """What is to be measured, and how much."""
    size = QUICK if options.quick else FULL
    size = replace(size, tail_calls=options.calls or size.tail_calls)
    chosen = None if options.robots == RIVAL_ARMS else options.robots
    return tail_jobs(size, chosen), size


def tell(report: Report) -> int:
    """Print the section; the exit status is 1 if something failed."""
    return tell_section(text(View(report)), failed=bool(report["failures"]))
