# SPDX-License-Identifier: BSD-3-Clause
"""frankik: He and Liu's closed form of Franka's arms, joint 7 given or sampled."""

from __future__ import annotations

import functools
import importlib
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from bench.rivals.base import UnsupportedError
from bench.rivals.enumerator import Enumerator, Frames, Request, fit_frames

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import ModuleType

    from bench.arms import Arm
    from bench.chain import Array

FEW, MANY = 60, 180
"""Values of joint 7 that are tried for one answer, and for all of them."""
TURN_DEG = 360.0
"""Span of these around the posture's joint 7 [degrees]: all that the limits allow."""
LIMITS_DIFFER = 1e-6
"""Limits farther apart than this are others [rad]."""
HALF = np.sqrt(0.5)
NO_HAND = np.linalg.inv(
    [[HALF, HALF, 0, 0], [-HALF, HALF, 0, 0], [0, 0, 1, 0.1034], [0, 0, 0, 1]]
)
"""From the hand's tip back to the flange; exact, where its constant has 0.707."""


class Frankik(Enumerator):
    """ik_sample_q7, which samples joint 7 around a posture, in C++.

    It tries all samples before it returns. With half as wide a span or by its `ik`
    instead of `ik_full` it misses 6 to 25 % of the Panda's poses, thus asked 0 to 0.2
    (500 reachable ones).
    """

    name = "frankik"
    distribution = "frankik"
    settings = (
        f"ik_sample_q7 over {TURN_DEG:g} degrees with full_ik; one: {FEW} samples, all "
        f"and nearest: {MANY}; of the FR3 it has limits of its own, which are narrower"
    )
    of_samples = True
    samples: ClassVar[dict[str, dict[str, Any]]] = {
        "one": {"sample_size": FEW, "sample_interval": TURN_DEG, "full_ik": True},
        "every": {"sample_size": MANY, "sample_interval": TURN_DEG, "full_ik": True},
    }

    def ways(self, arm: Arm) -> dict[str, Request]:
        """One: the first of the samples; all and nearest: of all samples."""
        frames, sample_q7 = _known(arm)
        sample, sample_all = (
            functools.partial(sample_q7, **self.samples[way])
            for way in ("one", "every")
        )
        home = _home(frames)

        def posture(pose: Array, near: Array) -> tuple[Any, ...]:
            return frames.target(pose), np.ascontiguousarray(near)

        def nearest(pose: Array, near: Array) -> Array | None:
            # As its class FrankaKinematics chooses.
            found = np.array(_usable(sample_all(pose, near)))
            if not len(found):
                return None
            return np.asarray(found[np.argmin(np.sum((found - near) ** 2, axis=1))])

        def chosen(returned: Any) -> list[Array]:
            return [] if returned is None else [returned]

        return {
            "one": Request(home, sample, _first),
            "every": Request(home, sample_all, _usable),
            "nearest": Request(posture, nearest, chosen),
        }

    def so_many(self, arm: Arm, number: int) -> Request:
        """So many samples, as for all."""
        frames, sample_q7 = _known(arm)
        words = self.samples["every"] | {"sample_size": number}
        return Request(_home(frames), functools.partial(sample_q7, **words), _usable)


class FrankikDefaults(Frankik):
    """The same as it is called without arguments but `full_ik` for all."""

    name = "frankik, defaults"
    settings = "its defaults: 60 samples of joint 7 over 40 degrees around the posture"
    samples: ClassVar[dict[str, dict[str, Any]]] = {
        "one": {},
        "every": {"full_ik": True},
    }


def _known(arm: Arm) -> tuple[Frames, Callable[..., Any]]:
    """Its frames of an arm, and its function with that arm's limits."""
    module = importlib.import_module("frankik")
    is_fr3 = _is_fr3(arm, module)
    # Its forward kinematics has the hand, its inverse has not.
    frames = fit_frames(arm, lambda q: np.asarray(module.fk(q) @ NO_HAND))
    return frames, functools.partial(module.ik_sample_q7, is_fr3=is_fr3)


def _home(frames: Frames) -> Callable[[Array, Array], tuple[Any, ...]]:
    """What it is asked without a posture."""

    def prepare(pose: Array, near: Array) -> tuple[Any, ...]:
        del near
        return (frames.target(pose),)

    return prepare


def _usable(returned: Any) -> list[Array]:
    return [np.asarray(q) for q in returned if np.isfinite(q).all()]


def _first(returned: Any) -> list[Array]:
    return _usable(returned)[:1]


def _is_fr3(arm: Arm, module: ModuleType) -> bool:
    """Whether to use the limits of the FR3: not on an arm that has the Panda's."""
    if arm.chain.dof != 7:
        raise UnsupportedError(f"Panda and FR3 only; not {arm.name}")
    lower, upper = np.array(module.q_min_panda), np.array(module.q_max_panda)
    off = np.abs([arm.chain.lower - lower, arm.chain.upper - upper]).max()
    return bool(off > LIMITS_DIFFER)
