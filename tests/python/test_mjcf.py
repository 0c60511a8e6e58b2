# SPDX-License-Identifier: BSD-3-Clause
"""MJCF is read as MuJoCo means it: the same poses at the same joint values."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import numpy as np
import pytest
from command_line import Run, assert_bad, assert_good
from mjcf_reference import MjcfFile

import iksel

SEED = int(os.environ.get("IKSEL_TEST_SEED", "1"))

pytest.importorskip("mujoco")

ARM = """<mujoco model="made">
  <compiler angle="radian"/>
  <asset><mesh name="lost" file="lost.stl"/></asset>
  <default><joint limited="true" range="-1 1.5"/></default>
  <worldbody>
    <body name="trunk" pos="0 0 0.3" euler="0.3 0 0.2">
      <joint name="i" axis="0 2 1" pos="0.1 0.2 0.3" ref="0.4"/>
      <joint name="j" type="slide" axis="1 1 0" ref="-0.2"/>
      <joint name="k" axis="0 0 1" pos="0 0.05 0"/>
      <geom type="mesh" mesh="lost"/>
      <body name="wrist" pos="0.3 0 0.1" quat="0.5 0.5 -0.5 0.5">
        <joint name="l" axis="1 0 0" limited="false"/>
        <body name="hand" pos="0 0 0.2" euler="0 1.5707963267948966 0"/>
      </body>
    </body>
  </worldbody>
  <actuator><motor joint="i"/></actuator>
</mujoco>"""


def write(folder: Path, text: str) -> Path:
    path = folder / "arm.xml"
    path.write_text(text, encoding="utf-8")
    return path


def test_joints_limits_and_frames(run: Run, tmp_path: Path) -> None:
    path = write(tmp_path, ARM)
    robot = iksel.load_robot(path)
    assert (robot.name, robot.base_link, robot.tip_link) == ("made", "world", "hand")
    assert robot.joint_names == ["i", "j", "k", "l"]
    kinds = [kind.name for kind in robot.joint_types]
    assert kinds == ["revolute", "prismatic", "revolute", "continuous"]
    np.testing.assert_array_equal(robot.lower, [-1, -1, -1, -np.inf])
    np.testing.assert_array_equal(robot.upper, [1.5, 1.5, 1.5, np.inf])
    for tip in ("trunk", "wrist", "hand"):
        MjcfFile(path).compare(iksel.load_robot(path, tip_link=tip), SEED)
    assert assert_good(run("info", path, "--json")).json()["name"] == "made"
    pose = robot.fk([0.1, 0.2, 0.3, 0.4])
    np.testing.assert_allclose(robot.fk([0.1, 0.2, 0.3, 0.4], "kdl"), pose, atol=1e-12)


def random_mjcf(rng: np.random.Generator, bodies: int) -> str:
    """Bodies in random places, each with up to three joints or a ball."""

    def words(count: int) -> str:
        return " ".join(map(str, rng.normal(size=count)))

    def joints() -> str:
        kinds = rng.choice(["hinge", "slide"], rng.integers(0, 4))
        if rng.random() < 0.1:
            kinds = ["ball"]
        return "".join(
            f'<joint type="{kind}" pos="{words(3)}" range="0.1 2" '
            + (f'axis="{words(3)}" ref="{words(1)}"/>' if kind != "ball" else "/>")
            for kind in kinds
        )

    inner = [""] * (bodies + 1)
    for i in range(bodies, 0, -1):
        name = f'name="b{i}"' if rng.random() < 0.8 else ""
        place = f'pos="{words(3)}" quat="{words(4)}"'
        inner[rng.integers(max(0, i - 3), i)] += (
            f'<body {name} {place}>{joints()}{inner[i]}<geom size="1" mass="1"/></body>'
        )
    return f"<mujoco><worldbody>{inner[0]}</worldbody></mujoco>"


def test_random_trees_are_mujocos(tmp_path: Path) -> None:
    rng = np.random.default_rng(SEED)
    chains = refused = 0
    for _ in range(40):
        path = write(tmp_path, random_mjcf(rng, 8))
        file = MjcfFile(path)
        for tip in file.tips:
            try:
                robot = iksel.load_robot(path, tip_link=tip)
            except iksel.UrdfError as error:
                if file.cause(tip, str(error)) is None:
                    pytest.fail(f"{error}, seed {SEED}")
                refused += 1
            else:
                file.compare(robot, SEED)
                chains += 1
    assert chains > 50
    assert refused > 5


FREE = """<mujoco><worldbody>
  <body name="torso"><freejoint name="root"/><geom size="1"/>
    <body name="arm" pos="1 0 0"><joint name="a" range="-90 90"/><geom size="1"/>
      <body name="ball" pos="1 0 0"><joint type="ball"/><geom size="1"/>
        <body name="hand"><joint name="b" range="-90 90"/><geom size="1"/></body>
      </body></body></body>
