# SPDX-License-Identifier: BSD-3-Clause
"""Arms with few joints, slides or wide tolerances, drawn at random."""

from __future__ import annotations

import os
from dataclasses import replace

import numpy as np
import pytest
from following_arms import with_follower

import iksel

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench import random_arms
from bench.random_arms import RIGHT, Joint, Sketch

SEED = int(os.environ.get("IKSEL_TEST_SEED", "7"))
ARMS = 10
POSES = 40


def robot_of(sketch: Sketch) -> iksel.Robot:
    return iksel.Robot.from_urdf(sketch.urdf(), "l0", "tip")


def apart(robot: iksel.Robot, q: np.ndarray, known: np.ndarray) -> float:
    """How far the nearest of some solutions is from one, whole turns not counted."""
    turned = np.remainder(q - known + np.pi, 2 * np.pi) - np.pi
    slides = np.array([kind == iksel.JointType.prismatic for kind in robot.joint_types])
    return float(np.abs(np.where(slides, 0, turned)).max(axis=1).min())


@pytest.mark.parametrize("build", ["general", "srs", "right_angles_7", "rail"])
def test_tolerances_as_wide_as_a_hand_lose_nothing(build: str) -> None:
    """Of seeds that are answers already the errors are not small."""
    for number in range(SEED, SEED + ARMS // 2):
        robot = robot_of(random_arms.sketch(build, number))
        poses = robot.fk(robot.random_configurations(POSES, number))
        for width in (0.03, 0.1, 1.0):
            options = iksel.SolverOptions(
                position_tolerance=width, task=iksel.Task.position_only()
            )
            solver = iksel.Solver(robot, options)
            where = f"arm {number}, tolerance {width}"
            assert solver.solve_batch(poses).solved == POSES, where
            assert all(solver.solve(pose) for pose in poses), where


def wrist(number: int) -> Sketch:
    """Three joints whose axes meet, with limits and a tool at random."""
    random = np.random.default_rng([SEED, number])
    joints = []
    for turn in (0.0, RIGHT, -RIGHT):
        lower, upper = -random.uniform(1, 3.1), random.uniform(1, 3.1)
        joints.append(Joint((0, 0, 0), (turn, 0, 0), float(lower), float(upper)))
    joints[0] = replace(joints[0], xyz=(0.1, 0.0, 0.3))
    tool = random.uniform(-0.3, 0.3, (2, 3))
    return Sketch(tuple(joints), tuple(tool[0].tolist()), tuple(tool[1].tolist()))


def test_both_solutions_of_three_axes_that_meet_are_found() -> None:
    """The first and the last axis meet in a point that no joint moves."""
    for number in range(ARMS):
        robot = robot_of(wrist(number))
        solver = iksel.Solver(robot)
        known = robot.random_configurations(POSES, number)
        starts = robot.random_configurations(POSES, number + 1)
        for q, start in zip(known, starts, strict=True):
            pose = robot.fk(q)
            where = f"arm {number}, q {q.tolist()}"
            assert apart(robot, solver.solve_all(pose).q, q) < 0.02, where
            move = solver.solve(pose, near=start).move
            assert move < np.linalg.norm(q - start) + 1e-4, where


def scara(number: int) -> Sketch:
    """Three parallel axes and a slide along them, somewhere."""
    random = np.random.default_rng([SEED, number])
    joints = []
    for length in (0.0, *random.uniform(0.1, 0.5, 2).tolist()):
        lower, upper = sorted(random.uniform(-3, 3, 2).tolist())
        joints.append(Joint((length, 0, 0), (0, 0, 0), lower, upper))
    slide = Joint((0, 0, 0), (0, 0, 0), 0.0, 0.5, "prismatic")
    joints.insert(int(random.integers(4)), slide)
    return Sketch(tuple(joints), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_both_elbows_are_found_whatever_the_unit_of_lengths(size: float) -> None:
    """Where the arm is almost straight, one is predicted from the other."""
    for number in range(4 * ARMS):
        robot = robot_of(scara(number).scaled(size))
        solver = iksel.Solver(robot, {"position_tolerance": 1e-6 * size})
        slide = [kind.name for kind in robot.joint_types].index("prismatic")
        elbow = [j for j in range(4) if j != slide][1]
        for q in robot.random_configurations(POSES, number):
            q[elbow] = np.clip(
                0.05 * (1 if q[elbow] > 0 else -1),
                robot.lower[elbow],
                robot.upper[elbow],
            )
            where = f"arm {number}, q {q.tolist()}"
            assert apart(robot, solver.solve_all(robot.fk(q)).q, q) < 0.02, where


def test_no_turn_of_a_joint_that_another_follows_by_a_part_of_it_is_lost() -> None:
    """Whole turns of such a joint lead elsewhere, also where its range has several."""
    for number in range(SEED, SEED + ARMS):
        general = random_arms.sketch("general", number)
        joints = [replace(joint, kind="revolute") for joint in general.joints[:5]]
        joints[0] = replace(joints[0], lower=-3.0, upper=3.0)
        joints[1] = replace(joints[1], lower=-40.0, upper=20.0)
        joints[2] = replace(joints[2], lower=-100.0, upper=100.0)
        urdf = with_follower(replace(general, joints=tuple(joints)).urdf(), 3, 2, 0.7)
        robot = iksel.Robot.from_urdf(urdf, "l0", "tip")
        poses = robot.fk(robot.random_configurations(10 * POSES, number))
        assert iksel.Solver(robot).solve_batch(poses).solved == len(poses), number


def test_nearest_to_a_posture_is_nearest_to_a_configuration() -> None:
    """Also of more joints than a curve of solutions has."""
    for number in range(SEED, SEED + ARMS // 2):
        first = random_arms.sketch("general", number)
        joints = first.joints + random_arms.sketch("general", number + ARMS).joints
        robot = robot_of(replace(first, joints=joints))
        solver = iksel.Solver(robot)
        poses = robot.fk(robot.random_configurations(POSES, number))
        for pose, posture in zip(
            poses, robot.random_configurations(POSES, 0), strict=True
        ):
            near = solver.solve(pose, near=posture)
            best = solver.solve(pose, objective=iksel.Objective.near_posture(posture))
            where = f"arm {number}, {posture.tolist()}"
            move = np.linalg.norm(best.q - posture)
            assert move < near.move + 0.02, where


@pytest.mark.parametrize("joints", [3, 4, 5])
@pytest.mark.parametrize("tolerances", [(1e-3, 1e-3), (1e-4, 1e-3), (1e-3, 1e-4)])
def test_few_joints_use_both_tolerances(
    joints: int, tolerances: tuple[float, float]
) -> None:
    """Off by less than both, a pose has an answer, where none has the least error."""
    position, rotation = tolerances
    options = iksel.SolverOptions(
        position_tolerance=position, rotation_tolerance=rotation
    )
    rng = np.random.default_rng([SEED, joints])
    for number in range(SEED, SEED + ARMS):
        general = random_arms.sketch("general", number)
        robot = robot_of(replace(general, joints=general.joints[:joints]))
        solver = iksel.Solver(robot, options)
        poses = robot.fk(robot.random_configurations(POSES, number))
        for pose in poses:
            off, turn = (
                each / np.linalg.norm(each) for each in rng.normal(size=(2, 3))
            )
            pose[:3, 3] += 0.5 * position * off
            turned = iksel.pose_from_euler([0, 0, 0], 0.25 * rotation * turn)
            pose[:3, :3] = turned[:3, :3] @ pose[:3, :3]
            where = f"arm {number}, pose {pose.tolist()}"
            assert solver.solve(pose), where
            assert solver.solve_all(pose), where
            assert solver.solve(pose, near=robot.lower.clip(-3, 3)), where
        assert solver.solve_batch(poses).solved == POSES, number
