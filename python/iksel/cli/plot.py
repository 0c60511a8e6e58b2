# SPDX-License-Identifier: BSD-3-Clause
"""iksel plot: pictures of a robot's workspace, manipulability and solutions."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import InvalidArgumentError, Solver, Status

from iksel._base import extras
from iksel._base.figures import check_suffix, save_figure
from iksel.cli import _plots as plots
from iksel.cli._angles import Angles
from iksel.cli._options import add_solver_options, given_database, solver_options
from iksel.cli._output import add_json, print_json, print_pairs
from iksel.cli._parser import count_up_to, seed
from iksel.cli._poses import FILE_FORMS, read_poses
from iksel.cli._robot import load
from iksel.cli._robot_flags import add_robot

if TYPE_CHECKING:
    import argparse

    from iksel_cpp import Robot

PICTURES = ("workspace", "manipulability", "branches")
CONFIGURATIONS = 200_000
MOST_CONFIGURATIONS = 10_000_000

EXAMPLES = f"""\
examples:
  iksel plot ur3 -o ur3.png
  iksel plot panda manipulability -o panda.svg --configurations 20000
  iksel plot ur3 branches --poses poses.csv -o branches.png --degrees
  iksel plot arm.urdf --base base_link --tip tool0 -o arm.png

workspace       where configurations at random, uniform inside the limits, put the TCP,
                from the side and from above
manipulability  the largest product of the Jacobian's singular values among them
                (Yoshikawa 1985), likewise
branches        all solutions of the poses of a path, joint by joint, with the limits,
                and the way that 'iksel path' takes through them

--poses {FILE_FORMS}
exit status: 0 drawn, 2 bad input
"""


def add_parser(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser(
        "plot",
        usage="iksel plot ROBOT [PICTURE] -o FILE [options]",
        help="draw the workspace, manipulability, or the solutions along a path",
        description="Draw a picture of a robot. Needs pip install 'iksel[plot]'.",
        epilog=EXAMPLES,
    )
    add_robot(parser)
    parser.add_argument(
        "picture",
        nargs="?",
        choices=PICTURES,
        default="workspace",
        metavar="PICTURE",
        help=f"{', '.join(PICTURES)} (default: %(default)s)",
    )
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        required=True,
        metavar="FILE",
        help=".png, .svg or .pdf",
    )
    parser.add_argument(
        "--poses", metavar="FILE", help="the path, for branches; - is stdin"
    )
    parser.add_argument(
        "--configurations",
        type=count_up_to(MOST_CONFIGURATIONS),
        metavar="N",
        help=f"for workspace and manipulability (default: {CONFIGURATIONS})",
    )
    parser.add_argument(
        "--seed", type=seed, metavar="N", help="of the configurations (default: 0)"
    )
    add_json(parser)
    add_solver_options(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Draw the picture."""
    check_flags(arguments)
    check_suffix(arguments.output)
    extras.need("matplotlib", user="iksel plot", extra="'iksel[plot]'")
    robot = load(arguments)
    if arguments.picture == "branches":
        figure, facts = draw_branches(robot, arguments)
    else:
        figure, facts = draw_cells(robot, arguments)
    save_figure(figure, arguments.output)
    facts = {"file": str(arguments.output), "picture": arguments.picture, **facts}
    if arguments.json:
        print_json(facts)
    else:
        print_pairs((name.replace("_", " "), str(x)) for name, x in facts.items())
    return 0


def check_flags(arguments: argparse.Namespace) -> None:
    """Refuse what the picture does not read.

    Raises:
        InvalidArgumentError: A flag is missing, or has no meaning.
    """
    if arguments.picture == "branches":
        if arguments.poses is None:
            raise InvalidArgumentError("branches: needs a path, --poses FILE")
        unread = ("configurations", "seed")
    else:
        unread = ("poses", "database")
    for name in unread:
        if getattr(arguments, name) is not None:
            raise InvalidArgumentError(
                f"--{name}: the picture '{arguments.picture}' does not read it"
            )


def draw_cells(
    robot: Robot, arguments: argparse.Namespace
) -> tuple[Any, dict[str, Any]]:
    """The figure of configurations at random, and what is in it."""
    number = arguments.configurations or CONFIGURATIONS
    q = robot.random_configurations(number, arguments.seed or 0)
    draw = {
        "workspace": plots.workspace_figure,
        "manipulability": plots.manipulability_figure,
    }[arguments.picture]
    return draw(robot, q), {"configurations": number}


def draw_branches(
    robot: Robot, arguments: argparse.Namespace
) -> tuple[Any, dict[str, Any]]:
    """The figure of the solutions along a path, and what is in it."""
    angles = Angles(arguments)
    poses = read_poses(arguments.poses, angles, robot)
    solver = Solver(robot, solver_options(arguments), given_database(arguments))
    branches = plots.find_branches(solver, poses)
    facts = {
        "waypoints": len(poses),
        "without_solution": int(np.sum(branches.status != int(Status.solved))),
        "solutions": len(branches.q),
        "path": branches.path.status.name,
    }
    return plots.branches_figure(robot, branches, angles), facts
