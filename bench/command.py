# SPDX-License-Identifier: BSD-3-Clause
"""The command line of the benchmarks."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from bench import plan
from bench.arms import RIVAL_ARMS
from bench.cells import WORK
from bench.frozen import compare, record
from bench.guard import guard
from bench.machine import fingerprint, stale
from bench.no import ROBOTS, no
from bench.report import (
    collect,
    installed_rivals,
    load_report,
    render,
    save_report,
)
from bench.rivals import RIVALS
from bench.run import run_jobs
from bench.store import Store

BENCH = Path(__file__).resolve().parent

EPILOG = f"""\
robots: {", ".join(RIVAL_ARMS)} (and, with --only robots, every built-in one)
solvers: {", ".join(repr(name) for name in RIVALS)}

An interrupted report goes on where it was when it is started again: results are kept
in build/bench by what was measured, on what and with what.
"""


def parser() -> argparse.ArgumentParser:
    """The commands and their options."""
    top = argparse.ArgumentParser(prog="python -m bench", description=__doc__)
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    report = commands.add_parser(
        "report",
        help="measure everything and write the report",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    report.add_argument(
        "--quick", action="store_true", help="fewer targets: a few minutes"
    )
    report.add_argument(
        "--robots", nargs="+", metavar="ROBOT", help="only these robots"
    )
    report.add_argument(
        "--only",
        nargs="+",
        metavar="PART",
        choices=[*plan.SECTIONS, *RIVALS],
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
    report.add_argument(
        "--fresh", action="store_true", help="measure again what was measured before"
    )
    again = commands.add_parser("render", help="write the text and plots again")
    again.add_argument("-o", "--output", type=Path, default=BENCH, metavar="FOLDER")
    check = commands.add_parser(
        "guard", help="compare speed and success with bench/guard.json"
    )
    check.add_argument(
        "--update", action="store_true", help="write bench/guard.json instead"
    )
    frozen = commands.add_parser(
        "frozen",
        help="compare the bits of every call's answers before and after a change",
        description="Records what every public call answers, on every built-in robot, "
        "at both presets and every SIMD level of this machine, or compares with that.",
    )
    frozen.add_argument("action", choices=["record", "compare"])
    frozen.add_argument("file", type=Path, help="where, e.g. build/frozen.json")
    no_command = commands.add_parser(
        "no", help="measure what a no costs, and how many of them are proven"
    )
    no_command.add_argument(
        "robots",
        nargs="*",
        metavar="ROBOT",
        default=ROBOTS,
        help=f"default: {' '.join(ROBOTS)}",
    )
    no_command.add_argument("--targets", type=int, default=10_000, help="of each kind")
    no_command.add_argument("--seed", type=int, default=1)
    return top


def main(arguments: list[str] | None = None) -> int:
    """Run one command; the exit status."""
    given = sys.argv[1:] if arguments is None else arguments
    options = parser().parse_args(given)
    if options.command == "guard":
        return guard(update=options.update)
    if options.command == "frozen":
        action = record if options.action == "record" else compare
        return action(options.file)
    if options.command == "no":
        return no(options.robots, options.targets, options.seed)
    if options.command == "render":
        render(load_report(options.output), options.output)
        return 0
    return _report(options, given)


def _report(options: argparse.Namespace, given: list[str]) -> int:
    size = plan.QUICK if options.quick else plan.FULL
    versions = installed_rivals()
    jobs = plan.plan(size, options.robots, options.only, versions)
    if not jobs:
        sys.stderr.write("bench: nothing to do for these robots and parts\n")
        return 2
    store = Store(WORK / "cells", fingerprint(), versions)
    if options.fresh:
        for job in jobs:
            for cell in job.cells:
                store.forget(cell)
    output = options.output
    if output is None:
        whole = not (options.quick or options.robots or options.only)
        output = BENCH if whole else WORK / "quick"
    if stale():
        sys.stderr.write(
            "bench: cpp/ or python/ has changed since this iksel was installed\n"
        )
    begin = time.monotonic()
    try:
        failures = run_jobs(jobs, store, WORK)
    except KeyboardInterrupt:
        sys.stderr.write("bench: interrupted; the same command goes on from here\n")
        return 130
    command = " ".join(["python -m bench", *given])
    seconds = time.monotonic() - begin
    report = collect(jobs, store, size, command=command, seconds=seconds)
    report["failures"] = failures
    save_report(report, output)
    render(report, output)
    for name, reason in failures.items():
        sys.stderr.write(f"bench: {name}: {reason}\n")
    sys.stderr.write(f"wrote {output / 'RESULTS.md'}\n")
    return 1 if failures else 0
