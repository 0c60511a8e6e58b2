# SPDX-License-Identifier: BSD-3-Clause
"""What iksel solve asks for: the target, and what is wished besides."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import InvalidArgumentError

from iksel.cli._lengths import warn_of_millimetres

if TYPE_CHECKING:
    import argparse

    from iksel_cpp import Robot

    from iksel._base.arrays import FloatArray
    from iksel.cli._angles import Angles


def add_request(parser: argparse.ArgumentParser) -> None:
    """Add what may be asked besides the pose."""
    parser.add_argument(
        "--seed-q",
        nargs="+",
        metavar="Q",
        help="joint values to try as a seed before the database's [rad or m]",
    )
    parser.add_argument(
        "--no-database-seeds",
        action="store_true",
        help="try no seeds but those of --seed-q and --near",
    )
    parser.add_argument(
        "--near",
        nargs="+",
        metavar="Q",
        help="joint values to stay near [rad or m], or the name of a state of --srdf: "
        "gives the solution with the smallest joint move",
    )
    parser.add_argument(
        "--all",
        action="store_true",
        help="give every distinct solution, nearest first (with --near: to that, else "
        "to the middle of the limits), or with --objective the best by that",
    )
    parser.add_argument(
        "--objective",
        choices=("limits", "manipulability"),
        help="of all answers found, the one farthest from the limits, or the most "
        "manipulable; a redundant arm is moved there along its self-motion",
    )
    parser.add_argument(
        "--closest",
        action="store_true",
        help="if there is no solution, give the configuration inside the limits that "
        "is nearest to one, with status closest; a radian counts reach / 4",
    )
    parser.add_argument(
        "--prove",
        action="store_true",
        help="prove that there is no solution even where that takes longer than to "
        "find none: of six joints that are swept, some 20 us",
    )
    parser.add_argument(
        "--diagnose",
        action="store_true",
        help="if there is no solution, search for the reason, and print it with the "
        "best effort",
    )


def read_target(
    robot: Robot, arguments: argparse.Namespace, angles: Angles
) -> FloatArray:
    """T_base_tip of the one tip, (4, 4), or of each, (k, 4, 4).

    Raises:
        InvalidArgumentError: A bad pose, or not one for each tip.
    """
    poses = [angles.read_pose("--pose", pose) for pose in arguments.pose]
    if len(poses) != robot.tips:
        raise InvalidArgumentError(
            f"--pose: given {len(poses)} times; expected once for each of "
            f"{', '.join(robot.tip_links)}"
        )
    target = np.stack(poses) if robot.tips > 1 else poses[0]
    warn_of_millimetres(robot, "--pose", target)
    return target


def read_request(
    robot: Robot, arguments: argparse.Namespace, angles: Angles
) -> dict[str, Any]:
    """What is asked besides the pose, as keywords of Solver.solve().

    Raises:
        InvalidArgumentError: Bad joint values, or flags that do not go together.
    """
    near = arguments.near and angles.read_joints("--near", arguments.near, robot)
    seed = arguments.seed_q and angles.read_joints("--seed-q", arguments.seed_q, robot)
    if arguments.closest and arguments.all:
        raise InvalidArgumentError("--closest: cannot be used with --all")
    given = {
        "near": near,
        "seeds": seed,
        "objective": arguments.objective,
        "closest": arguments.closest,
        "prove": arguments.prove,
    }
    request: dict[str, Any] = {name: value for name, value in given.items() if value}
    if arguments.no_database_seeds:
        if not (near or seed):
            raise InvalidArgumentError(
                "--no-database-seeds: leaves nothing to try without --seed-q or --near"
            )
        request["database_seeds"] = False
    return request
