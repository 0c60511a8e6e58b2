# SPDX-License-Identifier: BSD-3-Clause
"""What is made of a URDF: joints of each kind, mimics, chains that go up the tree."""

from __future__ import annotations

import math
import time
from pathlib import Path

import numpy as np
import pytest
from urdf_text import LIMIT, arm, joint, limits, link, mimic, robot

import iksel


def test_the_least_robot_works() -> None:
    made = iksel.Robot.from_urdf(arm())
    assert (made.name, made.base_link, made.tip_link) == ("test", "base", "hand")
    assert made.joint_names == ["first", "second"]
    np.testing.assert_array_equal(made.lower, [-1, -1])
    np.testing.assert_array_equal(made.upper, [2, 2])
    np.testing.assert_array_equal(made.velocity_limit, [3, 3])
    q = [0.3, -0.4]
    first = iksel.pose_from_euler([0, 0, 0.5], [0, 0.3, 0])
    expected = first @ iksel.pose_from_euler([0, 0, 0.5], [0, 0, -0.4])
    np.testing.assert_allclose(made.fk(q), expected, rtol=0, atol=1e-15)


def test_a_path_and_its_text_are_the_same_robot(tmp_path: Path) -> None:
    path = tmp_path / "arm with spaces.urdf"
    path.write_text(arm(), encoding="utf-8")
    by_text = iksel.Robot.from_urdf(arm())
    for given in (path, str(path)):
        by_path = iksel.Robot.from_urdf(given)
        assert by_path.chain_hash == by_text.chain_hash
        assert by_path.urdf == by_text.urdf


def test_axes_are_normalised() -> None:
    one, five = (iksel.Robot.from_urdf(arm(axis=f"0 {a} {a}")) for a in (1, 5))
    q = [0.3, 0.4]
    np.testing.assert_allclose(five.fk(q), one.fk(q), rtol=0, atol=1e-15)
    np.testing.assert_allclose(five.fk(q), five.fk(q, "kdl"), rtol=0, atol=1e-15)


def test_missing_velocity_limits_are_infinite() -> None:
    none = '<limit lower="-1" upper="1" velocity="0" effort="0"/>'
    made = iksel.Robot.from_urdf(arm(inside=none))
    assert made.velocity_limit.tolist() == [3.0, math.inf]


def test_continuous_joints_need_no_limits() -> None:
    made = iksel.Robot.from_urdf(arm(kind="continuous", inside=""))
    assert made.joint_types == [iksel.JointType.revolute, iksel.JointType.continuous]
    assert (made.lower[1], made.upper[1]) == (-math.inf, math.inf)
    assert made.within_limits([0.0, 1e6])


def test_sliding_joints_slide() -> None:
    made = iksel.Robot.from_urdf(arm(kind="prismatic", axis="1 0 0"))
    assert made.joint_types[1] == iksel.JointType.prismatic
    shift = made.fk([0.0, 0.7]) - made.fk([0.0, 0.0])
    np.testing.assert_allclose(shift[:3, 3], [0.7, 0, 0], rtol=0, atol=1e-15)
    np.testing.assert_array_equal(shift[:3, :3], 0)
    jacobian = made.jacobian([0.0, 0.3])[:, 1]
    np.testing.assert_allclose(jacobian, [1, 0, 0, 0, 0, 0], rtol=0, atol=1e-15)


def test_mimic_joints_follow() -> None:
    free = iksel.Robot.from_urdf(arm())
    made = iksel.Robot.from_urdf(arm(inside=mimic()))
    assert made.joint_names == ["first"]
    for q in (-0.3, 0.0, 0.2):
        follower = -2 * q + 0.1
        np.testing.assert_allclose(
            made.fk([q]), free.fk([q, follower]), rtol=0, atol=1e-15
        )
        both = free.jacobian([q, follower])
        np.testing.assert_allclose(
            made.jacobian([q])[:, 0], both[:, 0] - 2 * both[:, 1], rtol=0, atol=1e-14
        )
        kdl = made.fk([q], "kdl")
        np.testing.assert_allclose(made.fk([q]), kdl, rtol=0, atol=1e-12)


