# SPDX-License-Identifier: BSD-3-Clause
"""Robots with a torso and two arms, as every solver is given them."""

from __future__ import annotations

import copy
import functools
import hashlib
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import iksel
from bench.chain import (
    MOVING,
    Chain,
    chain_from_urdf,
    chain_joints,
    give_wide_limits,
)
from bench.check import right
from bench.rivals.base import UnsupportedError
from bench.robot_data import PACKAGE, robots_folder
from bench.tips import TURN, torso

if TYPE_CHECKING:
    import numpy.typing as npt

    from bench.chain import Array

MANY, SOME = 100_000, 10_000
"""Targets of a robot, unless told otherwise."""
TOLERANCE = 1e-6
"""Of every solver and of the judge, at each hand [m, rad]."""
ROUNDING = 1e-9
"""By which two forward kinematics may differ at the tolerance [m, rad]."""


class Description(NamedTuple):
    """A robot's file, below the robots of example-robot-data, and its links."""

    urdf: str
    base_link: str
    tip_links: tuple[str, str]
    targets: int = SOME


ROBOTS: dict[str, Description | None] = {
    "two_pandas": None,
    "pr2": Description(
        "pr2_description/urdf/pr2.urdf",
        "base_footprint",
        ("l_gripper_tool_frame", "r_gripper_tool_frame"),
        MANY,
    ),
    "talos": Description(
        "talos_data/robots/talos_reduced.urdf",
        "base_link",
        ("gripper_left_base_link", "gripper_right_base_link"),
    ),
    "g1": Description(
        "g1_description/urdf/g1_29dof_rev_1_0.urdf",
        "pelvis",
        ("left_wrist_yaw_link", "right_wrist_yaw_link"),
    ),
    "icub": Description(
        "icub_description/robots/icub.urdf", "base_link", ("l_hand", "r_hand")
    ),
    "alex": Description(
        "alex_description/urdf/alex_nub_hands.urdf",
        "Pelvis",
        ("LeftGripperYawLink", "RightGripperYawLink"),
    ),
    "romeo": Description(
        "romeo_description/urdf/romeo.urdf", "base_link", ("l_wrist", "r_wrist")
    ),
    "tiago_dual": Description(
        "tiago_description/robots/tiago_dual.urdf",
        "base_footprint",
        ("arm_left_tool_link", "arm_right_tool_link"),
    ),
}
"""By name; None: two built-in arms on one joint, which need no package."""


@dataclass(frozen=True)
class Body:
    """One robot: IKSel's, the judge's, and a URDF of just its chains for the loops."""

    name: str
    robot: iksel.Robot
    chains: tuple[Chain, ...]
    """From the base to each tip."""
    columns: tuple[npt.NDArray[np.intp], ...]
    """Where the joints of each chain are among the robot's."""
    urdf: str
    """The chains only; joints without limits have wide ones."""

    @property
    def shared(self) -> list[str]:
        """The joints that move more than one tip."""
        return [self.robot.joint_names[j] for j in self.robot.shared_joints]

    def fk(self, q: Array) -> Array:
        """T_base_tip of all tips, (N, dof) -> (N, k, 4, 4), without IKSel."""
        poses = [
            chain.fk(q[:, columns])
            for chain, columns in zip(self.chains, self.columns, strict=True)
        ]
        return np.stack(poses, axis=1)

    def random_configurations(self, count: int, seed: int | tuple[int, ...]) -> Array:
        """Uniform inside the limits, joints without any over a turn, (N, dof)."""
        lower, upper = self.search_limits()
        rng = np.random.default_rng(seed)
        return rng.uniform(lower, upper, (count, len(lower)))

    def search_limits(self) -> tuple[Array, Array]:
        """Limits [rad or m]; of joints that have none, half a turn to each side."""
        lower, upper = np.array(self.robot.lower), np.array(self.robot.upper)
        free = np.isinf(upper)
        lower[free], upper[free] = -np.pi, np.pi
        return lower, upper

    def right(self, poses: Array, q: Array) -> npt.NDArray[np.bool_]:
        """Which answers have every tip at its pose, and are inside the limits."""
        tolerance = TOLERANCE + ROUNDING
        tips = [
            right(chain, poses[:, i], q[:, columns], tolerance, tolerance)
            for i, (chain, columns) in enumerate(
                zip(self.chains, self.columns, strict=True)
            )
        ]
        return np.asarray(np.all(tips, axis=0))


def targets_of(name: str) -> int:
    """How many targets a robot has by default."""
    description = ROBOTS[name]
    return MANY if description is None else description.targets


def file_key(name: str) -> str:
    """Changes when the file of a robot does, or comes to be there."""
    description = ROBOTS[name]
    if description is None:
        return ""
    file = robots_folder() / description.urdf
    return hashlib.sha256(file.read_bytes()).hexdigest()[:12] if file.is_file() else ""


@functools.cache
def load_body(name: str) -> Body:
    """One of ROBOTS.

    Raises:
        UnsupportedError: Its file is not there.
    """
    description = ROBOTS[name]
    if description is None:
        arm = iksel.load_robot("panda")
        tips = ("l_" + arm.tip_link, "r_" + arm.tip_link)
        return body_of(name, torso(arm, (TURN,)), "base", tips)
    folder = robots_folder()
    if not folder.is_dir():
        raise UnsupportedError(f"{PACKAGE} is not installed (pip install {PACKAGE})")
    file = folder / description.urdf
    if not file.is_file():
        raise UnsupportedError(f"{description.urdf} is not in this {PACKAGE}")
    text = file.read_bytes().decode()
    return body_of(name, text, description.base_link, description.tip_links)


def body_of(name: str, urdf: str, base_link: str, tip_links: tuple[str, ...]) -> Body:
    """A robot from the text of its URDF."""
    robot = iksel.Robot.from_urdf(
        urdf.encode(), base_link=base_link, tip_links=tip_links
    )
    place = {joint: i for i, joint in enumerate(robot.joint_names)}
    chains, columns = [], []
    for tip in tip_links:
        chains.append(chain_from_urdf(urdf, base_link, tip, np.eye(4)))
        columns.append(
            np.array(
                [
                    place[joint.attrib["name"]]
                    for joint in chain_joints(urdf, base_link, tip)
                    if joint.attrib["type"] in MOVING
                ]
            )
        )
    text = chains_urdf(urdf, base_link, tip_links)
    return Body(name, robot, tuple(chains), tuple(columns), text)


def chains_urdf(urdf: str, base_link: str, tip_links: tuple[str, ...]) -> str:
    """A URDF that has only the joints from the base to the tips.

    Pinocchio has two numbers for a joint without limits, so these get wide ones.
    """
    root = ET.Element("robot", name="body")
    ET.SubElement(root, "link", name=base_link)
    done = set()
    for tip in tip_links:
        for joint in map(copy.deepcopy, chain_joints(urdf, base_link, tip)):
            child = joint.find("child")
            assert child is not None
            if child.attrib["link"] in done:
                continue
            done.add(child.attrib["link"])
            ET.SubElement(root, "link", name=child.attrib["link"])
            for controller in joint.findall("safety_controller"):
                joint.remove(controller)
            if joint.attrib["type"] == "continuous":
                give_wide_limits(joint)
            root.append(joint)
    return ET.tostring(root, encoding="unicode")
