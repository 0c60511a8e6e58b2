# SPDX-License-Identifier: BSD-3-Clause
"""All links of a URDF, and where they are when an arm of it moves."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from iksel_cpp import UnknownNameError, UrdfError

from iksel._files import read_text
from iksel.pose import pose_from_euler

if TYPE_CHECKING:
    import os
    from collections.abc import Iterable, Mapping

    from iksel_cpp import Robot

    from iksel._arrays import FloatArray

_MOVING = frozenset({"revolute", "continuous", "prismatic"})


class _Motion(NamedTuple):
    """What moves a joint: its value is factor * (value of driver) + offset."""

    driver: str
    factor: float
    offset: float


class _Joint:
    """A joint of a URDF."""

    def __init__(self, element: ET.Element) -> None:
        self.name = element.get("name", "")
        self.kind = element.get("type", "")
        self.moves = self.kind in _MOVING
        self.parent = _link(element, "parent")
        self.child = _link(element, "child")
        self.origin = read_origin(element)
        axis = element.find("axis")
        xyz = [1.0, 0.0, 0.0] if axis is None else read_numbers(axis, "xyz", 3)
        self.axis = np.array(xyz) / (np.linalg.norm(xyz) or 1.0)
        mimic = element.find("mimic")
        self.follows = mimic is not None
        self.own = _Motion(self.name, 1.0, 0.0)
        if mimic is not None:
            self.own = _Motion(
                mimic.get("joint", ""),
                read_numbers(mimic, "multiplier", 1, "1")[0],
                read_numbers(mimic, "offset", 1, "0")[0],
            )

    def terms(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """What the pose of the child in the parent grows by, with its value v.

        Returns:
            Three matrices (4, 4), to be multiplied by sin(v), 1 - cos(v) and v.
        """
        by_sine, by_cosine, by_value = np.zeros((3, 4, 4))
        if self.kind == "prismatic":
            by_value[:3, 3] = self.axis
        else:
            x, y, z = self.axis
            by_sine[:3, :3] = [[0, -z, y], [z, 0, -x], [-y, x, 0]]
            by_cosine = by_sine @ by_sine
        return self.origin @ by_sine, self.origin @ by_cosine, self.origin @ by_value

    def pose(self, value: float) -> FloatArray:
        """Pose (4, 4) of the child link in the parent link's frame."""
        by_sine, by_cosine, by_value = self.terms()
        turned = np.sin(value) * by_sine + (1 - np.cos(value)) * by_cosine
        moved: FloatArray = self.origin + turned + value * by_value
        return moved


