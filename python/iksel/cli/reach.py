# SPDX-License-Identifier: BSD-3-Clause
"""iksel reach: plan, compute and use reachability maps."""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING, Any

from iksel_cpp import InvalidArgumentError

from iksel import reach
from iksel.cli._output import Progress, add_json, add_progress, print_json, print_pairs
from iksel.cli._parser import count
from iksel.cli._reach_plan import add_plan
from iksel.cli.view import add_server, announce, serve

if TYPE_CHECKING:
    from collections.abc import Callable

EXAMPLES = """\
examples:
  iksel reach plan ur5e --spacing 0.05 --orientations 1000 -o ur5e.zarr
  iksel reach run ur5e.zarr
  iksel reach run ur5e.zarr --dask tcp://scheduler:8786
  iksel reach run ur5e.zarr --chunks $SLURM_ARRAY_TASK_ID/100
  iksel reach status ur5e.zarr
  iksel reach merge ur5e.zarr part0.zarr part1.zarr
  iksel reach view ur5e.zarr -o ur5e.png
  iksel reach view ur5e.zarr -o ur5e.svg --slice z=0.3
  iksel reach view ur5e.zarr --browser
  iksel reach export ur5e.zarr -o ur5e.h5
  iksel reach compare ur5e.zarr panda.zarr
"""

INCOMPLETE = 1
"""Exit status of `status` for a map of which something is missing."""


def add_parser(commands: Any) -> None:
    """Add the command and its own commands."""
    parser = commands.add_parser(
        "reach",
        help="compute and show reachability maps",
        description="Reachability maps: what inverse kinematics says about a grid of "
        "poses. Needs pip install 'iksel[reach]'.",
        epilog=EXAMPLES,
    )
    own = parser.add_subparsers(
        title="commands", metavar="COMMAND", dest="reach_command", required=True
    )
    add_plan(own)
    _add_run(own)
    _add_map(own, "status", _status, "say how much of a map has been computed")
    merge = _add_map(
        own, "merge", _merge, "collect chunks from stores of the same plan"
    )
    merge.add_argument("parts", nargs="+", metavar="PART", help="a store")
    _add_view(own)
    _add_export(own)
    compare = _add_map(own, "compare", _compare, "compare what two maps reach")
    compare.add_argument("other", metavar="OTHER", help="another map")


def _add_map(
    commands: Any, name: str, run: Callable[[argparse.Namespace], int], text: str
) -> argparse.ArgumentParser:
    """A command on a map."""
    parser: argparse.ArgumentParser = commands.add_parser(
        name, help=text, description=text[0].upper() + text[1:] + "."
    )
    parser.add_argument(
        "map", metavar="MAP", help="what 'plan' wrote: a path, or a URL of fsspec"
    )
    add_json(parser)
    parser.set_defaults(run=run)
    return parser


def _add_run(commands: Any) -> None:
    parser = _add_map(commands, "run", _run, "compute what is missing of a map")
    add_engine(parser)
    add_progress(parser)


def add_engine(parser: argparse.ArgumentParser) -> None:
    """Add what says where chunks are computed."""
    engine = parser.add_mutually_exclusive_group()
    engine.add_argument(
        "--workers", type=count, metavar="N", help="processes (default: one per core)"
    )
    engine.add_argument(
        "--dask", metavar="ADDRESS", help="scheduler of a Dask cluster, tcp://host:port"
    )
    parser.add_argument(
        "--chunks",
        type=_share,
        metavar="I/N",
        help="only the share I = 0 ... N - 1 of N jobs that know nothing of each other",
    )
    parser.add_argument(
        "--repair", action="store_true", help="compute damaged chunks again"
    )


def _add_view(commands: Any) -> None:
    parser = _add_map(commands, "view", _view, "draw a map as spheres or as a slice")
    target = parser.add_mutually_exclusive_group(required=True)
    target.add_argument(
        "-o", "--output", type=Path, metavar="FILE", help=".png or .svg"
    )
    target.add_argument(
        "--browser",
        action="store_true",
        help="show it in the browser around its robot, as 'iksel view' does",
    )
    add_server(parser)
    parser.add_argument(
        "--slice",
        type=_plane,
        metavar="AXIS=M",
        help="a plane, such as z=0.3 [m] (default: spheres)",
    )
    parser.add_argument(
        "--spacing",
        type=float,
        metavar="M",
        help="of what is drawn (default: the map's)",
    )


def _add_export(commands: Any) -> None:
    parser = _add_map(commands, "export", _export, "write a map for other programs")
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        required=True,
        metavar="FILE",
        help=".npy, or .h5 as Reuleaux reads it",
    )
    parser.add_argument(
        "--array",
        default="fraction",
        metavar="NAME",
        help="what a .npy file is of: fraction (of the orientations, per position), "
        "status, proof or a quality (default: %(default)s)",
    )


