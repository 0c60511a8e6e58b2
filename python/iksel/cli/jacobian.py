# SPDX-License-Identifier: BSD-3-Clause
"""iksel jacobian: how the pose changes with the joint values."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from iksel.cli._configuration import add_configuration, read_configuration
from iksel.cli._output import (
    number,
    numbers,
    print_json,
    print_matrix,
    print_pairs,
    print_table,
)
from iksel.cli._robot import chain_text

if TYPE_CHECKING:
    import argparse

EXAMPLES = """\
examples:
  iksel jacobian ur3 0 -1.2 1.4 -0.6 1.2 0.2
  iksel jacobian ur3 --degrees 0 -70 80 -35 70 10 --json
  iksel jacobian panda 0 -0.5 0 -2 0 1.6 0.8 --matrix
  iksel jacobian arm.urdf 0 0 0 0 --base base_link --tip tool0

Rows are the velocity of the TCP, linear [m/s], then angular [rad/s], in the base link's
axes; a column is for one joint at 1 rad/s or m/s, with --degrees too. --matrix prints
nothing but the six rows, in full precision; of several tips one below the other.
Manipulability is the product of the
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
    add_configuration(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Show the Jacobian."""
    configuration = read_configuration(arguments)
    robot = configuration.robot
    jacobian = robot.jacobian(configuration.q)
    values = np.linalg.svd(jacobian, compute_uv=False)
    rows = list(ROWS)
    if robot.tips > 1:
        rows = [f"{row} {link}" for link in robot.tip_links for row in ROWS]
    if arguments.matrix:
        print_matrix(jacobian)
    elif arguments.json:
        print_json(
            {
                **configuration.facts(),
                "rows": rows,
                "jacobian": jacobian,
                "singular_values": values,
                "manipulability": values.prod(),
            }
        )
    else:
        print_pairs(
            [
                ("robot", chain_text(robot)),
                ("singular values", numbers(values)),
                ("manipulability", f"{values.prod():.6g}"),
            ]
        )
        print()
        print_table(
            ("", *robot.joint_names),
            [
                (name, *(number(x) for x in row))
                for name, row in zip(rows, jacobian.tolist(), strict=True)
            ],
        )
    return 0
