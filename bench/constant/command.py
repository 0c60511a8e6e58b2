# SPDX-License-Identifier: BSD-3-Clause
"""What a constant of the core does: the core with other values of it, on random arms.

For each value the core is compiled, which takes a minute or three, and asked reachable
poses, noes, moves, sets of solutions, self-motions, tasks, paths and more of random
arms of each build and of pairs of them. Printed are, beside the value of the source,
the answers that failed, whether any answer is another, and the processor time. A
constant with which nothing changes needs no value of its own.
"""

from __future__ import annotations

import ast
import json
import os
import subprocess
import sys
from typing import TYPE_CHECKING, Any

import iksel
from bench import random_arms
from bench.arguments import add_count, add_seed
from bench.constant.variant import Constant, build, find
from bench.machine import ROOT
from bench.markdown import table

if TYPE_CHECKING:
    import argparse
    from pathlib import Path

Kinds = dict[str, dict[str, Any]]


def add(commands: Any) -> None:
    """The command `constant`."""
    command = commands.add_parser(
        "constant",
        help="what a constant of the core does, on arms drawn at random",
        description=__doc__,
    )
    command.add_argument(
        "name", metavar="[FILE:]NAME", help="e.g. seeds/sweep.cpp:kEvery"
    )
    command.add_argument(
        "values",
        nargs="*",
        metavar="VALUE",
        help="as C++ has it (default: three times and a third of what it is)",
    )
    command.add_argument(
        "--builds",
        nargs="+",
        default=tuple(random_arms.BUILDS),
        metavar="BUILD",
        help=f"default: {' '.join(random_arms.BUILDS)}",
    )
    add_count(command, "--arms", 6, "random arms of each build")
    add_count(command, "--rounds", 3, "of which the least time counts")
    add_seed(command, 31_000)


def run(args: argparse.Namespace) -> int:
    """Build, ask and print."""
    constant = find(args.name)
    folder = ROOT / "build" / "constant"
    rows = {
        value: _asked(build(constant, value, folder), args)
        for value in (constant.value, *(args.values or beside(constant)))
    }
    first = rows.pop(constant.value)
    sys.stdout.write(
        f"{constant.file}: {constant.name} = {constant.value}, beside "
        f"{', '.join(rows)}; {args.arms} arms of each build, seed {args.seed}, "
        f"SIMD level {iksel.simd_level()}.\n\n{compared(first, rows)}\n"
    )
    return 0


def beside(constant: Constant) -> list[str]:
    """Three times and a third of a constant's value.

    Raises SystemExit if that is no number.
    """
    try:
        value = ast.literal_eval(constant.value.removesuffix("F"))
        if isinstance(value, int):
            return [str(3 * value), str(max(1, round(value / 3)))]
        return [f"{3 * value:.6g}", f"{value / 3:.6g}"]
    except (SyntaxError, TypeError, ValueError):
        text = f"{constant.name} is {constant.value}: say which values"
        raise SystemExit(f"bench constant: {text}") from None


def compared(first: Kinds, others: dict[str, Kinds]) -> str:
    """A table with a row for each kind of question."""
    head = ["asked", "answers", "failed"]
    for value in others:
        head += [f"failed, {value}", "answers are others", "times the time"]
    lines = []
    for kind, row in first.items():
        line = [kind, f"{row['asked']:,}", f"{row['failed']:,}"]
        for other in (kinds[kind] for kinds in others.values()):
            line += [
                f"{other['failed']:,}",
                "no" if other["hash"] == row["hash"] else "yes",
                f"{other['cpu_s'] / row['cpu_s']:.2f}",
            ]
        lines.append(line)
    return table(head, lines)


def _asked(library: Path, args: argparse.Namespace) -> Kinds:
    """What bench.constant.asked says of the core in that folder."""
    ask = [str(n) for n in (args.arms, args.seed, args.rounds)] + list(args.builds)
    path = os.pathsep.join(str(p) for p in (library, ROOT))
    done = subprocess.run(
        [sys.executable, "-m", "bench.constant.asked", *ask],
        env=os.environ | {"PYTHONPATH": path},
        cwd=ROOT,
        check=False,
        capture_output=True,
        text=True,
    )
    if done.returncode:
        raise SystemExit(f"bench constant: {done.stderr[-2000:]}")
    kinds: Kinds = json.loads(done.stdout)
    return kinds
