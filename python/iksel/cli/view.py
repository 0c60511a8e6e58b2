# SPDX-License-Identifier: BSD-3-Clause
"""iksel view: a robot in the browser."""

from __future__ import annotations

import argparse
import contextlib
from pathlib import Path
from typing import Any

from iksel_cpp import Solver

from iksel.cli._angles import Angles
from iksel.cli._options import add_solver_options, given_database, solver_options
from iksel.cli._robot import load, of_files
from iksel.cli._robot_flags import add_robot
from iksel.view import PORT, Viewer

EXAMPLES = """\
examples:
  iksel view ur5e
  iksel view panda --q 0 -0.5 0 -2 0 1.6 0.8
  iksel view arm.urdf --base base_link --tip tool0 --tcp 0 0 0.1 0 0 0
  iksel view ur5e --map ur5e.zarr
  iksel view xarm5 --task free_spin --port 9000
  iksel view torso.urdf --tip left_hand --tip right_hand

Drag the target, or one for each --tip, and the robot follows. Ctrl-C ends.
"""


def add_parser(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser(
        "view",
        usage="iksel view ROBOT [options]",
        help="drag a target in the browser, and see inverse kinematics follow",
        description="Serve a page with the robot, a target to drag, sliders for the "
        "joints, joint values and poses to copy and type, all branches, and why there "
        "is no answer where there is none. Needs pip install 'iksel[view]'.",
        epilog=EXAMPLES,
    )
    add_robot(parser)
    parser.add_argument(
        "--q",
        nargs="+",
        metavar="Q",
        help="joint values to begin with [rad or m] (default: away from limits and "
        "singularities)",
    )
    parser.add_argument(
        "--map",
        type=Path,
        metavar="MAP",
        help="a reachability map of the robot ('iksel reach') to show around it",
    )
    add_server(parser)
    add_solver_options(parser)
    parser.set_defaults(run=run)


def add_server(parser: argparse.ArgumentParser) -> None:
    """Add where the page is served."""
    parser.add_argument(
        "--port",
        type=_port,
        default=PORT,
        metavar="N",
        help="of the page; the next free one if that is taken (default: %(default)s)",
    )
    parser.add_argument(
        "--host",
        default="127.0.0.1",
        metavar="ADDRESS",
        help="address to listen at (default: %(default)s, this machine alone; 0.0.0.0: "
        "all)",
    )
    parser.add_argument(
        "--origin",
        action="append",
        default=[],
        metavar="URL",
        help="a page that may connect besides the viewer's own, such as one behind a "
        "proxy: https://lab.example:8443; may be repeated",
    )


def run(arguments: argparse.Namespace) -> int:
    """Serve until Ctrl-C."""
    robot = load(arguments)
    angles = Angles(arguments)
    q = arguments.q and angles.read_joints("--q", arguments.q, robot)
    solver = Solver(robot, solver_options(arguments), given_database(arguments))
    looks = {"urdf": arguments.robot, **of_files(arguments)}
    with serve(arguments, solver, **looks) as viewer:
        if q is not None:
            viewer.show(q)
        if arguments.map is not None:
            from iksel import reach  # noqa: PLC0415 (an extra)

            viewer.show_map(reach.open(arguments.map))
        announce(viewer)
    return 0


def serve(arguments: argparse.Namespace, solver: Solver, **looks: Any) -> Viewer:
    """A viewer where the flags of add_server() say; `looks` are Viewer's."""
    where = {"port": arguments.port, "host": arguments.host}
    return Viewer(solver, **where, origins=arguments.origin, **looks)


def announce(viewer: Viewer) -> None:
    """Say where the page is, and serve it."""
    # Whoever reads the line may interrupt before wait() is reached.
    with contextlib.suppress(KeyboardInterrupt):
        print(f"{viewer.url} (Ctrl-C ends)", flush=True)
        viewer.wait()


def _port(text: str) -> int:
    """An argument that is a port."""
    if not text.isdecimal() or not 1 <= int(text) <= 65535:
        raise argparse.ArgumentTypeError(f"{text} is not between 1 and 65535")
    return int(text)
