# SPDX-License-Identifier: BSD-3-Clause
"""Joints whose limits the URDF leaves out: what is said, and limits by default."""

from __future__ import annotations

import pickle
from pathlib import Path

import pytest
from command_line import Run, assert_bad, assert_good
from urdf_text import LIMIT, arm, mimic

import iksel

WITHOUT = [
    "",
    '<limit velocity="2" effort="1"/>',
    '<limit lower="0" upper="0" velocity="2" effort="1"/>',
    '<limit lower="0.0" upper="-0" velocity="2" effort="1"/>',
]


@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
@pytest.mark.parametrize("inside", WITHOUT)
def test_joints_without_limits(kind: str, inside: str) -> None:
    xml = arm(kind=kind, inside=inside)
    with pytest.raises(iksel.UrdfError) as caught:
        iksel.Robot.from_urdf(xml)
    for word in ("'second'", "default_limits", "locked_joints"):
        assert word in str(caught.value)
    made = iksel.Robot.from_urdf(xml, default_limits=(-0.5, 0.75))
    assert made.lower.tolist() == [-1, -0.5]
    assert made.upper.tolist() == [2, 0.75]
    assert made.soft_upper.tolist() == [2, 0.75]
    assert made.default_limits == (-0.5, 0.75)
    locked = iksel.Robot.from_urdf(xml, locked_joints={"second": 0.3})
    assert locked.joint_names == ["first"]


@pytest.mark.parametrize("inside", WITHOUT)
def test_joints_off_the_chain_need_none(inside: str) -> None:
    made = iksel.Robot.from_urdf(arm(inside=inside), tip_link="elbow")
    assert made.joint_names == ["first"]
    assert made.default_limits is None


def test_effort_and_velocity_need_not_be_given() -> None:
    made = iksel.Robot.from_urdf(arm(inside='<limit lower="-1" upper="1"/>'))
    assert (made.lower[1], made.upper[1]) == (-1, 1)
    assert made.velocity_limit[1] == float("inf")
    quoted = '<limit\n lower = "-1"  upper = \'1\' note="a > b"></limit>'
    assert iksel.Robot.from_urdf(arm(inside=quoted)).upper[1] == 1


def test_limits_that_are_there_stay() -> None:
    plain = iksel.Robot.from_urdf(arm())
    made = iksel.Robot.from_urdf(arm(), default_limits=(-9, 9))
    assert made.chain_hash == plain.chain_hash
    assert made.upper.tolist() == plain.upper.tolist()
    assert made.urdf == plain.urdf
    one = '<limit lower="1" upper="1" velocity="1" effort="1"/>'
    for settings in ({}, {"default_limits": (-1, 1)}):
        with pytest.raises(iksel.UrdfError, match="'second'.*lower 1, upper 1.*locked"):
            iksel.Robot.from_urdf(arm(inside=one), **settings)


def test_continuous_joints_stay_continuous() -> None:
    made = iksel.Robot.from_urdf(
        arm(kind="continuous", inside=WITHOUT[2]), default_limits=(-1, 1)
    )
    assert made.joint_types[1] == iksel.JointType.continuous


def test_followers_without_limits_do_not_narrow() -> None:
    inside = mimic().replace(LIMIT, WITHOUT[2])
    for settings in ({}, {"default_limits": (-0.1, 0.1)}):
        made = iksel.Robot.from_urdf(arm(inside=inside), **settings)
        assert made.joint_names == ["first"]
        assert (made.lower[0], made.upper[0]) == (-1, 2)


@pytest.mark.parametrize(
    "limits",
    [(1, -1), (1, 1), (float("nan"), 1), (-1, float("inf")), (1,), (1, 2, 3), 3, "ab"],
    ids=str,
)
def test_default_limits_that_make_no_sense(limits: object) -> None:
    for xml in (arm(), arm(inside="")):
        with pytest.raises(iksel.InvalidArgumentError, match="default_limits"):
            iksel.Robot.from_urdf(xml, default_limits=limits)


def test_default_limits_travel() -> None:
    made = iksel.Robot.from_urdf(arm(inside=""), default_limits=(-0.5, 0.75))
    again = pickle.loads(pickle.dumps(made))
    assert again.default_limits == (-0.5, 0.75)
    assert again.chain_hash == made.chain_hash
    assert again.upper.tolist() == made.upper.tolist()


def test_default_limits_on_the_command_line(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(arm(inside=""), encoding="utf-8")
    message = "'second' has no limits.*--default-limits LOWER UPPER.*--lock"
    assert_bad(run("info", path), message)
    info = assert_good(run("info", path, "--json", "--default-limits", "-0.5", "0.75"))
    assert info.json()["joints"][1]["upper"] == 0.75
    words = ["info", path, "--default-limits=-1"]
    assert_bad(run(*words), "--default-limits")
    assert_bad(
        run("info", path, "--default-limits", "1", "-1"), "--default-limits LOWER"
    )
    assert run("info", path, "--lock", "second=0.5", "--json").json()["dof"] == 1
    for command in ("solve", "path", "build", "evaluate"):
        assert "--default-limits" in run(command, "--help").out
