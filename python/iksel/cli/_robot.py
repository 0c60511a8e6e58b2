# SPDX-License-Identifier: BSD-3-Clause
"""The ROBOT argument: a built-in name, or a URDF file with its links."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import (
    InvalidArgumentError,
    LinkTree,
    Robot,
    UnknownNameError,
    UrdfError,
)

from iksel._manifest import urdf_text
from iksel._urdf_xml import read_xml
from iksel.cli._angles import Angles, add_degrees
from iksel.cli._output import add_json
from iksel.cli._parser import POSE_METAVAR, parse_numbers
from iksel.robots import load_robot, robot_info, robot_names

if TYPE_CHECKING:
    import argparse

    from iksel._arrays import FloatArray

URDF_SUFFIXES = (".urdf", ".xml", ".xacro")

EVERY_TURN = (np.array([-np.inf]), np.array([np.inf]))
"""Limits of a joint that can have any value."""

# What errors call by the name of the argument in Python.
_FLAGS = {
    "default_limits": "--default-limits LOWER UPPER",
    "locked_joints": "--lock JOINT=VALUE",
}


def add_robot(parser: argparse.ArgumentParser) -> None:
    """Add ROBOT and the flags that change it."""
    parser.add_argument(
        "robot",
        metavar="ROBOT",
        help="a built-in robot (see 'iksel robots') or the path of a URDF file",
    )
    group = parser.add_argument_group("robot")
    group.add_argument(
        "--base",
        metavar="LINK",
        help="link that poses are relative to (default: a file's root link)",
    )
    group.add_argument(
        "--tip",
        metavar="LINK",
        help="link whose pose is meant (default: a file's only end link)",
    )
    group.add_argument(
        "--tcp",
        nargs="+",
        metavar=POSE_METAVAR,
        help="tool in the tip link's frame, written as for 'solve --pose', or 'none' "
        "(default: a built-in robot's own, else none)",
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
    add_degrees(group)


def add_joint_values(parser: argparse.ArgumentParser) -> None:
    """Add ROBOT, Q ..., and the forms in which what is there is shown."""
    add_robot(parser)
    parser.add_argument(
        "q", nargs="+", metavar="Q", help="joint values, one per joint [rad or m]"
    )
    form = parser.add_mutually_exclusive_group()
    add_json(form)
    form.add_argument(
        "--matrix", action="store_true", help="print the numbers of the matrix only"
    )


def load(arguments: argparse.Namespace) -> Robot:
    """The robot that the arguments of add_robot describe.

    Raises:
        UnknownNameError: Neither a built-in robot nor a file, or no such link or joint.
        UrdfError: The file cannot be read or used.
        InvalidArgumentError: A tool or locked joint that makes no sense.
    """
    angles = Angles(arguments)
    settings: dict[str, Any] = {
        "base_link": arguments.base,
        "tip_link": arguments.tip,
        "soft_limits": arguments.soft_limits,
    }
    if arguments.lock:
        settings["locked_joints"] = _locked_joints(arguments, angles)
    if arguments.default_limits is not None:
        flag = "--default-limits"
        limits = parse_numbers(flag, arguments.default_limits)
        # No warning: limits may be of any number of turns.
        settings["default_limits"] = angles.read(flag, limits, EVERY_TURN)
    if arguments.tcp is not None:
        none = arguments.tcp == ["none"]
        settings["tcp"] = None if none else angles.read_pose("--tcp", arguments.tcp)
    name = arguments.robot
    try:
        if is_built_in(name):
            return load_robot(name, **settings)
        return Robot.from_urdf(_urdf_path(name), **settings)
    except UnknownNameError as error:
        if str(error).endswith(" more"):
            message = f"{error} ('iksel info {name} --tree' shows all)"
            raise UnknownNameError(message) from None
        raise
    except UrdfError as error:
        message = str(error)
        tree = {"LinkTree": f"'iksel info {name} --tree'"}
        for argument, flag in (_FLAGS | tree).items():
            message = message.replace(argument, flag)
        if error.available:
            message += "; choose one by --tip"
        raise UrdfError(message) from None


def load_tree(arguments: argparse.Namespace) -> LinkTree:
    """The tree of all links of the robot.

    Raises:
        UnknownNameError: Neither a built-in robot nor a file.
        UrdfError: The file cannot be read or used.
    """
    name = arguments.robot
    if is_built_in(name):
        return LinkTree.from_urdf(urdf_text(robot_info(name)))
    return LinkTree.from_urdf(_urdf_path(name))


def is_built_in(name: str) -> bool:
    """Whether a ROBOT argument is the name of a built-in robot."""
    return name in robot_names()


def _urdf_path(name: str) -> Path:
    """The path that a ROBOT argument is, if it does not look like a mistyped name."""
    path = Path(name)
    if os.sep in name or path.suffix in URDF_SUFFIXES or path.exists():
        return path
    try:
        robot_info(name)
    except UnknownNameError as error:
        raise UnknownNameError(f"{error}; or give the path of a URDF file") from None
    return path


def _locked_joints(arguments: argparse.Namespace, angles: Angles) -> dict[str, float]:
    """Names and values of all --lock [rad or m]."""
    locked = dict(map(_lock, arguments.lock))
    slides = {
        joint.name for joint in load_tree(arguments).joints if joint.type == "prismatic"
    }
    limits = _joint_limits(arguments.robot)
    return {
        name: value
        if name in slides
        else angles.read(f"--lock {name}", [value], limits.get(name, EVERY_TURN))[0]
        for name, value in locked.items()
    }


def _joint_limits(name: str) -> dict[str, tuple[FloatArray, FloatArray]]:
    """Limits [rad] of the revolute joints of a URDF that states them, by joint."""
    source = urdf_text(robot_info(name)) if is_built_in(name) else _urdf_path(name)
    try:
        root = read_xml("robot", source)[0]
    except UrdfError:  # such as comments in Latin-1, which URDF's own reader takes
        return {}
    limits = {}
    for joint in root.iter("joint"):
        limit = joint.find("limit")
        if joint.get("type") != "revolute" or limit is None:
            continue
        try:
            ends = [float(limit.get(end, "nan")) for end in ("lower", "upper")]
        except ValueError:
            continue
        if ends[0] < ends[1]:
            lower, upper = np.array(ends)[:, None]
            limits[joint.get("name", "")] = (lower, upper)
    return limits


def _lock(text: str) -> tuple[str, float]:
    """Name and value of one --lock."""
    joint, equals, value = text.rpartition("=")
    numbers = parse_numbers(f"--lock {text}", [value]) if equals else []
    if not joint or len(numbers) != 1:
        raise InvalidArgumentError(f"--lock: expected JOINT=VALUE, got {text!r}")
    return joint, numbers[0]
