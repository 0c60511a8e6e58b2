# SPDX-License-Identifier: BSD-3-Clause
"""URDFs, good ones and bad: what is made of them, and errors that name the culprit."""

from __future__ import annotations

import math
import re
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest

import iksel

LIMIT = '<limit lower="-1" upper="2" velocity="3" effort="0"/>'


def link(*names: str) -> str:
    return "".join(f'<link name="{name}"/>' for name in names)


def joint(
    name: str,
    parent: str,
    child: str,
    *,
    kind: str = "revolute",
    xyz: str = "0 0 0.5",
    rpy: str = "0 0 0",
    axis: str = "0 0 1",
    inside: str = LIMIT,
) -> str:
    return f"""
      <joint name="{name}" type="{kind}">
        <parent link="{parent}"/><child link="{child}"/>
        <origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>{inside}
      </joint>"""


def robot(*parts: str) -> str:
    return f'<?xml version="1.0"?><robot name="test">{"".join(parts)}</robot>'


def arm(middle: str = "", **changes: str) -> str:
    """Three links in a row; `changes` apply to the joint between the last two."""
    return robot(
        link("base", "elbow", "hand"),
        joint("first", "base", "elbow", axis="0 1 0"),
        joint("second", "elbow", "hand", **changes),
        middle,
    )


@pytest.fixture(autouse=True)
def silence(capfd: pytest.CaptureFixture[str]):
    """Nothing in this file may make the core print."""
    yield
    out, err = capfd.readouterr()
    assert out == ""
    assert err == ""


def refuse(xml: object, match: str, error=iksel.UrdfError, **settings: object) -> str:
    with pytest.raises(error, match=match) as caught:
        iksel.Robot.from_urdf(xml, **settings)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_the_least_robot_works() -> None:
    made = iksel.Robot.from_urdf(arm())
    assert (made.name, made.base_link, made.tip_link) == ("test", "base", "hand")
    assert made.joint_names == ["first", "second"]
    np.testing.assert_array_equal(made.lower, [-1, -1])
    np.testing.assert_array_equal(made.upper, [2, 2])
    np.testing.assert_array_equal(made.velocity_limit, [3, 3])
    q = [0.3, -0.4]
    expected = (
        iksel.pose_from_euler([0, 0, 0.5], [0, 0.3, 0])
        @ iksel.pose_from_euler([0, 0, 0.5], [0, 0, -0.4])
    )
    np.testing.assert_allclose(made.fk(q), expected, rtol=0, atol=1e-15)


def test_a_path_and_its_text_are_the_same_robot(tmp_path: Path) -> None:
    path = tmp_path / "arm with spaces.urdf"
    path.write_text(arm(), encoding="utf-8")
    by_text = iksel.Robot.from_urdf(arm())
    for given in (path, str(path)):
        by_path = iksel.Robot.from_urdf(given)
        assert by_path.chain_hash == by_text.chain_hash
        assert by_path.urdf == arm()


def test_missing_files_are_named(tmp_path: Path) -> None:
    for path in (tmp_path / "absent.urdf", "absent.urdf", tmp_path):
        refuse(path, re.escape(str(path)))


@pytest.mark.parametrize("given", [None, 3, b"<robot/>", ["a.urdf"]])
def test_what_is_neither_path_nor_text_is_refused(given: object) -> None:
    with pytest.raises((iksel.InvalidArgumentError, TypeError)):
        iksel.Robot.from_urdf(given)


@pytest.mark.parametrize(
    "xml",
    [
        "<",
        "<robot",
        "<robot name='a'>",
        "<robot name='a'></robt>",
        "<html><body/></html>",
        "<robot/>",
        "<robot name='a'/>",
        "<?xml version='1.0'?>",
        robot(link("a", "a")),
        robot(joint("j", "a", "b")),
        robot(link("a", "b"), joint("j", "a", "b"), joint("j", "a", "b")),
        robot(link("a", "b"), joint("i", "a", "b"), joint("j", "b", "a")),
        robot(link("a"), joint("j", "a", "a")),
        robot(link("a", "b"), '<joint name="j"><parent link="a"/></joint>'),
        robot(link("a", "b"), joint("j", "a", "b", kind="ball")),
        arm(xyz="0 0"),
        arm(xyz="0 0 x"),
        arm(rpy="0 0 0 0"),
        arm(axis="z"),
        arm(inside='<limit lower="a" upper="1" velocity="1" effort="1"/>'),
        "<robot name='a'>" * 2000,
        "<robot name='\x00'/>",
        "<robot name='a'>" + "\xff\xfe" + "</robot>",
    ],
    ids=lambda xml: re.sub(r"\s+", " ", repr(xml))[:40],
)
def test_broken_urdfs_are_refused(xml: str) -> None:
    refuse(xml, ".")


