# SPDX-License-Identifier: BSD-3-Clause
"""Every built-in robot: known answers, agreement with KDL, laws of kinematics."""

from __future__ import annotations

import dataclasses
import math
import re

import numpy as np
import pytest

import iksel

NAMES = iksel.robot_names()
PAPER = [name for name in NAMES if iksel.robot_info(name).paper]
SEED = 20_24

each_robot = pytest.mark.parametrize("name", NAMES)


def test_names_are_listed_once() -> None:
    assert len(set(NAMES)) == len(NAMES) >= 28
    assert len(PAPER) == 4


@each_robot
def test_robot_is_what_the_manifest_says(made, name: str) -> None:
    robot, info = made.robot(name), iksel.robot_info(name)
    assert robot.name == info.name == name
    assert robot.dof == info.dof == len(robot.joint_names) == len(robot.joint_types)
    assert (robot.base_link, robot.tip_link) == (info.base_link, info.tip_link)
    tcp = iksel.pose_from_euler(info.tcp_xyz or (0, 0, 0), info.tcp_rpy)
    np.testing.assert_array_equal(robot.tcp, tcp)
    assert info.maker
    assert info.licence
    assert info.source


@each_robot
def test_fk_gives_the_known_answer(made, name: str) -> None:
    info = iksel.robot_info(name)
    expected = iksel.pose_from_quaternion(info.sample_position, info.sample_quaternion)
    pose = made.robot(name).fk(info.sample_q)
    np.testing.assert_allclose(pose, expected, rtol=0, atol=1e-10)


@each_robot
def test_kernel_agrees_with_kdl(made, cases: int, name: str) -> None:
    robot = made.robot(name)
    q = robot.random_configurations(cases, SEED)
    for function in (robot.fk, robot.jacobian):
        kernel, kdl = function(q), function(q, kinematics="kdl")
        np.testing.assert_allclose(kernel, kdl, rtol=0, atol=1e-12)


@each_robot
def test_jacobian_is_the_derivative_of_fk(made, name: str) -> None:
    robot = made.robot(name)
    step = 1e-6
    for q in robot.random_configurations(10, SEED + 1):
        shifts = step * np.eye(robot.dof)
        ahead, behind = robot.fk(q + shifts), robot.fk(q - shifts)
        linear = (ahead - behind)[:, :3, 3]
        turned = np.tile(np.eye(4), (robot.dof, 1, 1))
        turned[:, :3, :3] = ahead[:, :3, :3] @ behind[:, :3, :3].transpose(0, 2, 1)
        angular = iksel.rotation_vector_from_pose(turned)
        derivative = np.hstack([linear, angular]).T / (2 * step)
        np.testing.assert_allclose(robot.jacobian(q), derivative, rtol=0, atol=1e-8)


@each_robot
def test_batch_is_the_loop_bit_for_bit(made, name: str) -> None:
    robot = made.robot(name)
    q = robot.random_configurations(20, SEED + 2)
    for function in (robot.fk, robot.jacobian):
        one_by_one = np.stack([function(row) for row in q])
        np.testing.assert_array_equal(function(q), one_by_one)


@each_robot
def test_random_configurations_fill_the_limits(made, name: str) -> None:
    robot = made.robot(name)
    q = robot.random_configurations(2000, SEED + 3)
    assert q.shape == (2000, robot.dof)
    assert all(robot.within_limits(row) for row in q)
    low = np.where(np.isinf(robot.lower), -math.pi, robot.lower)
    high = np.where(np.isinf(robot.upper), math.pi, robot.upper)
    assert (low <= q).all()
    assert (q <= high).all()
    part = (q - low) / (high - low)
    np.testing.assert_allclose(part.mean(axis=0), 0.5, rtol=0, atol=0.05)
    assert part.min() < 0.01
    assert part.max() > 0.99
    np.testing.assert_array_equal(q, robot.random_configurations(2000, SEED + 3))
    assert (q != robot.random_configurations(2000, SEED + 4)).any()


@each_robot
def test_nothing_is_out_of_reach(made, cases: int, name: str) -> None:
    robot = made.robot(name)
    poses = robot.fk(robot.random_configurations(cases, SEED + 5))
    distance = np.linalg.norm(poses[:, :3, 3] - robot.reach_centre, axis=-1)
    assert distance.max() <= robot.reach + 1e-12
    assert robot.reach < 10


@each_robot
def test_limits_are_in_order(made, name: str) -> None:
    robot = made.robot(name)
    free = np.array([kind == iksel.JointType.continuous for kind in robot.joint_types])
    np.testing.assert_array_equal(np.isinf(robot.lower), free)
    np.testing.assert_array_equal(np.isinf(robot.upper), free)
    assert (robot.lower <= robot.soft_lower).all()
    assert (robot.soft_lower < robot.soft_upper).all()
    assert (robot.soft_upper <= robot.upper).all()
    assert (robot.velocity_limit > 0).all()


