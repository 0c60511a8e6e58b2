# SPDX-License-Identifier: BSD-3-Clause
"""iksel robots: the built-in robots."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from iksel.cli._angles import Angles, add_degrees
from iksel.cli._output import add_json, print_json, print_table
from iksel.robots import load_robot, robot_info, robot_names

if TYPE_CHECKING:
    import argparse

    from iksel_cpp import Robot

EXAMPLES = """\
examples:
  iksel robots
  iksel robots --json
"""


def add_parser(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser(
        "robots",
        help="list the built-in robots",
        description="List the built-in robots with their joint limits (deg; m for "
        "sliding joints; --json: rad, or deg with --degrees).",
        epilog=EXAMPLES,
    )
    add_json(parser)
    add_degrees(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """List the robots."""
    angles = Angles(arguments)
    robots = [(robot_info(name), load_robot(name)) for name in robot_names()]
    if arguments.json:
        print_json(
            {
                "angle_unit": angles.unit,
                "robots": [
                    {
                        **asdict(info),
                        "lower": angles.show(robot, robot.lower),
                        "upper": angles.show(robot, robot.upper),
                    }
                    for info, robot in robots
                ],
            }
        )
        return 0
    print_table(
        ("name", "dof", "maker", "licence", "limits [deg; m for sliding joints]"),
        [
            (info.name, str(info.dof), info.maker, info.licence, limits_text(robot))
            for info, robot in robots
        ],
    )
    return 0


def limits_text(robot: Robot) -> str:
    """The joint limits in short: degrees, or metres for sliding joints."""
    joints = zip(robot.joint_types, robot.lower, robot.upper, strict=True)
    return ", ".join(_range(kind.name, low, high) for kind, low, high in joints)


def _range(kind: str, lower: float, upper: float) -> str:
    if kind == "continuous":
        return "free"
    if kind == "prismatic":
        return f"{lower:.4g}..{upper:.4g} m"
    low, high = math.degrees(lower), math.degrees(upper)
    if math.isclose(low, -high, rel_tol=1e-4):
        return f"±{high:.4g}"
    return f"{low:.4g}..{high:.4g}"
