# SPDX-License-Identifier: BSD-3-Clause
"""URDF files as Pinocchio and a plain reading of the XML see them."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING

import numpy as np
import pinocchio

if TYPE_CHECKING:
    from pathlib import Path

    import iksel

MOVING = {"revolute", "continuous", "prismatic"}


class UrdfFile:
    """A URDF file: its links and joints by its XML, its kinematics by Pinocchio.

    Attributes:
        parsed: Whether Pinocchio reads it, too.
        base: The one link that nothing holds, or None.
        tips: Links that hold nothing, each the end of a chain from the base.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        text = path.read_bytes()
        try:
            root = ET.fromstring(text[max(text.find(b"<?xml"), 0) :])
        except ET.ParseError:
            root = ET.Element("nothing")
        links = [link.get("name") for link in root.findall("link")]
        self._joints = {joint.get("name"): joint for joint in root.findall("joint")}
        self._above = {
            joint.find("child").get("link"): joint for joint in self._joints.values()
        }
        holding = {_parent(joint) for joint in self._joints.values()}
        bases = [link for link in links if link not in self._above]
        self.base = bases[0] if len(bases) == 1 else None
        self.tips = [link for link in links if link not in holding]
        try:
            self._model = _read_model(root)
            self._data = self._model.createData()
        except ValueError:
            self._model = None
        self.parsed = self._model is not None

    def chain(self, tip: str) -> list[ET.Element]:
        """The joints between the base and the tip."""
        joints = []
        while tip in self._above:
            joints.append(self._above[tip])
            tip = _parent(joints[-1])
        return joints[::-1]

    def moving(self, tip: str) -> list[str]:
        """Names of the joints that move between the base and the tip."""
        return [j.get("name") for j in self.chain(tip) if j.get("type") in MOVING]

    def poses(self, robot: iksel.Robot, q: np.ndarray) -> np.ndarray:
        """Pinocchio's T_base_tip (n, 4, 4) of a robot of this file at q, (n, dof)."""
        model, data = self._model, self._data
        frame = model.getFrameId(robot.tip_link, pinocchio.BODY)
        poses = np.empty((len(q), 4, 4))
        for i, one in enumerate(self._values(robot, q)):
            pinocchio.forwardKinematics(model, data, one)
            poses[i] = pinocchio.updateFramePlacement(model, data, frame).homogeneous
        return poses

    def _values(self, robot: iksel.Robot, q: np.ndarray) -> np.ndarray:
        """Pinocchio's configurations: q in the chain's joints, neutral in others."""
        model = self._model
        values = np.tile(pinocchio.neutral(model), (len(q), 1))
        column = {name: i for i, name in enumerate(robot.joint_names)}
        for name in self.moving(robot.tip_link):
            driver, factor, offset = self._driver(name)
            value = factor * q[:, column[driver]] + offset
            joint = model.joints[model.getJointId(name)]
            if joint.nq == 1:
                values[:, joint.idx_q] = value
            else:  # a continuous joint is a point of the circle
                values[:, joint.idx_q] = np.cos(value)
                values[:, joint.idx_q + 1] = np.sin(value)
        return values

    def free(
        self, robot: iksel.Robot, q: np.ndarray, srdf: Path, packages: Path
    ) -> np.ndarray:
        """Which q, (n, dof), are free of collisions by Pinocchio and the SRDF."""
        model = self._model
        shapes = pinocchio.buildGeomFromUrdf(
            model, str(self.path), pinocchio.COLLISION, package_dirs=[str(packages)]
        )
        shapes.addAllCollisionPairs()
        pinocchio.removeCollisionPairs(model, shapes, str(srdf))
        placed = shapes.createData()
        first_only = True
        return np.array(
            [
                not pinocchio.computeCollisions(
                    model, self._data, shapes, placed, one, first_only
                )
                for one in self._values(robot, q)
            ]
        )

    def cause(self, tip: str, problem: str) -> str | None:
        """Why the chain cannot be used, if the file bears the message out."""
        joints = self.chain(tip)
        if not self.parsed:
            return "Pinocchio cannot read the file either"
        if "no movable joint" in problem:
            return None if self.moving(tip) else "nothing moves"
        others = {j.get("type") for j in joints} - MOVING - {"fixed"}
        if others and any(f"is {kind}" in problem for kind in others):
            return f"a joint is {' and '.join(sorted(others))}"
        strangers = {self._source(j) for j in joints} - set(self._joints)
        if strangers and any(f"mimics '{name}'" in problem for name in strangers):
            return "a joint mimics one that is not there"
        if "limit" in problem:
            return self._no_range([j.get("name") for j in joints])
        return None

    def _no_range(self, names: list[str]) -> str | None:
        """Why a driver of these joints has no range, if one has none."""
        if any(abs(x) > 1e8 for n in names for x in _finite(self._joints[n])):
            return "a limit is beyond 1e8"
        ranges: dict[str, list[float]] = {}
        for name in names:
            if self._joints[name].get("type") in {"revolute", "prismatic"}:
                driver, factor, offset = self._driver(name)
                low, high = _limits(self._joints[driver])
                if not low < high:
                    return "a joint has no range"
                ends = sorted(
                    (x - offset) / factor for x in _limits(self._joints[name])
                )
                low, high = ranges.get(driver, [low, high])
                ranges[driver] = [max(low, ends[0]), min(high, ends[1])]
        if all(low < high for low, high in ranges.values()):
            return None
        return "the limits of a follower leave its driver no range"

    def _source(self, joint: ET.Element) -> str | None:
        mimic = joint.find("mimic")
        return joint.get("name") if mimic is None else mimic.get("joint")

    def _driver(self, name: str) -> tuple[str, float, float]:
        """The joint that moves another, and the factor and offset by which it does."""
        mimic = self._joints[name].find("mimic")
        if mimic is None:
            return name, 1.0, 0.0
        driver, factor, offset = self._driver(mimic.get("joint"))
        by = float(mimic.get("multiplier", "1"))
        return driver, by * factor, by * offset + float(mimic.get("offset", "0"))


def _read_model(root: ET.Element) -> pinocchio.Model:
    """Pinocchio's model, which needs limits, efforts and velocities to be given."""
    for joint in root.findall("joint"):
        if joint.get("type") in {"revolute", "prismatic"}:
            limit = joint.find("limit")
            limit = ET.SubElement(joint, "limit") if limit is None else limit
            for name in ("effort", "velocity"):
                limit.set(name, limit.get(name, "0"))
    return pinocchio.buildModelFromXML(ET.tostring(root, encoding="unicode"))


def _parent(joint: ET.Element) -> str:
    return joint.find("parent").get("link")


def _finite(joint: ET.Element) -> tuple[float, ...]:
    """The limits, if the joint is to have any."""
    return _limits(joint) if joint.get("type") in {"revolute", "prismatic"} else ()


def _limits(joint: ET.Element) -> tuple[float, float]:
    if joint.get("type") == "continuous":
        return -np.inf, np.inf
    limit = joint.find("limit")
    if limit is None:
        return 0.0, 0.0
    return float(limit.get("lower", "0")), float(limit.get("upper", "0"))