@each_robot
def test_tool_moves_the_tip_and_leaves_the_chain(made, name: str) -> None:
    robot = made.robot(name)
    bare = iksel.load_robot(name, tcp=None)
    np.testing.assert_array_equal(bare.tcp, np.eye(4))
    tool = iksel.pose_from_euler([0.01, -0.02, 0.1], [0.3, -0.2, 0.1])
    tooled = iksel.load_robot(name, tcp=tool)
    q = robot.random_configurations(5, SEED + 6)
    np.testing.assert_allclose(tooled.fk(q), bare.fk(q) @ tool, rtol=0, atol=1e-14)
    np.testing.assert_array_equal(robot.with_tcp(tool).fk(q), tooled.fk(q))
    assert robot.chain_hash == bare.chain_hash == tooled.chain_hash


def test_chain_hashes_differ(made) -> None:
    hashes = {made.robot(name).chain_hash for name in NAMES}
    assert len(hashes) == len(NAMES)
    ur3 = made.robot("ur3")
    for other in (
        iksel.load_robot("ur3", locked_joints={"wrist_3_joint": 0.0}),
        iksel.load_robot("ur3", tip_link="wrist_2_link"),
    ):
        assert other.chain_hash != ur3.chain_hash


def test_a_tip_of_ones_own_has_no_tool() -> None:
    name = next(n for n in PAPER if iksel.robot_info(n).tcp_xyz)
    info = iksel.robot_info(name)
    whole = iksel.load_robot(name)
    last = whole.joint_names[-1]
    assert not np.array_equal(whole.tcp, np.eye(4))
    links = re.findall(r'link name="([^"]+)"', whole.urdf)
    other = next(link for link in links[::-1] if link != info.tip_link)
    short = iksel.load_robot(name, tip_link=other)
    np.testing.assert_array_equal(short.tcp, np.eye(4))
    assert short.tip_link == other
    assert last


def test_locked_joints_are_held(made) -> None:
    robot = made.robot("panda")
    locked = iksel.load_robot("panda", locked_joints={"panda_joint3": 0.4})
    assert locked.dof == 6
    assert "panda_joint3" not in locked.joint_names
    q = robot.random_configurations(10, SEED + 7)
    q[:, 2] = 0.4
    free = np.delete(q, 2, axis=1)
    np.testing.assert_allclose(locked.fk(free), robot.fk(q), rtol=0, atol=1e-14)
    without = np.delete(robot.jacobian(q), 2, axis=2)
    np.testing.assert_allclose(locked.jacobian(free), without, rtol=0, atol=1e-14)
    np.testing.assert_allclose(
        locked.fk(free), locked.fk(free, kinematics="kdl"), rtol=0, atol=1e-12
    )


def test_soft_limits_narrow_the_limits(made) -> None:
    hard, soft = made.robot("panda"), iksel.load_robot("panda", soft_limits=True)
    np.testing.assert_array_equal(soft.lower, hard.soft_lower)
    np.testing.assert_array_equal(soft.upper, hard.soft_upper)
    assert (soft.lower >= hard.lower).all()


@pytest.mark.parametrize(
    ("name", "hint"),
    [("ur3f", "mean ur3"), ("PANDA", "mean panda"), ("zzz", "built-in")],
)
def test_unknown_robots_get_suggestions(name: str, hint: str) -> None:
    for function in (iksel.load_robot, iksel.robot_info):
        with pytest.raises(iksel.UnknownNameError, match=hint) as caught:
            function(name)
        assert f"'{name}'" in str(caught.value)
        assert all(other in str(caught.value) for other in NAMES)


@pytest.mark.parametrize(
    ("settings", "culprit"),
    [
        ({"tip_link": "hand"}, "tip link 'hand' is not in the URDF; it has: .*tool0"),
        ({"base_link": "floor"}, "base link 'floor' is not in the URDF; .*base_link"),
        ({"locked_joints": {"elbow": 0.0}}, "locked joint 'elbow' .*elbow_joint"),
    ],
)
def test_unknown_links_and_joints_are_named(settings, culprit: str) -> None:
    with pytest.raises(iksel.UnknownNameError, match=culprit):
        iksel.load_robot("ur3", **settings)


@pytest.mark.parametrize("tcp", [np.zeros((4, 4)), np.eye(3), "flange", [[1.0]]])
def test_bad_tools_are_named(tcp) -> None:
    with pytest.raises(iksel.InvalidArgumentError, match="^tcp: "):
        iksel.load_robot("ur3", tcp=tcp)


@pytest.mark.parametrize(
    "q", [[0.0] * 5, [[0.0] * 7], 0.0, [0, 0, math.nan, 0, 0, 0], ["a"] * 6, [True] * 6]
)
@pytest.mark.parametrize("function", ["fk", "jacobian", "within_limits"])
def test_bad_configurations_are_named(made, function: str, q) -> None:
    with pytest.raises(iksel.InvalidArgumentError, match="^q"):
        getattr(made.robot("ur3"), function)(q)


def test_info_cannot_be_changed() -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        iksel.robot_info("ur3").maker = "us"
