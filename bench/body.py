# SPDX-License-Identifier: BSD-3-Clause
"""What it costs to keep an arm out of its own robot.

The robots are those of example-robot-data, from PyPI: their meshes are covered by
spheres, their pairs of links are those of the SRDF, or, where there is none, those that
5,000 configurations let touch. Solves with and without the scene take turns over the
same targets, poses of random configurations inside the limits, whether those collide or
not. Answers are judged by coal with the links' own meshes.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import iksel
import iksel.exact
import iksel.spheres
import iksel.srdf
from bench.arguments import add_count, add_max_error, add_robots, add_seed, check_robots
from bench.robot_data import PACKAGE, VARIABLE, robots_folder
from bench.settings import WORK
from bench.timing import least_times, time_calls

if TYPE_CHECKING:
    import argparse
    from pathlib import Path

    from bench.chain import Array

PASSES = 3
"""Of each target the least time of so many passes counts."""
LIMIT_S = 600.0


class Description(NamedTuple):
    """A robot's files, below the robots of example-robot-data, and its arm."""

    urdf: str
    srdf: str | None
    base_link: str
    tip_link: str


ROBOTS = {
    "panda": Description(
        "panda_description/urdf/panda.urdf",
        "panda_description/srdf/panda.srdf",
        "panda_link0",
        "panda_link8",
    ),
    "pr2": Description(
        "pr2_description/urdf/pr2.urdf",
        "pr2_description/srdf/pr2.srdf",
        "torso_lift_link",
        "r_wrist_roll_link",
    ),
    "tiago": Description(
        "tiago_description/robots/tiago.urdf", None, "torso_lift_link", "arm_7_link"
    ),
}


def data_folder() -> Path:
    """Where example-robot-data has its robots."""
    folder = robots_folder()
    if not folder.is_dir():
        raise SystemExit(
            f"bench body: no folder {folder}: pip install {PACKAGE}, or set "
            f"{VARIABLE} to its folder `robots`"
        )
    return folder


def home_of(robot: iksel.Robot, srdf: Path | None) -> tuple[str, Array]:
    """The SRDF's first state of the arm; else all joints at 0, or nearly."""
    states = iksel.srdf.Srdf(srdf).states(robot) if srdf else {}
    if states:
        name = next(iter(states))
        return name, np.asarray(states[name])
    return "zero", np.clip(np.zeros(robot.dof), robot.lower, robot.upper)


def measured(name: str, args: argparse.Namespace) -> dict[str, Any]:
    """A robot's row."""
    it = ROBOTS[name]
    folder = data_folder()
    urdf, srdf = folder / it.urdf, folder / it.srdf if it.srdf else None
    robot = iksel.load_robot(urdf, base_link=it.base_link, tip_link=it.tip_link)
    packages = {"example-robot-data": folder.parent}
    spheres = iksel.spheres.from_urdf(
        urdf,
        robot,
        max_error=args.max_error,
        srdf=srdf,
        packages=packages,
        cache=WORK / "body",
    )
    scene = iksel.Scene(robot, spheres)
    exact = iksel.exact.ExactCollision(scene, urdf, packages=packages)
    home, at_home = home_of(robot, srdf)
    solver = iksel.Solver(robot)
    calls = [
        (pose,)
        for pose in robot.fk(robot.random_configurations(args.targets, seed=args.seed))
    ]
    ways = (solver.solve, lambda pose: solver.solve(pose, scene=scene))
    runs = [[time_calls(way, calls, LIMIT_S) for way in ways] for _ in range(PASSES)]
    plain, kept_out = (least_times([run[i][0] for run in runs]) for i in (0, 1))
    results = runs[0][1][1]
    solved = np.array([bool(result) for result in results])
    first = np.array([result.q for result in runs[0][0][1]])
    extra = (kept_out - plain) / 1e3
    q = np.array([result.q for result in results if result])
    return {
        "spheres": sum(map(len, spheres.links.values())),
        "pairs": len(spheres.pairs),
        "pairs_from": it.srdf or "5,000 configurations",
        "home": home,
        "home_is_free": bool(scene.is_free(at_home)),
        "targets": len(calls),
        "plain_us": float(plain.mean()) / 1e3,
        "extra_us": float(extra.mean()),
        "extra_median_us": float(np.median(extra)),
        "extra_solved_us": float(extra[solved].mean()),
        "extra_none_us": None if solved.all() else float(extra[~solved].mean()),
        "solved": int(solved.sum()),
        "first_answers_that_collide": int(np.count_nonzero(~scene.is_free(first))),
        "false": int(np.count_nonzero(~exact.geometry_is_free(q))),
    }


def add(commands: Any) -> None:
    """The command `body`."""
    command = commands.add_parser(
        "body", help="arms kept out of their own robots", description=__doc__
    )
    add_robots(command, tuple(ROBOTS))
    add_count(command, "--targets", 1_000, "targets")
    add_seed(command, 0)
    add_max_error(command, 0.02)


def run(args: argparse.Namespace) -> int:
    """Measure, and print JSON."""
    check_robots("body", args.robots, tuple(ROBOTS))
    rows: dict[str, Any] = {"simd": iksel.simd_level()}
    rows |= {name: measured(name, args) for name in args.robots}
    print(json.dumps(rows, indent=2))
    return 0
