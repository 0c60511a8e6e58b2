# SPDX-License-Identifier: BSD-3-Clause
"""Joint values and the target as text, to be copied and typed."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import InvalidArgumentError, JointType

from iksel._base.arrays import reject
from iksel.pose import euler_from_pose, pose_from_euler, pose_from_quaternion

if TYPE_CHECKING:
    from iksel_cpp import Robot

    from iksel._base.arrays import FloatArray
    from iksel.view.session import Session

DEGREES = "degrees"
UNITS = (DEGREES, "radians")
_DIGITS = 6


class Numbers:
    """Fields of text, and a button for each that moves the robot there."""

    def __init__(self, gui: Any, session: Session) -> None:
        """Take viser's GUI and what is shown."""
        self._session = session
        robot = session.robot
        self._turns = np.array([k != JointType.prismatic for k in robot.joint_types])
        self._degrees = True
        self.q = gui.add_text(
            "q",
            "",
            multiline=True,
            hint="values of all joints, in the unit of the sliders",
        )
        self.to_q = gui.add_button("move to q", hint="and the target with the tool")
        self.poses = []
        self.to_poses = []
        for name in target_names(robot):
            field = gui.add_text(
                name,
                "",
                multiline=True,
                hint="x y z [m] roll pitch yaw, or x y z and a quaternion w x y z",
            )
            self.poses.append(field)
            self.to_poses.append(gui.add_button(f"move to {name}"))

    @property
    def buttons(self) -> list[Any]:
        """What moves the robot."""
        return [self.to_q, *self.to_poses]

    def draw(self, *, degrees: bool) -> None:
        """Show where the robot and the targets are."""
        self._degrees = degrees
        self.q.value = _words(self._session.q * self._scales())
        for field, pose in zip(self.poses, self._session.targets, strict=True):
            angles = np.array(euler_from_pose(pose)) * self._angle()
            field.value = _words([*pose[:3, 3], *angles])

    def apply(self, button: Any) -> None:
        """Move the robot to what is in the field of a button.

        Raises:
            InvalidArgumentError: The field holds something else.
        """
        if button is self.to_q:
            q = _read("q", self.q.value, (self._session.robot.dof,))
            self._session.show(q / self._scales())
            return
        tip = self.to_poses.index(button)
        values = _read("target", self.poses[tip].value, (6, 7))
        if len(values) == 6:
            pose = pose_from_euler(values[:3], values[3:] / self._angle())
        else:
            norm = np.linalg.norm(values[3:])
            if norm < 0.9 or norm > 1.1:
                reject("target", f"a quaternion has length 1, this {norm:.3g}")
            pose = pose_from_quaternion(values[:3], values[3:] / norm)
        self._session.move_target(pose, tip)

    def _angle(self) -> float:
        """What an angle [rad] is multiplied by to be shown."""
        return float(np.rad2deg(1.0)) if self._degrees else 1.0

    def _scales(self) -> FloatArray:
        return np.where(self._turns, self._angle(), 1.0)


def target_names(robot: Robot) -> list[str]:
    """What the target of each tip is called; one needs no name."""
    if robot.tips == 1:
        return ["target"]
    return [f"target of {link}" for link in robot.tip_links]


def _words(values: Any) -> str:
    """Numbers as text; what is nothing but rounding is 0."""
    rounded = np.round(np.asarray(values, float), _DIGITS) + 0.0
    return " ".join(f"{value:.{_DIGITS}g}" for value in rounded)


def _read(name: str, text: str, counts: tuple[int, ...]) -> FloatArray:
    """The numbers of a field, which may have commas and brackets between them."""
    words = re.split(r"[\s,;\[\]()]+", text.strip().strip("[]();,"))
    listed = " or ".join(map(str, counts))
    try:
        values = np.array([float(word) for word in words if word])
    except ValueError as error:
        raise InvalidArgumentError(f"{name}: {error}") from None
    if len(values) not in counts or not np.isfinite(values).all():
        reject(name, f"expected {listed} numbers, got {text[:80]!r}")
    return values
