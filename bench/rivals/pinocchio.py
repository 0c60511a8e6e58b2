# SPDX-License-Identifier: BSD-3-Clause
"""Pinocchio: a damped least-squares loop in Python over its kinematics."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

import numpy as np

from bench.rivals.base import PythonRival, UnsupportedError

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array

TOLERANCE = 1e-6
ITERATIONS = 60
STARTS = 20
DAMPING = 1e-6


class Pinocchio(PythonRival):
    """Pinocchio has no solver of its own; this is the loop that its users write."""

    name = "Pinocchio, Python loop"
    distribution = "pin"
    settings = (
        f"own damped loop in Python, damping {DAMPING:g}, {ITERATIONS} iterations, "
        f"{STARTS} starts, {TOLERANCE:g} m and rad, wrapped into the limits"
    )
    share = 0.25

    def __init__(self, arm: Arm) -> None:
        """Parse the chain's URDF."""
        self._pin = pin = importlib.import_module("pinocchio")
        self._model = pin.buildModelFromXML(arm.urdf)
        if self._model.nq != arm.chain.dof:
            raise UnsupportedError("the adapter has no continuous joints")
        self._data = self._model.createData()
        self._frame = self._model.getFrameId(arm.tip_link)
        self._lower, self._upper = arm.chain.lower, arm.chain.upper
        self._turning = ~arm.chain.prismatic
        self._random = np.random.default_rng(1)

    def prepare(self, pose: Array, start: Array) -> tuple[Any, ...]:
        """The pose as SE3."""
        return (self._pin.SE3(pose[:3, :3], pose[:3, 3]), start)

    def call(self, *arguments: Any) -> Any:
        """Damped Newton in the tip's frame, started anew where it does not end."""
        target, q = arguments
        for _ in range(STARTS):
            found = self._search(target, q)
            if found is not None:
                return found
            q = self._random.uniform(self._lower, self._upper)
        return None

    def answers(self, returned: Any) -> list[Array]:
        """At most one."""
        return [] if returned is None else [returned]

    def _search(self, target: Any, q: Array) -> Array | None:
        pin, model, data = self._pin, self._model, self._data
        for _ in range(ITERATIONS):
            pin.framesForwardKinematics(model, data, q)
            error = data.oMf[self._frame].actInv(target)
            twist = pin.log6(error).vector
            if max(np.abs(twist[:3]).max(), np.abs(twist[3:]).max()) < TOLERANCE / 2:
                return self._wrapped(q)
            jacobian = pin.computeFrameJacobian(model, data, q, self._frame)
            jacobian = pin.Jlog6(error.inverse()) @ jacobian
            gram = jacobian @ jacobian.T
            gram[np.diag_indices(6)] += DAMPING
            q = q + jacobian.T @ np.linalg.solve(gram, twist)
        return None

    def _wrapped(self, q: Array) -> Array | None:
        turn = 2.0 * np.pi
        below = np.where(self._turning, np.ceil((self._lower - q) / turn), 0.0)
        q = q + turn * np.maximum(below, 0.0)
        above = np.where(self._turning, np.ceil((q - self._upper) / turn), 0.0)
        q = q - turn * np.maximum(above, 0.0)
        inside = np.all((q >= self._lower) & (q <= self._upper))
        return q if inside else None
