# SPDX-License-Identifier: BSD-3-Clause
"""The robot that the flags of _robot_flags.py describe."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import (
    InvalidArgumentError,
    UnknownNameError,
    UrdfError,
)

from iksel.cli import _curves
from iksel.cli._angles import Angles
from iksel.cli._coupled import FLAG, parse_coupled_limit
from iksel.cli._parser import parse_numbers
from iksel.description import read_description
from iksel.formats._urdf_xml import read_xml
from iksel.robots import load_robot, robot_names
from iksel.robots import load_tree as load_tree_of

if TYPE_CHECKING:
    import argparse

    from iksel_cpp import CoupledLimit, LinkTree, Robot

    from iksel._base.arrays import FloatArray

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