def test_broken_files_are_named(tmp_path: Path) -> None:
    path = tmp_path / "broken.urdf"
    path.write_text(arm()[:100], encoding="utf-8")
    refuse(path, r"broken\.urdf")
    path.write_text(arm(axis="0 0 0"), encoding="utf-8")
    refuse(path, "'second'")


def test_deep_nesting_is_refused_and_not_followed() -> None:
    program = """
        import iksel

        try:
            iksel.Robot.from_urdf("<robot name='a'>" + "<a>" * 300_000)
        except iksel.UrdfError:
            print("refused")
    """
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(program)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "refused\n", "")


def test_truncated_urdfs_never_crash() -> None:
    xml = arm()
    for end in range(1, len(xml) - len("</robot>")):
        with pytest.raises(iksel.UrdfError):
            iksel.Robot.from_urdf(xml[:end])


@pytest.mark.parametrize(
    ("settings", "match"),
    [
        ({"tip_link": "gripper"}, "tip link 'gripper' .* has: base, elbow, hand"),
        ({"base_link": "floor"}, "base link 'floor' .* has: base, elbow, hand"),
        ({"locked_joints": {"third": 0.0}}, "'third' .* has: first, second"),
    ],
    ids=str,
)
def test_unknown_names_are_listed(settings: dict[str, object], match: str) -> None:
    refuse(arm(), match, iksel.UnknownNameError, **settings)


@pytest.mark.parametrize(
    ("locked", "match"),
    [
        ({"first": math.nan}, "first"),
        ({"first": "a"}, "first"),
        ({"first": None}, "first"),
        ([("first", 0.0)], "locked_joints"),
        ({1: 0.0}, "locked_joints"),
    ],
    ids=str,
)
def test_bad_locks_are_named(locked: object, match: str) -> None:
    refuse(arm(), match, iksel.InvalidArgumentError, locked_joints=locked)


def test_links_of_two_trees_are_not_connected() -> None:
    xml = robot(link("a", "b", "c", "d"), joint("i", "a", "b"), joint("j", "c", "d"))
    refuse(xml, ".", base_link="a", tip_link="d")


def test_a_chain_needs_a_joint_that_moves() -> None:
    xml = arm(kind="fixed")
    message = refuse(xml, "no movable joint", base_link="elbow", tip_link="hand")
    assert "elbow" in message
    assert "hand" in message
    refuse(arm(), "base", base_link="base", tip_link="base")
    locked = {"first": 0.0, "second": 0.0}
    refuse(arm(), "no movable joint", locked_joints=locked)


def test_several_tips_are_listed() -> None:
    xml = robot(
        link("base", "left", "right"),
        joint("i", "base", "left"),
        joint("j", "base", "right"),
    )
    refuse(xml, "left, right")
    assert iksel.Robot.from_urdf(xml, tip_link="left").joint_names == ["i"]


@pytest.mark.parametrize("kind", ["floating", "planar"])
def test_joints_that_cannot_be_solved_are_named(kind: str) -> None:
    message = refuse(arm(kind=kind), f"'second' is {kind}")
    for possible in ("revolute", "continuous", "prismatic", "fixed"):
        assert possible in message
    # Beside the chain they do no harm.
    assert iksel.Robot.from_urdf(arm(kind=kind), tip_link="elbow").dof == 1


@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
@pytest.mark.parametrize(
    "limit",
    [
        "",
        '<limit lower="1" upper="-1" velocity="1" effort="1"/>',
        '<limit lower="1" upper="1" velocity="1" effort="1"/>',
        '<limit lower="nan" upper="1" velocity="1" effort="1"/>',
        '<limit lower="-1" upper="nan" velocity="1" effort="1"/>',
        '<limit lower="-inf" upper="inf" velocity="1" effort="1"/>',
        '<limit lower="-1e999" upper="1" velocity="1" effort="1"/>',
        '<limit velocity="1" effort="1"/>',
    ],
)
def test_limits_that_make_no_sense_are_named(kind: str, limit: str) -> None:
    refuse(arm(kind=kind, inside=limit), "second")


