# SPDX-License-Identifier: BSD-3-Clause
"""IKFast's code for an arm of PR2's, the only one that installs from PyPI."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

import numpy as np

from bench.rivals.base import UnsupportedError
from bench.rivals.enumerator import Enumerator, Request, fit_frames

if TYPE_CHECKING:
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

    def ways(self, arm: Arm) -> dict[str, Request]:
        """All branches of all samples, or until one is inside the limits."""
        if arm.chain.dof != 7:
            raise UnsupportedError(f"PR2's right arm only; not {arm.name}")
        module = importlib.import_module("pr2_ikfast.ikRight")
        chain = arm.chain
        lower, upper = chain.lower.tolist(), chain.upper.tolist()
        step = (upper[FREE] - lower[FREE]) / SAMPLES
        free = [[TORSO, lower[FREE] + (i + 0.5) * step] for i in range(SAMPLES)]
        frames = fit_frames(arm, lambda q: _pose(module.get_fk([TORSO, *q.tolist()])))

        def prepare(pose: Array, near: Array) -> tuple[Any, ...]:
            del near
            target = frames.target(pose)
            return target[:3, :3].tolist(), target[:3, 3].tolist()

        def every(rotation: Any, position: Any) -> list[list[float]]:
            found: list[list[float]] = []
            for values in free:
                found += module.get_ik(rotation, position, values) or ()
            return found

        def one(rotation: Any, position: Any) -> list[list[float]]:
            for values in free:
                for q in module.get_ik(rotation, position, values) or ():
                    if _inside(q, lower, upper):
                        return [q]
            return []

        return {
            "one": Request(prepare, one, _arms),
            "every": Request(prepare, every, _arms),
        }


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