def test_the_limits_of_a_follower_hold_too() -> None:
    made = iksel.Robot.from_urdf(arm(inside=mimic()))
    # -1 <= -2 q + 0.1 <= 2
    np.testing.assert_allclose(made.lower, [-0.95], rtol=0, atol=1e-15)
    np.testing.assert_allclose(made.upper, [0.55], rtol=0, atol=1e-15)
    np.testing.assert_allclose(made.velocity_limit, [1.5], rtol=0, atol=1e-15)


def test_a_follower_with_no_motion_is_named() -> None:
    inside = mimic(extra="", limit=limits(3, 4))
    match = "'second'.*lower 3, upper 4.*'first'.*from -1 to 2"
    with pytest.raises(iksel.UrdfError, match=match):
        iksel.Robot.from_urdf(arm(inside=inside))


def test_slides_that_follow_what_turns_without_end() -> None:
    def slide(limit: str, factor: float) -> str:
        inside = mimic(limit=limit, extra=f'multiplier="{factor}" offset="0.2"')
        second = joint("second", "elbow", "hand", kind="prismatic", inside=inside)
        first = joint("first", "base", "elbow", kind="continuous", inside="")
        return robot(link("base", "elbow", "hand"), first, second)

    with pytest.raises(iksel.UrdfError, match="'second' has no limits.*'first'.*give"):
        iksel.Robot.from_urdf(slide("", 0.01))
    assert iksel.Robot.from_urdf(slide(LIMIT, 0.01)).upper == pytest.approx([180])
    for limit in ("", LIMIT):
        made = iksel.Robot.from_urdf(slide(limit, 0))
        assert made.joint_types == [iksel.JointType.continuous]
        assert made.fk([1.0])[2, 3] == pytest.approx(1.2)
        assert iksel.Solver(made).solve(made.fk([1.0])).success


@pytest.mark.parametrize("step", [-1, 1])
def test_long_rows_of_followers_are_read_at_once(step: int) -> None:
    """Each joint follows the one before or behind it: no row is walked twice."""
    n = 20_000
    followed = [mimic(f"j{i + step}", "") for i in range(n)]
    followed[0 if step < 0 else -1] = LIMIT
    joints = [
        joint(f"j{i}", f"l{i}", f"l{i + 1}", inside=followed[i]) for i in range(n)
    ]
    xml = robot(link(*(f"l{i}" for i in range(n + 1))), *joints)
    began = time.perf_counter()
    with pytest.raises(iksel.UrdfError, match="more than 64 moving joints"):
        iksel.Robot.from_urdf(xml)
    assert time.perf_counter() - began < 20


def test_mimic_joints_of_locked_joints_are_locked() -> None:
    tail = link("tool") + joint("third", "hand", "tool", axis="1 0 0")
    free = iksel.Robot.from_urdf(arm(tail))
    xml = arm(tail, inside=mimic())
    made = iksel.Robot.from_urdf(xml, locked_joints={"first": 0.2})
    assert made.joint_names == ["third"]
    np.testing.assert_allclose(
        made.fk([0.5]), free.fk([0.2, -0.3, 0.5]), rtol=0, atol=1e-15
    )


def test_chains_may_go_up_the_tree() -> None:
    down = iksel.Robot.from_urdf(arm())
    up = iksel.Robot.from_urdf(arm(), base_link="hand", tip_link="base")
    assert up.joint_names == ["second", "first"]
    for q in down.random_configurations(5, 1):
        np.testing.assert_allclose(
            up.fk(q[::-1]) @ down.fk(q), np.eye(4), rtol=0, atol=1e-15
        )
        np.testing.assert_allclose(
            up.fk(q[::-1]), up.fk(q[::-1], "kdl"), rtol=0, atol=1e-12
        )


