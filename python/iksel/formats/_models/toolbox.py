# SPDX-License-Identifier: BSD-3-Clause
"""Robots of the Robotics Toolbox: DHRobot, ERobot and Robot."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import UrdfError

from iksel.formats._models import Model
from iksel.formats._urdf_writer import UrdfWriter

if TYPE_CHECKING:
    from iksel._base.arrays import FloatArray

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def read(robot: Any) -> Model:
    """The URDF of a robot: its links by their names, its base and its tool.

    The root link is `world`, in which the robot's base is placed. The tip link is
    where the toolbox's own forward kinematics end: the last link, or that of the
    gripper, and with a tool the link `tool` behind it. Joints have the names that a
    URDF gave them, or those of the links that they carry.
    """
    grippers = list(getattr(robot, "grippers", ()))
    links = list(robot.links)
    for gripper in grippers:
        links += [link for link in gripper.links if link not in links]
    writer = UrdfWriter(str(robot.name), "world")
    base = "base"
    while base in {str(link.name) for link in links}:
        base += "'"
    writer.add_fixed("world", base, _matrix(robot.base))
    is_serial = any(c.__name__ == "DHRobot" for c in type(robot).__mro__)
    names: dict[int, str] = {}
    previous = base
    for link in links:
        above = link.parent
        parent = previous if is_serial else base if above is None else names[id(above)]
        previous = names[id(link)] = _add(writer, parent, link)
    ends = [(gripper.links[0], gripper.tool) for gripper in grippers] or [
        (link, robot.tool) for link in (links[-1:] if is_serial else robot.ee_links)
    ]
    if len(ends) > 1:
        return Model(writer.text())
    ((last, tool),) = ends
    tip = names[id(last)]
    if not np.array_equal(_matrix(tool), np.eye(4)):
        tip = writer.free_link("tool")
        writer.add_fixed(names[id(last)], tip, _matrix(tool))
    return Model(writer.text(), tip)


def _add(writer: UrdfWriter, parent: str, link: Any) -> str:
    """Add a link and its joint; gives its name in the URDF."""
    name = writer.free_link(str(link.name))
    before, after = np.eye(4), np.eye(4)
    joint = None
    for part in link.ets:
        if part.isjoint:
            if joint is not None:
                raise UrdfError(f"link {link.name!r} has several joints: split it")
            joint = part
        elif joint is None:
            before = before @ part.A()
        else:
            after = after @ part.A()
    if joint is None:
        writer.add_fixed(parent, name, before)
        return name
    is_last = np.array_equal(after, np.eye(4))
    child = name if is_last else writer.free_link(f"{name}/joint")
    sign = -1.0 if joint.isflip else 1.0
    word = str(getattr(joint, "kind", None) or joint.axis)  # "Rx", "tz"; older: axis
    axis = sign * np.array(_AXES[word[-1].lower()])
    qlim = link.qlim
    limits = None if qlim is None else (float(qlim[0]), float(qlim[1]))
    writer.add_joint(
        writer.free_joint(str(getattr(link, "_joint_name", None) or link.name)),
        "prismatic" if joint.istranslation else "revolute",
        parent,
        child,
        before,
        axis=axis,
        limits=limits,
    )
    if not is_last:
        writer.add_fixed(child, name, after)
    return name


def _matrix(transform: Any) -> FloatArray:
    """(4, 4) of an SE3, or of the array that it may be."""
    matrix: FloatArray = np.asarray(getattr(transform, "A", transform), dtype=float)
    return matrix
