# SPDX-License-Identifier: BSD-3-Clause
"""iksel dataset: random poses with all their solutions."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from iksel import reach
from iksel.cli._options import add_solver_options, solver_options
from iksel.cli._output import add_json, add_progress
from iksel.cli._parser import count, seed
from iksel.cli._robot import load
from iksel.cli._robot_flags import add_robot
from iksel.cli.reach import add_engine, compute

if TYPE_CHECKING:
    import argparse

EXAMPLES = """\
examples:
  iksel dataset ur5e --samples 1000000 -o ur5e.zarr
  iksel dataset panda --samples 100000 --targets poses -o p.zarr --parquet p
  iksel dataset ur5e --samples 100000000 -o ur5e.zarr --chunks $SLURM_ARRAY_TASK_ID/100

The same command goes on where it was interrupted; 'iksel reach status' and 'merge' work
on data sets too.
"""


def add_parser(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser(
        "dataset",
        usage="iksel dataset ROBOT --samples N -o STORE [options]",
        help="compute random poses with all their solutions",
        description="Random poses with all their solutions, for those who train "
        "models: a Zarr store, and from it Parquet files. Needs "
        "pip install 'iksel[reach]'.",
        epilog=EXAMPLES,
    )
    add_robot(parser)
    parser.add_argument(
        "--samples", type=count, required=True, metavar="N", help="number of poses"
    )
    parser.add_argument(
        "-o",
        "--output",
        required=True,
        metavar="STORE",
        help="Zarr store: a path, or a URL of fsspec",
    )
    parser.add_argument(
        "--parquet",
        type=Path,
        metavar="FOLDER",
        help="write also Parquet files, one for each chunk",
    )
    parser.add_argument(
        "--seed",
        type=seed,
        default=0,
        metavar="S",
        help="seed of the random poses (default: %(default)s)",
    )
    parser.add_argument(
        "--targets",
        choices=reach.TARGETS,
        default=reach.TARGETS[0],
        help="poses of random configurations, or random poses, of which many cannot be "
        "reached (default: %(default)s)",
    )
    parser.add_argument(
        "--max-solutions",
        type=count,
        default=16,
        metavar="N",
        help="solutions of a pose that are kept (default: %(default)s)",
    )
    add_json(parser)
    add_engine(parser)
    add_progress(parser)
    add_solver_options(parser, database=False)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Plan and compute."""
    plan = reach.plan_samples(
        load(arguments),
        arguments.samples,
        seed=arguments.seed,
        targets=arguments.targets,
        max_solutions=arguments.max_solutions,
        options=solver_options(arguments),
    )
    reach.create(plan, arguments.output)
    code = compute(arguments, arguments.output)
    if arguments.parquet is not None:
        reach.export_parquet(arguments.output, arguments.parquet)
    return code
