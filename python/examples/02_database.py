# SPDX-License-Identifier: BSD-3-Clause
"""Build the paper's small database for a UR3, save it, load it and solve with it.

As a program that starts often would. cpp/examples/02_database.cpp prints the same.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

import iksel


def show_progress(done, total):
    end = "\n" if done == total else ""
    print(f"\r{done} of {total} samples", end=end, file=sys.stderr, flush=True)


robot = iksel.load_robot("ur3")
options = iksel.SolverOptions.paper()
options.database.scale = iksel.Scale.small

with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "ur3.iksel"
    iksel.Database.build(robot, options.database, show_progress).save(file)

    # Loading maps the file into memory: it takes no time, and processes share it. A
    # file that is damaged or belongs to another robot is refused.
    database = iksel.Database.load(file)
    solver = iksel.Solver(robot, options, database)
    print(f"samples {len(database)}")

    result = solver.solve(robot.fk(0.3 + 0.2 * np.arange(robot.dof)))

if not result.success:
    sys.exit(f"no solution: {result.status.name}")
print(f"attempts {result.attempts}")
print(f"iterations {result.iterations}")
print("q [rad]")
print("".join(f" {value:13.9f}" for value in result.q))
