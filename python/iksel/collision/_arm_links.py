# SPDX-License-Identifier: BSD-3-Clause
"""All links of a URDF, and where they are when an arm of it moves."""

from __future__ import annotations

import copy
import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING

import numpy as np
from iksel_cpp import LinkTree, Robot, UnknownNameError

from iksel.description import read_description
from iksel.formats._urdf_xml import read_xml

if TYPE_CHECKING:
    import os
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from iksel._base.arrays import FloatArray

_MOVING = frozenset({"revolute", "continuous", "prismatic"})


class ArmLinks:
    """All links of a URDF as the joints of an arm move them.

    Attributes:
        links: Names of all links, parents first.
        index: For each link its place among them.
        body: For each link the first that it never moves against.
        base: The arm's base link.
        parent_of: For each joint the link that it is on.
        child_of: For each joint the link that it carries.
    """

    def __init__(
        self, root: ET.Element, robot: Robot, others: Mapping[str, float]
    ) -> None:
        """Find the arm in the URDF.

        Args:
            root: The URDF, which may have more links than the arm's own.
            robot: The arm whose joints move.
            others: Values of further joints [rad or m]; those neither here nor locked
                in the arm are 0.
        """
        text = _without_geometry(root)
        self._joints = LinkTree.from_urdf(text, robot.base_link).joints
        self._check_known("robot", robot.joint_names)
        self._check_known("other_joints", others)
        self._robot = self._find_arm(text, robot, others)
        self._columns = [robot.joint_names.index(n) for n in self._robot.joint_names]
        self.links = self._robot.link_names
        self.base = robot.base_link
        self.index = {name: i for i, name in enumerate(self.links)}
        self.body = self._find_bodies()
        self.parent_of = {joint.name: joint.parent_link for joint in self._joints}
        self.child_of = {joint.name: joint.child_link for joint in self._joints}

    def poses(self, q: FloatArray) -> FloatArray:
        """Poses of the links in the frame of one of them, (n, links, 4, 4).

        Args:
            q: Values of the arm's joints, (n, dof) [rad or m].
        """
        return self._robot.link_poses(q[:, self._columns])

    def neighbours(self, solid: Iterable[str]) -> set[frozenset[str]]:
        """Pairs of `solid` links that one joint connects.

        Links that are fixed to each other count as one, and links that have nothing
        solid as part of the joint.
        """
        solid = set(solid)
        group = {self.links[0]: self.links[0]}
        above = {}  # for each group the one that its joint is on
        for joint in self._joints:
            parent, child = group[joint.parent_link], joint.child_link
            group[child] = child if joint.type in _MOVING else parent
            if group[child] == child:
                above[child] = parent
        members: dict[str, list[str]] = {}
        for link in self.links:
            if link in solid:
                members.setdefault(group[link], []).append(link)
        found = set()
        for first, lower in members.items():
            upper = above.get(first)
            while upper is not None and upper not in members:
                upper = above.get(upper)
            if upper is not None:
                found |= {frozenset((a, b)) for a in lower for b in members[upper]}
        return found

    def joints_between(self, a: str, b: str) -> list[str] | None:
        """The joints that move two links against each other, from one to the other.

        None where others than the arm's do, such as mimic joints.
        """
        to_a, to_b = self._joints_to(a), self._joints_to(b)
        shared = sum(x == y for x, y in zip(to_a, to_b))  # noqa: B905 (the shorter ends)
        found = to_a[: shared - 1 : -1] if shared else to_a[::-1]
        found += to_b[shared:]
        return found if set(found) <= set(self._robot.joint_names) else None

    def _joints_to(self, link: str) -> list[str]:
        """The joints between the root and a link that ever move it."""
        above = {joint.child_link: joint for joint in self._joints}
        found = []
        while link in above:
            joint = above[link]
            if self.body[link] == link:
                found.append(joint.name)
            link = joint.parent_link
        return found[::-1]

    def _find_arm(self, text: str, robot: Robot, others: Mapping[str, float]) -> Robot:
        """The same arm among the links of this URDF, all other joints held."""
        names = {joint.name for joint in self._joints}
        given = {**robot.locked_joints, **others}
        held = {
            name: value
            for name, value in given.items()
            if name in names and name not in robot.joint_names
        }
        while True:
            arm = Robot.from_urdf(
                text,
                base_link=robot.base_link,
                tip_links=robot.tip_links,
                locked_joints=held,
                default_limits=robot.default_limits or (-1.0, 1.0),
            )
            more = set(arm.joint_names) - set(robot.joint_names)
            if not more:
                break
            held.update(dict.fromkeys(more, 0.0))
        for name in robot.joint_names:
            if name not in arm.joint_names:
                tips = " or ".join(map(repr, robot.tip_links))
                raise UnknownNameError(
                    f"robot: the URDF has joint {name!r} elsewhere than between "
                    f"{robot.base_link!r} and {tips}, where it has: "
                    f"{', '.join(arm.joint_names)}"
                )
        return arm

    def _find_bodies(self) -> dict[str, str]:
        """Links that differ in no two configurations belong together."""
        poses = self._robot.link_poses(self._robot.random_configurations(2, seed=0))
        body = {self.links[0]: self.links[0]}
        for joint in self._joints:
            above, link = self.index[joint.parent_link], self.index[joint.child_link]
            first, second = np.linalg.solve(poses[:, above], poses[:, link])
            moves = np.abs(first - second).max() > 1e-9 * np.abs(first).max()
            body[joint.child_link] = (
                joint.child_link if moves else body[joint.parent_link]
            )
        return body

    def _check_known(self, argument: str, names: Iterable[str]) -> None:
        known = [joint.name for joint in self._joints]
        for name in names:
            if name not in known:
                raise UnknownNameError(
                    f"{argument}: the URDF has no joint {name!r}; it has: "
                    f"{', '.join(known)}"
                )


def _without_geometry(root: ET.Element) -> str:
    """The URDF's text with nothing in its links."""
    bare = copy.deepcopy(root)
    for link in bare.findall("link"):
        del link[:]
    return ET.tostring(bare, "unicode")


def read_urdf(
    source: str | os.PathLike[str],
    packages: Mapping[str, str | os.PathLike[str]],
    xacro_args: Mapping[str, str] | None,
    link: str,
    *,
    trusted: bool,
) -> tuple[ET.Element, Path]:
    """The root of a robot's URDF, and the folder that its file names start from.

    Where its links hang in several trees, only the one of `link` is in it.
    """
    read = read_description(
        source, packages=packages, xacro_args=xacro_args, trusted=trusted
    )
    root, _, folder = read_xml("urdf", read.urdf, link)
    return root, folder if read.format == "URDF" else read.folder
