# SPDX-License-Identifier: BSD-3-Clause
"""Writes URDF: what robots of other formats and libraries become."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING

import numpy as np
from iksel_cpp import UrdfError

from iksel.pose import euler_from_pose

if TYPE_CHECKING:
    import numpy.typing as npt

    from iksel._base.arrays import FloatArray

LARGEST = 1e8
"""Limits [rad or m] from here on stand for none: libraries write the largest number."""


class UrdfWriter:
    """A URDF that grows by joints, each with the link that it carries.

    Attributes:
        links: Names of the links so far.
    """

    def __init__(self, name: str, root: str) -> None:
        self._element = ET.Element("robot", name=name or "robot")
        ET.SubElement(self._element, "link", name=root)
        self.links = {root}
        self._joints: set[str] = set()

    def free_link(self, name: str) -> str:
        """A name of a link that is not taken: this one, or with primes behind it."""
        while name in self.links:
            name += "'"
        return name

    def free_joint(self, name: str) -> str:
        """A name of a joint that is not taken."""
        while name in self._joints:
            name += "'"
        return name

    def add_fixed(self, parent: str, child: str, origin: FloatArray) -> None:
        """Fix a new link to another; origin is T_parent_child, (4, 4)."""
        self.add_joint(
            self.free_joint(f"{child}/fixed"), "fixed", parent, child, origin
        )

    def add_joint(
        self,
        name: str,
        kind: str,
        parent: str,
        child: str,
        origin: FloatArray,
        *,
        axis: npt.ArrayLike | None = None,
        limits: tuple[float, float] | None = None,
        velocity: float = math.inf,
        mimic: tuple[str, float, float] | None = None,
    ) -> None:
        """Add a joint and the link that it carries.

        Args:
            name: Its name.
            kind: A type of the URDF; revolute without limits becomes continuous.
            parent: Link that carries it.
            child: New link.
            origin: T_parent_child, (4, 4), at the joint value 0.
            axis: Axis in the child's frame, (3,).
            limits: Lower and upper limit [rad or m]; None or infinite: there are none.
            velocity: Largest velocity [rad/s or m/s]; inf: any.
            mimic: Joint that it follows, factor and offset.

        Raises:
            UrdfError: The URDF would have two joints or links of one name, or a number
                is not finite.
        """
        if name in self._joints or child in self.links:
            what = f"joint {name!r}" if name in self._joints else f"link {child!r}"
            raise UrdfError(f"there is a second {what}: names have to differ")
        if not np.isfinite(origin).all():
            raise UrdfError(f"joint {name!r}: its origin is not finite")
        self._joints.add(name)
        self.links.add(child)
        # One without the other is the core's affair, if the chain goes through it.
        if limits is not None and min(map(abs, limits)) >= LARGEST:
            limits = None
        if kind == "revolute" and limits is None:
            kind = "continuous"
        ET.SubElement(self._element, "link", name=child)
        joint = ET.SubElement(self._element, "joint", name=name, type=kind)
        ET.SubElement(joint, "parent", link=parent)
        ET.SubElement(joint, "child", link=child)
        rpy = _words(euler_from_pose(origin))
        ET.SubElement(joint, "origin", xyz=_words(origin[:3, 3]), rpy=rpy)
        if axis is not None:
            ET.SubElement(joint, "axis", xyz=_words(np.asarray(axis)))
        if mimic is not None:
            followed, factor, offset = mimic
            numbers = {"multiplier": _word(factor), "offset": _word(offset)}
            ET.SubElement(joint, "mimic", {"joint": followed, **numbers})
        self._add_limit(joint, limits, velocity)

    def text(self) -> str:
        """The URDF so far."""
        ET.indent(self._element)
        return ET.tostring(self._element, "unicode")

    @staticmethod
    def _add_limit(
        joint: ET.Element, limits: tuple[float, float] | None, velocity: float
    ) -> None:
        is_limited = 0.0 < velocity < LARGEST
        if limits is None and not is_limited:
            return
        values = {"effort": "0", "velocity": _word(velocity if is_limited else 0.0)}
        if limits is not None:
            values |= {"lower": _word(limits[0]), "upper": _word(limits[1])}
        ET.SubElement(joint, "limit", values)


def _words(values: FloatArray) -> str:
    return " ".join(map(_word, values))


def _word(value: float) -> str:
    """A number that is read back as the same, with no sign of zero."""
    return repr(float(value) + 0.0)
