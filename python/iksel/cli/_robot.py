# SPDX-License-Identifier: BSD-3-Clause
"""The ROBOT argument: a built-in name, or a file with its links."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import (
    InvalidArgumentError,
    UnknownNameError,
    UrdfError,
)

from iksel._urdf_xml import read_xml
from iksel.cli import _curves
from iksel.cli._angles import Angles, add_degrees, add_order
from iksel.cli._coupled import FLAG, FORM, parse_coupled_limit
from iksel.cli._parser import POSE_METAVAR, parse_numbers
from iksel.description import read_description
from iksel.robots import load_robot, robot_names
from iksel.robots import load_tree as load_tree_of

if TYPE_CHECKING:
    import argparse

    from iksel_cpp import CoupledLimit, LinkTree, Robot

    from iksel._arrays import FloatArray

EVERY_TURN = (np.array([-np.inf]), np.array([np.inf]))
"""Limits of a joint that can have any value."""

# What errors call by the name of the argument in Python.
_FLAGS = {
    "default_limits": "--default-limits LOWER UPPER",
    "coupled_limits": FLAG,
    "mimic_curves": _curves.FLAG,
    "locked_joints": "--lock JOINT=VALUE",
    "xacro_args": "--xacro-arg NAME=VALUE",
    "packages: ": "--package NAME=FOLDER: ",
    "trusted=True": "--trust",
    "tip_link: ": "--tip: ",
    "(group)": "(--group)",
}


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


def chain_text(robot: Robot) -> str:
    """A robot's name, and the links that its chains join."""
    return f"{robot.name}, {robot.base_link} -> {', '.join(robot.tip_links)}"


def load(arguments: argparse.Namespace) -> Robot:
    """The robot that the arguments of add_robot describe.

    Raises:
        UnknownNameError: Neither a built-in robot nor a file, or no such link or joint.
        UrdfError: The file cannot be read or used.
        InvalidArgumentError: A tool, locked joint, coupled limit or curve that makes
            no sense.
    """
    angles = Angles(arguments)
    settings: dict[str, Any] = {
        "base_link": arguments.base,
        **_tips(arguments, angles),
        "soft_limits": arguments.soft_limits,
        "srdf": arguments.srdf,
        "group": arguments.group,
        **of_files(arguments),
    }
    if arguments.lock:
        settings["locked_joints"] = _locked_joints(arguments, angles)
    if arguments.default_limits is not None:
        flag = "--default-limits"
        limits = parse_numbers(flag, arguments.default_limits)
        # No warning: limits may be of any number of turns.
        settings["default_limits"] = angles.read(flag, limits, EVERY_TURN)
    if arguments.coupled_limit:
        settings["coupled_limits"] = _coupled_limits(arguments, angles)
    settings["mimic_curves"] = [
        _curves.read_mimic_curve(text) for text in arguments.mimic_curve
    ]
    name = arguments.robot
    try:
        return load_robot(name, **settings)
    except UnknownNameError as error:
        message = _with_flags(str(error), name)
        if message.endswith(" more"):
            message = f"{message} ('iksel info {name} --tree' shows all)"
        raise UnknownNameError(message) from None
    except UrdfError as error:
        message = _with_flags(str(error), name)
        if error.available:
            message += "; choose one by --tip"
        raise UrdfError(message) from None
    except InvalidArgumentError as error:
        raise InvalidArgumentError(_with_flags(str(error), name)) from None


def _tips(arguments: argparse.Namespace, angles: Angles) -> dict[str, Any]:
    """What all --tip and --tcp give."""
    links, given = arguments.tip, arguments.tcp
    tools = [
        None if tool == ["none"] else angles.read_pose("--tcp", tool) for tool in given
    ]
    if len(tools) not in (0, max(len(links), 1)):
        raise InvalidArgumentError(
            f"--tcp: given {len(tools)} times; expected once for each --tip, or never"
        )
    if len(links) > 1:
        none = np.eye(4)
        each = [none if tool is None else tool for tool in tools]
        return {"tip_links": links, "tcps": np.stack(each) if each else None}
    settings: dict[str, Any] = {"tip_link": links[0] if links else None}
    return settings | ({"tcp": tools[0]} if tools else {})


def load_tree(arguments: argparse.Namespace) -> LinkTree:
    """The tree of all links of the robot.

    Raises:
        UnknownNameError: Neither a built-in robot nor a file.
        UrdfError: The file cannot be read or used.
    """
    name = arguments.robot
    try:
        return load_tree_of(
            name,
            link=arguments.base or next(iter(arguments.tip), None),
            **of_files(arguments),
        )
    except (UnknownNameError, UrdfError) as error:
        raise type(error)(_with_flags(str(error), name)) from None


def default_tip(arguments: argparse.Namespace) -> str | None:
    """The link that the robot's format makes the tip where several could be."""
    return read_description(arguments.robot, **of_files(arguments)).tip_link


def is_built_in(name: str) -> bool:
    """Whether a ROBOT argument is the name of a built-in robot."""
    return name in robot_names()


def _with_flags(message: str, name: str) -> str:
    """A message that names flags rather than arguments of Python."""
    tree = {"LinkTree": f"'iksel info {name} --tree'"}
    for argument, flag in (_FLAGS | tree).items():
        message = message.replace(argument, flag)
    return message


def of_files(arguments: argparse.Namespace) -> dict[str, Any]:
    """What --xacro-arg, --package and --trust give."""
    flags = {
        "xacro_args": ("--xacro-arg", "NAME=VALUE", arguments.xacro_arg),
        "packages": ("--package", "NAME=FOLDER", arguments.package),
    }
    pairs = {
        argument: dict(_pair(flag, form, text) for text in texts)
        for argument, (flag, form, texts) in flags.items()
    }
    return {**pairs, "trusted": arguments.trust}


def _pair(flag: str, form: str, text: str) -> tuple[str, str]:
    """Name and value of one NAME=VALUE."""
    name, equals, value = text.partition("=")
    if not (name and equals):
        raise InvalidArgumentError(f"{flag}: expected {form}, got {text!r}")
    return name, value


def _locked_joints(arguments: argparse.Namespace, angles: Angles) -> dict[str, float]:
    """Names and values of all --lock [rad or m]."""
    locked = dict(map(_lock, arguments.lock))
    slides = _slides(arguments)
    limits = _joint_limits(arguments)
    return {
        name: value
        if name in slides
        else angles.read(f"--lock {name}", [value], limits.get(name, EVERY_TURN))[0]
        for name, value in locked.items()
    }


def _slides(arguments: argparse.Namespace) -> set[str]:
    """Names of the prismatic joints."""
    joints = load_tree(arguments).joints
    return {joint.name for joint in joints if joint.type == "prismatic"}


def _coupled_limits(
    arguments: argparse.Namespace, angles: Angles
) -> list[CoupledLimit]:
    """Those of all --coupled-limit [rad or m]."""
    slides = _slides(arguments)

    def read_end(joints: list[str], value: float) -> float:
        if slides.intersection(joints):
            return value
        # No warning: a sum may be of any number of turns.
        return float(angles.read(FLAG, [value], EVERY_TURN)[0])

    return [parse_coupled_limit(text, read_end) for text in arguments.coupled_limit]


def _joint_limits(
    arguments: argparse.Namespace,
) -> dict[str, tuple[FloatArray, FloatArray]]:
    """Limits [rad] of the revolute joints of a robot that states them, by joint."""
    read = read_description(arguments.robot, **of_files(arguments))
    try:
        root = read_xml("robot", read.urdf)[0]
    except UrdfError:  # as whoever loads the robot will say
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
