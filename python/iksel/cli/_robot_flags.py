# SPDX-License-Identifier: BSD-3-Clause
"""The ROBOT argument and its flags: a built-in name, or a file with its links."""

from __future__ import annotations

from typing import TYPE_CHECKING

from iksel.cli import _curves
from iksel.cli._angles import add_degrees, add_order
from iksel.cli._coupled import FLAG, FORM
from iksel.cli._parser import POSE_METAVAR

if TYPE_CHECKING:
    import argparse


def add_robot(parser: argparse.ArgumentParser) -> None:
    """Add ROBOT and the flags that change it."""
    parser.add_argument(
        "robot",
        metavar="ROBOT",
        help="a built-in robot (see 'iksel robots'), the path of a URDF, xacro or MJCF "
        "file, or a name of robot_descriptions, as rd:panda_description",
    )
    group = parser.add_argument_group("robot")
    group.add_argument(
        "--base",
        metavar="LINK",
        help="link that poses are relative to (default: a file's root link)",
    )
    group.add_argument(
        "--tip",
        action="append",
        default=[],
        metavar="LINK",
        help="link whose pose is meant (default: a file's only end link); several "
        "times: the tips of one robot, as the hands of a torso with two arms",
    )
    group.add_argument(
        "--tcp",
        nargs="+",
        action="append",
        default=[],
        metavar=POSE_METAVAR,
        help="tool in the tip link's frame, written as for 'solve --pose', or 'none' "
        "(default: a built-in robot's own, else none); once for each --tip",
    )
    group.add_argument(
        "--lock",
        action="append",
        default=[],
        metavar="JOINT=VALUE",
        help="hold a joint at a value [rad or m]; may be repeated",
    )
    group.add_argument(
        "--soft-limits",
        action="store_true",
        help="narrow the joint limits to the URDF's soft limits",
    )
    group.add_argument(
        "--default-limits",
        nargs=2,
        metavar=("LOWER", "UPPER"),
        help="limits of joints whose limits the URDF leaves out or has as 0, 0 [rad or "
        "m]; without, such a joint is an error",
    )
    group.add_argument(
        FLAG,
        action="append",
        default=[],
        metavar="LIMIT",
        help=f"limit of a sum of joint values [rad or m], {FORM}; joints may have "
        "coefficients, as 0.5 JOINT, and one end may be left out; may be repeated",
    )
    group.add_argument(
        _curves.FLAG,
        action="append",
        default=[],
        metavar=_curves.FORM,
        help="JOINT follows SOURCE by the curve through the file's points, in lines of "
        "SOURCE's value, JOINT's [rad or m] and, if known, the slope, separated by "
        "commas; in the place of the URDF's mimic tag; may be repeated",
    )
    _add_formats(group)
    add_degrees(group)
    add_order(group)


def _add_formats(group: argparse._ArgumentGroup) -> None:
    """Add what other files than the robot's own say of it."""
    group.add_argument(
        "--srdf",
        metavar="FILE",
        help="SRDF with the groups of --group, and with named states, which --near, "
        "--start and --from-q take in the place of numbers",
    )
    group.add_argument(
        "--group",
        metavar="NAME",
        help="group of the SRDF that gives base and tip (default: its only one)",
    )
    group.add_argument(
        "--xacro-arg",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="value of an argument of a xacro file; may be repeated",
    )
    group.add_argument(
        "--package",
        action="append",
        default=[],
        metavar="NAME=FOLDER",
        help="folder of a ROS package that a xacro file names (default: looked for "
        "around the file, in $ROS_PACKAGE_PATH and $AMENT_PREFIX_PATH); may be "
        "repeated",
    )
    group.add_argument(
        "--trust",
        action="store_true",
        help="let a xacro file run whatever Python its expressions contain (default: "
        "only arithmetic and the like; see 'Files from strangers' in the manual)",
    )