def _run(arguments: argparse.Namespace) -> int:
    return compute(arguments, arguments.map)


def compute(arguments: argparse.Namespace, path: str) -> int:
    """Compute what is missing of a store by the engine of add_engine()."""
    with Progress("computing", show=arguments.progress) as progress:
        settings: dict[str, Any] = {
            "share": arguments.chunks,
            "repair": arguments.repair,
            "progress": progress,
        }
        if arguments.dask is None:
            result = reach.run(path, workers=arguments.workers, **settings)
        else:
            with reach.connect(arguments.dask) as client:
                result = reach.run(path, client=client, **settings)
    return _print_progress(arguments, path, result)


def _status(arguments: argparse.Namespace) -> int:
    result = reach.status(arguments.map)
    _print_progress(arguments, arguments.map, result)
    return 0 if result.complete else INCOMPLETE


def _merge(arguments: argparse.Namespace) -> int:
    result = reach.merge(arguments.map, arguments.parts)
    return _print_progress(arguments, arguments.map, result)


def _view(arguments: argparse.Namespace) -> int:
    found = reach.open(arguments.map)
    if arguments.browser:
        if arguments.slice is not None or arguments.spacing is not None:
            raise InvalidArgumentError(
                "--browser: shows spheres; --slice and --spacing are for --output"
            )
        with serve(arguments, found.solver) as viewer:
            announce(viewer.show_map(found))
        return 0
    if arguments.slice is None:
        reach.draw_spheres(found, arguments.output, spacing=arguments.spacing)
    else:
        axis, at = arguments.slice
        reach.draw_slice(
            found, arguments.output, axis=axis, at=at, spacing=arguments.spacing
        )
    return _print_written(arguments)


def _export(arguments: argparse.Namespace) -> int:
    found = reach.open(arguments.map)
    suffix = arguments.output.suffix
    if suffix == ".npy":
        reach.export_npy(found, arguments.output, arguments.array)
    elif suffix in (".h5", ".hdf5"):
        reach.export_reuleaux(found, arguments.output)
    else:
        raise InvalidArgumentError(
            f"--output {arguments.output}: the suffix {suffix!r} is none of .npy, .h5"
        )
    return _print_written(arguments)


def _compare(arguments: argparse.Namespace) -> int:
    result = reach.compare(reach.open(arguments.map), reach.open(arguments.other))
    report = dataclasses.asdict(result) | {"overlap": result.overlap}
    del report["difference"]
    if arguments.json:
        print_json(report)
        return 0
    labels = {
        "both": "both",
        "only_first": f"only {arguments.map}",
        "only_second": f"only {arguments.other}",
        "neither": "neither",
    }
    volumes = [(text, f"{report[name]:.6f} m^3") for name, text in labels.items()]
    print_pairs([*volumes, ("overlap", f"{100 * result.overlap:.2f} %")])
    return 0


def _print_progress(
    arguments: argparse.Namespace, path: str, result: reach.Progress
) -> int:
    report = {**dataclasses.asdict(result), "complete": result.complete}
    if arguments.json:
        print_json(report)
        return 0
    print_pairs(
        [
            ("store", path),
            ("chunks", f"{result.done:,} of {result.chunks:,} computed"),
            ("cells", f"{result.cells:,}"),
        ]
    )
    return 0


def _print_written(arguments: argparse.Namespace) -> int:
    size = arguments.output.stat().st_size
    if arguments.json:
        print_json({"file": str(arguments.output), "bytes": size})
    else:
        print_pairs([("file", str(arguments.output)), ("size", f"{size / 1e6:.2f} MB")])
    return 0


def _share(text: str) -> tuple[int, int]:
    """An argument I/N."""
    first, slash, second = text.partition("/")
    if not (slash and first.isdecimal() and second.isdecimal()):
        raise argparse.ArgumentTypeError(f"{text!r} is no I/N")
    i, n = int(first), int(second)
    if i >= n:
        raise argparse.ArgumentTypeError(f"{text}: I is 0 ... N - 1")
    return i, n


def _plane(text: str) -> tuple[str, float]:
    """An argument AXIS=NUMBER."""
    axis, equals, value = text.partition("=")
    try:
        at = float(value)
    except ValueError:
        at = float("nan")
    if axis not in ("x", "y", "z") or not equals or at != at:  # noqa: PLR0124 (NaN)
        raise argparse.ArgumentTypeError(f"{text!r} is no AXIS=NUMBER, such as z=0.3")
    return axis, at
