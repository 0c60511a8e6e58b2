# SPDX-License-Identifier: BSD-3-Clause
"""iksel build: write a database to a file."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from iksel_cpp import Database

from iksel.cli._options import add_database_options, add_preset, database_options
from iksel.cli._output import Progress, add_json, add_progress, print_json, print_pairs
from iksel.cli._robot import load
from iksel.cli._robot_flags import add_robot

if TYPE_CHECKING:
    import argparse

EXAMPLES = """\
examples:
  iksel build ur3 -o ur3.iksel
  iksel build ur3 -o ur3.iksel --scale large
  iksel build arm.urdf --base base_link --tip tool0 -o arm.iksel --samples 40000
"""


def add_parser(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser(
        "build",
        usage="iksel build ROBOT -o FILE [options]",
        help="build a database and save it",
        description="Build a robot's database of seeds and save it. An older file "
        "stays as it is until the new one is complete.",
        epilog=EXAMPLES,
    )
    add_robot(parser)
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        required=True,
        metavar="FILE",
        help="file to write",
    )
    add_json(parser)
    add_progress(parser)
    add_preset(parser)
    add_database_options(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Build, save and print what was written."""
    robot = load(arguments)
    options = database_options(arguments)
    start = time.perf_counter()
    with Progress(f"building {robot.name}", show=arguments.progress) as progress:
        database = Database.build(robot, options, progress)
    build_s = time.perf_counter() - start
    database.save(arguments.output)
    report = {
        "robot": robot.name,
        "file": str(arguments.output),
        "bytes": arguments.output.stat().st_size,
        "samples": len(database),
        "key_dimension": database.key_dimension,
        "chain_hash": f"{database.chain_hash:016x}",
        "build_s": build_s,
        "options": options.to_dict(),
    }
    if arguments.json:
        print_json(report)
        return 0
    print_pairs(
        [
            ("robot", robot.name),
            ("file", str(arguments.output)),
            ("size", f"{arguments.output.stat().st_size / 1e6:.2f} MB"),
            ("samples", f"{len(database):,}"),
            ("time", f"{build_s:.3f} s"),
        ]
    )
    return 0
