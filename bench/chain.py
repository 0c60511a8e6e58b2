# SPDX-License-Identifier: BSD-3-Clause
"""Forward kinematics by numpy from the URDF text, with nothing of IKSel in it.

Targets are made and every solver's answer is judged by this, so that neither IKSel nor
a rival is its own judge.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

MOVING = ("revolute", "continuous", "prismatic")
WIDE = 20.0 * np.pi
"""What stands for no limit in programs that ask for one [rad]."""


@dataclass(frozen=True)
class Chain:
    """A serial chain whose joint axes are all z axes.

    T_base_tip(q) = offsets[0] Z(q[0]) offsets[1] Z(q[1]) ... offsets[dof], where Z
    turns about z, or moves along it if that joint is prismatic.
    """

    offsets: Array
    """Constant transforms between the joints, (dof + 1, 4, 4)."""
    prismatic: npt.NDArray[np.bool_]
    """Which joints slide, (dof,)."""
    lower: Array
    """Lower limits [rad or m], (dof,); -inf for continuous joints."""
    upper: Array
    """Upper limits [rad or m], (dof,); inf for continuous joints."""

    @property
    def dof(self) -> int:
        """Degrees of freedom."""
        return len(self.prismatic)

    def joint_frames(self, q: Array) -> tuple[Array, Array]:
        """The frames before each joint moves, (dof, N, 4, 4), and the tip's, (N, 4, 4).

        Args:
            q: Joint values, (N, dof).
        """
        frame = np.broadcast_to(self.offsets[0], (len(q), 4, 4))
        frames = np.empty((self.dof, len(q), 4, 4))
        for i in range(self.dof):
            frames[i] = frame
            frame = frame @ self._moved(i, q[:, i]) @ self.offsets[i + 1]
        return frames, frame

    def fk(self, q: Array) -> Array:
        """T_base_tip of each row of q, (N, dof) -> (N, 4, 4)."""
        return self.joint_frames(q)[1]

    def fk_jacobian(self, q: Array) -> tuple[Array, Array]:
        """T_base_tip, (N, 4, 4), and the geometric Jacobian at the tip, (N, 6, dof).

        Rows of the Jacobian are [linear; angular] in base axes.
        """
        frames, tip = self.joint_frames(q)
        jacobian = np.zeros((len(q), 6, self.dof))
        for i, frame in enumerate(frames):
            axis = frame[:, :3, 2]
            if self.prismatic[i]:
                jacobian[:, :3, i] = axis
            else:
                arm = tip[:, :3, 3] - frame[:, :3, 3]
                jacobian[:, :3, i] = np.cross(axis, arm)
                jacobian[:, 3:, i] = axis
        return tip, jacobian

    def within_limits(self, q: Array, slack: float = 0.0) -> npt.NDArray[np.bool_]:
        """Which rows of q, (N, dof), lie inside the limits give or take the slack."""
        inside = (q >= self.lower - slack) & (q <= self.upper + slack)
        return np.asarray(inside.all(axis=1))

    def middle(self) -> Array:
        """Of the limits, (dof,); 0 of a joint that has none."""
        limited = np.isfinite(self.lower) & np.isfinite(self.upper)
        middle = np.zeros(self.dof)
        middle[limited] = (self.lower[limited] + self.upper[limited]) / 2.0
        return middle

    def _moved(self, i: int, values: Array) -> Array:
        """Z(q) of joint i for many values, (N, 4, 4)."""
        moved = np.zeros((len(values), 4, 4))
        moved[:] = np.eye(4)
        if self.prismatic[i]:
            moved[:, 2, 3] = values
        else:
            c, s = np.cos(values), np.sin(values)
            moved[:, 0, 0], moved[:, 0, 1] = c, -s
            moved[:, 1, 0], moved[:, 1, 1] = s, c
        return moved


def chain_joints(urdf: str, base_link: str, tip_link: str) -> list[ET.Element]:
    """The URDF's joint elements from base to tip.

    Raises:
        ValueError: The tip is not below the base.
    """
    above = {}
    for joint in ET.fromstring(urdf).iterfind("joint"):
        child = joint.find("child")
        if child is not None:
            above[child.attrib["link"]] = joint
    joints = []
    link = tip_link
    while link != base_link:
        if link not in above:
            raise ValueError(f"no joint leads from {base_link!r} down to {tip_link!r}")
        joint = above[link]
        joints.append(joint)
        parent = joint.find("parent")
        link = "" if parent is None else parent.attrib["link"]
    return joints[::-1]


def chain_from_urdf(urdf: str, base_link: str, tip_link: str, tcp: Array) -> Chain:
    """The chain between two links of a URDF, with a tool T_tip_tcp, (4, 4).

    Raises:
        ValueError: The links are not connected, or a joint mimics another.
    """
    offsets, prismatic, lower, upper = [], [], [], []
    pending = np.eye(4)
    for joint in chain_joints(urdf, base_link, tip_link):
        pending = pending @ joint_origin(joint)
        kind = joint.attrib["type"]
        if kind not in MOVING:
            continue
        if joint.find("mimic") is not None:
            raise ValueError(f"joint {joint.attrib['name']!r} mimics another")
        to_axis = _z_to(_numbers(joint.find("axis"), "xyz", (1.0, 0.0, 0.0)))
        offsets.append(pending @ to_axis)
        pending = to_axis.T
        prismatic.append(kind == "prismatic")
        limit = joint.find("limit")
        unlimited = kind == "continuous" or limit is None
        lower.append(-np.inf if unlimited else float(limit.attrib["lower"]))  # type: ignore[union-attr]
        upper.append(np.inf if unlimited else float(limit.attrib["upper"]))  # type: ignore[union-attr]
    offsets.append(pending @ tcp)
    return Chain(
        np.array(offsets),
        np.array(prismatic, dtype=bool),
        np.array(lower),
        np.array(upper),
    )


def give_wide_limits(joint: ET.Element) -> None:
    """Make a continuous joint one with wide limits, where these cannot be missing."""
    joint.attrib["type"] = "revolute"
    for limit in joint.findall("limit"):
        joint.remove(limit)
    ends = {"lower": repr(float(-WIDE)), "upper": repr(float(WIDE))}
    ET.SubElement(joint, "limit", ends, effort="1", velocity="1")


def _numbers(
    element: ET.Element | None, key: str, default: tuple[float, float, float]
) -> Array:
    if element is None or key not in element.attrib:
        return np.array(default)
    return np.array([float(word) for word in element.attrib[key].split()])


def joint_origin(joint: ET.Element) -> Array:
    """The transform of a joint's origin, R = Rz(yaw) Ry(pitch) Rx(roll)."""
    element = joint.find("origin")
    roll, pitch, yaw = _numbers(element, "rpy", (0.0, 0.0, 0.0))
    transform = np.eye(4)
    transform[:3, :3] = _turn(2, yaw) @ _turn(1, pitch) @ _turn(0, roll)
    transform[:3, 3] = _numbers(element, "xyz", (0.0, 0.0, 0.0))
    return transform


def _turn(axis: int, angle: float) -> Array:
    """Rotation about a coordinate axis, (3, 3)."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    turn = np.eye(3)
    turn[i, i] = turn[j, j] = np.cos(angle)
    turn[j, i] = np.sin(angle)
    turn[i, j] = -turn[j, i]
    return turn


def _z_to(axis: Array) -> Array:
    """A rotation, (4, 4), that takes z to a direction."""
    z = axis / np.linalg.norm(axis)
    helper = np.eye(3)[np.argmin(np.abs(z))]
    x = np.cross(helper, z)
    x /= np.linalg.norm(x)
    transform = np.eye(4)
    transform[:3, :3] = np.column_stack([x, np.cross(z, x), z])
    return transform
