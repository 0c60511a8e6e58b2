# SPDX-License-Identifier: BSD-3-Clause
"""pink's and mink's steps towards the poses of one tip or several, repeated.

Neither solves for poses: a step towards them is solved for, under limits, and the
caller repeats that.
"""

from __future__ import annotations

import importlib
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from bench.chain import Array

DAMPING = 1e-2
"""Levenberg-Marquardt damping of the tasks. Of 0 and 1e-6 to 1, with 30 and 100 steps,
these take pink the fewest steps (panda and ur3, 25 targets each); with both hands of
the robots of bench.whole_body (15 and 25 targets) no other is faster on most."""
SETTINGS = f"lm_damping {DAMPING:g}, steps of 1 s under the joint limits, QP by daqp"


class FrameTasks(ABC):
    """A task of costs 1 for the frame of each tip, and the steps of all."""

    joints: list[str]
    """The model's, in its order."""
    tasks: list[Any]

    @abstractmethod
    def __init__(self, urdf: str, tips: list[str]) -> None:
        """Model and tasks."""

    @abstractmethod
    def targets(self, poses: Array) -> list[Any]:
        """Poses (k, 4, 4), one of each tip, as the package has them."""

    @abstractmethod
    def configuration(self, q: Array) -> Any:
        """At joint values in the model's order."""

    @abstractmethod
    def velocity(self, configuration: Any) -> Any:
        """The next step; None if there is none."""

    def descend(self, targets: list[Any], q: Array, steps: int, close: float) -> Any:
        """Joint values where no component of an error is above `close` [m, rad].

        Returns:
            In the model's order; None if it does not arrive from q in so many steps.
        """
        configuration = self.configuration(q)
        for task, target in zip(self.tasks, targets, strict=True):
            task.set_target(target)
        for _ in range(steps):
            if all(
                np.abs(task.compute_error(configuration)).max() < close
                for task in self.tasks
            ):
                return np.asarray(configuration.q)
            velocity = self.velocity(configuration)
            if velocity is None:
                return None
            configuration.integrate_inplace(velocity, 1.0)
        return None


class PinkTasks(FrameTasks):
    """pink on Pinocchio."""

    def __init__(self, urdf: str, tips: list[str]) -> None:
        self._pin = pin = importlib.import_module("pinocchio")
        self._pink = pink = importlib.import_module("pink")
        self._model = pin.buildModelFromXML(urdf)
        self._data = self._model.createData()
        limits = importlib.import_module("pink.limits")
        self._limits = [limits.ConfigurationLimit(self._model, 1.0)]
        self.tasks = [pink.tasks.FrameTask(tip, 1.0, 1.0, DAMPING) for tip in tips]
        self.joints = list(self._model.names)[1:]

    def targets(self, poses: Array) -> list[Any]:
        """As SE3."""
        return [self._pin.SE3(pose[:3, :3], pose[:3, 3]) for pose in poses]

    def configuration(self, q: Array) -> Any:
        """A new one."""
        return self._pink.Configuration(self._model, self._data, q)

    def velocity(self, configuration: Any) -> Any:
        """solve_ik."""
        try:
            return self._pink.solve_ik(
                configuration,
                self.tasks,
                1.0,
                "daqp",
                limits=self._limits,
                safety_break=False,
            )
        except self._pink.exceptions.NoSolutionFound:
            return None


class MinkTasks(FrameTasks):
    """mink on MuJoCo."""

    def __init__(self, urdf: str, tips: list[str]) -> None:
        """MuJoCo's model of the URDF, with some mass: it asks for that."""
        mujoco = importlib.import_module("mujoco")
        self._mink = mink = importlib.import_module("mink")
        compiler = (
            '<mujoco><compiler fusestatic="false" boundmass="1" boundinertia="1"/>'
            "</mujoco>"
        )
        text = urdf.replace("</robot>", f"{compiler}</robot>")
        model = mujoco.MjModel.from_xml_string(text)
        self._limits = [mink.ConfigurationLimit(model, gain=1.0)]
        self.tasks = [
            mink.FrameTask(tip, "body", 1.0, 1.0, lm_damping=DAMPING) for tip in tips
        ]
        self._configuration = mink.Configuration(model)
        self.joints = [model.joint(i).name for i in range(model.njnt)]

    def targets(self, poses: Array) -> list[Any]:
        """As its SE3."""
        return [self._mink.SE3.from_matrix(pose) for pose in poses]

    def configuration(self, q: Array) -> Any:
        """The only one, updated."""
        self._configuration.update(q)
        return self._configuration

    def velocity(self, configuration: Any) -> Any:
        """solve_ik."""
        try:
            return self._mink.solve_ik(
                configuration, self.tasks, 1.0, "daqp", limits=self._limits
            )
        except self._mink.exceptions.NoSolutionFound:
            return None
