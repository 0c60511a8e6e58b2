# SPDX-License-Identifier: BSD-3-Clause
"""pink and mink: differential IK by quadratic programs, as the loops people write.

Neither solves for a pose: a step towards it is solved for, under limits, and the caller
repeats that. A loop that does not arrive starts anew at random.
"""

from __future__ import annotations

import importlib
import itertools
from abc import abstractmethod
from typing import TYPE_CHECKING, Any

import numpy as np

from bench.rivals.base import UnsupportedError
from bench.rivals.enumerator import Enumerator, Request

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array

ITERATIONS = 30
STARTS = 20
TOLERANCE = 1e-6
DAMPING = 1e-2
"""Levenberg-Marquardt damping of the frame task. Of 0 and 1e-6 to 1, with 30 and 100
steps, these take pink the fewest steps (panda and ur3, 25 targets each)."""
LOOP = (
    f"one frame task of costs 1, lm_damping {DAMPING:g}, steps of 1 s under the joint "
    f"limits, QP by daqp, {ITERATIONS} steps, {STARTS} starts, {TOLERANCE:g} m and rad"
)


class Loop(Enumerator):
    """What both have in common: starts, steps, and when to end."""

    numerical = True
    settings = LOOP

    def ways(self, arm: Arm) -> dict[str, Request]:
        """One from a random start; the nearest from the posture."""
        chain = arm.chain
        if not np.isfinite(chain.upper - chain.lower).all():
            raise UnsupportedError("the adapter has no continuous joints")
        random = np.random.default_rng(1)
        starts = random.uniform(chain.lower, chain.upper, (1_000, chain.dof))
        following = itertools.cycle(starts)
        self.make(arm)

        def prepare(pose: Array, near: Array) -> tuple[Any, ...]:
            del near
            return self.target(pose), next(following)

        def from_posture(pose: Array, near: Array) -> tuple[Any, ...]:
            return self.target(pose), np.clip(near, chain.lower, chain.upper)

        def search(target: Any, q: Array) -> Array | None:
            for _ in range(STARTS):
                found = self.descend(target, q)
                if found is not None:
                    return found
                q = next(following)
            return None

        def answers(returned: Any) -> list[Array]:
            return [] if returned is None else [np.array(returned)]

        return {
            "one": Request(prepare, search, answers),
            "nearest": Request(from_posture, search, answers),
        }

    @abstractmethod
    def make(self, arm: Arm) -> None:
        """Model and task."""

    @abstractmethod
    def target(self, pose: Array) -> Any:
        """The pose as the package has it."""

    @abstractmethod
    def descend(self, target: Any, q: Array) -> Array | None:
        """The loop from one start; None if it does not arrive."""


class Pink(Loop):
    """pink on Pinocchio."""

    name = "pink"
    distribution = "pin-pink"

    def make(self, arm: Arm) -> None:
        """The model of the chain's URDF."""
        self._pin = pin = importlib.import_module("pinocchio")
        self._pink = pink = importlib.import_module("pink")
        self._model = pin.buildModelFromXML(arm.urdf)
        self._data = self._model.createData()
        limits = importlib.import_module("pink.limits")
        self._limits = [limits.ConfigurationLimit(self._model, 1.0)]
        self._task = pink.tasks.FrameTask(arm.tip_link, 1.0, 1.0, DAMPING)

    def target(self, pose: Array) -> Any:
        """As SE3."""
        return self._pin.SE3(pose[:3, :3], pose[:3, 3])

    def descend(self, target: Any, q: Array) -> Array | None:
        """solve_ik and integrate, repeated."""
        pink, task = self._pink, self._task
        configuration = pink.Configuration(self._model, self._data, q)
        task.set_target(target)
        for _ in range(ITERATIONS):
            if np.abs(task.compute_error(configuration)).max() < TOLERANCE / 2:
                return np.asarray(configuration.q)
            try:
                v = pink.solve_ik(
                    configuration,
                    [task],
                    1.0,
                    "daqp",
                    limits=self._limits,
                    safety_break=False,
                )
            except pink.exceptions.NoSolutionFound:
                return None
            configuration.integrate_inplace(v, 1.0)
        return None


class Mink(Loop):
    """mink on MuJoCo."""

    name = "mink"
    distribution = "mink"

    def make(self, arm: Arm) -> None:
        """MuJoCo's model of the chain's URDF, with some mass: it asks for that."""
        mujoco = importlib.import_module("mujoco")
        self._mink = mink = importlib.import_module("mink")
        compiler = (
            '<mujoco><compiler fusestatic="false" boundmass="1" boundinertia="1"/>'
            "</mujoco>"
        )
        text = arm.urdf.replace("</robot>", f"{compiler}</robot>")
        self._model = mujoco.MjModel.from_xml_string(text)
        self._limits = [mink.ConfigurationLimit(self._model, gain=1.0)]
        self._task = mink.FrameTask(arm.tip_link, "body", 1.0, 1.0, lm_damping=DAMPING)
        self._configuration = mink.Configuration(self._model)

    def target(self, pose: Array) -> Any:
        """As its SE3."""
        return self._mink.SE3.from_matrix(pose)

    def descend(self, target: Any, q: Array) -> Array | None:
        """solve_ik and integrate, repeated."""
        mink, task, configuration = self._mink, self._task, self._configuration
        configuration.update(q)
        task.set_target(target)
        for _ in range(ITERATIONS):
            if np.abs(task.compute_error(configuration)).max() < TOLERANCE / 2:
                return np.asarray(configuration.q)
            try:
                v = mink.solve_ik(
                    configuration, [task], 1.0, "daqp", limits=self._limits
                )
            except mink.exceptions.NoSolutionFound:
                return None
            configuration.integrate_inplace(v, 1.0)
        return None
