# SPDX-License-Identifier: BSD-3-Clause
"""Solves beside other work, which takes the solver's place in the processor's caches.

Before each timed solve so much other memory is touched, a byte of each cache line:
inside C++, where the clock stands around the solve alone (`iksel.evaluate`), and from
Python, where it stands around the call with the interpreter's own misses; beside these
a call from Python that solves nothing, `robot.fk`, and solves with nothing touched.
Conditions take turns, round by round, so that a machine whose speed changes meanwhile
changes all of them; of a condition's rounds the middle median counts.
"""

from __future__ import annotations

import json
import statistics
import time
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.arguments import add_count, add_robots, add_seed
from bench.machine import facts

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Sequence

    import numpy.typing as npt

ROBOTS = ("ur3", "panda", "cvr038")
MEGABYTE = 1 << 20
LINE = 64
"""Bytes of a cache line."""


def from_python(
    call: Callable[[Any], object],
    arguments: Sequence[Any],
    other: npt.NDArray[np.uint8],
) -> float:
    """The median time of a call after other memory was touched [us]."""
    lines = other[::LINE]
    times = times_after(call, arguments, lambda: np.add(lines, 1, out=lines))
    return float(np.median(times)) / 1e3


def times_after(
    call: Callable[[Any], object],
    arguments: Sequence[Any],
    before: Callable[[], object],
) -> npt.NDArray[np.int64]:
    """The times of calls, before each of which something else is done [ns]."""
    times = np.zeros(len(arguments), dtype=np.int64)
    for i, argument in enumerate(arguments):
        before()
        time.perf_counter_ns()
        begin = time.perf_counter_ns()
        call(argument)
        times[i] = time.perf_counter_ns() - begin
    return times


def measure(name: str, args: argparse.Namespace) -> dict[str, Any]:
    """The medians of all conditions of a robot [us]."""
    robot = iksel.load_robot(name)
    solver = iksel.Solver(robot)
    q = robot.random_configurations(args.targets, args.seed)
    poses = list(robot.fk(q))
    other = np.zeros(max(args.touched) * MEGABYTE, dtype=np.uint8)
    rounds: dict[str, dict[str, list[float]]] = {}
    for _ in range(args.rounds):
        for size in (0, *args.touched):
            found = {
                "c++": iksel.evaluate(
                    solver, args.targets, args.seed, touched=size * MEGABYTE
                ).median_us,
                "python": from_python(solver.solve, poses, other[: size * MEGABYTE]),
                "python fk": from_python(robot.fk, list(q), other[: size * MEGABYTE]),
            }
            condition = rounds.setdefault(f"{size} MB", {})
            for key, value in found.items():
                condition.setdefault(key, []).append(value)
    row: dict[str, Any] = {"database_bytes": solver.database.nbytes}
    for size, kinds in rounds.items():
        row[size] = {key: round(statistics.median(of), 2) for key, of in kinds.items()}
    return row


def add(commands: Any) -> None:
    """The command `cold`."""
    command = commands.add_parser(
        "cold",
        help="solves that find nothing in the processor's caches",
        description=__doc__,
    )
    add_robots(command, ROBOTS)
    command.add_argument(
        "--touched",
        type=int,
        nargs="+",
        default=[16, 96],
        metavar="MB",
        help="other memory between solves (%(default)s)",
    )
    add_count(command, "--targets", 200, "targets")
    add_count(command, "--rounds", 5, "rounds")
    add_seed(command)


def run(args: argparse.Namespace) -> int:
    """Measure, and print a line of JSON for each robot: medians [us]."""
    machine = {key: facts()[key] for key in ("cpu", "simd", "load")}
    for name in args.robots:
        print(json.dumps({**machine, name: measure(name, args)}), flush=True)
    return 0
