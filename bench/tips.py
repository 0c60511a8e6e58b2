# SPDX-License-Identifier: BSD-3-Clause
"""Two arms on a torso, both tips at once: what an answer costs, and how many are lost.

The torso lifts by 0.35 m and turns by 1.5 rad to each side; the arms are two of a
built-in one, 0.4 m apart and tilted by 0.8 rad outwards. Targets are the poses of
random configurations inside the limits, so that all can be reached. `near` is such a
configuration after a random change of each joint, uniform over a part of its range.
"""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.arguments import add_count, add_seed
from bench.timing import time_calls

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

    import numpy.typing as npt

    from bench.chain import Array

ARMS = ("ur5e", "panda", "pr2_right_arm", "valkyrie_right_arm", "xarm5", "so100")
TorsoJoint = tuple[str, str, float, float]
"""Name, type, and both limits [rad or m], of a joint about or along z."""
LIFT: TorsoJoint = ("lift", "prismatic", 0.0, 0.35)
TURN: TorsoJoint = ("turn", "revolute", -1.5, 1.5)
LIMIT_S = 60.0
"""No solve of a row is begun after this time."""


def torso(arm: iksel.Robot, joints: Sequence[TorsoJoint] = (LIFT, TURN)) -> str:
    """The URDF of two arms on a torso, whose joints follow one another."""
    inside = re.sub(r"<!--.*?-->|<\?.*?\?>|</?robot.*?>", "", arm.urdf, flags=re.DOTALL)
    text = '<robot name="torso"><link name="base"/>'
    parent = "base"
    for name, kind, lower, upper in joints:
        child = name + "_link"
        text += f"""<link name="{child}"/>
            <joint name="{name}" type="{kind}"><parent link="{parent}"/>
            <child link="{child}"/><axis xyz="0 0 1"/>
            <limit lower="{lower}" upper="{upper}" effort="1" velocity="1"/></joint>"""
        parent = child
    for side, y, roll in (("l_", 0.2, -0.8), ("r_", -0.2, 0.8)):
        text += re.sub(r'\b(name|link|joint)="', rf'\1="{side}', inside)
        text += f"""<joint name="{side}mount" type="fixed"><parent link="{parent}"/>
            <child link="{side}{arm.link_names[0]}"/>
            <origin xyz="0 {y} 0.2" rpy="{roll} 0 0"/></joint>"""
    return text + "</robot>"


def changed(robot: iksel.Robot, q: Array, part: float, seed: int) -> Array:
    """Configurations near those given; joints without limits count as one turn."""
    turns = np.isinf(robot.upper)
    width = np.where(turns, 2 * np.pi, robot.upper - robot.lower)
    rng = np.random.default_rng(seed)
    return q + part * width * rng.uniform(-0.5, 0.5, q.shape)


def row_of(times: npt.NDArray[np.int64], results: list[iksel.Result]) -> dict[str, Any]:
    """What a run comes to."""
    microseconds = times / 1e3
    return {
        "targets": len(results),
        "lost": sum(not result for result in results),
        "mean_us": float(microseconds.mean()),
        "median_us": float(np.median(microseconds)),
        "p99_us": float(np.percentile(microseconds, 99)),
    }


def measure(name: str, args: argparse.Namespace) -> dict[str, Any]:
    """One robot: without `near`, and with."""
    arm = iksel.load_robot(name)
    tips = ["l_" + arm.tip_link, "r_" + arm.tip_link]
    robot = iksel.Robot.from_urdf(torso(arm), tip_links=tips)
    solver = iksel.Solver(robot)
    q = robot.random_configurations(args.targets, args.seed)
    poses = robot.fk(q)
    times, results = time_calls(solver.solve, [(p,) for p in poses], LIMIT_S)
    row = {"joints": robot.dof, "first": row_of(times, results)}
    some = slice(args.near)
    near = changed(robot, q[some], args.part, args.seed)
    times, results = time_calls(
        lambda pose, here: solver.solve(pose, near=here),
        list(zip(poses[some], near, strict=True)),
        LIMIT_S,
    )
    known = np.linalg.norm(q[some][: len(results)] - near[: len(results)], axis=1)
    moves = np.array([result.move for result in results])
    farther = int(np.count_nonzero(moves > known + 1e-6))
    row["near"] = row_of(times, results) | {"farther_than_known": farther}
    return row


def add(commands: Any) -> None:
    """The command `tips`."""
    command = commands.add_parser(
        "tips", help="two arms on a torso, both tips at once", description=__doc__
    )
    add_count(command, "--targets", 10_000, "targets")
    add_count(command, "--near", 1_000, "of these with near")
    command.add_argument(
        "--part", type=float, default=0.1, help="of each joint's range (%(default)s)"
    )
    add_seed(command, 0)
    command.add_argument("--only", metavar="ARM", choices=ARMS, help="one arm")


def run(args: argparse.Namespace) -> int:
    """Measure, and print JSON."""
    names = [name for name in ARMS if args.only in {None, name}]
    rows: dict[str, Any] = {name: measure(name, args) for name in names}
    print(json.dumps({"simd": iksel.simd_level()} | rows, indent=2))
    return 0
