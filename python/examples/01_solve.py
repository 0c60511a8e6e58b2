# SPDX-License-Identifier: BSD-3-Clause
"""Solve inverse kinematics for one pose of a UR3.

Or of the arm from base_link to tool0 in the URDF file given as argument.
cpp/examples/01_solve.cpp prints the same.
"""

import sys

import numpy as np

import iksel


def show(name, matrix):
    print(name)
    for row in matrix:
        print("".join(f" {value:13.9f}" for value in row))


if len(sys.argv) > 1:
    robot = iksel.Robot.from_urdf(sys.argv[1], base_link="base_link", tip_link="tool0")
else:
    robot = iksel.load_robot("ur3")

# A target that can be reached: the pose T_base_tip at joint values of our choice.
target = robot.fk(0.3 + 0.2 * np.arange(robot.dof))

# Builds its database of seeds; then `solve` may be called from many threads at once.
solver = iksel.Solver(robot)
result = solver.solve(target)
if not result.success:
    sys.exit(f"no solution: {result.status.name}")

# Not always the joint values from above: a UR3 has up to eight answers per pose, and
# more by whole turns.
show("target", target)
show("q [rad]", [result.q])
print(f"position error [m]   {result.position_error:.9f}")
print(f"rotation error [rad] {result.rotation_error:.9f}")
