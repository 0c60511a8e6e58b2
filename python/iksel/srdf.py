# SPDX-License-Identifier: BSD-3-Clause
"""Groups and named states of an SRDF.

    srdf = iksel.srdf.Srdf("arm.srdf")
    robot = iksel.load_robot("arm.urdf", srdf=srdf, group="manipulator")
    home = srdf.states(robot)["home"]

The pairs of links that it disables are read by iksel.collision.SelfCollision(srdf=...).
"""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING

import numpy as np
from iksel_cpp import LinkTree, UnknownNameError, UrdfError

from iksel.formats._urdf_xml import read_xml

if TYPE_CHECKING:
    import os
    import xml.etree.ElementTree as ET
    from collections.abc import Sequence

    from iksel_cpp import LinkTreeJoint, Robot

    from iksel._base.arrays import FloatArray


class Srdf:
    """What an SRDF says of groups of joints, and of states that they have names for."""

    def __init__(self, source: str | os.PathLike[str]) -> None:
        """Read an SRDF.

        Args:
            source: Path of the file, or its text.

        Raises:
            UrdfError: It cannot be read.
        """
        root = read_xml("srdf", source)[0]
        if root.tag != "robot":
            raise UrdfError(f"srdf: expected <robot>, got <{root.tag}>")
        groups = root.findall("group")
        self._groups = {group.get("name", ""): group for group in groups}
        self._states = root.findall("group_state")

    @property
    def groups(self) -> list[str]:
        """Names of the groups."""
        return list(self._groups)

    def ends(
        self,
        group: str,
        urdf: str | os.PathLike[str],
        tip_link: str | None = None,
    ) -> tuple[str, str]:
        """The links that a group's chain is between.

        Args:
            group: One of `groups`: it has one chain, or joints or links of one.
            urdf: Path of the robot's URDF, or its text.
            tip_link: Which end is meant of a group with several.

        Returns:
            Base and tip link.

        Raises:
            UnknownNameError: The SRDF lacks the group, or the URDF a joint or link.
            UrdfError: The group is empty, or branches and `tip_link` names no end.
        """
        self._check_group(group)
        chains = [_chain_ends(e) for e in self._groups[group].findall("chain")]
        if len(self._groups[group]) == len(chains) == 1:
            return chains[0]
        links = [e.get("name", "") for e in self._groups[group].findall("link")]
        some = next((base for base, _ in chains), next(iter(links), None))
        joints = LinkTree.from_urdf(urdf, tip_link or some).joints
        above = {joint.child_link: joint for joint in joints}
        members = self._members(group, joints, ())
        paths = {name: _path(name, joints, above) for name in members}
        inner = {name for path in paths.values() for name in path[:-1]}
        last = [name for name in members if name not in inner]
        if not last:
            raise UrdfError(f"srdf: group {group!r} has no chain, joint or link")
        ends = {}
        for name in last:
            first = next(joint for joint in paths[name] if joint in members)
            ends[_joint(name, joints).child_link] = _joint(first, joints).parent_link
        if len(ends) > 1:
            ends |= {tip: base for base, tip in chains}
        tip = tip_link if tip_link in ends or len(ends) > 1 else next(iter(ends))
        if tip not in ends:
            listed = ", ".join(j.child_link for j in joints if j.child_link in ends)
            raise UrdfError(
                f"srdf: group {group!r} is no chain, it ends in several links; choose "
                f"one by tip_link: {listed}"
            )
        return ends[tip], tip

    def states(self, robot: Robot, group: str | None = None) -> dict[str, FloatArray]:
        """Joint values of the named states that give all joints of a robot.

        Args:
            robot: The robot whose joint values they are.
            group: Only the states of this group; None: of any. Where groups have states
                of one name, the first counts.

        Returns:
            Joint values by name, (dof,) [rad or m], which may lie outside the limits.

        Raises:
            UnknownNameError: The SRDF lacks the group.
        """
        if group is not None:
            self._check_group(group)
        found: dict[str, FloatArray] = {}
        for state in self._states:
            values = {e.get("name"): e.get("value", "") for e in state.findall("joint")}
            if group not in {None, state.get("group")}:
                continue
            if set(robot.joint_names) <= set(values):
                q = [_number(state, name, values[name]) for name in robot.joint_names]
                found.setdefault(state.get("name", ""), np.array(q))
        return found

    def _members(
        self, group: str, joints: Sequence[LinkTreeJoint], within: tuple[str, ...]
    ) -> list[str]:
        """Names of the joints of a group and of the groups in it."""
        if group in within:
            raise UrdfError(f"srdf: group {group!r} is in itself")
        self._check_group(group)
        above = {joint.child_link: joint for joint in joints}
        names: list[str] = []
        for part in self._groups[group]:
            name = part.get("name", "")
            if part.tag == "group":
                names += self._members(name, joints, (*within, group))
            elif part.tag == "chain":
                base, tip = _chain_ends(part)
                _check_link(base, joints)
                names += _joints_between(base, tip, joints, above)
            elif part.tag == "joint":
                _path(name, joints, above)
                names.append(name)
            elif part.tag == "link":
                _check_link(name, joints)
                names += [above[name].name] if name in above else []
        return list(dict.fromkeys(names))

    def _check_group(self, group: str) -> None:
        if group not in self._groups:
            close = difflib.get_close_matches(group, self._groups)
            hint = f"did you mean {' or '.join(close)}? " if close else ""
            error = UnknownNameError(
                f"srdf: no group {group!r}; {hint}groups: "
                f"{', '.join(self._groups) or 'none'}"
            )
            error.available = tuple(self._groups)
            raise error


def _chain_ends(chain: ET.Element) -> tuple[str, str]:
    return chain.get("base_link", ""), chain.get("tip_link", "")


def _path(
    name: str, joints: Sequence[LinkTreeJoint], above: dict[str, LinkTreeJoint]
) -> list[str]:
    """Names of the joints from the root to a joint, which is the last."""
    joint: LinkTreeJoint | None = _joint(name, joints)
    names = []
    while joint is not None:
        names.append(joint.name)
        joint = above.get(joint.parent_link)
    return names[::-1]


def _joint(name: str, joints: Sequence[LinkTreeJoint]) -> LinkTreeJoint:
    """The joint of a name."""
    for joint in joints:
        if joint.name == name:
            return joint
    known = ", ".join(joint.name for joint in joints)
    raise UnknownNameError(f"srdf: the URDF has no joint {name!r}; it has: {known}")


def _joints_between(
    base: str,
    tip: str,
    joints: Sequence[LinkTreeJoint],
    above: dict[str, LinkTreeJoint],
) -> list[str]:
    """Names of the joints between two links."""
    _check_link(tip, joints)
    ends = [
        _path(above[e].name, joints, above) if e in above else [] for e in (base, tip)
    ]
    return [
        name for name in (*ends[0], *ends[1]) if (name in ends[0]) != (name in ends[1])
    ]


def _check_link(link: str, joints: Sequence[LinkTreeJoint]) -> None:
    links = {name for j in joints for name in (j.parent_link, j.child_link)}
    if link not in links:
        raise UnknownNameError(
            f"srdf: the URDF has no link {link!r}; it has: {', '.join(sorted(links))}"
        )


def _number(state: ET.Element, joint: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise UrdfError(
            f"srdf: state {state.get('name')!r}: joint {joint!r} has {text!r}, which "
            "is no number"
        ) from None
