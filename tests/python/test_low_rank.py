# SPDX-License-Identifier: BSD-3-Clause
"""Arms whose joints do not move the tip along all six axes, however many they are."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest
from following_arms import with_follower

import iksel

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench import random_arms
from bench.random_arms import Joint, Sketch

if TYPE_CHECKING:
    from collections.abc import Callable

SEED = int(os.environ.get("IKSEL_TEST_SEED", "7"))
ARMS = 4
POSES = 20
AXES = ("l0", "tip")


def joint(random: np.random.Generator, *, turns: bool = True, **at) -> Joint:
    """About or along an axis parallel to the one before, unless it says otherwise."""
    low, high = random.uniform(0.8, 3.1, 2) if turns else random.uniform(0.1, 0.5, 2)
    xyz = at.get("xyz", random.uniform([0.1, -0.1, -0.1], [0.4, 0.1, 0.1]).tolist())
    rpy = at.get("rpy", (0.0, 0.0, float(random.uniform(-3, 3))))
    kind = "revolute" if turns else "prismatic"
    return Joint(tuple(xyz), tuple(rpy), -float(low), float(high), kind)


def turned(random: np.random.Generator, **at) -> Joint:
    """About an axis that is not parallel to the one before."""
    roll, yaw = random.uniform(0.5, 1.6), random.uniform(-3, 3)
    return joint(random, rpy=(float(roll), 0.0, float(yaw)), **at)


def snake(random: np.random.Generator) -> list[Joint]:
    return [turned(random), *(joint(random) for _ in range(6))]


def two_planes(random: np.random.Generator) -> list[Joint]:
    parallel = [joint(random) for _ in range(5)]
    return [turned(random), *parallel[:2], turned(random), *parallel[2:]]


def plane_and_wrist(random: np.random.Generator) -> list[Joint]:
    plane = [turned(random), *(joint(random) for _ in range(2))]
    wrist = [turned(random, xyz=(0.0, 0.0, 0.0)) for _ in range(2)]
    return [*plane, turned(random), *wrist]


def level(random: np.random.Generator) -> list[Joint]:
    joints = [joint(random, turns=bool(i % 2)) for i in range(6)]
    return [turned(random), *joints]


KINDS: dict[str, Callable[[np.random.Generator], list[Joint]]] = {
    "snake": snake,
    "two_planes": two_planes,
    "plane_and_wrist": plane_and_wrist,
    "level": level,
}


def sketch(kind: str, number: int) -> Sketch:
    random = np.random.default_rng([SEED, number])
    tool = random.uniform(-0.3, 0.3, (2, 3)).tolist()
    return Sketch(tuple(KINDS[kind](random)), tuple(tool[0]), tuple(tool[1]))


def robot_of(kind: str, number: int, *, times: float = 1) -> iksel.Robot:
    """A random arm of the kind, its limits so many times as wide."""
    whole = sketch(kind, number)
    joints = tuple(
        replace(each, lower=times * each.lower, upper=times * each.upper)
        for each in whole.joints
    )
    return iksel.Robot.from_urdf(replace(whole, joints=joints).urdf(), *AXES)


def off_by(
    poses: np.ndarray, position: float, rotation: float, random: np.random.Generator
) -> np.ndarray:
    """Poses in place of which others are, so far away [m, rad]."""
    ways = random.normal(size=(2, len(poses), 3))
    moves, turns = ways / np.linalg.norm(ways, axis=2, keepdims=True)
    out = poses @ iksel.pose_from_rotation_vector(np.zeros(3), rotation * turns)
    out[:, :3, 3] += position * moves
    return out


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("tolerances", [(1e-6, 1e-6), (1e-4, 1e-3), (1e-3, 1e-4)])
def test_what_the_tolerances_allow_is_found(
    kind: str, tolerances: tuple[float, float]
) -> None:
    """Of 1,000 poses that are off in all directions up to 527 got no answer."""
    position, rotation = tolerances
    options = iksel.SolverOptions(
        position_tolerance=position, rotation_tolerance=rotation
    )
    for number in range(SEED, SEED + ARMS):
        robot = robot_of(kind, number)
        solver = iksel.Solver(robot, options)
        random = np.random.default_rng(number)
        exact = robot.fk(robot.random_configurations(POSES, number))
        poses = off_by(exact, 0.7 * position, 0.7 * rotation, random)
        batch = solver.solve_batch(poses)
        assert batch.solved == POSES, (number, poses[~batch.success].tolist())
        for pose in poses[:5]:
            where = f"arm {number}, pose {pose.tolist()}"
            assert solver.solve_all(pose), where
            assert solver.solve(pose, near=robot.lower), where


@pytest.mark.parametrize("kind", KINDS)
def test_what_no_joint_moves_is_proven(kind: str) -> None:
    """Any other rotation is, at once; and it is no matter of limits."""
    proven = 0
    for number in range(SEED, SEED + ARMS):
        robot = robot_of(kind, number)
        solver = iksel.Solver(robot)
        wide = iksel.Solver(robot_of(kind, number, times=4))
        random = np.random.default_rng(number)
        exact = robot.fk(robot.random_configurations(POSES, number))
        for pose in off_by(exact, 0.0, 0.3, random):
            result = solver.solve(pose)
            proven += result.proven
            if not result.proven:
                continue
            assert result.status is iksel.Status.out_of_reach
            assert result.proof is iksel.Proof.reach
            assert result.attempts == 0
            # What searches by another way comes no nearer, were the limits wider.
            nearest = wide.solve(pose, closest=True)
            assert nearest.status is iksel.Status.closest, (number, pose.tolist())
    # Before a wrist the rotation may be any, but its centre is in the plane.
    assert proven > 0.9 * ARMS * POSES, proven


def test_the_height_of_a_planar_arm_is_proven_to_its_tolerance() -> None:
    position = 1e-4
    options = iksel.SolverOptions(position_tolerance=position, rotation_tolerance=1e-2)
    for number in range(SEED, SEED + ARMS):
        robot = robot_of("snake", number)
        solver = iksel.Solver(robot, options)
        anywhere = iksel.Task.position_only()
        for pose in robot.fk(robot.random_configurations(POSES, number)):
            axis = robot.jacobian(solver.solve(pose).q)[3:, 0]
            for part in (-1.01, -0.95, 0.95, 1.01):
                lifted = pose.copy()
                lifted[:3, 3] += part * position * axis
                is_off = abs(part) > 1
                where = f"arm {number}, {part} of the tolerance, {pose.tolist()}"
                for task in (None, anywhere):
                    result = solver.solve(lifted, task=task)
                    assert bool(result) is not is_off, where
                    assert result.proven is is_off, where


def test_a_tool_that_followers_keep_level_is_proven_to_stay_so() -> None:
    """The last joint turns back what the one before turns."""
    for number in range(SEED, SEED + ARMS):
        random = np.random.default_rng([SEED, number])
        joints = (
            turned(random),
            joint(random, turns=False),
            joint(random),
            joint(random),
        )
        whole = Sketch(joints, (0.1, 0.2, 0.3), (0.0, 0.0, 0.0))
        urdf = with_follower(whole.urdf(), 4, 3, -1.0)
        robot = iksel.Robot.from_urdf(urdf, *AXES)
        solver = iksel.Solver(robot)
        poses = robot.fk(robot.random_configurations(POSES, number))
        assert solver.solve_batch(poses).solved == POSES, number
        for pose in off_by(poses, 0.0, 0.1, random):
            assert solver.solve(pose).proof is iksel.Proof.reach, number


@pytest.mark.parametrize(
    "build", ["general", "right_angles_6", "srs", "three_parallel"]
)
def test_arms_that_move_along_all_axes_are_not_bound(build: str) -> None:
    for number in range(SEED, SEED + ARMS):
        robot = iksel.Robot.from_urdf(random_arms.sketch(build, number).urdf(), *AXES)
        ranks = [
            np.linalg.matrix_rank(robot.jacobian(q), tol=1e-3)
            for q in robot.random_configurations(10, number)
        ]
        if max(ranks) < 6:
            continue
        solver = iksel.Solver(robot)
        random = np.random.default_rng(number)
        poses = robot.fk(robot.random_configurations(POSES, number))
        off = off_by(poses, 0.0, 1.0, random)
        statuses = {solver.solve(pose).status for pose in off}
        assert iksel.Status.out_of_reach not in statuses, number
