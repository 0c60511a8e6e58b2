# SPDX-License-Identifier: BSD-3-Clause
"""OPW kinematics: six joints with a parallel elbow and a spherical wrist, in Rust."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from bench.rivals.axes import meeting_point
from bench.rivals.base import UnsupportedError
from bench.rivals.enumerator import Enumerator, Request, fit_frames

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array

SQUARE = 1e-9
"""Cosines below this are of perpendicular axes; lengths, of none [m]."""


@dataclass(frozen=True)
class OpwForm:
    """Lengths, and joint values: theirs = signs * ours + offsets.

    After Brandstoetter, Angerer and Hofbaur (2014), with base and tool frames left to
    bench.rivals.enumerator.fit_frames, so that c1 = c4 = 0.
    """

    lengths: dict[str, float]
    signs: Array
    offsets: Array


def opw_form(arm: Arm) -> OpwForm:
    """The parameters of an arm.

    Raises:
        UnsupportedError: It has another structure.
    """
    chain = arm.chain
    if chain.dof != 6 or chain.prismatic.any():
        raise UnsupportedError(f"6 revolute joints only; {arm.name} has {chain.dof}")
    frames, _ = chain.joint_frames(np.zeros((1, 6)))
    h, p = frames[:, 0, :3, 2], frames[:, 0, :3, 3]
    z, y = h[0], h[1]
    x = np.cross(y, z)
    wrist = meeting_point(h[3:], p[3:])
    if wrist is None:
        raise UnsupportedError("its last three axes do not meet in one point")
    perpendicular = [z @ y, h[3] @ y, h[3] @ h[4], h[4] @ h[5]]
    if np.abs(perpendicular).max() > SQUARE or abs(abs(h[2] @ y) - 1.0) > SQUARE:
        raise UnsupportedError(f"{arm.name} has no parallel elbow with a square wrist")
    shoulder = p[0] + ((p[1] - p[0]) @ z) * z
    upper, fore = p[2] - p[1], wrist - p[2]
    tilt = np.arctan2(upper @ x, upper @ z)
    # Axis 4 points along the forearm.
    along = 1.0 if fore @ h[3] >= 0.0 else -1.0
    d = along * h[3]
    reach = np.arctan2(d @ x, d @ z)
    outward = np.cos(reach) * x - np.sin(reach) * z
    roll = np.arctan2(-(h[4] @ outward), h[4] @ y)
    across = np.cross(h[4], d)
    pitch = np.arctan2(h[5] @ across, h[5] @ d)
    lengths = {
        "a1": float((p[1] - shoulder) @ x),
        "a2": float(fore @ outward),
        "b": float((wrist - shoulder) @ y),
        "c2": float(np.hypot(upper @ x, upper @ z)),
        "c3": float(fore @ d),
    }
    elbow = float(np.sign(h[2] @ y))
    offsets = np.array([0.0, tilt, reach - tilt, roll, pitch, 0.0])
    return OpwForm(lengths, np.array([1.0, 1.0, elbow, along, 1.0, 1.0]), offsets)


class Opw(Enumerator):
    """py-opw-kinematics, which calls the crate rs-opw-kinematics."""

    name = "opw"
    distribution = "py-opw-kinematics"
    settings = (
        "lengths, signs and offsets from the axes, radians; all branches in one call; "
        "nearest: the first inside the limits as it sorts them; limits are not its "
        "business"
    )
    keeps_limits = False

    def ways(self, arm: Arm) -> dict[str, Request]:
        """All branches, sorted by distance from a posture if there is one."""
        module = importlib.import_module("py_opw_kinematics")
        form = opw_form(arm)
        robot = module.Robot(module.KinematicModel(**form.lengths), degrees=False)

        def fk(q: Array) -> Array:
            pose = robot.forward(tuple(form.signs * q + form.offsets))
            return np.asarray(getattr(pose, "as_matrix", lambda: pose)())

        frames = fit_frames(arm, fk)
        rigid = importlib.import_module("scipy.spatial.transform").RigidTransform

        def alone(pose: Array, near: Array) -> tuple[Any, ...]:
            del near
            return (rigid.from_matrix(frames.target(pose)),)

        def both(pose: Array, near: Array) -> tuple[Any, ...]:
            theirs = tuple(form.signs * near + form.offsets)
            return rigid.from_matrix(frames.target(pose)), theirs

        def every(returned: Any) -> list[Array]:
            return [(np.array(q) - form.offsets) * form.signs for q in returned]

        return {
            "every": Request(alone, robot.inverse, every),
            "nearest": Request(both, robot.inverse, every),
        }
