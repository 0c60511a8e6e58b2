# SPDX-License-Identifier: BSD-3-Clause
"""Parts of a pose, objectives, and why there is no answer.

cpp/examples/06_task.cpp prints the same.
"""

import math

import numpy as np

import iksel


def show(name, q):
    print(f"{name:<16} q" + "".join(f" {value:7.3f}" for value in q))


robot = iksel.load_robot("panda")
solver = iksel.Solver(robot)
here = np.array([0.2, -0.4, 0.1, -2.0, 0.3, 1.7, 0.5])
target = robot.fk(here)
target[:3, 3] += [-0.05, 0.1, 0.05]

show("the pose", solver.solve(target, near=here).q)

# The hand may turn about its own z axis, say to drill: one joint more is free.
show("any spin", solver.solve(target, near=here, task=iksel.Task.free_spin()).q)
# Within 2 cm to either side along the tool's x, and exact along the rest.
box = iksel.Task.box([0.02, 0, 0], [0, 0, 0])
show("2 cm of room", solver.solve(target, near=here, task=box).q)

# Seven joints for six directions: the one left makes the answer a better one.
far = iksel.Objective.far_from_limits()
show("far from limits", solver.solve(target, objective=far).q)


def elbow_in(q):
    """Cost of joint values; any function will do."""
    return 1 - math.cos(q[2])


result = solver.solve(target, objective=elbow_in)
print(f"elbow in         cost {result.cost:.3f}")

# Beyond what the arm reaches.
target[:3, 3] *= 1.5 / np.linalg.norm(target[:3, 3])
diagnosis = solver.diagnose(target)
print(f"no answer        {diagnosis.cause.name} by {diagnosis.beyond_reach:.2f} m")
