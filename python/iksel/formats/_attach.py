# SPDX-License-Identifier: BSD-3-Clause
"""One URDF of two: an arm beside another, on a rail, or in front of a turntable."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING

import numpy as np
from iksel_cpp import InvalidArgumentError, LinkTree, UnknownNameError

from iksel.description import Source, read_description
from iksel.formats._urdf_xml import read_xml
from iksel.pose import check_pose, euler_from_pose

if TYPE_CHECKING:
    from iksel.formats._packages import Packages
    from iksel.pose import PoseLike

_KEPT = {"link", "joint", "material"}


def attach(
    parent: Source,
    child: Source,
    *,
    at: str | None = None,
    pose: PoseLike | None = None,
    prefixes: tuple[str, str] = ("", ""),
    packages: Packages | None = None,
    trusted: bool = False,
) -> str:
    """Fix a robot to a link of another: two arms on a stand, an arm on a rail.

    Two arms, to be solved from tool to tool::

        urdf = attach("panda", "panda", pose=T_left_right, prefixes=("left_", "right_"))
        robot = Robot.from_urdf(urdf, base_link="left_panda_link8", ...)

    Args:
        parent: What Robot loads: the name of a built-in robot; the path of a URDF,
            xacro or MJCF file; a name of robot_descriptions; or URDF text.
        child: The same; its root link is fixed to the parent.
        at: The parent's link, without the prefix; None: its root link.
        pose: T_at_root, where the child's root link is, (4, 4) [m]; None: at the link.
        prefixes: Of the names of the parent's links and joints, and of the child's.
        packages: Folders of ROS packages that xacro's $(find ...) names.
        trusted: Whether a xacro file may run whatever Python it contains.

    Returns:
        URDF text of both: links, joints and materials, with paths of meshes that were
        relative made absolute. What else the files hold is left out.

    Raises:
        UrdfError: A description cannot be read.
        UnknownNameError: The parent has no link of that name.
        InvalidArgumentError: Both have a link or a joint of the same name; or the pose
            is not rigid.
    """
    whole, root = _read(parent, prefixes[0], packages, trusted=trusted)
    part, part_root = _read(child, prefixes[1], packages, trusted=trusted)
    links = _names(whole, "link")
    link = root if at is None else prefixes[0] + at
    if link not in links:
        error = UnknownNameError(
            f"at: the parent has no link {at!r}; it has {', '.join(sorted(links))}"
        )
        error.available = tuple(sorted(links))
        raise error
    for kind in ("link", "joint"):
        shared = _names(whole, kind) & _names(part, kind)
        if shared:
            raise InvalidArgumentError(
                f"prefixes: both descriptions have {kind}s named "
                f"{', '.join(sorted(shared))}; give prefixes=('left_', 'right_')"
            )
    materials = _names(whole, "material")
    whole.extend(
        e
        for e in part
        if (e.tag, e.get("name")) not in {("material", name) for name in materials}
    )
    mount = f"{part_root}_mount"
    while mount in _names(whole, "joint"):
        mount += "_"
    joint = ET.SubElement(whole, "joint", name=mount, type="fixed")
    ET.SubElement(joint, "parent", link=link)
    ET.SubElement(joint, "child", link=part_root)
    origin = np.eye(4) if pose is None else check_pose(pose)
    ET.SubElement(
        joint,
        "origin",
        xyz=_words(origin[:3, 3]),
        rpy=_words(euler_from_pose(origin)),
    )
    return ET.tostring(whole, encoding="unicode")


def _words(numbers: np.ndarray) -> str:
    return " ".join(repr(float(x)) for x in numbers)


def _names(robot: ET.Element, kind: str) -> set[str]:
    return {element.get("name", "") for element in robot.findall(kind)}


def _read(
    source: Source, prefix: str, packages: Packages | None, *, trusted: bool
) -> tuple[ET.Element, str]:
    """The robot's links, joints and materials by their new names, and its root link."""
    read = read_description(source, packages=packages, trusted=trusted)
    root = prefix + LinkTree.from_urdf(read.urdf).links[0]
    robot = read_xml("urdf", read.urdf)[0]
    for element in list(robot):
        if element.tag not in _KEPT:
            robot.remove(element)
    for element in robot:
        if element.tag == "material":
            continue
        element.set("name", prefix + element.get("name", ""))
        for end in ("parent", "child"):
            for inner in element.findall(end):
                inner.set("link", prefix + inner.get("link", ""))
        for inner in element.findall("mimic"):
            inner.set("joint", prefix + inner.get("joint", ""))
        for mesh in element.iter("mesh"):
            name = mesh.get("filename", "")
            if name and not re.match(r"[\w+.-]+://", name):
                mesh.set("filename", str((read.folder / name).absolute()))
    return robot, root