@pytest.mark.parametrize("axis", ["0 0 0", "nan 0 0", "0 inf 0", "1e-20 0 0"])
def test_axes_that_make_no_sense_are_named(axis: str) -> None:
    refuse(arm(axis=axis), "second")


@pytest.mark.parametrize("origin", [{"xyz": "nan 0 0"}, {"rpy": "0 inf 0"}])
def test_origins_that_make_no_sense_are_named(origin: dict[str, str]) -> None:
    refuse(arm(**origin), "second")


def test_axes_are_normalised() -> None:
    one, five = (iksel.Robot.from_urdf(arm(axis=f"0 {a} {a}")) for a in (1, 5))
    q = [0.3, 0.4]
    np.testing.assert_allclose(five.fk(q), one.fk(q), rtol=0, atol=1e-15)
    np.testing.assert_allclose(five.fk(q), five.fk(q, "kdl"), rtol=0, atol=1e-15)


def test_too_many_joints_are_counted() -> None:
    names = [f"l{i}" for i in range(34)]
    xml = robot(
        link(*names),
        *(joint(f"j{i}", names[i], names[i + 1], axis="0 1 0") for i in range(33)),
    )
    refuse(xml, "33 movable joints; at most 32")
    assert iksel.Robot.from_urdf(xml, base_link="l1").dof == 32


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


def mimic(source: str = "first", extra: str = 'multiplier="-2" offset="0.1"') -> str:
    return f'{LIMIT}<mimic joint="{source}" {extra}/>'


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
        np.testing.assert_allclose(made.fk([q]), made.fk([q], "kdl"), rtol=0, atol=1e-12)


def test_the_limits_of_a_follower_hold_too() -> None:
    made = iksel.Robot.from_urdf(arm(inside=mimic()))
    # -1 <= -2 q + 0.1 <= 2
    np.testing.assert_allclose(made.lower, [-0.95], rtol=0, atol=1e-15)
    np.testing.assert_allclose(made.upper, [0.55], rtol=0, atol=1e-15)
    np.testing.assert_allclose(made.velocity_limit, [1.5], rtol=0, atol=1e-15)


def test_mimic_joints_of_locked_joints_are_locked() -> None:
    tail = link("tool") + joint("third", "hand", "tool", axis="1 0 0")
    free = iksel.Robot.from_urdf(arm(tail))
    made = iksel.Robot.from_urdf(arm(tail, inside=mimic()), locked_joints={"first": 0.2})
    assert made.joint_names == ["third"]
    np.testing.assert_allclose(
        made.fk([0.5]), free.fk([0.2, -0.3, 0.5]), rtol=0, atol=1e-15
    )


@pytest.mark.parametrize(
    ("inside", "match"),
    [
        (mimic("nobody"), "'second' mimics 'nobody'.* first, second"),
        (mimic("second"), "second.*circle"),
        (mimic("first", 'multiplier="nan"'), "second"),
        (mimic("first", 'multiplier="x"'), "."),
    ],
)
def test_bad_mimics_are_named(inside: str, match: str) -> None:
    refuse(arm(inside=inside), match)


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


def test_errors_have_a_family() -> None:
    assert issubclass(iksel.UnknownNameError, iksel.UrdfError)
    for error in (iksel.UrdfError, iksel.InvalidArgumentError, iksel.DatabaseError):
        assert issubclass(error, iksel.Error)
    for error in (
        iksel.DatabaseIoError,
        iksel.DatabaseCorruptError,
        iksel.DatabaseMismatchError,
    ):
        assert issubclass(error, iksel.DatabaseError)
    assert issubclass(iksel.InvalidArgumentError, ValueError)
    assert issubclass(iksel.Error, Exception)


def test_names_may_be_any_text() -> None:
    xml = arm().replace("hand", "hånd/左 1").replace('name="test"', 'name="tęst"')
    made = iksel.Robot.from_urdf(xml, tip_link="hånd/左 1")
    assert made.name == "tęst"
    assert made.tip_link == "hånd/左 1"
    refuse(xml, "'手'.*hånd/左 1", iksel.UnknownNameError, tip_link="手")
