# SPDX-License-Identifier: BSD-3-Clause
"""Poses and joint values in the unit of angles that the user chose."""

from __future__ import annotations

import math
import re
import sys
from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import InvalidArgumentError, JointType, UnknownNameError

from iksel._base.angles import look_like_degrees
from iksel.cli._parser import POSE_COUNTS, POSE_FORMS, parse_numbers, warning_line
from iksel.pose import check_pose, pose_from_euler, pose_from_quaternion
from iksel.srdf import Srdf

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

    from iksel_cpp import Robot

    from iksel._base.arrays import FloatArray
    from iksel.pose import QuaternionOrder

    Limits = tuple[FloatArray, FloatArray]

SLACK = math.radians(1.0)
"""By how much joints that are at a limit may be measured outside it [rad]."""


def add_order(parser: argparse._ActionsContainer) -> None:
    """Add --order."""
    parser.add_argument(
        "--order",
        choices=("wxyz", "xyzw"),
        default="wxyz",
        help="of the quaternion in a pose of 7 numbers: the scalar qw first, or last, "
        "as ROS and SciPy print it; names of columns in a file say it themselves "
        "(default: wxyz)",
    )


def add_degrees(parser: argparse._ActionsContainer) -> None:
    """Add --degrees."""
    parser.add_argument(
        "--degrees",
        action="store_true",
        help="joint angles and roll, pitch, yaw are degrees, in what is given and in "
        "what is printed; tolerances and errors stay radians",
    )


