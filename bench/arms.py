# SPDX-License-Identifier: BSD-3-Clause
"""The robots of the benchmarks, as every solver is given them."""

from __future__ import annotations

import copy
import functools
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import iksel
from bench.chain import (
    MOVING,
    Chain,
    chain_from_urdf,
    chain_joints,
    joint_origin,
)

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


BENCH_ARMS = {"crx10ia": Path(__file__).with_name("crx10ia.urdf")}
"""Arms of the benchmarks alone, for solvers that take no built-in one."""


@functools.cache
def load_arm(name: str) -> Arm:
    """A built-in robot by name, with the manifest's tool, or one of BENCH_ARMS."""
    file = BENCH_ARMS.get(name)
    robot = iksel.load_robot(name) if file is None else iksel.Robot.from_urdf(file)
    return arm_of(name, robot)


def arm_of(name: str, robot: iksel.Robot) -> Arm:
    """A robot with its judge, and as rivals get it."""
    chain = chain_from_urdf(robot.urdf, robot.base_link, robot.tip_link, robot.tcp)
    return Arm(name, robot, chain, chain_urdf(robot), robot.base_link)


def chain_urdf(robot: iksel.Robot) -> str:
    """A URDF that has only the joints from base to tip, and the tool as a last link.

    Rivals parse whole files; what is not on the chain would be theirs to ignore. All
    that is fixed behind the last joint that moves is one joint: OptIK composes two
    wrongly. There are no safety controllers: pytracik takes them for limits of 0.
    """
    root = ET.Element("robot", name=robot.name)
    ET.SubElement(root, "link", name=robot.base_link)
    joints = chain_joints(robot.urdf, robot.base_link, robot.tip_link)
    tool = robot.tcp
    while joints[-1].attrib["type"] not in MOVING:
        tool = joint_origin(joints.pop()) @ tool
    last = ""
    for joint in map(copy.deepcopy, joints):
        child = joint.find("child")
        assert child is not None
        last = child.attrib["link"]
        for controller in joint.findall("safety_controller"):
            joint.remove(controller)
        ET.SubElement(root, "link", name=last)
        root.append(joint)
    ET.SubElement(root, "link", name=TCP_LINK)
    fixed = ET.SubElement(root, "joint", name="bench_tcp_joint", type="fixed")
    ET.SubElement(fixed, "parent", link=last)
    ET.SubElement(fixed, "child", link=TCP_LINK)
    rpy = _words(iksel.euler_from_pose(tool))
    ET.SubElement(fixed, "origin", xyz=_words(tool[:3, 3]), rpy=rpy)
    return ET.tostring(root, encoding="unicode")


def _words(values: Iterable[float]) -> str:
    return " ".join(repr(float(value)) for value in values)
