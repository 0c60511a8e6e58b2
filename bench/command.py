# SPDX-License-Identifier: BSD-3-Clause
"""The command line of the benchmarks."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bench import (
    beside,
    body,
    closest,
    cold,
    coupled,
    dual,
    hands,
    instructions,
    laws,
    lost,
    moves,
    plan,
    report_command,
    scene,
    tips,
)
from bench.analytic import command as analytic_command
from bench.arguments import add_fresh, add_quick, add_robots
from bench.frozen import compare, record
from bench.guard import guard
from bench.learned import command as learned_command
from bench.paper import command as text_command
from bench.provenance import ProvenanceError
from bench.report import installed_rivals, load_report
from bench.report_command import BENCH, make, measured, render_again
from bench.sections import learned, newer, no, random_builds, tails
from bench.size import FULL, QUICK, SEED
from bench.view import View
from bench.whole_body import command as whole_body_command

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import ModuleType


ALONE = {
    "beside": beside,
    "scene": scene,
    "body": body,
    "closest": closest,
    "cold": cold,
    "coupled": coupled,
    "dual": dual,
    "hands": hands,
    "instructions": instructions,
    "laws": laws,
    "lost": lost,
    "moves": moves,
    "tips": tips,
}
"""Commands that measure by themselves and print."""

SECTIONS = {
    "analytic": analytic_command,
    "paper2026": newer,
    "random": random_builds,
    "tails": tails,
    "text": text_command,
    "whole_body": whole_body_command,
}
"""Commands whose results are kept as the report's are."""


def parser() -> argparse.ArgumentParser:
    """The commands and their options."""
    top = argparse.ArgumentParser(prog="python -m bench", description=__doc__)
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    report_command.add(commands)
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
    _add_no(commands)
    learned_command.add(commands)
    for part in (*SECTIONS.values(), *ALONE.values()):
        part.add(commands)
    return top


def _add_no(commands: Any) -> None:
    noes = commands.add_parser(
        "no",
        help="the report's section on poses without an answer, printed",
        description="Measures what a yes and a no cost each solver, how many are "
        "right, and all answers and the nearest. Results are kept as the report's are.",
    )
    add_robots(noes, plan.NO_ARMS)
    add_quick(noes)
    noes.add_argument(
        "--solvers",
        nargs="+",
        metavar="SOLVER",
        choices=plan.NO_RIVALS,
        help="only these",
    )
    noes.add_argument("--targets", type=int, help="of each kind, for the fast solvers")
    noes.add_argument("--seed", type=int, default=SEED)
    add_fresh(noes)


def main(arguments: list[str] | None = None) -> int:
    """Run one command; the exit status."""
    given = sys.argv[1:] if arguments is None else arguments
    options = parser().parse_args(given)
    try:
        return _run(options, given)
    except ProvenanceError as error:
        sys.stderr.write(f"bench: not rendered: {error}\n")
        return 2


def _run(options: argparse.Namespace, given: list[str]) -> int:
    if options.command == "guard":
        return guard(update=options.update)
    if options.command == "frozen":
        return (record if options.action == "record" else compare)(options.file)
    if options.command in ALONE:
        return int(ALONE[options.command].run(options))
    others: dict[str, Callable[[argparse.Namespace, list[str]], int]] = {
        "no": _no,
        "learned": _learned,
        **{name: partial(_section, part) for name, part in SECTIONS.items()},
    }
    if options.command in others:
        return others[options.command](options, given)
    if options.command == "render":
        return render_again(options.output)
    return make(options, given)


def _no(options: argparse.Namespace, given: list[str]) -> int:
    size = QUICK if options.quick else FULL
    size = replace(size, no=options.targets or size.no, no_seed=options.seed)
    versions = installed_rivals()
    wanted = [name for name in versions if name in (options.solvers or plan.NO_RIVALS)]
    jobs = plan.no_plan(size, options.robots, wanted)
    report = measured(jobs, size, versions, given, fresh=options.fresh)
    if report is None:
        return 130
    view = View(report)
    sys.stdout.write(no.text(view) + "\n")
    bad = no.wrong(view)
    for line in bad:
        sys.stdout.write(f"WRONG: {line}\n")
    return 1 if bad or report["failures"] else 0


def _section(part: ModuleType, options: argparse.Namespace, given: list[str]) -> int:
    """A section that knows its jobs and prints itself."""
    versions = installed_rivals()
    jobs, size = part.jobs_of(options, versions)
    report = measured(jobs, size, versions, given, fresh=options.fresh)
    return 130 if report is None else int(part.tell(report))


def _learned(options: argparse.Namespace, given: list[str]) -> int:
    if options.action == "train":
        return learned_command.train(options)
    if options.action == "table":
        sys.stdout.write(learned.text(View(load_report(BENCH))) + "\n")
        return 0
    size = QUICK if options.quick else FULL
    jobs = plan.learned_plan(size, options.robots or None, options.models)
    if not jobs:
        sys.stderr.write("bench: no learned models for these robots\n")
        return 2
    report = measured(jobs, size, {}, given, fresh=options.fresh)
    if report is None:
        return 130
    sys.stdout.write(learned.text(View(report)) + "\n")
    return 1 if report["failures"] else 0
