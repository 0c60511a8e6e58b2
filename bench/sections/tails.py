# SPDX-License-Identifier: BSD-3-Clause
"""What means hide as text, and the command for it."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from bench.arguments import add_count, add_kept, add_robots
from bench.arms import RIVAL_ARMS
from bench.machine import load_text
from bench.markdown import NONE, microseconds, percent, table
from bench.size import FULL, QUICK
from bench.tails.beside import BATCH, CONDITIONS, THREADS, TOUCHED_MB
from bench.tails.fresh import LATER
from bench.tails.plan import (
    KINDS,
    beside_cell,
    calls_cell,
    fresh_cell,
    tail_jobs,
    threads_cell,
)
from bench.tails.slowest import AGAIN, OTHERS, SLOWEST
from bench.view import View, tell_section

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Collection

    from bench.size import Job, Size
    from bench.store import Settings
    from bench.view import Report

KIND_WORDS = {KINDS[0]: "reachable", KINDS[1]: "random rotations"}


def text(view: View) -> str:
    """The whole section; empty where there are no results."""
    parts = [*_slowest(view), *_beside(view), *_threads(view), *_fresh(view)]
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


def _of(
    view: View, cell: str, settings: Callable[[str], Settings]
) -> list[tuple[str, dict[str, Any]]]:
    """The results of a cell by robot."""
    found = [(robot, view.get(settings(robot))) for robot in view.robots(cell)]
    return [(robot, result) for robot, result in found if result is not None]


def _slowest(view: View) -> list[str]:
    rows, lines = [], []
    for kind in KINDS:
        cells = _of(view, "tail_calls", partial(calls_cell, kind=kind, size=view.size))
        for robot, cell in cells:
            settings = calls_cell(robot, kind, view.size)
            name = f"`{robot}`, {KIND_WORDS[kind]}"
            came, least = cell["came"], cell["least"]
            rows.append(
                [
                    f"{name}, {settings['count']:,}",
                    *(
                        microseconds(came[of])
                        for of in ("mean_us", "median_us", "p99_us")
                    ),
                    *_pair("p999_us", came, least),
                    *_pair("max_us", came, least),
                    percent(cell["by_machine"], cell["again"], 0),
                    " / ".join(f"{stage:.2f}" for stage in cell["stages"]),
                ]
            )
            lines.append(f"- {name}: {_call(cell['slowest'][0])}")
            lines.append(f"  - again: {_call(cell['slowest_again'][0])}")
    if not rows:
        return []
    header = [
        "targets",
        "mean",
        "median",
        "p99",
        "p99.9",
        "of the targets",
        "worst",
        "of the targets",
        "slow by the machine %",
        "query / seeds / iterate",
    ]
    note = (
        f"The slowest {100 * SLOWEST:g} % of the calls are called {AGAIN} times again, "
        "and those that then are the slowest; "
        "*of the targets*: with the least time of each, so without interruptions, "
        "other work and data that left the caches. *Slow by the machine*: of these "
        f"calls those that took more than {OTHERS:g} times their least. Stages: means "
        "inside C++ over reachable targets, since single ones do not tell theirs. Then "
        "the slowest call as it came, and the one that is the slowest again and again:"
    )
    title = "### The slowest calls, µs"
    return [title, table(header, rows), note, "\n".join(lines)]


def _pair(what: str, came: dict[str, float], least: dict[str, float]) -> list[str]:
    return [microseconds(came[what]), microseconds(least[what])]


def _call(call: dict[str, Any]) -> str:
    """One call and its cause."""
    cause = "machine" if call["us"] > OTHERS * call["again_us"] else "target"
    answer = "yes" if call["answer"] else f"no ({call['proof']})"
    seed, number = call["where"]
    return (
        f"{microseconds(call['us'])} µs, again {microseconds(call['again_us'])}: by "
        f"the {cause}; {answer}, {call['attempts']} attempts, {call['iterations']} "
        f"steps; target {number} of seed {seed}"
    )


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
        for robot, cell in _of(
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
        for robot, cell in _of(
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
    cells = _of(view, "tail_fresh", fresh_cell)
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
