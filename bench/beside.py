# SPDX-License-Identifier: BSD-3-Clause
"""What a no costs beside limits, where paths end and teleoperation lives.

Poses of configurations that are inside the limits but for one joint, which is a little
outside; each joint that has limits in turn, on either side. Some have other answers
and are solved; of the others the time of each no counts, called one by one from Python.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.arguments import add_count, add_robots, add_seed
from bench.arms import load_arm
from bench.timing import least_times, time_calls

if TYPE_CHECKING:
    import argparse

    from bench.arms import Arm
    from bench.chain import Array

ROBOTS = (
    "ur3",
    "irb120",
    "vs060",
    "cvr038",
    "gen3_6dof",
    "xarm6",
    "panda",
    "iiwa14",
    "xarm7",
)
DISTANCES = (1e-5, 1e-4, 1e-3, 1e-2, 3e-2)
"""How far the joint is outside [rad or m]."""
PASSES = 3
"""Runs through all poses; of each pose the least time counts."""
LIMIT_S = 600.0
"""Of a run [s]."""


def outside_poses(arm: Arm, distance: float, count: int, seed: int) -> Array:
    """Poses of configurations with one joint so far outside its limits, (count, 4, 4).

    Raises:
        ValueError: No joint has limits.
    """
    chain = arm.chain
    limited = np.flatnonzero(np.isfinite(chain.lower))
    if limited.size == 0:
        raise ValueError(f"{arm.name} has no joint limits to be beside of")
    q = arm.robot.random_configurations(count, seed)
    rows = np.arange(count)
    joints = limited[rows % limited.size]
    at_upper = rows // limited.size % 2 == 0
    outside = (chain.upper[joints] + distance, chain.lower[joints] - distance)
    q[rows, joints] = np.where(at_upper, *outside)
    return chain.fk(q)


def noes(solver: iksel.Solver, poses: Array) -> tuple[Array, Array]:
    """Which poses get a no, and the least time of each pose [us]."""
    arguments = [(pose,) for pose in poses]
    runs = [time_calls(solver.solve, arguments, LIMIT_S) for _ in range(PASSES)]
    failed = np.array([not result.success for result in runs[0][1]])
    return failed, least_times([times for times, _ in runs]) / 1e3


def measured(arm: Arm, distance: float, count: int, seed: int) -> dict[str, Any]:
    """How many noes, and their mean, median and p99 [us]."""
    solver = iksel.Solver(arm.robot)
    failed, times = noes(solver, outside_poses(arm, distance, count, seed))
    row: dict[str, Any] = {"poses": count, "noes": int(failed.sum())}
    if failed.any():
        own = times[failed]
        row |= {
            "mean_us": round(float(own.mean()), 2),
            "median_us": round(float(np.median(own)), 2),
            "p99_us": round(float(np.quantile(own, 0.99)), 2),
        }
    return row


def add(commands: Any) -> None:
    """The command `beside`."""
    command = commands.add_parser(
        "beside",
        help="what a no costs where a joint is a little outside its limits",
        description=__doc__.splitlines()[0],
    )
    add_robots(command, ROBOTS)
    add_count(command, "--poses", 2000, "poses")
    add_seed(command)


def run(args: argparse.Namespace) -> int:
    """Measure, and print a line of JSON for each robot and distance."""
    for name in args.robots:
        arm = load_arm(name)
        for distance in DISTANCES:
            row = measured(arm, distance, args.poses, args.seed)
            about = {"simd": iksel.simd_level(), "robot": name, "outside": distance}
            print(json.dumps(about | row), flush=True)
    return 0