class Angles:
    """Reads and shows angles in degrees or radians; warns of radians that are none."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        """Take the unit from --degrees, and the order of quaternions from --order."""
        self._degrees: bool = arguments.degrees
        self._order: QuaternionOrder = getattr(arguments, "order", "wxyz")
        self._warned = False
        self._srdf: str | None = getattr(arguments, "srdf", None)

    @property
    def unit(self) -> str:
        """The unit's name."""
        return "deg" if self._degrees else "rad"

    def read(
        self, flag: str, angles: Sequence[float], limits: Limits | None = None
    ) -> list[float]:
        """Angles that were given, in radians.

        Args:
            flag: What they were given by, for the warning.
            angles: The angles of a rotation, or the values of joints that turn.
            limits: Lower and upper limits of the joints [rad]; None: of a rotation.
        """
        if self._degrees:
            return [float(x) for x in np.radians(angles)]
        if self._warned:
            return list(angles)
        if limits is None:
            suspect = look_like_degrees(angles)
        else:
            suspect = joints_look_like_degrees(angles, *limits)
        if suspect:
            self._warned = True
            text = " ".join(f"{x:g}" for x in angles)
            sys.stderr.write(
                warning_line(
                    f"{flag}: {text} look like degrees, and are taken as radians; "
                    "give --degrees if they are"
                )
            )
        return list(angles)

    def read_pose(self, flag: str, words: Sequence[str]) -> FloatArray:
        """A pose in one of POSE_FORMS as a (4, 4) matrix.

        Raises:
            InvalidArgumentError: Not numbers, another count, or not rigid.
        """
        numbers = parse_numbers(flag, words)
        comma = any(re.fullmatch(r"-?\d+,\d+", word) for word in words)
        if comma and len(numbers) not in POSE_COUNTS:
            raise InvalidArgumentError(
                f"{flag}: expected {POSE_FORMS}; got {len(numbers)}; decimals take a "
                "point, and commas separate numbers"
            )
        return self.as_pose(flag, numbers)

    def as_pose(
        self, flag: str, numbers: Sequence[float], order: QuaternionOrder | None = None
    ) -> FloatArray:
        """The pose that the numbers of one of POSE_FORMS are, as a (4, 4) matrix.

        Args:
            flag: What they were given by, for messages.
            numbers: Of the pose.
            order: Of the quaternion, if they are one; None: that of --order.

        Raises:
            InvalidArgumentError: Another count, not finite, or not rigid.
        """
        try:
            if len(numbers) == 6:
                return pose_from_euler(numbers[:3], self.read(flag, numbers[3:]))
            if len(numbers) == 7:
                order = order or self._order
                return pose_from_quaternion(numbers[:3], numbers[3:], order)
            if len(numbers) == 16:
                return check_pose([numbers[i : i + 4] for i in range(0, 16, 4)])
        except InvalidArgumentError as error:
            raise InvalidArgumentError(f"{flag}: {error}") from None
        raise InvalidArgumentError(f"{flag}: expected {POSE_FORMS}; got {len(numbers)}")

    def read_joints(self, flag: str, words: Sequence[str], robot: Robot) -> list[float]:
        """One number per joint [rad or m], or the name of a state of the SRDF.

        Raises:
            InvalidArgumentError: Not numbers, or not as many as there are joints.
            UnknownNameError: No state of that name gives all joints.
        """
        names = robot.joint_names
        if self._srdf is not None and len(words) == 1 and not _is_number(words[0]):
            return _state(flag, words[0], Srdf(self._srdf).states(robot))
        values = parse_numbers(flag, words)
        if len(values) != len(names):
            raise InvalidArgumentError(
                f"{flag}: expected {len(names)} numbers, one per joint "
                f"({', '.join(names)}), got {len(values)}"
            )
        turns = turning(robot)
        angles = [v for v, turn in zip(values, turns, strict=True) if turn]
        limits = robot.lower[turns], robot.upper[turns]
        radians = iter(self.read(flag, angles, limits))
        return [next(radians) if t else v for v, t in zip(values, turns, strict=True)]

    def show(self, robot: Robot, q: FloatArray) -> FloatArray:
        """Joint values (..., dof) [rad or m] in the unit."""
        scale = np.degrees(1.0) if self._degrees else 1.0
        return np.asarray(q * np.where(turning(robot), scale, 1.0))

    def units(self, robot: Robot) -> list[str]:
        """The unit of each joint's values."""
        return [self.unit if turn else "m" for turn in turning(robot)]

    def show_angles(self, radians: FloatArray) -> FloatArray:
        """Angles of any shape [rad] in the unit."""
        return np.degrees(radians) if self._degrees else radians

    def show_joint(self, robot: Robot, joint: int, values: FloatArray) -> FloatArray:
        """Values of one joint, of any shape [rad or m], in the unit."""
        return self.show_angles(values) if turning(robot)[joint] else values

    def show_optional(self, robot: Robot, q: Any) -> FloatArray | None:
        """The same; None stays None."""
        return None if q is None else self.show(robot, q)


def _state(flag: str, name: str, states: dict[str, FloatArray]) -> list[float]:
    if name not in states:
        raise UnknownNameError(
            f"{flag}: no state {name!r} of the SRDF gives all joints; states that do: "
            f"{', '.join(states) or 'none'}"
        )
    return [float(value) for value in states[name]]


def _is_number(word: str) -> bool:
    try:
        parse_numbers("", [word])
    except InvalidArgumentError:
        return False
    return True


def joints_look_like_degrees(
    values: Sequence[float], lower: FloatArray, upper: FloatArray
) -> bool:
    """Whether joint values are no radians, for their limits, but could be degrees.

    As radians one of them lies more than a whole turn outside its limits, and as
    degrees all lie inside. So a joint without limits, or with limits of many turns, is
    never suspected for turning far.
    """
    q = np.asarray(values, dtype=float)
    turn = 2 * math.pi
    beyond = (q < lower - turn) | (q > upper + turn)
    degrees = np.radians(q)
    inside = (degrees >= lower - SLACK) & (degrees <= upper + SLACK)
    return bool(beyond.any() and inside.all())


def turning(robot: Robot) -> list[bool]:
    """Which joints turn; the others slide."""
    return [kind != JointType.prismatic for kind in robot.joint_types]
