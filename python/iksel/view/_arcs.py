# SPDX-License-Identifier: BSD-3-Clause
"""The arcs of a self-motion, one after the other from 0 to 1."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from iksel_cpp import ArcEnd

if TYPE_CHECKING:
    from iksel_cpp import Robot, SelfMotion, SelfMotionEnd

    from iksel._base.arrays import FloatArray


class Arcs:
    """Configurations along all arcs, from the first one's begin to the last's end."""

    def __init__(self, robot: Robot, motion: SelfMotion | None) -> None:
        """Take a robot, and its self-motion at a target, if that is known."""
        self._robot = robot
        self._motion = list(motion or ())
        arcs = [arc.q for arc in self._motion]
        self._q = np.concatenate(arcs) if arcs else np.empty((0, robot.dof))

    def __len__(self) -> int:
        """Number of configurations."""
        return len(self._q)

    def at(self, share: float) -> FloatArray | None:
        """The configuration at a share from 0 to 1; None: there is none."""
        if not self:
            return None
        return np.array(self._q[round(share * (len(self._q) - 1))])

    def share(self, q: FloatArray) -> float:
        """Where along the arcs a configuration (dof,) is, as at() takes it."""
        return self._nearest(q) / (len(self._q) - 1) if len(self._q) > 1 else 0.0

    def words(self, q: FloatArray) -> str:
        """The arc that a configuration (dof,) is on, in words; or none."""
        if not self:
            return "none"
        ends = np.cumsum([len(arc) for arc in self._motion])
        index = int(np.searchsorted(ends, self._nearest(q), side="right"))
        arc = self._motion[index]
        text = f"arc {index + 1} of {len(self._motion)}"
        if arc.is_closed:
            return f"{text}, closed"
        return f"{text}, from {self._end(arc.begin)} to {self._end(arc.end)}"

    def _nearest(self, q: FloatArray) -> int:
        return int(np.abs(self._q - q).max(axis=1).argmin())

    def _end(self, end: SelfMotionEnd) -> str:
        if end.kind != ArcEnd.limit:
            return "a fold"
        side = "upper" if end.at_upper else "lower"
        return f"the {side} limit of {self._robot.joint_names[end.joint]}"
