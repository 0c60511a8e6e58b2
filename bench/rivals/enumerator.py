# SPDX-License-Identifier: BSD-3-Clause
"""Solvers that are asked in several ways: for one answer, for all, for the nearest."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from bench.rivals.base import Rival, Run, UnsupportedError
from bench.timing import time_calls

if TYPE_CHECKING:
    from collections.abc import Callable

    from bench.arms import Arm
    from bench.chain import Array, Chain
    from bench.targets import Targets

WAYS = ("one", "every", "nearest")
"""What is asked for: any answer, all branches, the branch nearest to a posture."""

EXACT = 1e-9
"""Two descriptions of an arm may differ by this [m, elements of a rotation]."""
PROBES = 50
"""Configurations that they are compared at."""


@dataclass(frozen=True)
class Request:
    """One way to ask a solver."""

    prepare: Callable[[Array, Array], tuple[Any, ...]]
    """Arguments of `call` from a pose and a posture, made before the clock starts."""
    call: Callable[..., Any]
    """The one thing that is timed."""
    answers: Callable[[Any], list[Array]]
    """Configurations in what `call` returned, made after the clock has stopped."""


class Enumerator(Rival):
    """A solver made for one robot, and the ways in which it can be asked."""

    numerical: ClassVar[bool] = False
    """Whether it iterates to one answer from a start."""
    of_samples: ClassVar[bool] = False
    """Whether the number that `so_many` takes is of samples, not of answers."""

    def __init__(self, arm: Arm) -> None:
        """Make it for a robot; UnsupportedError if it cannot be."""
        self.requests = self.ways(arm)

    @abstractmethod
    def ways(self, arm: Arm) -> dict[str, Request]:
        """Some of WAYS. A solver that only knows all has "every" alone."""

    def so_many(self, arm: Arm, number: int) -> Request:
        """Some of all answers.

        Raises:
            UnsupportedError: It cannot be asked for so many.
        """
        raise UnsupportedError(f"{self.name} cannot give {number} of {arm.name}")

    def ask(self, way: str, targets: Targets, near: Array, limit_s: float) -> Run:
        """Time one way on all targets; no further call after `limit_s`."""
        request = self.requests[way]
        prepared = [
            request.prepare(pose, q)
            for pose, q in zip(targets.poses, near, strict=True)
        ]
        times, returned = time_calls(request.call, prepared, limit_s)
        return Run(times, [request.answers(value) for value in returned])

    def run(self, targets: Targets) -> Run:
        """One answer where it can be asked for one, else all."""
        way = next(way for way in WAYS if way in self.requests)
        return self.ask(way, targets, targets.starts, self.limit_s)


@dataclass(frozen=True)
class Frames:
    """T_base_tip of an arm as another description has it: base @ theirs @ tool."""

    base: Array
    tool: Array

    def target(self, pose: Array) -> Array:
        """The pose to ask for so that the tip gets this one, (4, 4)."""
        return np.ascontiguousarray(
            np.linalg.inv(self.base) @ pose @ np.linalg.inv(self.tool)
        )


def fit_frames(arm: Arm, fk: Callable[[Array], Array]) -> Frames:
    """The frames by which another forward kinematics becomes an arm's.

    Args:
        arm: All of its joints turn.
        fk: The other one, from one configuration (dof,) of the arm to a pose (4, 4).

    Raises:
        UnsupportedError: It is another arm.
    """
    chain = arm.chain
    if chain.prismatic.any():
        raise UnsupportedError(f"{arm.name} has a joint that slides")
    zero = np.zeros(chain.dof)
    ours = _axes(lambda q: np.asarray(chain.fk(q[None])[0]), chain.dof)
    theirs = _axes(fk, chain.dof)
    u, _, v = np.linalg.svd(ours[0].T @ theirs[0])
    base = np.eye(4)
    base[:3, :3] = u @ np.diag([1.0, 1.0, np.linalg.det(u @ v)]) @ v
    moved = theirs[1] @ base[:3, :3].T
    # A point of each axis may lie anywhere along it.
    across = np.eye(3) - ours[0][:, :, None] * ours[0][:, None, :]
    gaps = np.einsum("nij,nj->ni", across, ours[1] - moved)
    base[:3, 3] = np.linalg.lstsq(across.reshape(-1, 3), gaps.ravel(), rcond=None)[0]
    tool = np.linalg.inv(base @ fk(zero)) @ chain.fk(zero[None])[0]
    frames = Frames(base, tool)
    off = _largest_difference(chain, fk, frames)
    if not off <= EXACT:
        raise UnsupportedError(
            f"{arm.name} is no such arm: poses are off by {off:.1g} (m, or elements of "
            "the rotation)"
        )
    return frames


def _axes(fk: Callable[[Array], Array], dof: int) -> tuple[Array, Array]:
    """Directions and points of the joint axes at zero, (dof, 3) each."""
    start = np.linalg.inv(fk(np.zeros(dof)))
    directions, points = [], []
    for row in np.eye(dof):
        moved = fk(row) @ start
        turn, shift = moved[:3, :3], moved[:3, 3]
        skew = turn - turn.T
        axis = np.array([skew[2, 1], skew[0, 2], skew[1, 0]]) / (2.0 * np.sin(1.0))
        directions.append(axis)
        points.append(np.linalg.lstsq(np.eye(3) - turn, shift, rcond=None)[0])
    return np.array(directions), np.array(points)


def _largest_difference(
    chain: Chain, fk: Callable[[Array], Array], frames: Frames
) -> float:
    random = np.random.default_rng(1)
    q = random.uniform(-np.pi, np.pi, (PROBES, chain.dof))
    theirs = np.array([frames.base @ fk(row) @ frames.tool for row in q])
    return float(np.abs(theirs - chain.fk(q)).max())
