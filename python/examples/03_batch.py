# SPDX-License-Identifier: BSD-3-Clause
"""Solve for 1000 random reachable poses of a UR3 at once.

cpp/examples/03_batch.cpp prints the same.
"""

import iksel

robot = iksel.load_robot("ur3")
targets = robot.fk(robot.random_configurations(1000, seed=1))

# On one thread per core; the answers have the same bits for any number of threads.
solver = iksel.Solver(robot)
results = solver.solve_batch(targets)

solved = results.success
position = solver.options.position_tolerance
rotation = solver.options.rotation_tolerance
positions_hold = (results.position_error[solved] < position).all()
rotations_hold = (results.rotation_error[solved] < rotation).all()
print(f"targets {len(targets)}")
print(f"solved {solved.sum()}")
print(f"all positions within {position:g} m: {'yes' if positions_hold else 'no'}")
print(f"all rotations within {rotation:g} rad: {'yes' if rotations_hold else 'no'}")
print(f"sum of all joint values {results.q[solved].sum():.6f}")
