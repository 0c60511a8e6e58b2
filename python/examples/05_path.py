# SPDX-License-Identifier: BSD-3-Clause
"""A straight line of a Panda as a joint path, planned at once and streamed.

cpp/examples/05_path.cpp prints the same.
"""

import numpy as np

import iksel

robot = iksel.load_robot("panda")
solver = iksel.Solver(robot)

start = np.array([0.0, -0.4, 0.0, -2.2, 0.0, 1.8, 0.8])
dt = 0.01
# 0.3 m sideways, a millimetre per time step.
line = np.repeat(robot.fk(start)[None], 300, axis=0)
line[:, 1, 3] += 0.001 * np.arange(1, 301)

path = solver.solve_path(line, start, dt=dt)
print(f"path: {path.status.name}, {len(path.q)} waypoints")
print(f"largest step {path.largest_step:.4f} rad, joint {path.largest_step_joint}")

tracker = solver.tracker(start)
late = sum(not tracker.track(pose, dt).success for pose in line)
print(f"streamed: {late} late, ends at q" + "".join(f" {q:.4f}" for q in tracker.q))
