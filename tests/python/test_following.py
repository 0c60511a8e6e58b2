# SPDX-License-Identifier: BSD-3-Clause
"""Joints that follow others by mimic tags: such arms are searched, in lanes as all."""

from __future__ import annotations

import os

import numpy as np
import pytest
from following_arms import following_arm
from urdf_text import joint, limits, link, mimic, robot

import iksel

SEED = int(os.environ.get("IKSEL_TEST_SEED", "7"))
ARMS = int(os.environ.get("IKSEL_TEST_CASES", "20"))
POSES = 300
NEAR = 10
SAME_MOVE = 0.01

ARMS_THAT_LOST = (71, 139, 250, 290, 350, 352)
"""One of these poses each, while they were solved one seed at a time."""

TURNING_LEADERS = (18, 20, 35, 48, 57)
"""Followers stand elsewhere after a whole turn of these leaders inside their limits."""


@pytest.mark.parametrize(
    "seed", [*ARMS_THAT_LOST, *range(1000 * SEED, 1000 * SEED + ARMS)]
)
def test_what_can_be_reached_is_found(seed: int) -> None:
    robot = following_arm(seed)
    if robot is None:
        pytest.skip("limits leave nothing")
    q = robot.random_configurations(POSES, seed=seed)
    poses = robot.fk(q)
    solver = iksel.Solver(robot)
    batch = solver.solve_batch(poses)
    assert batch.success.all()
    assert robot.within_limits(batch.q).all()
    np.testing.assert_allclose(robot.fk(batch.q), poses, atol=2.5e-6)
    rng = np.random.default_rng(seed)
    lower, upper = robot.lower, robot.upper
    for pose, known in zip(poses[:NEAR], q[:NEAR], strict=True):
        assert solver.solve(pose)
        assert len(solver.solve_all(pose)) > 0
        near = np.clip(known + 0.1 * rng.normal(size=robot.dof), lower, upper)
        result = solver.solve(pose, near=near)
        assert result.move <= np.linalg.norm(near - known) + SAME_MOVE


@pytest.mark.parametrize("seed", TURNING_LEADERS)
def test_what_is_closest_is_as_close_as_from_many_seeds(seed: int) -> None:
    robot = following_arm(seed)
    assert robot is not None
    poses = robot.fk(robot.random_configurations(40, seed=seed))
    targets = poses[:20]
    targets[:, :3, 3] *= 1.5
    targets[:, :3, :3] = poses[20:, :3, :3]
    solver = iksel.Solver(robot)
    seeds = robot.random_configurations(48, seed=seed + 1)

    def measure(result: iksel.Result) -> float:
        return float(np.hypot(result.position_error, result.rotation_error))

    for target in targets:
        found = solver.solve(target, closest=np.ones(6))
        from_seeds = solver.solve(target, closest=np.ones(6), seeds=seeds)
        assert measure(found) <= 1.01 * measure(from_seeds)


def test_a_telescope_is_one_joint_of_many() -> None:
    """A column that lifts, and five stages of an arm that slide out by the same."""
    stages = "".join(
        f"""<link name="stage{i}"/><joint name="slide{i}" type="prismatic">
        <parent link="{f"stage{i - 1}" if i else "column"}"/><child link="stage{i}"/>
        <origin xyz="0 0 0.03"/><axis xyz="0 1 0"/>
        <limit lower="0" upper="0.1" effort="1" velocity="1"/>
        {'<mimic joint="slide0"/>' if i else ""}</joint>"""
        for i in range(5)
    )
    robot = iksel.Robot.from_urdf(
        f"""<robot name="telescope"><link name="base"/><link name="column"/>
        <joint name="lift" type="prismatic"><parent link="base"/><child link="column"/>
        <axis xyz="0 0 1"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint>
        {stages}<link name="wrist"/><link name="hand"/>
        <joint name="yaw" type="revolute"><parent link="stage4"/><child link="wrist"/>
        <axis xyz="0 0 1"/><limit lower="-2" upper="4" effort="1" velocity="1"/></joint>
        <joint name="pitch" type="revolute"><parent link="wrist"/><child link="hand"/>
        <origin xyz="0 0.1 0"/><axis xyz="1 0 0"/>
        <limit lower="-1.5" upper="0.5" effort="1" velocity="1"/></joint></robot>""",
        tip_link="hand",
    )
    assert robot.joint_names == ["lift", "slide0", "yaw", "pitch"]
    q = robot.random_configurations(500, seed=SEED)
    solver = iksel.Solver(robot)
    assert solver.database.options.key_scheme == iksel.KeyScheme.reduced
    batch = solver.solve_batch(robot.fk(q))
    assert batch.success.all()
    np.testing.assert_allclose(batch.q, q, atol=1e-4)


def leading_arm(own: str, follower: str, kind: str) -> iksel.Robot:
    """Six joints, of which another follows the first."""
    names = [f"l{i}" for i in range(8)]
    parts = [
        link(*names),
        joint("leader", "l0", "l1", inside=own),
        joint("follower", "l1", "l2", kind=kind, inside=follower),
    ]
    for i, axis in enumerate(("0 1 0", "0 1 0", "1 0 0", "0 1 0", "0 0 1")):
        place = {"axis": axis, "xyz": "0.05 0 0.3", "inside": limits(-2, 2)}
        parts.append(joint(f"j{i}", f"l{i + 2}", f"l{i + 3}", **place))
    return iksel.Robot.from_urdf(robot(*parts), "l0", "l7")


def diagnoses(arm: iksel.Robot, count: int) -> list[tuple[np.ndarray, iksel.Diagnosis]]:
    """Those of targets that a joint reaches beyond its limits, where none is inside."""
    solver = iksel.Solver(arm)
    rng = np.random.default_rng(SEED)
    found = []
    for q in arm.random_configurations(count, seed=SEED):
        q[rng.integers(1, arm.dof)] = 2 + rng.uniform(0.2, 0.6)
        target = arm.fk(q)
        if not solver.solve(target):
            found.append((target, solver.diagnose(target)))
    assert len(found) > 3
    return found


def test_a_diagnosis_has_a_branch_where_whole_turns_count() -> None:
    half = mimic("leader", 'multiplier="0.5"', limits(-9, 9))
    arm = leading_arm(limits(0.5, 5.5), half, "revolute")
    branches = 0
    for target, diagnosis in diagnoses(arm, 40):
        if diagnosis.branch is None:
            continue
        branches += 1
        np.testing.assert_allclose(arm.fk(diagnosis.branch), target, atol=1e-5)
    assert branches > 3


@pytest.mark.parametrize(("kind", "factor"), [("prismatic", 0.01), ("revolute", 1)])
def test_limits_are_the_cause_also_where_turns_move_a_slide(kind, factor) -> None:
    follower = mimic("leader", f'multiplier="{factor}"', limits(-2, 2))
    arm = leading_arm(limits(-2, 2), follower, kind)
    for _, diagnosis in diagnoses(arm, 12):
        assert diagnosis.cause is iksel.Cause.joint_limits
