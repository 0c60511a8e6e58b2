# SPDX-License-Identifier: BSD-3-Clause
"""pink and mink: differential IK by quadratic programs, as the loops people write.

Neither solves for a pose: a step towards it is solved for, under limits, and the caller
repeats that. A loop that does not arrive starts anew at random.
"""

from __future__ import annotations

import itertools
import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from bench.chain import WIDE, give_wide_limits
from bench.rivals.enumerator import Enumerator, Request
from bench.rivals.frame_tasks import SETTINGS, FrameTasks, MinkTasks, PinkTasks

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array

ITERATIONS = 30
STARTS = 20
TOLERANCE = 1e-6
LOOP = (
    f"one frame task of costs 1, {SETTINGS}, {ITERATIONS} steps, {STARTS} starts, "
    f"{TOLERANCE:g} m and rad; continuous joints have limits of {WIDE / np.pi:.0f} pi "
    "to each side"
)


def limited(urdf: str) -> str:
    """A chain's URDF in which every joint that turns has limits."""
    root = ET.fromstring(urdf)
    for joint in root.findall("joint"):
        if joint.attrib["type"] == "continuous":
            give_wide_limits(joint)
    return ET.tostring(root, encoding="unicode")


class Loop(Enumerator):
    """What both have in common: starts, steps, and when to end."""

    numerical = True
    settings = LOOP
    of_package: ClassVar[type[FrameTasks]]

    def ways(self, arm: Arm) -> dict[str, Request]:
        """One from a random start; the nearest from the posture."""
        chain = arm.chain
        random = np.random.default_rng(1)
        lower = np.where(np.isfinite(chain.lower), chain.lower, -np.pi)
        upper = np.where(np.isfinite(chain.upper), chain.upper, np.pi)
        starts = random.uniform(lower, upper, (1_000, chain.dof))
        following = itertools.cycle(starts)
        tasks = self.of_package(limited(arm.urdf), [arm.tip_link])

        def prepare(pose: Array, near: Array) -> tuple[Any, ...]:
            del near
            return tasks.targets(pose[None]), next(following)

        def from_posture(pose: Array, near: Array) -> tuple[Any, ...]:
            return tasks.targets(pose[None]), np.clip(near, chain.lower, chain.upper)

        def search(target: Any, q: Array) -> Array | None:
            for _ in range(STARTS):
                found = tasks.descend(target, q, ITERATIONS, TOLERANCE / 2)
                if found is not None:
                    return np.asarray(found)
                q = next(following)
            return None

        def answers(returned: Any) -> list[Array]:
            return [] if returned is None else [np.array(returned)]

        return {
            "one": Request(prepare, search, answers),
            "nearest": Request(from_posture, search, answers),
        }


class Pink(Loop):
    """pink on Pinocchio."""

    name = "pink"
    distribution = "pin-pink"
    of_package = PinkTasks


class Mink(Loop):
    """mink on MuJoCo."""

    name = "mink"
    distribution = "mink"
    of_package = MinkTasks
