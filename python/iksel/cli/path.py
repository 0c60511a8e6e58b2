# SPDX-License-Identifier: BSD-3-Clause
"""iksel path: joint values along a path of poses."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from iksel_cpp import Solver, Status

from iksel.cli._angles import Angles, turning
from iksel.cli._options import add_solver_options, given_database, solver_options
from iksel.cli._output import add_json, print_json, print_pairs
from iksel.cli._poses import FILE_FORMS, read_poses
from iksel.cli._robot import chain_text, load
from iksel.cli._robot_flags import add_robot
from iksel.cli._solve_text import print_configurations

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

    from iksel_cpp import PathResult, Robot

    from iksel._base.arrays import FloatArray

EXIT_SOLVED, EXIT_NO_SOLUTION = 0, 1


class Haste(NamedTuple):
    """What makes a path too fast."""

    joint: int
    """The joint that would have to exceed its velocity limit by the largest factor."""
    waypoint: int
    """On the way to which waypoint."""
    speed: float
    """How fast it would have to be [rad/s or m/s]."""
    limit: float
    """How fast it may be [rad/s or m/s]."""
    dt: float | None
    """A time step in which the whole path is solved [s]; None: none is known."""


EXAMPLES = f"""\
examples:
  iksel path ur3 poses.txt --start 0.3 -1.2 1.4 -0.6 1.2 0.2 --dt 0.01
  iksel path ur3 poses.txt --json
  iksel path torso.urdf --tip left_hand --tip right_hand poses.csv

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
    parser.add_argument("file", metavar="FILE", help="poses, one a row; of each --tip")
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
    poses = read_poses(arguments.file, angles, robot)
    start = arguments.start and angles.read_joints("--start", arguments.start, robot)
    database = given_database(arguments)
    solver = Solver(robot, solver_options(arguments), database)
    path = solver.solve_path(poses, start, dt=arguments.dt)
    haste = None
    if path.status == Status.too_fast:
        haste = find_haste(solver, poses, start, arguments.dt)
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
                "too_fast": haste and haste_report(robot, haste, angles),
                "q": angles.show(robot, path.q),
            }
        )
    else:
        print_text(robot, path, len(poses), angles, haste)
    return EXIT_SOLVED if path.success else EXIT_NO_SOLUTION


def largest_step(robot: Robot, path: PathResult, angles: Angles) -> float:
    """The farthest that a joint moves between two poses, in that joint's unit."""
    steps = np.zeros(robot.dof)
    if path.largest_step_joint is not None:
        steps[path.largest_step_joint] = path.largest_step
    return float(angles.show(robot, steps).max())


def find_haste(
    solver: Solver, poses: FloatArray, start: Sequence[float] | None, dt: float
) -> Haste | None:
    """Why a path is too fast, by the path that takes its time.

    Args:
        solver: Of the path.
        poses: Its waypoints, (n, 4, 4), of k tips (n, k, 4, 4).
        start: Where the arm is before the first; None: anywhere.
        dt: The time step that is too short [s].

    Returns:
        None where the path has an end for another reason too.
    """
    unhurried = solver.solve_path(poses, start)
    limits = solver.robot.velocity_limit
    q = unhurried.q if start is None else np.vstack([start, unhurried.q])
    moves = np.abs(np.diff(q, axis=0))
    if not unhurried.success or len(moves) == 0:
        return None
    times = moves / limits
    step, joint = np.unravel_index(np.argmax(times), times.shape)
    needed = round_up(float(times[step, joint]))
    if needed <= dt:
        return None
    in_time = solver.solve_path(poses, start, dt=needed).success
    return Haste(
        int(joint),
        int(step) + (start is None),
        float(moves[step, joint]) / dt,
        float(limits[joint]),
        needed if in_time else None,
    )


def round_up(value: float) -> float:
    """A number that is larger by 1 % at most, with three digits."""
    unit = 10.0 ** (math.floor(math.log10(value)) - 2)
    return float(f"{math.ceil(value / unit * (1 + 1e-9)) * unit:.3g}")


def haste_report(robot: Robot, haste: Haste, angles: Angles) -> dict[str, Any]:
    """The fields of Haste, the joint by its name."""
    speeds = np.array([haste.speed, haste.limit])
    speed, limit = angles.show_joint(robot, haste.joint, speeds).tolist()
    return {
        "joint": robot.joint_names[haste.joint],
        "waypoint": haste.waypoint,
        "speed": speed,
        "velocity_limit": limit,
        "dt": haste.dt,
    }


def haste_rows(robot: Robot, haste: Haste, angles: Angles) -> list[tuple[str, str]]:
    """What makes the path too fast, for people."""
    facts = haste_report(robot, haste, angles)
    unit = f"{angles.units(robot)[haste.joint]}/s"
    needed, limit = f"{facts['speed']:.4g} {unit}", f"{facts['velocity_limit']:.4g}"
    text = (
        f"{facts['joint']} would have to move at {needed} to waypoint "
        f"{haste.waypoint}; its limit is {limit} {unit}"
    )
    rows = [("too fast", text)]
    if haste.dt is not None:
        rows.append(("in time with", f"--dt {haste.dt:g}"))
    return rows


def print_text(
    robot: Robot, path: PathResult, count: int, angles: Angles, haste: Haste | None
) -> None:
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
    if haste is not None:
        rows += haste_rows(robot, haste, angles)
    if path.largest_step_joint is not None:
        joint = robot.joint_names[path.largest_step_joint]
        unit = angles.unit if turning(robot)[path.largest_step_joint] else "m"
        step = f"{largest_step(robot, path, angles):.4g} {unit}, {joint}"
        rows.append(
            ("largest step", f"{step} to waypoint {path.largest_step_waypoint}")
        )
    print_pairs(rows)
    if len(path.q) == 0:
        return
    print()
    print_configurations(robot, path.q, angles)
