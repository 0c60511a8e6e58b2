# SPDX-License-Identifier: BSD-3-Clause
"""The solution nearest to where a UR3 is, all of its branches, and with a filter.

cpp/examples/04_nearest.cpp prints the same.
"""

import numpy as np

import iksel


def show(name, result):
    q = "".join(f" {value:7.3f}" for value in result.q)
    print(f"{name:<20} move {result.move:.3f}  q{q}")


robot = iksel.load_robot("ur3")
solver = iksel.Solver(robot)

here = np.array([0.3, -1.2, 1.4, -0.6, 1.2, 0.2])
target = robot.fk(here)
target[:3, 3] += [0.02, -0.03, 0.01]

show("nearest", solver.solve(target, near=here))
for one in solver.solve_all(target, near=here):
    show("branch", one)


def elbow_up(q):
    """Say which of (n, dof) candidates are welcome; real ones look for collisions."""
    return (q[:, 2] < 0) & (q[:, 4] > 0)


show("nearest, elbow up", solver.solve(target, near=here, filter=elbow_up))
