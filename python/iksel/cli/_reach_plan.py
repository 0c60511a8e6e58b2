# SPDX-License-Identifier: BSD-3-Clause
"""iksel reach plan: write the plan of a map."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from iksel import reach
from iksel.cli._options import add_solver_options, solver_options
from iksel.cli._output import add_json, print_json, print_pairs
from iksel.cli._parser import count
from iksel.cli._robot import load
from iksel.cli._robot_flags import add_robot

if TYPE_CHECKING:
    import argparse


def add_plan(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser(
        "plan",
        usage="iksel reach plan ROBOT -o MAP [options]",
        help="write the plan of a map",
        description="Write the plan of a map: which cells, and what of each. Where the "
        "first joint turns all the way round, positions are rings about its axis, and "
        "where the last one does, orientations are directions of its axis.",
    )
    add_robot(parser)
    add_json(parser)
    parser.add_argument(
        "-o",
        "--output",
        required=True,
        metavar="MAP",
        help="store to make: a path, or a URL of fsspec such as s3://bucket/map.zarr",
    )
    group = parser.add_argument_group("grid")
    group.add_argument(
        "--spacing",
        type=float,
        default=0.05,
        metavar="M",
        help="edge of the cells of positions [m] (default: %(default)s)",
    )
    resolution = group.add_mutually_exclusive_group()
    resolution.add_argument(
        "--orientations",
        type=count,
        metavar="N",
        help="orientations per position, about (default: 1000; of directions 100)",
    )
    resolution.add_argument(
        "--angle", type=float, metavar="RAD", help="distance of orientations [rad]"
    )
    group.add_argument(
        "--free-spin",
        action="store_true",
        help="cells are directions of the tool's axis, reached with some spin about it",
    )
    group.add_argument(
        "--axis",
        choices=("x", "y", "z"),
        default="z",
        help="axis of the tool that directions are of (default: %(default)s)",
    )
    group.add_argument(
        "--box",
        nargs=6,
        type=float,
        metavar=("X0", "Y0", "Z0", "X1", "Y1", "Z1"),
        help="positions in the base frame [m] (default: as far as the robot reaches)",
    )
    group.add_argument(
        "--quality",
        action="append",
        default=[],
        choices=reach.QUALITIES,
        help="what is computed besides status and proof; may be repeated",
    )
    group.add_argument(
        "--no-symmetry",
        action="store_true",
        help="compute also what a turn of the first or last joint does not change",
    )
    group.add_argument(
        "--chunk-cells", type=count, metavar="N", help="cells of a chunk, about"
    )
    add_solver_options(parser, database=False)
    parser.set_defaults(run=_plan)


def _plan(arguments: argparse.Namespace) -> int:
    plan = reach.plan(
        load(arguments),
        spacing=arguments.spacing,
        orientations=arguments.orientations,
        angle=arguments.angle,
        free_spin=arguments.free_spin,
        axis=arguments.axis,
        box=None if arguments.box is None else [arguments.box[:3], arguments.box[3:]],
        qualities=arguments.quality,
        symmetry=not arguments.no_symmetry,
        options=solver_options(arguments),
        chunk_cells=arguments.chunk_cells,
    )
    reach.create(plan, arguments.output)
    left_out = {"first joint": plan.first_turn, "last joint": plan.last_turn}
    report = {
        "map": arguments.output,
        "id": plan.id,
        "robot": plan.robot_data["name"],
        "dims": plan.dims,
        "shape": plan.shape,
        "cells": plan.size,
        "chunks": plan.chunks,
        "left_out": [name for name, out in left_out.items() if out],
    }
    if arguments.json:
        print_json(report)
        return 0
    print_pairs(
        [
            ("map", report["map"]),
            ("robot", report["robot"]),
            (
                "grid",
                " x ".join(
                    f"{n} {dim}" for n, dim in zip(plan.shape, plan.dims, strict=True)
                ),
            ),
            ("turns left out", ", ".join(report["left_out"]) or "none"),
            ("cells", f"{plan.size:,}"),
            ("chunks", f"{plan.chunks:,}"),
        ]
    )
    return 0
