# SPDX-License-Identifier: BSD-3-Clause
"""The robots of the benchmarks, as every solver is given them."""

from __future__ import annotations

import copy
import functools
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from typing import TYPE_CHECKING

import iksel
from bench.chain import Chain, chain_from_urdf, chain_joints

if TYPE_CHECKING:
    from collections.abc import Iterable

PAPER_ARMS = {"cvr038": "C0", "cvrb1213": "C1", "ur3_wrs": "UR3", "irb14050": "IRB"}
"""The paper's robots with the names of its tables."""

RIVAL_ARMS = (*PAPER_ARMS, "panda", "iiwa14")
"""The robots that all solvers are compared on."""

TCP_LINK = "bench_tcp"


@dataclass(frozen=True)
class Arm:
    """One robot: IKSel's, the judge's, and a URDF of just its chain for the rivals."""

    name: str
    robot: iksel.Robot
    chain: Chain
    urdf: str
    """The chain from base_link to TCP_LINK only, the tool included."""
    base_link: str
    tip_link: str = TCP_LINK


@functools.cache
def load_arm(name: str) -> Arm:
    """A built-in robot by name, with the manifest's tool."""
    robot = iksel.load_robot(name)
    chain = chain_from_urdf(robot.urdf, robot.base_link, robot.tip_link, robot.tcp)
    return Arm(name, robot, chain, chain_urdf(robot), robot.base_link)


def chain_urdf(robot: iksel.Robot) -> str:
    """A URDF that has only the joints from base to tip, and the tool as a last link.

    Rivals parse whole files; what is not on the chain would be theirs to ignore.
    """
    root = ET.Element("robot", name=robot.name)
    ET.SubElement(root, "link", name=robot.base_link)
    for joint in chain_joints(robot.urdf, robot.base_link, robot.tip_link):
        child = joint.find("child")
        assert child is not None
        ET.SubElement(root, "link", name=child.attrib["link"])
        # pytracik reads a safety_controller as limits of 0; the others leave it alone.
        moving = copy.deepcopy(joint)
        for controller in moving.findall("safety_controller"):
            moving.remove(controller)
        root.append(moving)
    ET.SubElement(root, "link", name=TCP_LINK)
    tool = ET.SubElement(root, "joint", name="bench_tcp_joint", type="fixed")
    ET.SubElement(tool, "parent", link=robot.tip_link)
    ET.SubElement(tool, "child", link=TCP_LINK)
    ET.SubElement(
        tool,
        "origin",
        xyz=_words(robot.tcp[:3, 3]),
        rpy=_words(iksel.euler_from_pose(robot.tcp)),
    )
    return ET.tostring(root, encoding="unicode")


def _words(values: Iterable[float]) -> str:
    return " ".join(repr(float(value)) for value in values)
