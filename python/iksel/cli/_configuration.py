# SPDX-License-Identifier: BSD-3-Clause
"""ROBOT Q ...: one configuration, of which fk and jacobian say what there is."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from iksel.cli._angles import Angles
from iksel.cli._output import add_json
from iksel.cli._robot import load
from iksel.cli._robot_flags import add_robot

if TYPE_CHECKING:
    import argparse

    from iksel_cpp import Robot

    from iksel._base.arrays import FloatArray


def tip_facts(robot: Robot) -> dict[str, Any]:
    """The link that is the tip, or those that are."""
    if robot.tips == 1:
        return {"tip_link": robot.tip_link}
    return {"tip_links": robot.tip_links}


class Configuration(NamedTuple):
    """A robot and its joint values."""

    robot: Robot
    angles: Angles
    q: FloatArray
    """(dof,) [rad or m]."""

    def facts(self) -> dict[str, Any]:
        """What is given again in JSON."""
        robot = self.robot
        return {
            "robot": robot.name,
            "base_link": robot.base_link,
            **tip_facts(robot),
            "joint_names": robot.joint_names,
            "angle_unit": self.angles.unit,
            "q": self.angles.show(robot, self.q),
        }


def add_configuration(parser: argparse.ArgumentParser) -> None:
    """Add ROBOT, Q ..., and the forms in which what is there is shown."""
    add_robot(parser)
    parser.add_argument(
        "q", nargs="+", metavar="Q", help="joint values, one per joint [rad or m]"
    )
    form = parser.add_mutually_exclusive_group()
    add_json(form)
    form.add_argument(
        "--matrix", action="store_true", help="print the numbers of the matrix only"
    )


def read_configuration(arguments: argparse.Namespace) -> Configuration:
    """What the arguments of add_configuration() describe.

    Raises:
        Error: As of load(); InvalidArgumentError too if there are not dof numbers.
    """
    robot = load(arguments)
    angles = Angles(arguments)
    q = np.array(angles.read_joints("Q", arguments.q, robot))
    return Configuration(robot, angles, q)
