# SPDX-License-Identifier: BSD-3-Clause
"""The commands `report` and `render`, and how cells are measured for any command."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bench import plan
from bench.analytic.plan import BUILDING
from bench.arguments import add_kept
from bench.arms import RIVAL_ARMS, load_arm
from bench.machine import facts, fingerprint, stale
from bench.others import Others
from bench.provenance import check
from bench.report import (
    collect,
    installed_rivals,
    load_report,
    merged,
    render,
    save_report,
)
from bench.rivals import ENUMERATORS, RIVALS, ssik
from bench.run import run_jobs
from bench.settings import WORK
from bench.size import FULL, QUICK
from bench.store import Store

if TYPE_CHECKING:
    from collections.abc import Collection

    from bench.size import Job, Size
    from bench.view import Report

BENCH = Path(__file__).resolve().parent

SOLVERS = list(dict.fromkeys([*RIVALS, *ENUMERATORS]))
"""All that a section asks, each once."""

EPILOG = f"""\
robots: {", ".join(RIVAL_ARMS)} (and, with --only robots, every built-in one)
solvers: {", ".join(repr(name) for name in SOLVERS)}

An interrupted report goes on where it was when it is started again: results are kept
in build/bench by what was measured, on what and with what.
"""


def add(commands: Any) -> None:
    """The arguments of `report`."""
    report = commands.add_parser(
        "report",
        help="measure everything and write the report",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    report.add_argument(
        "--robots", nargs="+", metavar="ROBOT", help="only these robots"
    )
    report.add_argument(
        "--only",
        nargs="+",
        metavar="PART",
        choices=[*plan.SECTIONS, *SOLVERS],
        help=f"only these sections ({', '.join(plan.SECTIONS)}) or solvers",
    )
    report.add_argument(
        "-o",
        "--output",
        type=Path,
        metavar="FOLDER",
        help="where RESULTS.md, results/ and plots/ go (default: bench, or build/bench/"
        "quick for a quick or partial report)",
    )
    add_kept(report, "fewer targets: a few minutes")
    report.add_argument(
        "--keep",
        action="store_true",
        help="with --only and -o: keep what the folder's report has besides",
    )


def add_render(commands: Any) -> None:
    """The arguments of `render`."""
    render_ = commands.add_parser(
        "render", help="write the text and plots of a report again"
    )
    render_.add_argument(
        "-o",
        "--output",
        type=Path,
        default=BENCH,
        metavar="FOLDER",
        help="the report's (default: bench)",
    )


def render_again(folder: Path) -> int:
    """Write the text and plots of a folder's report again."""
    report = load_report(folder)
    check(report)
    render(report, folder)
    return 0


def make(options: argparse.Namespace, given: list[str]) -> int:
    """Measure a report and write it."""
    size = QUICK if options.quick else FULL
    versions = installed_rivals()
    jobs = plan.plan(size, options.robots, options.only, versions)
    if not jobs:
        sys.stderr.write("bench: nothing to do for these robots and parts\n")
        return 2
    output = options.output
    if output is None:
        whole = not (options.quick or options.robots or options.only)
        output = BENCH if whole else WORK / "quick"
    published = output.resolve() == BENCH
    if published:
        # Before the measuring, not after it.
        check({"machine": facts()})
        if options.keep:
            check(_rest(load_report(output), options.only or ()))
    report = measured(jobs, size, versions, given, fresh=options.fresh)
    if report is None:
        return 130
    if options.keep:
        every = plan.plan(size)
        sections = [part for part in plan.SECTIONS if part in (options.only or ())]
        report = merged(load_report(output), report, every, sections)
    save_report(report, output)
    if published:
        check(report)
    render(report, output)
    sys.stderr.write(f"wrote {output / 'RESULTS.md'}\n")
    return 1 if report["failures"] else 0


def measured(
    jobs: list[Job],
    size: Size,
    versions: dict[str, str],
    given: list[str],
    *,
    fresh: bool,
) -> Report | None:
    """What the jobs gave, failures told; None if interrupted."""
    store = Store(WORK / "cells", fingerprint(), versions)
    if fresh:
        for job in jobs:
            for cell in job.cells:
                store.forget(cell)
    if stale():
        sys.stderr.write(
            "bench: cpp/ or python/ has changed since this iksel was installed\n"
        )
    build(jobs)
    others = Others(size.patience_s)
    begin = time.monotonic()
    try:
        failures = run_jobs(jobs, store, WORK, others)
    except KeyboardInterrupt:
        sys.stderr.write("bench: interrupted; the same command goes on from here\n")
        return None
    command = " ".join(["python -m bench", *given])
    seconds = time.monotonic() - begin
    report = collect(jobs, store, size, command=command, seconds=seconds)
    report["machine"]["others"] = others.facts()
    report["failures"] = failures
    for name, reason in failures.items():
        sys.stderr.write(f"bench: {name}: {reason}\n")
    return report


def build(jobs: list[Job]) -> None:
    """Make what solvers need once, as programs are compiled: no part of the report."""
    cells = [cell for job in jobs for cell in job.cells]
    for name in sorted({c["robot"] for c in cells if c.get("rival") in BUILDING}):
        ssik.build(load_arm(name))


def _rest(report: Report, sections: Collection[str]) -> Report:
    """What stays of a report whose sections are measured anew."""
    parts = report.get("parts", {})
    kept = {name: part for name, part in parts.items() if name not in sections}
    return {**report, "parts": kept}
