# SPDX-License-Identifier: BSD-3-Clause
"""How many instructions calls take, by valgrind, before and after a change.

Times of a shared machine waver by a third, instructions by a thousandth: this is to see
a percent. What they take in a cache or a pipeline it does not see. Valgrind knows no
AVX-512, so the kernels are those of AVX2 or below.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any

import iksel
from bench.arguments import add_before_and_after, add_robots
from bench.store import write_json

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

ROBOTS = ("ur5e", "irb120", "cvr038", "gen3_6dof", "panda", "iiwa14", "xarm7")
CALLS = ("yes", "no", "near", "all", "batch")
TARGETS = 100
ROUNDS = 5
SEED = 12
MORE = 1.02
"""Times as many as before may be taken."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser(
        "instructions",
        help="compare the instructions that calls take before and after a change",
        description="Records the instructions that solve takes of reachable poses "
        "(yes) and others (no), with near, solve_all (16 answers) and solve_batch, or "
        "compares with that: exit status 1 if any takes more than 2 % more. Needs "
        "valgrind; 8 minutes on 2 cores.",
    )
    add_before_and_after(parser, "build/instructions.json")
    add_robots(parser, ROBOTS)


def run(options: argparse.Namespace) -> int:
    """Record or compare; the exit status."""
    if shutil.which("valgrind") is None:
        raise SystemExit("needs valgrind, e.g. apt install valgrind")
    after = _measured(options.robots)
    if options.action == "record":
        write_json(options.file, after, indent=0)
        sys.stdout.write(f"wrote {options.file}: {len(after)} calls\n")
        return 0
    return compare(json.loads(options.file.read_text(encoding="utf-8")), after)


def compare(before: dict[str, int], after: dict[str, int]) -> int:
    """Print what each call takes beside before; 1 if one takes too many more."""
    is_more = False
    for name, count in after.items():
        if name not in before:
            sys.stdout.write(f"{name}: {count}, was not measured before\n")
            continue
        ratio = count / before[name]
        is_more = is_more or ratio > MORE
        mark = "  more" if ratio > MORE else ""
        sys.stdout.write(f"{name}: {before[name]} to {count}, {ratio:.3f}{mark}\n")
    return int(is_more)


def _measured(robots: Sequence[str]) -> dict[str, int]:
    """Of each robot and call, the instructions for one target, in the mean."""
    pairs = [(robot, call) for robot in robots for call in (None, *CALLS)]
    # What else runs changes nothing.
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        counts = dict(zip(pairs, pool.map(_collected, pairs), strict=True))
    return {
        f"{robot} {call}": round((count - counts[robot, None]) / ROUNDS / TARGETS)
        for (robot, call), count in counts.items()
        if call is not None
    }


def _collected(pair: tuple[str, str | None]) -> int:
    """Of a process that makes the calls, or none."""
    robot, call = pair
    valgrind = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
    program = [sys.executable, "-m", "bench.instructions", robot]
    done = subprocess.run(
        [*valgrind, *program, *([call] if call else [])],
        env=os.environ | {"PYTHONHASHSEED": "0", "OPENBLAS_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    found = re.search(r"Collected\s*:\s*(\d+)", done.stderr)
    if done.returncode or found is None:
        raise RuntimeError(done.stderr)
    return int(found[1])


def main(robot: str, call: str | None = None) -> None:
    """Make the calls, one after the other."""
    arm = iksel.load_robot(robot)
    solver = iksel.Solver(arm)
    poses = arm.fk(arm.random_configurations(TARGETS, SEED))
    near = arm.random_configurations(TARGETS, SEED + 1)
    if call == "no":
        poses[:, :3, 3] *= 1.2

    def each(i: int) -> object:
        if call == "near":
            return solver.solve(poses[i], near=near[i])
        if call == "all":
            return solver.solve_all(poses[i], max=16)
        return solver.solve(poses[i])

    for _ in range(ROUNDS if call else 0):
        if call == "batch":
            solver.solve_batch(poses, threads=1)
            continue
        for i in range(TARGETS):
            each(i)


if __name__ == "__main__":
    main(*sys.argv[1:])
