# SPDX-License-Identifier: BSD-3-Clause
"""iksel info: one robot's chain, joints and limits."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from iksel.cli._output import (
    add_json,
    number,
    numbers,
    print_json,
    print_pairs,
    print_table,
)
from iksel.cli._robot import add_robot, is_built_in, load
from iksel.pose import euler_from_pose
from iksel.robots import robot_info

if TYPE_CHECKING:
    import argparse

    from iksel_cpp import Robot

    from iksel._arrays import FloatArray

EXAMPLES = """\
examples:
  iksel info ur3
  iksel info panda --tip panda_link7 --json
  iksel info arm.urdf --base base_link --tip tool0 --lock wrist=0.5
"""

LIMIT_FIELDS = ("lower", "upper", "soft_lower", "soft_upper", "velocity_limit")
SOURCE_FIELDS = ("maker", "licence", "source", "note")


def add_parser(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser(
        "info",
        usage="iksel info ROBOT [options]",
        help="show a robot's joints, limits and reach",
        description="Show a robot's links, tool, reach, joints and their limits.",
        epilog=EXAMPLES,
    )
    add_robot(parser)
    add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Show the robot."""
    robot = load(arguments)
    reach = f"{number(robot.reach, 4)} m around {_point(robot.reach_centre)}"
    origin = {}
    if is_built_in(arguments.robot):
        info = robot_info(arguments.robot)
        origin = {field: getattr(info, field) for field in SOURCE_FIELDS}
    if arguments.json:
        print_json(as_dict(robot) | origin)
        return 0
    print_pairs(
        [
            ("robot", f"{robot.name}, {robot.dof} degrees of freedom"),
            ("chain", f"{robot.base_link} -> {robot.tip_link}"),
            ("tcp", pose_text(robot.tcp)),
            ("reach", reach),
            ("chain hash", f"{robot.chain_hash:016x}"),
            *((field, text) for field, text in origin.items() if text),
        ]
    )
    print()
    print_table(("joint", "type", "lower", "upper", "velocity", "unit"), _rows(robot))
    return 0


def as_dict(robot: Robot) -> dict[str, Any]:
    """All about a robot as plain data and arrays [rad, m]."""
    columns = zip(
        robot.joint_names,
        (kind.name for kind in robot.joint_types),
        *(array.tolist() for array in _limits(robot)),
        strict=True,
    )
    names = ("name", "type", *LIMIT_FIELDS)
    return {
        "name": robot.name,
        "base_link": robot.base_link,
        "tip_link": robot.tip_link,
        "dof": robot.dof,
        "tcp": robot.tcp,
        "reach": robot.reach,
        "reach_centre": robot.reach_centre,
        "chain_hash": f"{robot.chain_hash:016x}",
        "joints": [dict(zip(names, joint, strict=True)) for joint in columns],
    }


def pose_text(pose: FloatArray) -> str:
    """A pose in words: position and roll, pitch, yaw."""
    if np.array_equal(pose, np.eye(4)):
        return "none"
    rpy = euler_from_pose(pose)
    return (
        f"xyz {numbers(pose[:3, 3])} m\n"
        f"rpy {numbers(rpy)} rad ({numbers(np.degrees(rpy), 3)} deg)"
    )


def _limits(robot: Robot) -> list[FloatArray]:
    return [getattr(robot, field) for field in LIMIT_FIELDS]


def _rows(robot: Robot) -> list[tuple[str, ...]]:
    """One row per joint, angles in degrees."""
    rows = []
    for i, (name, kind) in enumerate(
        zip(robot.joint_names, robot.joint_types, strict=True)
    ):
        slides = kind.name == "prismatic"
        values = (robot.lower[i], robot.upper[i], robot.velocity_limit[i])
        texts = [number(v if slides else math.degrees(v), 3) for v in values]
        rows.append((name, kind.name, *texts, "m, m/s" if slides else "deg, deg/s"))
    return rows


def _point(position: FloatArray) -> str:
    return f"({', '.join(number(x, 4) for x in position)})"
