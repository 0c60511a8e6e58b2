# SPDX-License-Identifier: BSD-3-Clause
"""Measures IKSel beside the paper and its rivals; bench/README.md says what for."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from bench import (
    beside,
    body,
    closest,
    cold,
    coupled,
    dual,
    frozen,
    guard,
    hands,
    instructions,
    laws,
    lost,
    moves,
    no_command,
    report_command,
    scene,
    tips,
)
from bench.analytic import command as analytic_command
from bench.constant import command as constant_command
from bench.learned import command as learned_command
from bench.learned import train_command
from bench.paper import command as text_command
from bench.provenance import ProvenanceError
from bench.report import installed_rivals
from bench.report_command import make, measured, render_again
from bench.sections import newer, random_builds, tails
from bench.whole_body import command as whole_body_command

if TYPE_CHECKING:
    from types import ModuleType

SECTIONS = {
    "no": no_command,
    "analytic": analytic_command,
    "random": random_builds,
    "tails": tails,
    "text": text_command,
    "paper2026": newer,
    "learned": learned_command,
    "whole_body": whole_body_command,
}
"""Commands whose results are kept as the report's are."""

ALONE = {
    "guard": guard,
    "frozen": frozen,
    "instructions": instructions,
    "train": train_command,
    "laws": laws,
    "lost": lost,
    "moves": moves,
    "closest": closest,
    "beside": beside,
    "cold": cold,
    "coupled": coupled,
    "dual": dual,
    "tips": tips,
    "hands": hands,
    "scene": scene,
    "body": body,
    "constant": constant_command,
}
"""Commands that measure by themselves and print."""


def parser() -> argparse.ArgumentParser:
    """The commands and their options."""
    top = argparse.ArgumentParser(prog="python -m bench", description=__doc__)
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    report_command.add(commands)
    report_command.add_render(commands)
    for part in (*SECTIONS.values(), *ALONE.values()):
        part.add(commands)
    return top


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
    if options.command in ALONE:
        return int(ALONE[options.command].run(options))
    if options.command in SECTIONS:
        return _section(SECTIONS[options.command], options, given)
    if options.command == "render":
        return render_again(options.output)
    return make(options, given)


def _section(part: ModuleType, options: argparse.Namespace, given: list[str]) -> int:
    """A section that knows its jobs and prints itself."""
    versions = installed_rivals()
    jobs, size = part.jobs_of(options, versions)
    if not jobs:
        sys.stderr.write("bench: nothing to do for these arguments\n")
        return 2
    report = measured(jobs, size, versions, given, fresh=options.fresh)
    return 130 if report is None else int(part.tell(report))
