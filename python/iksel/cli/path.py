# SPDX-License-Identifier: BSD-3-Clause
"""iksel path: joint values along a path of poses."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import Solver

from iksel.cli._angles import Angles, turning
from iksel.cli._options import add_solver_options, given_database, solver_options
from iksel.cli._output import add_json, print_json, print_pairs
from iksel.cli._poses import FILE_FORMS, read_poses
from iksel.cli._robot import add_robot, chain_text, load
from iksel.cli._solve_text import print_configurations

if TYPE_CHECKING:
    import argparse

    from iksel_cpp import PathResult, Robot

EXIT_SOLVED, EXIT_NO_SOLUTION = 0, 1

EXAMPLES = f"""\
examples:
  iksel path ur3 poses.txt --start 0.3 -1.2 1.4 -0.6 1.2 0.2 --dt 0.01
  iksel path ur3 poses.txt --json

{FILE_FORMS}
exit status: 0 solved, 1 a waypoint has no continuation, 2 bad input
"""


def add_parser(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser(
        "path",
        usage="iksel path ROBOT FILE [options]",
        help="find joint values along a path of poses",
        description="Find joint values along a path of poses with little joint motion.",
        epilog=EXAMPLES,
    )
    add_robot(parser)
    parser.add_argument("file", metavar="FILE", help="poses, one a row")
    parser.add_argument(
        "--start",
        nargs="+",
        metavar="Q",
        help="where the arm is one time step before the first pose [rad or m], or "
        "the name of a state of --srdf",
    )
    parser.add_argument(
        "--dt",
        type=float,
        default=0.0,
        metavar="S",
        help="time between poses [s], in which no joint moves farther than its "
        "velocity limit allows; 0: speeds are not limited (default)",
    )
    add_json(parser)
    add_solver_options(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Solve and print the path."""
    robot = load(arguments)
    angles = Angles(arguments)
    poses = read_poses(arguments.file, angles)
    start = arguments.start and angles.read_joints("--start", arguments.start, robot)
    database = given_database(arguments)
    solver = Solver(robot, solver_options(arguments), database)
    path = solver.solve_path(poses, start, dt=arguments.dt)
    if arguments.json:
        print_json(
            {
                "robot": robot.name,
                "joint_names": robot.joint_names,
                "success": path.success,
                "status": path.status.name,
                "first_unreachable": path.first_unreachable,
                "angle_unit": angles.unit,
                "largest_step": largest_step(robot, path, angles),
                "largest_step_joint": path.largest_step_joint,
                "largest_step_waypoint": path.largest_step_waypoint,
                "move": path.move,
                "q": angles.show(robot, path.q),
            }
        )
    else:
        print_text(robot, path, len(poses), angles)
    return EXIT_SOLVED if path.success else EXIT_NO_SOLUTION


def largest_step(robot: Robot, path: PathResult, angles: Angles) -> float:
    """The farthest that a joint moves between two poses, in that joint's unit."""
    steps = np.zeros(robot.dof)
    if path.largest_step_joint is not None:
        steps[path.largest_step_joint] = path.largest_step
    return float(angles.show(robot, steps).max())


def print_text(robot: Robot, path: PathResult, count: int, angles: Angles) -> None:
    """Print the path for people."""
    rows = [
        ("robot", chain_text(robot)),
        ("waypoints", str(count)),
        ("status", path.status.name),
    ]
    if path.first_unreachable is not None:
        rows.append(
            ("first unreachable", f"waypoint {path.first_unreachable} (from 0)")
        )
    if path.largest_step_joint is not None:
        joint = robot.joint_names[path.largest_step_joint]
        unit = angles.unit if turning(robot)[path.largest_step_joint] else "m"
        step = f"{largest_step(robot, path, angles):.4g} {unit}, {joint}"
        rows.append(
            ("largest step", f"{step} to waypoint {path.largest_step_waypoint}")
        )
    print_pairs(rows)
    print()
    print_configurations(robot, path.q, angles)
