# SPDX-License-Identifier: BSD-3-Clause
"""The paper's loop by hand: select a seed, iterate it, and after a failure re-select.

Solves 200 poses of a UR3 so and by the paper preset, which gives the same joint values.
cpp/examples/08_selection.cpp prints the same.
"""

import numpy as np

import iksel

robot = iksel.load_robot("ur3")
options = iksel.SolverOptions.paper()
solver = iksel.Solver(robot, options)
selector = iksel.Selector(solver.database, options.strategy)


def solve_by_hand(pose):
    """Joint values for a pose, and the samples that were tried."""
    selector.candidates(pose, count=200, ranking="joint_adjustment")
    tried = []
    while len(tried) < options.max_attempts:
        sample = selector.next(failed=tried)
        tried.append(sample)
        # One attempt of the iteration from this seed alone.
        seed = solver.database.q(sample)
        result = solver.solve(pose, seeds=[seed], database_seeds=False)
        if result:
            return result.q, tried
    return None, tried


poses = robot.fk(robot.random_configurations(200, seed=1))
answers = [solve_by_hand(pose) for pose in poses]
same = sum(
    np.array_equal(q, solver.solve(pose).q)
    for pose, (q, _) in zip(poses, answers, strict=True)
)
print(f"solved {sum(q is not None for q, _ in answers)} of {len(poses)}")
print(f"re-selected {sum(len(tried) > 1 for _, tried in answers)}")
print(f"as the paper preset {same}")

indices, distances, adjustments, _ = selector.candidates(poses[0], count=5)
print("sample    distance  adjustment")
for row in zip(indices, distances, adjustments, strict=True):
    print("{:6d} {:11.6f} {:11.6f}".format(*row))
