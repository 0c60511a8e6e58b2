# SPDX-License-Identifier: BSD-3-Clause
"""iksel solve: joint values for one pose, or for each of a file."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Any

from iksel_cpp import Solver, Status

from iksel.cli._angles import Angles
from iksel.cli._answers import FILE_FORMS as ANSWER_FILES
from iksel.cli._options import add_solver_options, given_database, solver_options
from iksel.cli._output import add_json, print_json, print_pairs
from iksel.cli._parser import POSE_FORMS, POSE_METAVAR
from iksel.cli._poses import FILE_FORMS as POSE_FILES
from iksel.cli._robot import chain_text, load
from iksel.cli._robot_flags import add_robot
from iksel.cli._solve_file import add_poses, answer_format, check_flags, solve_file
from iksel.cli._solve_request import add_request, read_request, read_target
from iksel.cli._solve_text import (
    diagnosis_report,
    print_configurations,
    print_diagnosis,
    print_text,
    proof_row,
    target_rows,
)

if TYPE_CHECKING:
    import argparse

    from iksel_cpp import Result, Robot

    from iksel._base.arrays import FloatArray

EXIT_SOLVED, EXIT_NO_SOLUTION = 0, 1

EXAMPLES = f"""\
examples:
  iksel solve ur3 --pose 0.2 0.15 0.3 0 3.1416 0
  iksel solve ur3 --pose 0.2 0.15 0.3 0 0 1 0 --json
  iksel solve ur3 --pose 0.2 0.15 0.3 0 3.1416 0 --near 0 -1 1 0 1 0
  iksel solve ur3 --pose 0.2 0.15 0.3 0 3.1416 0 --all
  iksel solve ur3 --pose 0.2 0.15 0.3 0 3.1416 0 --task free_spin
  iksel solve ur3 --pose 0.9 0 0.3 0 0 0 --diagnose
  iksel solve ur3 --pose 0.9 0 0.3 0 0 0 --closest
  iksel solve panda --from-q 0 -0.5 0 -2 0 1.6 0.8 --preset paper --max-attempts 6
  iksel solve arm.urdf --base base_link --tip tool0 --tcp 0 0 0.1 0 0 0 --from-q 0 0 0 0
  iksel solve torso.urdf --tip left --tip right --pose 1 1 1 0 0 0 --pose 1 -1 1 0 0 0
  iksel solve ur3 --poses poses.csv -o answers.csv
  iksel solve ur3 --poses poses.jsonl -o answers.npy --near 0 -1 1 0 1 0
  cat poses.csv | iksel solve ur3 --poses - --format jsonl

--poses {POSE_FILES}
Answers are in the order of the rows, one a row:
{ANSWER_FILES}
exit status: 0 solved, 1 no solution, of --poses for one row or more, 2 bad input
"""


def add_parser(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser(
        "solve",
        usage="iksel solve ROBOT (--pose ... | --from-q ... | --poses FILE) [options]",
        help="find joint values for one pose, or for each of a file",
        description="Find joint values that put the TCP (or tip link) at a pose, or at "
        "each of many poses.",
        epilog=EXAMPLES,
    )
    add_robot(parser)
    target = parser.add_mutually_exclusive_group(required=True)
    target.add_argument(
        "--pose",
        nargs="+",
        action="append",
        metavar=POSE_METAVAR,
        help=f"{POSE_FORMS}; once for each --tip",
    )
    target.add_argument(
        "--from-q",
        nargs="+",
        metavar="Q",
        help="take the pose at these joint values [rad or m] as the target",
    )
    target.add_argument(
        "--poses",
        metavar="FILE",
        help="solve every pose of a file by itself, see below; - is stdin",
    )
    add_request(parser)
    add_json(parser)
    add_poses(parser)
    add_solver_options(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Solve and print the answer."""
    check_flags(arguments)
    robot = load(arguments)
    angles = Angles(arguments)
    request = read_request(robot, arguments, angles)
    if arguments.poses is not None:
        answer_format(arguments)  # an error comes before the work
        solver = make_solver(robot, arguments)
        return solve_file(solver, request, arguments, angles)
    if arguments.pose is not None:
        target = read_target(robot, arguments, angles)
    else:
        target = robot.fk(angles.read_joints("--from-q", arguments.from_q, robot))
    solver = make_solver(robot, arguments)
    if arguments.all:
        return run_all(solver, target, request, arguments, angles)

    def solve() -> Result:
        return solver.solve(target, **request)

    # The first call also fetches the database into the caches: time the second.
    solve()
    start = time.perf_counter()
    result = solve()
    time_us = (time.perf_counter() - start) * 1e6

    report = {
        "robot": robot.name,
        "preset": arguments.preset,
        "joint_names": robot.joint_names,
        "target": target,
        "success": result.success,
        "status": result.status.name,
        "proof": result.proof.name,
        "angle_unit": angles.unit,
        "q": angles.show_optional(robot, result.q),
        "position_error": result.position_error,
        "rotation_error": result.rotation_error,
        "move": result.move,
        "cost": result.cost,
        "attempts": result.attempts,
        "iterations": result.iterations,
        "time_us": time_us,
    }
    diagnosis = None
    if arguments.diagnose and not result.success:
        diagnosis = solver.diagnose(target)
        report["diagnosis"] = diagnosis_report(robot, diagnosis, angles)
    if arguments.json:
        print_json(report)
    else:
        print_text(robot, result, report)
        if diagnosis is not None:
            print_diagnosis(robot, diagnosis)
    print_hint(solver, result)
    return EXIT_SOLVED if result.success else EXIT_NO_SOLUTION


def make_solver(robot: Robot, arguments: argparse.Namespace) -> Solver:
    """The solver that the flags describe.

    Raises:
        InvalidArgumentError: A value out of range.
        DatabaseError: --database FILE cannot be used.
    """
    options = solver_options(arguments)
    return Solver(robot, options, given_database(arguments))


def print_hint(solver: Solver, result: Result) -> None:
    """If nothing else explains it, say which tasks suit an arm with few joints."""
    if solver.task_hint and result.status == Status.not_converged:
        print(f"iksel: hint: {solver.task_hint}", file=sys.stderr)


def run_all(
    solver: Solver,
    target: FloatArray,
    request: dict[str, Any],
    arguments: Any,
    angles: Angles,
) -> int:
    """Find every distinct solution and print them."""
    robot = solver.robot
    start = time.perf_counter()
    found = solver.solve_all(target, **request)
    report = {
        "robot": robot.name,
        "preset": arguments.preset,
        "joint_names": robot.joint_names,
        "target": target,
        "success": found.success,
        "status": found.status.name,
        "proof": found.proof.name,
        "angle_unit": angles.unit,
        "q": angles.show(robot, found.q),
        "position_error": found.position_error,
        "rotation_error": found.rotation_error,
        "move": found.move,
        "cost": found.cost,
        "attempts": found.attempts,
        "iterations": found.iterations,
        "time_us": (time.perf_counter() - start) * 1e6,
    }
    if arguments.json:
        print_json(report)
    else:
        print_pairs(
            [
                ("robot", chain_text(robot)),
                *target_rows(robot, target),
                ("status", found.status.name),
                ("solutions", str(len(found))),
                *proof_row(found),
            ]
        )
        if found.success:
            print()
            print_configurations(robot, found.q, angles)
    return EXIT_SOLVED if found.success else EXIT_NO_SOLUTION
