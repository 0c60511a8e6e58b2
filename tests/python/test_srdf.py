# SPDX-License-Identifier: BSD-3-Clause
"""Groups of an SRDF give base and tip, its states joint values."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from command_line import Run, assert_bad, assert_good
from urdf_text import joint, link, robot

import iksel

URDF = robot(
    link("base", "elbow", "hand", "flange", "finger", "thumb"),
    joint("first", "base", "elbow", axis="0 1 0"),
    joint("second", "elbow", "hand"),
    joint("mount", "hand", "flange", kind="fixed"),
    joint("grip", "flange", "finger", kind="prismatic"),
    joint("pinch", "flange", "thumb", kind="prismatic"),
)
SRDF = """<robot name="test">
  <group name="chain"><chain base_link="elbow" tip_link="finger"/></group>
  <group name="joints"><joint name="first"/><joint name="second"/></group>
  <group name="links"><link name="base"/><link name="elbow"/><link name="flange"/>
  </group>
  <group name="both"><group name="joints"/><joint name="grip"/></group>
  <group name="hands"><chain base_link="finger" tip_link="thumb"/><joint name="mount"/>
  </group>
  <group name="none"/>
  <group name="knot"><group name="knot"/></group>
  <group name="lost"><joint name="elsewhere"/></group>
  <group_state name="home" group="joints">
    <joint name="first" value="0.5"/><joint name="second" value="-0.25"/>
  </group_state>
  <group_state name="open" group="both">
    <joint name="first" value="0"/><joint name="second" value="1"/>
    <joint name="grip" value="0.5"/>
  </group_state>
  <group_state name="half" group="joints"><joint name="first" value="1"/></group_state>
</robot>"""


@pytest.mark.parametrize(
    ("group", "base", "tip", "names"),
    [
        ("chain", "elbow", "finger", ["second", "grip"]),
        ("joints", "base", "hand", ["first", "second"]),
        ("links", "base", "flange", ["first", "second"]),
        ("both", "base", "finger", ["first", "second", "grip"]),
    ],
)
def test_groups_give_base_and_tip(group, base, tip, names) -> None:
    srdf = iksel.Srdf(SRDF)
    assert srdf.ends(group, URDF) == (base, tip)
    made = iksel.load_robot(URDF, srdf=srdf, group=group)
    assert made.joint_names == names
    own = iksel.load_robot(URDF, srdf=SRDF, group=group, tip_link="flange")
    assert (own.base_link, own.tip_link) == (base, "flange")


@pytest.mark.parametrize(
    ("group", "message"),
    [
        ("hands", "ends in several links; choose one by tip_link: finger, thumb"),
        ("none", "'none' has no chain, joint or link"),
        ("knot", "'knot' is in itself"),
        ("lost", "no joint 'elsewhere'; it has: first, second"),
        ("joint", "no group 'joint'; did you mean joints"),
    ],
)
def test_groups_that_are_no_chain_are_refused(group, message) -> None:
    with pytest.raises(iksel.UrdfError, match=message):
        iksel.load_robot(URDF, srdf=SRDF, group=group)


def test_a_group_needs_an_srdf() -> None:
    with pytest.raises(iksel.InvalidArgumentError, match="'arm' is of an SRDF"):
        iksel.load_robot(URDF, group="arm")


def test_an_only_group_need_not_be_named() -> None:
    only = '<robot name="a"><group name="g"><joint name="first"/></group></robot>'
    assert iksel.load_robot(URDF, srdf=only).tip_link == "elbow"
    assert (
        iksel.load_robot("ur3", srdf=only).tip_link == iksel.load_robot("ur3").tip_link
    )


def test_where_there_are_several_tips_groups_are_named(
    run: Run, tmp_path: Path
) -> None:
    urdf, srdf = tmp_path / "arm.urdf", tmp_path / "arm.srdf"
    urdf.write_text(URDF, encoding="utf-8")
    srdf.write_text(SRDF, encoding="utf-8")
    groups = r"of the SRDF's groups \((--)?group\): chain, joints, "
    with pytest.raises(iksel.UrdfError, match=groups) as caught:
        iksel.load_robot(urdf, srdf=srdf)
    assert caught.value.available
    assert_bad(run("info", urdf, "--srdf", srdf), f"{groups}.*; choose one by --tip")


def test_states_are_joint_values() -> None:
    srdf = iksel.Srdf(SRDF)
    made = iksel.load_robot(URDF, srdf=srdf, group="joints")
    states = srdf.states(made)
    assert list(states) == ["home", "open"]
    np.testing.assert_array_equal(states["home"], [0.5, -0.25])
    np.testing.assert_array_equal(states["open"], [0, 1])
    assert list(srdf.states(made, "joints")) == ["home"]
    up = iksel.load_robot(URDF, base_link="hand", tip_link="base")
    np.testing.assert_array_equal(srdf.states(up)["home"], [-0.25, 0.5])
    with pytest.raises(iksel.UnknownNameError, match="no group 'arm'"):
        srdf.states(made, "arm")
    bad = iksel.Srdf(SRDF.replace("-0.25", "low"))
    with pytest.raises(iksel.UrdfError, match="'home': joint 'second' has 'low'"):
        bad.states(made)


def test_the_command_line(run: Run, tmp_path: Path) -> None:
    urdf, srdf = tmp_path / "arm.urdf", tmp_path / "arm.srdf"
    urdf.write_text(URDF, encoding="utf-8")
    srdf.write_text(SRDF, encoding="utf-8")
    chosen = (urdf, "--srdf", srdf, "--group", "joints")
    out = assert_good(run("info", *chosen, "--json")).json()
    assert out["groups"][:2] == ["chain", "joints"]
    assert out["states"] == {"home": [0.5, -0.25], "open": [0, 1]}
    degrees = assert_good(run("info", *chosen, "--json", "--degrees")).json()
    np.testing.assert_allclose(degrees["states"]["home"], np.degrees([0.5, -0.25]))
    text = assert_good(run("info", *chosen)).out
    assert "home, open" in text
    task = ("--from-q", "home")
    solved = run("solve", *chosen, *task, "--near", "home", "--json")
    np.testing.assert_allclose(assert_good(solved).json()["q"], [0.5, -0.25], atol=1e-4)
    unknown = run("solve", *chosen, "--from-q", "hme")
    assert_bad(unknown, "--from-q: no state 'hme'.*: home, open")
    assert_bad(run("info", urdf, "--group", "joints"), "give it by srdf")
    assert_bad(run("info", urdf, "--srdf", urdf, "--group", "g"), "no group 'g'")
    assert_bad(run("info", urdf, "--srdf", tmp_path / "no.srdf"), "srdf: .*no.srdf")
