# SPDX-License-Identifier: BSD-3-Clause
"""iksel fk: the pose at joint values."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from iksel._base.limits import violated_limits
from iksel.cli._configuration import add_configuration, read_configuration
from iksel.cli._output import numbers, print_json, print_matrix, print_pairs
from iksel.cli._robot import chain_text
from iksel.pose import euler_from_pose, quaternion_from_pose

if TYPE_CHECKING:
    import argparse

    from iksel_cpp import Robot

    from iksel._base.arrays import FloatArray
    from iksel.cli._angles import Angles

EXAMPLES = """\
examples:
  iksel fk ur3 0 -1.2 1.4 -0.6 1.2 0.2
  iksel fk ur3 --degrees 0 -70 80 -35 70 10 --json
  iksel fk panda 0 -0.5 0 -2 0 1.6 0.8 --matrix
  iksel fk arm.urdf 0 0 0 0 --base base_link --tip tool0

The pose is T_base_tcp, of the tip link without a tool. --matrix prints nothing but its
four rows, in full precision.

exit status: 0 done, 2 bad input
"""


def add_parser(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser(
        "fk",
        usage="iksel fk ROBOT Q ... [options]",
        help="show the pose at joint values",
        description="Forward kinematics: the pose of the TCP (or tip link) in the base "
        "link's frame.",
        epilog=EXAMPLES,
    )
    add_configuration(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Show the pose."""
    configuration = read_configuration(arguments)
    robot, angles, q = configuration
    pose = robot.fk(q)
    if arguments.matrix:
        print_matrix(pose.reshape(-1, 4))
    elif arguments.json:
        print_json(
            {
                **configuration.facts(),
                "within_limits": bool(robot.within_limits(q)),
                "pose": pose,
                "position": pose[..., :3, 3],
                "rpy": angles.show_angles(euler_from_pose(pose)),
                "quaternion_wxyz": quaternion_from_pose(pose),
            }
        )
    else:
        rows = [("robot", chain_text(robot))]
        for link, each in zip(robot.tip_links, pose.reshape(-1, 4, 4), strict=True):
            if robot.tips > 1:
                rows.append(("tip", link))
            rows += _pose_rows(each, angles)
        print_pairs([*rows, ("limits", limits_text(robot, q))])
    return 0


def _pose_rows(pose: FloatArray, angles: Angles) -> list[tuple[str, str]]:
    """A pose (4, 4) in all forms."""
    rpy = angles.show_angles(euler_from_pose(pose))
    return [
        ("position", f"{numbers(pose[:3, 3])} m"),
        ("rpy", f"{numbers(rpy)} {angles.unit}"),
        ("quaternion", f"{numbers(quaternion_from_pose(pose))} (w x y z)"),
        ("matrix", "\n".join(f"{numbers(row)}" for row in pose)),
    ]


def limits_text(robot: Robot, q: FloatArray) -> str:
    """Whether joint values (dof,) lie inside the limits; if not, which do not."""
    names = violated_limits(robot, q)
    return f"outside: {', '.join(names)}" if names else "inside"
