# SPDX-License-Identifier: BSD-3-Clause
"""Peter Corke's Robotics Toolbox: ik_LM, whose loop is C++."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

import numpy as np

from bench.rivals.base import PythonRival, UnsupportedError

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array


K = 0.1
"""Of Chan's damping: 10 to 20 % faster here than 0.01."""


class RoboticsToolbox(PythonRival):
    """Levenberg-Marquardt with Chan's damping and random restarts."""

    name = "Robotics Toolbox"
    distribution = "roboticstoolbox-python"
    # Its default tolerance, 1e-6, is of half the squared error: 1.4 mm.
    settings = (
        f"ik_LM, Chan, k {K:g}, tol 1e-12 (of half the squared error), 30 iterations, "
        "100 searches, random start"
    )

    def __init__(self, arm: Arm) -> None:
        """Write the chain as elementary transforms."""
        toolbox = importlib.import_module("roboticstoolbox")
        chain = arm.chain
        if chain.prismatic.any() or not np.isfinite(chain.lower).all():
            raise UnsupportedError("the adapter has revolute joints with limits only")
        transforms = toolbox.ET.SE3(chain.offsets[0])
        for i in range(chain.dof):
            limits = [chain.lower[i], chain.upper[i]]
            joint = toolbox.ET.Rz(jindex=i, qlim=limits)
            transforms = transforms * joint * toolbox.ET.SE3(chain.offsets[i + 1])
        self._ets = transforms

    def prepare(self, pose: Array, start: Array) -> tuple[Any, ...]:
        """As it is."""
        return (pose, start, 30, 100, 1e-12, None, True, K, "chan")

    def call(self, *arguments: Any) -> Any:
        """Solve."""
        return self._ets.ik_LM(*arguments)

    def answers(self, returned: Any) -> list[Array]:
        """One, where it says success."""
        return [np.asarray(returned.q)] if returned.success else []
