# SPDX-License-Identifier: BSD-3-Clause
"""IKFast's code for an arm of PR2's, the only one that installs from PyPI."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

import numpy as np

from bench.rivals.base import UnsupportedError
from bench.rivals.enumerator import Enumerator, Frames, Request, fit_frames

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import ModuleType

    from bench.arms import Arm
    from bench.chain import Array

SAMPLES = 72
"""Values of the roll of the upper arm: as many as the package draws itself."""
FREE = 2
"""That joint, from 0."""
TORSO = 0.0
"""Lift of the torso; base_link of the arm's description is above it [m]."""


class IkFast(Enumerator):
    """pr2-ikfast: OpenRAVE's generated C++ by the package's own extension."""

    name = "IKFast"
    distribution = "pr2-ikfast"
    settings = (
        f"pr2-ikfast, its right arm, {SAMPLES} evenly spaced values of the free joint "
        "(the package draws as many at random); one: until a branch is inside the "
        "limits; limits are not its business"
    )
    keeps_limits = False
    of_samples = True

    def ways(self, arm: Arm) -> dict[str, Request]:
        """All branches of all samples, or until one is inside the limits."""
        module, frames = _known(arm)
        lower, upper = arm.chain.lower.tolist(), arm.chain.upper.tolist()
        free = _free_values(lower[FREE], upper[FREE], SAMPLES)

        def one(rotation: Any, position: Any) -> list[list[float]]:
            for values in free:
                for q in module.get_ik(rotation, position, values) or ():
                    if _inside(q, lower, upper):
                        return [q]
            return []

        return {
            "one": Request(_prepare(frames), one, _arms),
            "every": self.so_many(arm, SAMPLES),
        }

    def so_many(self, arm: Arm, number: int) -> Request:
        """All branches of so many samples."""
        module, frames = _known(arm)
        free = _free_values(arm.chain.lower[FREE], arm.chain.upper[FREE], number)

        def every(rotation: Any, position: Any) -> list[list[float]]:
            found: list[list[float]] = []
            for values in free:
                found += module.get_ik(rotation, position, values) or ()
            return found

        return Request(_prepare(frames), every, _arms)


def _known(arm: Arm) -> tuple[ModuleType, Frames]:
    """Its module, and its frames of the arm."""
    if arm.chain.dof != 7:
        raise UnsupportedError(f"PR2's right arm only; not {arm.name}")
    module = importlib.import_module("pr2_ikfast.ikRight")
    frames = fit_frames(arm, lambda q: _pose(module.get_fk([TORSO, *q.tolist()])))
    return module, frames


def _free_values(lower: float, upper: float, samples: int) -> list[list[float]]:
    """Torso and free joint, evenly spaced."""
    step = (upper - lower) / samples
    return [[TORSO, float(lower + (i + 0.5) * step)] for i in range(samples)]


def _prepare(frames: Frames) -> Callable[[Array, Array], tuple[Any, ...]]:
    def prepare(pose: Array, near: Array) -> tuple[Any, ...]:
        del near
        target = frames.target(pose)
        return target[:3, :3].tolist(), target[:3, 3].tolist()

    return prepare


def _inside(q: list[float], lower: list[float], upper: list[float]) -> bool:
    return all(
        low <= value <= high
        for low, value, high in zip(lower, q[1:], upper, strict=True)
    )


def _pose(returned: Any) -> Array:
    pose = np.eye(4)
    pose[:3, 3], pose[:3, :3] = returned
    return pose


def _arms(returned: Any) -> list[Array]:
    """Without the torso, which comes first."""
    return [np.array(q[1:]) for q in returned]
