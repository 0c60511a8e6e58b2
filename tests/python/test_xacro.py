# SPDX-License-Identifier: BSD-3-Clause
"""Xacro is told from URDF and expanded; a missing file is missing first."""

from __future__ import annotations

import sys
import types
from pathlib import Path

import numpy as np
import pytest
from command_line import Run, assert_bad, assert_good
from urdf_text import arm, link, robot

import iksel

DECLARED = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="test"'

UNEXPANDED = [
    robot('<xacro:include filename="arm.xacro"/>'),
    robot('<xacro:property name="length" value="1"/>', link("base")),
    robot("<xacro:macro name='a' params='b'>", link("base", "hand"), "</xacro:macro>"),
    arm(xyz="${length} 0 0").replace('<robot name="test"', DECLARED),
    arm(rpy="0 0 $(arg yaw)").replace('<robot name="test"', DECLARED),
]


@pytest.mark.parametrize("xml", UNEXPANDED)
@pytest.mark.parametrize("suffix", [".urdf", ".urdf.xacro", ".xml"])
def test_unexpanded_xacro_is_recognised(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, xml: str, suffix: str
) -> None:
    monkeypatch.setitem(sys.modules, "xacro", None)  # as if it was not installed
    path = tmp_path / ("arm" + suffix)
    path.write_text(xml, encoding="utf-8")
    for source in (xml, path):
        for settings in ({}, {"tip_link": "tool"}):
            with pytest.raises(
                iksel.UrdfError,
                match="or in Python iksel.load_robot",
            ):
                iksel.Robot.from_urdf(source, **settings)
    missing = r"is xacro.* xacro FILE > robot\.urdf"
    if DECLARED in xml:  # else xacro could not read it either
        missing = "pip install 'iksel\\[xacro\\]'.*" + missing.partition(".*")[2]
    assert_bad(run("info", path), missing)
    with pytest.raises(iksel.UrdfError, match=missing):
        iksel.load_robot(path)


def test_expanded_xacro_is_urdf(run: Run, tmp_path: Path) -> None:
    """What xacro writes keeps its namespace, and may keep the suffix."""
    xml = arm().replace('<robot name="test"', DECLARED)
    assert iksel.Robot.from_urdf(xml).dof == 2
    path = tmp_path / "arm.urdf.xacro"
    path.write_text(xml, encoding="utf-8")
    assert_good(run("info", path))
    # What stands in comments is no xacro, and errors are those of URDF.
    with pytest.raises(iksel.UnknownNameError, match=r"^tip link 'a'"):
        iksel.Robot.from_urdf(arm("<!-- <xacro:a> ${b} -->"), tip_link="a")


def test_missing_files_are_missing_first(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("arm.urdf.xacro", "arm.xacro", "arm.urdf"):
        assert_bad(run("info", name), f"'{name}': No such file")
        with pytest.raises(iksel.UrdfError, match=f"'{name}': No such file"):
            iksel.Robot.from_urdf(name)


MACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="made">
  <xacro:arg name="prefix" default=""/>
  <xacro:include filename="$(find parts)/parts.xacro"/>
  <link name="$(arg prefix)base"/>
  <xacro:turn parent="base" child="elbow" length="${reach / 2}"/>
  <xacro:turn parent="elbow" child="hand" length="${reach}"/>
</robot>"""
PARTS = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="reach" value="0.6"/>
  <xacro:macro name="turn" params="parent child length">
    <link name="$(arg prefix)${child}"/>
    <joint name="to_${child}" type="revolute">
      <parent link="$(arg prefix)${parent}"/><child link="$(arg prefix)${child}"/>
      <origin xyz="${length} 0 0"/><axis xyz="0 0 1"/>
      <limit lower="-1" upper="${radians(90)}" velocity="1" effort="0"/>
    </joint>
  </xacro:macro>
</robot>"""


def write_parts(folder: Path, package_xml: str | None = None) -> None:
    folder.mkdir(parents=True)
    (folder / "parts.xacro").write_text(PARTS, encoding="utf-8")
    if package_xml is not None:
        (folder / "package.xml").write_text(package_xml, encoding="utf-8")


@pytest.fixture
def macro(tmp_path: Path) -> Path:
    """A xacro file in a workspace, without the package that it needs."""
    pytest.importorskip("xacro")
    path = tmp_path / "workspace/arm/arm.urdf.xacro"
    path.parent.mkdir(parents=True)
    path.write_text(MACRO, encoding="utf-8")
    return path


def assert_made(robot: iksel.Robot, prefix: str = "") -> None:
    assert (robot.name, robot.tip_link) == ("made", prefix + "hand")
    np.testing.assert_allclose(robot.fk([0, 0])[:3, 3], [0.9, 0, 0], rtol=0, atol=1e-15)
    np.testing.assert_allclose(robot.upper, np.pi / 2, rtol=0, atol=1e-15)


def test_xacro_is_expanded(run: Run, tmp_path: Path, macro: Path) -> None:
    write_parts(tmp_path / "elsewhere")
    folder = tmp_path / "elsewhere"
    robot = iksel.load_robot(
        macro, packages={"parts": folder}, xacro_args={"prefix": "left_"}
    )
    assert_made(robot, "left_")
    flags = ("--package", f"parts={folder}", "--xacro-arg", "prefix=left_")
    out = assert_good(run("info", macro, *flags, "--json")).json()
    assert out["tip_link"] == "left_hand"
    tree = iksel.load_tree(macro, packages={"parts": folder})
    assert tree.tips == [("hand", 2)]


@pytest.mark.parametrize("beside", ["workspace/arm/parts", "workspace/parts"])
def test_packages_are_found_around_the_file(
    tmp_path: Path, macro: Path, beside: str
) -> None:
    write_parts(tmp_path / beside)
    assert_made(iksel.load_robot(macro))


def test_packages_are_found_where_ros_looks(
    tmp_path: Path, macro: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    named = "<package><name>parts</name></package>"
    write_parts(tmp_path / "one/other_name", named)
    write_parts(tmp_path / "two/share/parts", named)
    with pytest.raises(iksel.UrdfError, match="no folder for package 'parts'"):
        iksel.load_robot(macro)
    with monkeypatch.context() as patch:
        patch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "one/other_name"))
        assert_made(iksel.load_robot(macro))
    with monkeypatch.context() as patch:
        patch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "two"))
        assert_made(iksel.load_robot(macro))
    # By its folder's name, though its package.xml has another.
    write_parts(tmp_path / "workspace/parts", named.replace("parts", "stranger"))
    assert_made(iksel.load_robot(macro))


