# SPDX-License-Identifier: BSD-3-Clause
"""Forward kinematics of a robot's chain by numpy, followers included."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING

import numpy as np
from bench.chain import MOVING, chain_from_urdf, chain_joints

if TYPE_CHECKING:
    import iksel


class ReferenceChain:
    """What bench/chain.py makes of a robot's URDF, each joint by its own value."""

    def __init__(self, robot: iksel.Robot) -> None:
        # Prefixes that no declaration binds are no matter here.
        text = re.sub(r"(</?)[\w.-]+:([\w.-]+)", r"\1\2", robot.urdf)
        root = ET.fromstring(re.sub(r"\s[\w.-]+:[\w.-]+=\"[^\"]*\"", "", text))
        followed = {}
        for joint in root.iterfind("joint"):
            mimic = joint.find("mimic")
            if mimic is not None:
                numbers = (mimic.get("multiplier", "1"), mimic.get("offset", "0"))
                followed[joint.get("name")] = mimic.get("joint"), *map(float, numbers)
                joint.remove(mimic)
            for limit in joint.iterfind("limit"):  # the robot's are asked for
                limit.set("lower", "-1")
                limit.set("upper", "1")
        text = ET.tostring(root, "unicode")
        ends = robot.base_link, robot.tip_link
        self._chain = chain_from_urdf(text, *ends, robot.tcp)
        moving = [j for j in chain_joints(text, *ends) if j.get("type") in MOVING]
        # Values of all joints: factors @ q + offsets.
        self._factors = np.zeros((len(moving), robot.dof))
        self._offsets = np.zeros(len(moving))
        for row, joint in enumerate(moving):
            name, factor, offset = joint.get("name"), 1.0, 0.0
            while name in followed:
                name, by, plus = followed[name]
                factor, offset = factor * by, factor * plus + offset
            self._factors[row, robot.joint_names.index(name)] = factor
            self._offsets[row] = offset

    @property
    def between(self) -> np.ndarray:
        """Transforms between the joints, and how those move that follow others."""
        moved = np.concatenate([self._factors.ravel(), self._offsets])
        return np.concatenate([self._chain.offsets[1:-1].ravel(), moved])

    def fk(self, q: np.ndarray) -> np.ndarray:
        """T_base_tip (n, 4, 4) at joint values (n, dof)."""
        return self._chain.fk(q @ self._factors.T + self._offsets)
