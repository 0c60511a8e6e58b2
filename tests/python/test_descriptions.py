# SPDX-License-Identifier: BSD-3-Clause
"""Names of robot_descriptions, by a stand-in: the package downloads from GitHub."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from command_line import Run, assert_bad, assert_good
from urdf_text import arm

import iksel

SRDF = """<robot name="test"><group name="whole">
  <chain base_link="base" tip_link="hand"/></group></robot>"""
XACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="made">
  <xacro:arg name="tip" default="hand"/><xacro:include filename="$(find made)/p.xacro"/>
  <xacro:pair/></robot>"""
PAIR = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="pair">
  <link name="base"/><link name="$(arg tip)"/>
  <joint name="j" type="continuous"><parent link="base"/><child link="$(arg tip)"/>
  </joint>
</xacro:macro></robot>"""


@pytest.fixture
def descriptions(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A package robot_descriptions with robots of ours."""
    forget_modules()
    made = tmp_path / "cache/made"
    made.mkdir(parents=True)
    files = {"arm.urdf": arm(), "arm.srdf": SRDF, "a.xacro": XACRO, "p.xacro": PAIR}
    files["arm.xml"] = """<mujoco model="m"><worldbody><body name="b"><joint name="j"/>
      <geom size="1"/></body></worldbody></mujoco>"""
    for name, text in files.items():
        (made / name).write_text(text, encoding="utf-8")
    where = f"PACKAGE_PATH = {str(made)!r}\n"
    modules = {
        "plain_description": f"URDF_PATH = {str(made / 'arm.urdf')!r}\n"
        f"SRDF_PATH = {str(made / 'arm.srdf')!r}\nprint('Cloning')\n",
        "macro_description": f"XACRO_PATH = {str(made / 'a.xacro')!r}\n"
        "XACRO_ARGS = {'tip': 'tool'}\n",
        "plain_mj_description": f"MJCF_PATH = {str(made / 'arm.xml')!r}\n",
        "empty_description": "",
        "far_description": "raise OSError('could not resolve host: github.com')\n",
        "_cache": "",
    }
    package = tmp_path / "site/robot_descriptions"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("", encoding="utf-8")
    for name, text in modules.items():
        (package / f"{name}.py").write_text(where + text, encoding="utf-8")
    monkeypatch.syspath_prepend(str(package.parent))
    yield package
    forget_modules()


def forget_modules() -> None:
    for name in [name for name in sys.modules if name.startswith("robot_descriptions")]:
        del sys.modules[name]


@pytest.mark.usefixtures("descriptions")
def test_names_are_robots(run: Run) -> None:
    for name in ("rd:plain_description", "rd:plain"):
        robot = iksel.load_robot(name)
        assert (robot.name, robot.dof, robot.tip_link) == ("test", 2, "hand")
    assert iksel.load_robot("rd:plain", group="whole").dof == 2
    out = run("info", "rd:plain_description", "--json")
    assert '"test"' in out.out
    assert out.json()["dof"] == 2  # what the package prints is not on stdout
    assert_good(run("info", "rd:plain", "--tree"))


@pytest.mark.usefixtures("descriptions")
def test_xacro_with_its_arguments_and_packages() -> None:
    pytest.importorskip("xacro")
    assert iksel.load_robot("rd:macro").tip_link == "tool"
    assert iksel.load_robot("rd:macro", xacro_args={"tip": "a"}).tip_link == "a"


@pytest.mark.usefixtures("descriptions")
def test_mjcf() -> None:
    pytest.importorskip("mujoco")
    assert iksel.load_robot("rd:plain_mj").joint_names == ["j"]


@pytest.mark.usefixtures("descriptions")
def test_what_is_missing_is_named(run: Run) -> None:
    with pytest.raises(
        iksel.UnknownNameError, match="did you mean plain_desc"
    ) as error:
        iksel.load_robot("rd:plane_description")
    assert error.value.available[0] == "empty_description"
    assert_bad(run("info", "rd:plane"), "robot_descriptions has no 'plane'")
    assert_bad(run("info", "rd:empty"), "no URDF, xacro or MJCF of it")
    assert_bad(run("info", "rd:far"), "could not fetch it: could not resolve host.*git")
    assert_bad(run("info", "rd:_cache"), "robot_descriptions has no '_cache'")


def test_the_package_is_named(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "robot_descriptions", None)
    missing = r"rd:panda_description: .*pip install 'iksel\[descriptions\]'"
    assert_bad(run("info", "rd:panda_description"), missing)