def test_what_xacro_refuses_is_named(run: Run, tmp_path: Path, macro: Path) -> None:
    assert_bad(
        run("info", macro), "--package NAME=FOLDER: no folder for package 'parts'"
    )
    macro.write_text(MACRO.replace("$(arg prefix)", "$(arg other)"), encoding="utf-8")
    write_parts(tmp_path / "workspace/parts")
    with pytest.raises(
        iksel.UrdfError, match="other.*; values are given by xacro_args"
    ):
        iksel.load_robot(macro)
    plain = tmp_path / "plain.urdf"
    plain.write_text(arm(), encoding="utf-8")
    assert_bad(run("info", plain, "--xacro-arg", "a=1"), "a, but the file is not xacro")
    assert_bad(run("info", plain, "--xacro-arg", "a"), "expected NAME=VALUE, got 'a'")


@pytest.mark.parametrize(
    ("name", "remedy"),
    [
        ("package://parts/parts.xacro", r"xacro includes files by \$\(find PACKAGE"),
        ("absent.xacro", "put that file where the xacro file names it"),
        ("broken.xacro", "mend that in the file"),
    ],
)
def test_with_what_xacro_says_is_what_to_do(
    macro: Path, name: str, remedy: str
) -> None:
    macro.with_name("broken.xacro").write_text("<robot>", encoding="utf-8")
    text = MACRO.replace("$(find parts)/parts.xacro", name)
    macro.write_text(text, encoding="utf-8")
    with pytest.raises(iksel.UrdfError, match=f"xacro says: .*; {remedy}"):
        iksel.load_robot(macro)


def test_files_of_macros_are_no_robots(run: Run, tmp_path: Path, macro: Path) -> None:
    write_parts(tmp_path / "parts")
    culprit = r"parts\.xacro' expands to no link; .*give the file that includes it"
    assert_bad(run("info", tmp_path / "parts/parts.xacro"), culprit)


def test_expanding_leaves_other_modules_alone(
    tmp_path: Path, macro: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_parts(tmp_path / "workspace/parts")
    stranger = types.ModuleType("ament_index_python")
    with monkeypatch.context() as patch:
        patch.setitem(sys.modules, stranger.__name__, stranger)
        before = dict(sys.modules)
        assert_made(iksel.load_robot(macro))
        assert before.items() <= sys.modules.items()
        assert "ament_index_python.packages" not in sys.modules
    iksel.load_robot(macro)
    assert "ament_index_python" not in sys.modules


def test_arguments_of_what_is_no_xacro_are_refused(made) -> None:
    for source in ("ur3", made.robot("ur3").urdf, made.robot("ur3").urdf.encode()):
        for load in (iksel.load_robot, iksel.load_tree):
            with pytest.raises(iksel.UrdfError, match="xacro_args: prefix.* no xacro"):
                load(source, xacro_args={"prefix": "left_"})
