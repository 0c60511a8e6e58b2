# SPDX-License-Identifier: BSD-3-Clause
"""Two arms as one chain, and arms on rails and turntables.

Two arms of a kind stand 0.6 m apart, and the chain goes from the tool of one to that of
the other: 12 or 14 joints. Targets are relative poses of random configurations inside
the limits. A rail is 3 m long and across the arm's front; a turntable stands 0.7 m
before it. Every answer is judged by numpy.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.arguments import add_count, add_names, add_seed
from bench.chain import chain_from_urdf
from bench.check import POSITION_TOLERANCE, ROTATION_TOLERANCE, rotation_distance
from bench.timing import time_calls

if TYPE_CHECKING:
    import argparse

    from bench.chain import Array

ARMS = ("panda", "iiwa14", "ur5e")
LIMIT_S = 60.0
"""No solve of a row is begun after this time."""

RAIL = """<robot name="rail"><link name="floor"/><link name="carriage"/>
<joint name="rail" type="prismatic"><parent link="floor"/><child link="carriage"/>
<axis xyz="0 1 0"/><limit lower="0" upper="3" velocity="1" effort="1"/></joint>
</robot>"""

TURNTABLE = """<robot name="table"><link name="pedestal"/><link name="plate"/>
<joint name="turntable" type="continuous"><parent link="pedestal"/>
<child link="plate"/><axis xyz="0 0 1"/></joint></robot>"""


def two_arms(name: str) -> iksel.Robot:
    """From the tool of the left one to that of the right one."""
    beside = iksel.pose_from_euler([0, -0.6, 0], [0, 0, 0])
    tip = iksel.robot_info(name).tip_link
    return iksel.Robot.from_urdf(
        iksel.attach(name, name, pose=beside, prefixes=("left_", "right_")),
        base_link=f"left_{tip}",
        tip_link=f"right_{tip}",
    )


def on_rail(name: str) -> iksel.Robot:
    """From the floor to the tool."""
    return iksel.Robot.from_urdf(
        iksel.attach(RAIL, name, at="carriage"),
        base_link="floor",
        tip_link=iksel.robot_info(name).tip_link,
    )


def at_turntable(name: str) -> iksel.Robot:
    """From the turntable's plate to the tool."""
    before = iksel.pose_from_euler([0.7, 0, 0], [0, 0, 0])
    return iksel.Robot.from_urdf(
        iksel.attach(name, TURNTABLE, pose=before),
        base_link="plate",
        tip_link=iksel.robot_info(name).tip_link,
    )


def fk(robot: iksel.Robot, q: Array) -> Array:
    """T_base_tip of each row of q, (N, dof) -> (N, 4, 4), by way of the root link."""
    root = iksel.LinkTree.from_urdf(robot.urdf).links[0]
    up = chain_from_urdf(robot.urdf, root, robot.base_link, np.eye(4))
    down = chain_from_urdf(robot.urdf, root, robot.tip_link, np.eye(4))
    to_base = up.fk(q[:, : up.dof][:, ::-1])
    return np.asarray(np.linalg.inv(to_base) @ down.fk(q[:, up.dof :]))


def judge(robot: iksel.Robot, poses: Array, q: Array, claimed: Any) -> dict[str, int]:
    """How many targets were missed, and how many answers are none."""
    reached = fk(robot, q[claimed])
    wanted = poses[claimed]
    position = np.linalg.norm(reached[:, :3, 3] - wanted[:, :3, 3], axis=1)
    rotation = rotation_distance(reached[:, :3, :3], wanted[:, :3, :3])
    good = (position <= POSITION_TOLERANCE) & (rotation <= ROTATION_TOLERANCE)
    inside = np.asarray(robot.within_limits(q[claimed]))
    return {
        "failures": int(np.count_nonzero(~claimed)),
        "false": int(np.count_nonzero(~(good & inside))),
    }


def measure(robot: iksel.Robot, targets: int, seed: int) -> dict[str, Any]:
    """A row: single solves and a batch."""
    solver = iksel.Solver(robot)
    poses = robot.fk(robot.random_configurations(targets, seed=seed))
    times, results = time_calls(solver.solve, [(pose,) for pose in poses], LIMIT_S)
    solved = np.array([bool(result) for result in results])
    q = np.array([result.q for result in results])
    batch_ns, batches = time_calls(
        lambda: solver.solve_batch(poses, threads=1), [(), ()], LIMIT_S
    )
    return {
        "joints": robot.dof,
        "targets": len(results),
        "mean_us": float(times.mean()) / 1e3,
        "p99_us": float(np.percentile(times, 99)) / 1e3,
        "max_us": float(times.max()) / 1e3,
        "attempts": float(np.mean([result.attempts for result in results])),
        "iterations": float(np.mean([result.iterations for result in results])),
        **judge(robot, poses[: len(results)], q, solved),
        "batch_us": float(batch_ns.min()) / 1e3 / targets,
        "batch": judge(robot, poses, batches[-1].q, batches[-1].success),
    }


def measure_preferred(
    robot: iksel.Robot, value: float, targets: int, seed: int
) -> dict[str, Any]:
    """A row: the first joint where it is preferred, or as near to it as may be."""
    solver = iksel.Solver(robot)
    name = robot.joint_names[0]
    there = iksel.Objective.preferred(robot, {name: value})
    poses = robot.fk(robot.random_configurations(targets, seed=seed))
    times, results = time_calls(
        lambda pose: solver.solve(pose, objective=there),
        [(pose,) for pose in poses],
        LIMIT_S,
    )
    solved = np.array([bool(result) for result in results])
    q = np.array([result.q for result in results])
    away = np.abs(q[solved, 0] - value)
    held = np.zeros_like(solved)
    held[solved] = away <= 1e-6
    return {
        "joints": robot.dof,
        "targets": len(results),
        "mean_us": float(times.mean()) / 1e3,
        "held": float(held.mean()),
        "held_us": float(times[held].mean()) / 1e3,
        "moved_us": float(times[~held].mean()) / 1e3,
        "mean_distance": float(away.mean()),
        **judge(robot, poses[: len(results)], q, solved),
    }


def add(commands: Any) -> None:
    """The command `dual`."""
    command = commands.add_parser(
        "dual", help="two arms as one chain; rails and turntables", description=__doc__
    )
    add_names(command, "arms", ARMS)
    add_count(command, "--targets", 100_000, "targets")
    add_count(
        command, "--preferred", 10_000, "targets for arms on a rail or at a turntable"
    )
    add_seed(command)


def run(args: argparse.Namespace) -> int:
    """Measure, and print JSON."""
    rows: dict[str, Any] = {"simd": iksel.simd_level()}
    for arm in args.arms:
        rows[f"two {arm}"] = measure(two_arms(arm), args.targets, args.seed)
        for place, robot, value in (
            ("on a rail", on_rail(arm), 1.2),
            ("at a turntable", at_turntable(arm), 0.0),
        ):
            row = measure_preferred(robot, value, args.preferred, args.seed)
            rows[f"{arm} {place}"] = row
    print(json.dumps(rows, indent=2))
    return 0
