# SPDX-License-Identifier: BSD-3-Clause
"""IKSel, and the loops that people write with Pinocchio, pink and mink: both hands.

None of the three solves for poses: a step towards them is solved for, and the caller
repeats that. A loop that does not arrive starts anew at random.
"""

from __future__ import annotations

import importlib
import itertools
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

import iksel
from bench.rivals.frame_tasks import (
    DAMPING,
    SETTINGS,
    FrameTasks,
    MinkTasks,
    PinkTasks,
)
from bench.whole_body.robots import TOLERANCE

if TYPE_CHECKING:
    from bench.chain import Array
    from bench.whole_body.robots import Body

STARTS = 40
STEPS = 30
"""Of each start: 50 and 100 take longer on talos, two_pandas, pr2 and g1."""
CLOSE = TOLERANCE / 2.0
"""Where a loop ends: the largest component of the errors [m, rad]."""
SOME_STARTS = 1_000
"""Starts are made before the clock runs, and used again after so many."""

START_SEED = (1, 2)
"""Not a number, as those of targets are: else a start would be a target's answer."""


class Solver(ABC):
    """A solver of both hands' poses, made for one robot in a process of its own."""

    settings: ClassVar[str]
    """As the table's legend states them."""

    @abstractmethod
    def __init__(self, body: Body) -> None:
        """Make it for a robot."""

    @abstractmethod
    def prepare(self, poses: Array) -> Any:
        """Poses, (k, 4, 4), as `call` takes them, before the clock starts."""

    @abstractmethod
    def call(self, target: Any) -> Any:
        """The one thing that is timed."""

    @abstractmethod
    def answer(self, returned: Any) -> Array | None:
        """In the order of the robot's joints, (dof,); None if there is none."""


class Ours(Solver):
    """IKSel."""

    settings = "Solver(robot).solve(poses), options as they are; no start is given"

    def __init__(self, body: Body) -> None:
        self._solver = iksel.Solver(body.robot)
        self.call = self._solver.solve  # type: ignore[method-assign, assignment]

    def prepare(self, poses: Array) -> Any:
        """As they are."""
        return poses

    def call(self, target: Any) -> Any:
        """Solve."""
        return self._solver.solve(target)

    def answer(self, returned: Any) -> Array | None:
        """Where it says so."""
        return np.array(returned.q) if returned else None


class Loop(Solver):
    """What the others have in common: starts, steps, and when to end."""

    def __init__(self, body: Body) -> None:
        names = self.make(body)
        place = {joint: i for i, joint in enumerate(names)}
        self._order = np.array([place[joint] for joint in body.robot.joint_names])
        q = body.random_configurations(SOME_STARTS, START_SEED)
        starts = np.empty_like(q)
        starts[:, self._order] = q
        self._starts = itertools.cycle(starts)

    @abstractmethod
    def make(self, body: Body) -> list[str]:
        """Model and tasks; the model's joints in its order."""

    @abstractmethod
    def descend(self, target: Any, q: Array) -> Array | None:
        """The loop from one start; None if it does not arrive."""

    def call(self, target: Any) -> Any:
        """Start until one arrives."""
        for _ in range(STARTS):
            found = self.descend(target, next(self._starts))
            if found is not None:
                return found
        return None

    def answer(self, returned: Any) -> Array | None:
        """In the robot's order."""
        return None if returned is None else np.array(returned[self._order])


class Pinocchio(Loop):
    """Damped least squares on the stacked Jacobian, in Python."""

    settings = (
        "own Python loop: damped least squares on the stacked Jacobian of 12 rows, "
        f"damping {DAMPING:g} of the squared error, steps of at most 1 rad clipped to "
        "the limits, joints at a limit that a step would leave are held"
    )
    longest = 1.0
    """Of a step, by its largest component [rad or m]."""

    def make(self, body: Body) -> list[str]:
        """The model of the chains' URDF."""
        self._pin = pin = importlib.import_module("pinocchio")
        self._model = pin.buildModelFromXML(body.urdf)
        self._data = self._model.createData()
        self._frames = [self._model.getFrameId(tip) for tip in body.robot.tip_links]
        self._lower = self._model.lowerPositionLimit
        self._upper = self._model.upperPositionLimit
        return list(self._model.names)[1:]

    def prepare(self, poses: Array) -> Any:
        """As SE3."""
        return [self._pin.SE3(pose[:3, :3], pose[:3, 3]) for pose in poses]

    def descend(self, target: Any, q: Array) -> Array | None:
        """Damped steps, what is at a limit held."""
        pin, model, data = self._pin, self._model, self._data
        rows = 6 * len(self._frames)
        error, jacobian = np.empty(rows), np.empty((rows, model.nv))
        for _ in range(STEPS):
            pin.computeJointJacobians(model, data, q)
            pin.updateFramePlacements(model, data)
            for i, (frame, pose) in enumerate(zip(self._frames, target, strict=True)):
                off = data.oMf[frame].actInv(pose)
                part = slice(6 * i, 6 * i + 6)
                error[part] = pin.log6(off).vector
                columns = pin.getFrameJacobian(model, data, frame, pin.LOCAL)
                jacobian[part] = pin.Jlog6(off.inverse()) @ columns
            if np.abs(error).max() < CLOSE:
                return q
            step = _step(jacobian, error)
            leaves = (q <= self._lower) & (step < 0) | (q >= self._upper) & (step > 0)
            if leaves.any():
                step = _step(jacobian * ~leaves, error)
            step *= min(1.0, self.longest / np.abs(step).max())
            q = np.clip(q + step, self._lower, self._upper)
        return None


def _step(jacobian: Array, error: Array) -> Array:
    """J^T (J J^T + damping)^-1 error, (dof,)."""
    gram = jacobian @ jacobian.T
    gram[np.diag_indices(len(gram))] += DAMPING * (error @ error) + 1e-12
    return np.asarray(jacobian.T @ np.linalg.solve(gram, error))


class OfFrameTasks(Loop):
    """A loop of steps that a package solves for."""

    settings = f"a frame task of costs 1 at each hand, {SETTINGS}"
    of_package: ClassVar[type[FrameTasks]]

    def make(self, body: Body) -> list[str]:
        """The model of the chains' URDF."""
        self._tasks = self.of_package(body.urdf, body.robot.tip_links)
        return self._tasks.joints

    def prepare(self, poses: Array) -> Any:
        """As the package has them."""
        return self._tasks.targets(poses)

    def descend(self, target: Any, q: Array) -> Array | None:
        """solve_ik and integrate, repeated."""
        found: Array | None = self._tasks.descend(target, q, STEPS, CLOSE)
        return found


class Pink(OfFrameTasks):
    """pink on Pinocchio."""

    of_package = PinkTasks


class Mink(OfFrameTasks):
    """mink on MuJoCo."""

    of_package = MinkTasks


SOLVERS: dict[str, type[Solver]] = {
    "IKSel": Ours,
    "Pinocchio": Pinocchio,
    "pink": Pink,
    "mink": Mink,
}
"""By the names that bench.rivals has for their packages."""
