# SPDX-License-Identifier: BSD-3-Clause
"""crx-kinematics: FANUC's CRX arms in closed form but for one root, in Rust."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

import numpy as np

from bench.rivals.base import UnsupportedError
from bench.rivals.enumerator import Enumerator, Request, fit_frames

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array

MILLI = 1e3


class Crx(Enumerator):
    """The class Crx with the arm's four lengths."""

    name = "crx"
    distribution = "crx-kinematics"
    settings = (
        "the arm's four lengths, its ik; limits are not its business, nor that of its "
        "ik_closest, whose answer may lie outside and is not asked for"
    )
    keeps_limits = False

    def ways(self, arm: Arm) -> dict[str, Request]:
        """All branches."""
        module = importlib.import_module("crx_kinematics")
        robot = module.Crx.from_params(*_lengths(arm))

        def fk(q: Array) -> Array:
            return _metres(np.asarray(robot.fk(_controller(q))))

        frames = fit_frames(arm, fk)

        def alone(pose: Array, near: Array) -> tuple[Any, ...]:
            del near
            target = frames.target(pose)
            target[:3, 3] *= MILLI
            return (target,)

        return {
            "every": Request(alone, robot.ik, lambda rows: [_ours(q) for q in rows])
        }


def _lengths(arm: Arm) -> tuple[float, float, float, float]:
    """z1, x1, x2, y1 [mm] as if it were one; the frames tell whether it is."""
    chain = arm.chain
    if chain.dof != 6 or chain.prismatic.any():
        raise UnsupportedError(f"FANUC CRX only; {arm.name} has {chain.dof} joints")
    frames, tip = chain.joint_frames(np.zeros((1, 6)))
    h, p = frames[:, 0, :3, 2], frames[:, 0, :3, 3]
    z1 = np.linalg.norm(p[2] - p[1])
    x1 = abs((p[4] - p[2]) @ h[3])
    y1 = (p[5] - p[3]) @ h[1]
    x2 = abs((tip[0, :3, 3] - p[4]) @ h[5])
    lengths = MILLI * np.array([z1, x1, x2, abs(y1)])
    return tuple(lengths.tolist())


def _controller(q: Array) -> Array:
    """Degrees as FANUC's controller has them: joint 3 is counted against joint 2."""
    degrees = np.degrees(q)
    degrees[2] -= degrees[1]
    return np.asarray(degrees)


def _ours(degrees: Array) -> Array:
    ours = degrees.copy()
    ours[2] += ours[1]
    return np.asarray(np.radians(ours))


def _metres(pose: Array) -> Array:
    pose = pose.copy()
    pose[:3, 3] /= MILLI
    return pose