def test_chains_may_go_up_and_down() -> None:
    xml = robot(
        link("trunk", "left", "right"),
        joint("i", "trunk", "left", xyz="0.1 0.2 0.3", rpy="0.3 0 0", axis="0 1 0"),
        joint("j", "trunk", "right", kind="prismatic", xyz="0 -0.3 0", axis="1 0 0"),
    )
    sides = [iksel.Robot.from_urdf(xml, tip_link=tip) for tip in ("left", "right")]
    across = iksel.Robot.from_urdf(xml, base_link="left", tip_link="right")
    assert across.joint_names == ["i", "j"]
    for q in across.random_configurations(5, 2):
        left, right = sides[0].fk(q[:1]), sides[1].fk(q[1:])
        np.testing.assert_allclose(left @ across.fk(q), right, rtol=0, atol=1e-14)
        step = 1e-6 * np.eye(2)
        ahead, behind = across.fk(q + step), across.fk(q - step)
        linear = (ahead - behind)[:, :3, 3].T / 2e-6
        np.testing.assert_allclose(across.jacobian(q)[:3], linear, rtol=0, atol=1e-9)
        np.testing.assert_allclose(
            across.jacobian(q), across.jacobian(q, "kdl"), rtol=0, atol=1e-12
        )


@pytest.mark.parametrize("inside", [LIMIT, LIMIT + '<dynamics damping="1"/>'])
def test_what_the_kinematics_do_not_need_is_ignored(inside: str) -> None:
    extra = """
      <material name="red"><color rgba="1 0 0 1"/></material>
      <gazebo reference="base"/><transmission name="t"/><!-- comment -->"""
    made = iksel.Robot.from_urdf(arm(extra, inside=inside))
    assert made.chain_hash == iksel.Robot.from_urdf(arm()).chain_hash


def test_soft_limits() -> None:
    safety = '<safety_controller soft_lower_limit="-0.5" soft_upper_limit="9" \
              k_velocity="1"/>'
    hard = iksel.Robot.from_urdf(arm(inside=LIMIT + safety))
    soft = iksel.Robot.from_urdf(arm(inside=LIMIT + safety), soft_limits=True)
    assert (hard.lower[1], hard.upper[1]) == (-1, 2)
    assert (hard.soft_lower[1], hard.soft_upper[1]) == (-0.5, 2)
    assert (soft.lower[1], soft.upper[1]) == (-0.5, 2)


def test_names_may_be_any_text() -> None:
    xml = arm().replace("hand", "hånd/左 1").replace('name="test"', 'name="tęst"')
    made = iksel.Robot.from_urdf(xml, tip_link="hånd/左 1")
    assert made.name == "tęst"
    assert made.tip_link == "hånd/左 1"


def test_letters_of_no_other_encoding_are_latin(tmp_path: Path) -> None:
    file = tmp_path / "latin.urdf"
    file.write_bytes(arm("<!-- José -->").replace("hand", "hånd").encode("latin-1"))
    made = iksel.Robot.from_urdf(file)
    assert made.tip_link == "hånd"
    assert "hånd" in repr(made)


def test_files_that_never_end_are_refused() -> None:
    with pytest.raises(iksel.UrdfError, match="'/dev/zero' is larger than 256 MiB"):
        iksel.Robot.from_urdf("/dev/zero")


@pytest.mark.parametrize(
    "changes", [{"tip_link": "\udcff"}, {"locked_joints": {"\ud800": 1.0}}]
)
def test_names_that_are_no_text_are_named(changes: dict) -> None:
    (culprit,) = changes
    with pytest.raises(iksel.InvalidArgumentError, match=f"{culprit}: .* in UTF-8"):
        iksel.Robot.from_urdf(arm(), **changes)


def test_a_link_has_one_parent() -> None:
    twice = joint("third", "base", "hand")
    with pytest.raises(
        iksel.UrdfError, match="link 'hand' is the child of two joints: 'second' and"
    ):
        iksel.Robot.from_urdf(arm(twice))