class LinkTree:
    """All links of a URDF, sorted into bodies that an arm moves as one.

    Attributes:
        links: Names of all links, in the order of the URDF.
        body: For each link the index of its body; 0 holds the root link.
        in_body: For each link its pose in the frame of its body, (4, 4).
    """

    def __init__(
        self, root: ET.Element, robot: Robot, others: Mapping[str, float]
    ) -> None:
        """Read the joints.

        Args:
            root: The URDF.
            robot: The arm whose joints move.
            others: Values of further joints [rad or m]; those neither here nor locked
                in the arm are 0.
        """
        self.links = [link.get("name", "") for link in root.findall("link")]
        joints = [_read_joint(element) for element in root.findall("joint")]
        self._joints = {joint.name: joint for joint in joints}
        self._joint_above = {joint.child: joint for joint in joints}
        self._check_known("robot", robot.joint_names)
        self._check_known("other_joints", others)
        self._column = {name: i for i, name in enumerate(robot.joint_names)}
        self._held = {**robot.locked_joints, **others}
        self.body: dict[str, int] = {}
        self.in_body: dict[str, FloatArray] = {}
        self._above: list[int] = []  # the body that holds body 1, 2, ...
        self._terms = np.empty((4, 0, 4, 4))  # of their poses in it, see poses()
        self._motions: list[tuple[int, float, float]] = []
        for link in self._parents_first():
            self._place(link)

    def poses(self, q: FloatArray) -> FloatArray:
        """Poses of the bodies in the root link's frame, (n, bodies, 4, 4).

        Args:
            q: Values of the arm's joints, (n, dof) [rad or m].
        """
        columns, factors, offsets = np.reshape(self._motions, (-1, 3)).T
        values = q[:, columns.astype(int)] * factors + offsets
        values = values[..., None, None]
        still, by_sine, by_cosine, by_value = self._terms
        in_parent = still + np.sin(values) * by_sine
        in_parent += (1 - np.cos(values)) * by_cosine
        in_parent += values * by_value
        poses = np.empty((len(q), len(self._above) + 1, 4, 4))
        poses[:, 0] = np.eye(4)
        for i, above in enumerate(self._above):
            poses[:, i + 1] = poses[:, above] @ in_parent[:, i]
        return poses

    def neighbours(self, solid: Iterable[str]) -> set[frozenset[str]]:
        """Pairs of `solid` links that one joint connects.

        Links that are fixed to each other count as one, and links that have nothing
        solid as part of the joint.
        """
        solid = set(solid)
        group: dict[str, str] = {}
        for link in self._parents_first():
            above = self._joint_above.get(link)
            moves = above is None or above.moves
            group[link] = link if above is None or moves else group[above.parent]
        members: dict[str, list[str]] = {}
        for link in self.links:
            if link in solid:
                members.setdefault(group[link], []).append(link)
        found = set()
        for first, lower in members.items():
            above = self._joint_above.get(first)
            while above is not None and group[above.parent] not in members:
                above = self._joint_above.get(group[above.parent])
            if above is not None:
                upper = members[group[above.parent]]
                found |= {frozenset((a, b)) for a in lower for b in upper}
        return found

    def _place(self, link: str) -> None:
        """Give the link a body: its parent's, or a new one if the arm moves it."""
        joint = self._joint_above.get(link)
        if joint is None:
            self.body[link], self.in_body[link] = 0, np.eye(4)
            return
        body, in_body = self.body[joint.parent], self.in_body[joint.parent]
        motion = self._motion(joint) if joint.moves else joint.own
        held = joint.name in self._held and joint.name not in self._column
        if joint.moves and motion.driver in self._column and not held:
            terms = in_body @ np.array([joint.origin, *joint.terms()])
            self._terms = np.concatenate([self._terms, terms[:, None]], axis=1)
            self._motions.append(
                (self._column[motion.driver], motion.factor, motion.offset)
            )
            self._above.append(body)
            self.body[link], self.in_body[link] = len(self._above), np.eye(4)
            return
        driven = motion.factor * self._held.get(motion.driver, 0.0) + motion.offset
        value = self._held.get(joint.name, driven) if joint.moves else 0.0
        self.body[link], self.in_body[link] = body, in_body @ joint.pose(value)

    def _motion(self, joint: _Joint) -> _Motion:
        """What moves the joint in the end, through any number of mimic tags."""
        motion = joint.own
        source = joint
        for _ in self._joints:
            if not source.follows:
                return motion
            if motion.driver not in self._joints:
                raise UnknownNameError(
                    f"urdf: joint {source.name!r} mimics {motion.driver!r}, which is "
                    f"not in the URDF; it has: {', '.join(self._joints)}"
                )
            source = self._joints[motion.driver]
            motion = _Motion(
                source.own.driver,
                motion.factor * source.own.factor,
                motion.offset + motion.factor * source.own.offset,
            )
        raise UrdfError(
            f"urdf: joint {joint.name!r} mimics itself through a circle of joints"
        )

    def _parents_first(self) -> list[str]:
        """All links, each after the link that holds it."""
        below: dict[str, list[str]] = {}
        for joint in self._joint_above.values():
            below.setdefault(joint.parent, []).append(joint.child)
        order = [link for link in self.links if link not in self._joint_above]
        for link in order:
            order += below.get(link, [])
        missing = set(self.links) - set(order)
        if missing:
            raise UrdfError(
                f"urdf: no way from a root link to: {', '.join(sorted(missing))}"
            )
        return order

    def _check_known(self, argument: str, names: Iterable[str]) -> None:
        for name in names:
            if name not in self._joints:
                raise UnknownNameError(
                    f"{argument}: the URDF has no joint {name!r}; it has: "
                    f"{', '.join(self._joints)}"
                )


def read_xml(
    argument: str, source: str | os.PathLike[str]
) -> tuple[ET.Element, str, Path]:
    """Read XML from a path or text.

    Returns:
        The root element, the text, and the folder that relative names start from.

    Raises:
        UrdfError: It cannot be read; the message names the argument.
    """
    if isinstance(source, str) and source.lstrip().startswith("<"):
        text, folder = source, Path()
    else:
        path = Path(source)
        try:
            text, folder = read_text(path), path.parent
        except (OSError, ValueError) as error:
            raise UrdfError(f"{argument}: {error}") from None
    try:
        return ET.fromstring(text), text, folder  # noqa: S314 (the user's own file)
    except (ET.ParseError, ValueError) as error:
        raise UrdfError(f"{argument}: {error}") from None


def read_numbers(
    element: ET.Element, attribute: str, count: int, default: str = ""
) -> list[float]:
    """The finite numbers that an attribute holds; else a UrdfError."""
    text = element.get(attribute, default)
    try:
        numbers = [float(word) for word in text.split()]
    except ValueError:
        numbers = []
    if len(numbers) != count or not np.isfinite(numbers).all():
        raise UrdfError(
            f"{element.tag} with {attribute}={text!r}, expected {count} numbers"
        )
    return numbers


def read_origin(element: ET.Element) -> FloatArray:
    """The pose (4, 4) that <origin> gives; the identity without one."""
    origin = element.find("origin")
    if origin is None:
        return np.eye(4)
    xyz = read_numbers(origin, "xyz", 3, "0 0 0")
    return pose_from_euler(xyz, read_numbers(origin, "rpy", 3, "0 0 0"))


def _read_joint(element: ET.Element) -> _Joint:
    try:
        return _Joint(element)
    except UrdfError as error:
        name = element.get("name", "")
        raise UrdfError(f"urdf: joint {name!r}: {error}") from None


def _link(joint: ET.Element, end: str) -> str:
    element = joint.find(end)
    return "" if element is None else element.get("link", "")
