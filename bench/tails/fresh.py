# SPDX-License-Identifier: BSD-3-Clause
"""What comes before a robot's first answer, in a process that has done nothing yet.

As a program it measures itself: `python -m bench.tails.fresh ROBOT SEED`.
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from bench.store import Settings

LATER = 200
"""Calls after the first, whose median is what it is beside."""
MEGABYTE = 1 << 20


def fresh(settings: Settings) -> dict[str, Any]:
    """The least of each figure over some processes."""
    command = [sys.executable, "-m", __name__, settings["robot"]]
    command.append(str(settings["seed"]))
    rows = []
    for _ in range(settings["count"]):
        done = subprocess.run(command, check=True, capture_output=True, text=True)
        rows.append(json.loads(done.stdout))
    return {name: min(row[name] for row in rows) for name in rows[0]}


def memory_mb() -> float:
    """What the process holds in memory [MB]; 0 where the system does not say."""
    try:
        pages = Path("/proc/self/statm").read_text(encoding="utf-8").split()[1]
    except OSError:
        return 0.0
    return int(pages) * 4096 / MEGABYTE


def measure(name: str, seed: int) -> dict[str, float]:
    """Import, robot, solver and first calls, in the order in which they come."""
    clock = time.perf_counter
    begin = clock()
    import numpy as np  # noqa: F401, PLC0415 - timed

    numpy_s = clock() - begin
    begin = clock()
    import iksel  # noqa: PLC0415 - timed

    import_s = clock() - begin
    begin = clock()
    robot = iksel.load_robot(name)
    robot_s = clock() - begin
    before = memory_mb()
    begin = clock()
    solver = iksel.Solver(robot)
    solver_s = clock() - begin
    after = memory_mb()
    poses = list(robot.fk(robot.random_configurations(LATER + 1, seed)))
    times = []
    for pose in poses:
        begin = clock()
        solver.solve(pose)
        times.append(clock() - begin)
    return {
        "numpy_ms": 1e3 * numpy_s,
        "import_ms": 1e3 * import_s,
        "robot_ms": 1e3 * robot_s,
        "solver_ms": 1e3 * solver_s,
        "first_us": 1e6 * times[0],
        "later_us": 1e6 * sorted(times[1:])[LATER // 2],
        "solver_mb": after - before,
        "process_mb": after,
        "database_mb": solver.database.nbytes / MEGABYTE,
    }


if __name__ == "__main__":
    sys.stdout.write(json.dumps(measure(sys.argv[1], int(sys.argv[2]))) + "\n")