</worldbody></mujoco>"""


def test_free_and_ball_joints_are_named_by_their_bodies(
    run: Run, tmp_path: Path
) -> None:
    path = write(tmp_path, FREE)
    with pytest.raises(iksel.UrdfError, match="'free joint of body torso' is floating"):
        iksel.load_robot(path, tip_link="arm")
    assert_bad(run("info", path, "--base", "torso"), "'ball joint of body ball'")
    robot = iksel.load_robot(path, base_link="torso", tip_link="arm")
    np.testing.assert_allclose(robot.upper, [np.pi / 2], rtol=0, atol=1e-15)


def test_equal_names_of_bodies_and_links_between(tmp_path: Path) -> None:
    path = write(tmp_path, ARM.replace('name="hand"', 'name="trunk/i"'))
    MjcfFile(path).compare(iksel.load_robot(path, tip_link="trunk/i"), SEED)


SITES = """<mujoco><compiler angle="radian"/>
  <asset><texture name="t" type="2d" file="lost.png"/><material name="m" texture="t"/>
  </asset>
  <worldbody><site name="mark" pos="1 1 1"/>
    <body name="a"><joint name="i" axis="0 0 1" pos="0.1 0.2 0"/><geom size=".02"/>
      <site name="flag" pos="0.1 0 0.2" quat="0.5 0.5 -0.5 0.5" material="m"/>
      <body name="b" pos="0 0 .3"><joint name="j" axis="0 1 0"/><geom size=".02"/>
        <site name="b" pos="0 0 .2" euler="0.3 1.2 -2"/><site pos="3 0 0"/>
        <site name="grip" pos="0 0 .2" euler="0 1.5707963267948966 0"/></body>
  </body></worldbody></mujoco>"""


def test_sites_are_tips(run: Run, tmp_path: Path) -> None:
    path = write(tmp_path, SITES)
    file = MjcfFile(path)
    assert {tip for tip, _ in iksel.load_tree(path).tips} == set(file.tips)
    for tip, joints in (("flag", ["i"]), ("grip", ["i", "j"]), ("b/site", ["i", "j"])):
        assert tip in file.tips
        robot = iksel.load_robot(path, tip_link=tip)
        assert robot.joint_names == joints
        file.compare(robot, SEED)
    # Without a name it is the last body, as if there were no sites.
    assert iksel.load_robot(path).tip_link == "b"
    assert assert_good(run("info", path, "--json")).json()["tip_link"] == "b"
    assert_good(run("info", path, "--tip", "grip"))
    with pytest.raises(iksel.UnknownNameError, match="'mark'"):
        iksel.load_robot(path, tip_link="mark")


REFUSED = {
    "leave that joint out": ARM.replace('type="slide"', 'type="fixed"'),
    "save the converted model": ARM.replace(
        "<worldbody>", '<compiler coordinate="global"/><worldbody>', 1
    ),
    "put that file where the model names it": ARM.replace(
        "<worldbody>", '<include file="absent.xml"/><worldbody>', 1
    ),
    "mend that element, or take it out; MuJoCo .* is installed": ARM.replace(
        "<worldbody>", '<option collision="predefined"/><worldbody>', 1
    ),
    "give the file that includes it": "<mujoco><texture/></mujoco>",
}


@pytest.mark.parametrize("remedy", REFUSED)
def test_with_what_mujoco_says_is_what_to_do(tmp_path: Path, remedy: str) -> None:
    assert REFUSED[remedy] != ARM
    path = write(tmp_path, REFUSED[remedy])
    with pytest.raises(iksel.UrdfError, match=f"mujoco says: .*; .*{remedy}"):
        iksel.load_robot(path)


def test_what_mujoco_refuses_is_named(tmp_path: Path) -> None:
    path = write(tmp_path, ARM.replace("slide", "glide"))
    with pytest.raises(iksel.UrdfError, match=r"arm\.xml': mujoco says: .*glide"):
        iksel.load_robot(path)
    part = write(tmp_path, "<mujocoinclude><worldbody/></mujocoinclude>")
    with pytest.raises(iksel.UrdfError, match="give the file that includes it"):
        iksel.load_robot(part)
    with pytest.raises(iksel.UrdfError, match="MJCF text; give the path"):
        iksel.load_robot(ARM)


def test_a_missing_package_is_named(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    path = write(tmp_path, ARM)
    assert_bad(run("info", path), r"is MJCF, .*pip install 'iksel\[mjcf\]'")
