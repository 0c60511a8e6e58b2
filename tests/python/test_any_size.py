# SPDX-License-Identifier: BSD-3-Clause
"""An arm of any size is solved as surely as one of a metre."""

from __future__ import annotations

import os
from dataclasses import replace

import numpy as np
import pytest
from following_arms import with_follower

import iksel

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench import random_arms

SEED = int(os.environ.get("IKSEL_TEST_SEED", "7"))
ARMS = 3
POSES = 200
SIZES = (1e-3, 1e2, 1e3, 1e6)

FOLLOWING = "a joint that follows another"


def arm(build: str, number: int, size: float) -> iksel.Robot:
    if build != FOLLOWING:
        urdf = random_arms.sketch(build, number).scaled(size).urdf()
    else:
        sketch = random_arms.sketch("rail", number).scaled(size)
        *others, last = sketch.joints
        free = replace(last, kind="continuous")
        urdf = with_follower(replace(sketch, joints=(*others, free)).urdf(), 7, 4, 0.7)
    return iksel.Robot.from_urdf(urdf, "l0", "tip")


@pytest.mark.parametrize(
    "build",
    [
        "general",
        "right_angles_6",
        "shoulder_offset",
        "right_angles_7",
        "rail",
        FOLLOWING,
    ],
)
def test_reachable_poses_are_solved(build: str) -> None:
    rng = np.random.default_rng(SEED)
    for number in range(SEED, SEED + ARMS):
        for size in rng.uniform(1, 10, len(SIZES)) * SIZES:
            robot = arm(build, number, size)
            poses = robot.fk(robot.random_configurations(POSES, SEED))
            solver = iksel.Solver(robot)
            answers = solver.solve_batch(poses)
            where = f"arm {number}, size {size!r}"
            assert answers.solved == POSES, where
            assert all(solver.solve(pose) for pose in poses[:10]), where
            q = answers.q
            position, rotation = iksel.pose_error(poses, robot.fk(q))
            assert position.max() <= 1e-6 + 1e-15 * robot.reach, where
            assert rotation.max() <= 1.001e-6, where
            assert all(robot.within_limits(each) for each in q), where


@pytest.mark.parametrize("size", [32.0**-2, 32.0**2, 32.0**4])
@pytest.mark.parametrize("build", random_arms.BUILDS)
def test_the_structure_is_that_of_the_smaller_arm(build: str, size: float) -> None:
    for number in range(SEED, SEED + ARMS):
        found = arm(build, number, size).structure
        assert found.kind == arm(build, number, 1.0).structure.kind, number


@pytest.mark.parametrize("size", [1e4, 1e6])
def test_tolerances_below_what_doubles_hold_prove_nothing(size: float) -> None:
    """Rounding alone moves the tip farther: some poses are not found."""
    options = iksel.SolverOptions(position_tolerance=1e-12)
    for build in ("spherical_wrist", "general", "srs", "right_angles_7"):
        robot = arm(build, SEED, size)
        poses = robot.fk(robot.random_configurations(50, SEED))
        answers = iksel.Solver(robot, options).solve_batch(poses)
        lost = ~answers.success
        assert (answers.proof[lost] == iksel.Proof.none).all()
        assert (answers.position_error[~lost] <= 1e-12).all()
