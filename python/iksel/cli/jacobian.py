# SPDX-License-Identifier: BSD-3-Clause
"""iksel jacobian: how the pose changes with the joint values."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from iksel.cli._angles import Angles
from iksel.cli._output import (
    number,
    numbers,
    print_json,
    print_matrix,
    print_pairs,
    print_table,
)
from iksel.cli._robot import add_joint_values, load

if TYPE_CHECKING:
    import argparse

    from iksel._arrays import FloatArray

EXAMPLES = """\
examples:
  iksel jacobian ur3 0 -1.2 1.4 -0.6 1.2 0.2
  iksel jacobian ur3 --degrees 0 -70 80 -35 70 10 --json
  iksel jacobian panda 0 -0.5 0 -2 0 1.6 0.8 --matrix
  iksel jacobian arm.urdf 0 0 0 0 --base base_link --tip tool0

Rows are the velocity of the TCP, linear [m/s], then angular [rad/s], in the base link's
axes; a column is for one joint at 1 rad/s or m/s, with --degrees too. --matrix prints
nothing but the six rows, in full precision. Manipulability is the product of the
singular values (Yoshikawa 1985), of which some are lengths and some are not.

exit status: 0 done, 2 bad input
"""

ROWS = ("vx", "vy", "vz", "wx", "wy", "wz")


def add_parser(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser(
        "jacobian",
        usage="iksel jacobian ROBOT Q ... [options]",
        help="show the Jacobian at joint values",
        description="The geometric Jacobian at joint values, its singular values and "
        "the manipulability.",
        epilog=EXAMPLES,
    )
    add_joint_values(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Show the Jacobian."""
    robot = load(arguments)
    angles = Angles(arguments)
    q = np.array(angles.read_joints("Q", arguments.q, robot))
    jacobian = robot.jacobian(q)
    values = np.linalg.svd(jacobian, compute_uv=False)
    if arguments.matrix:
        print_matrix(jacobian)
    elif arguments.json:
        print_json(
            {
                "robot": robot.name,
                "base_link": robot.base_link,
                "tip_link": robot.tip_link,
                "joint_names": robot.joint_names,
                "angle_unit": angles.unit,
                "q": angles.show(robot, q),
                "rows": ROWS,
                "jacobian": jacobian,
                "singular_values": values,
                "manipulability": manipulability(jacobian),
            }
        )
    else:
        print_pairs(
            [
                ("robot", f"{robot.name}, {robot.base_link} -> {robot.tip_link}"),
                ("singular values", numbers(values)),
                ("manipulability", f"{manipulability(jacobian):.6g}"),
            ]
        )
        print()
        print_table(
            ("", *robot.joint_names),
            [
                (name, *(number(x) for x in row))
                for name, row in zip(ROWS, jacobian.tolist(), strict=True)
            ],
        )
    return 0


def manipulability(jacobian: FloatArray) -> Any:
    """Product of the singular values of Jacobians (..., 6, dof)."""
    return np.linalg.svd(jacobian, compute_uv=False).prod(axis=-1)
