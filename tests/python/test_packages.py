# SPDX-License-Identifier: BSD-3-Clause
"""package:// names of meshes are found as ROS finds packages."""

from __future__ import annotations

from pathlib import Path

import pytest

import iksel
from iksel.formats._packages import find_package, resolve_path


def make(folder: Path, name: str | None = None) -> Path:
    folder.mkdir(parents=True)
    if name is not None:
        text = f"<package><name> {name} </name></package>"
        (folder / "package.xml").write_text(text, encoding="utf-8")
    return folder


def test_given_folders_come_first(tmp_path: Path) -> None:
    around = make(tmp_path / "arm/urdf").parent
    other = tmp_path / "elsewhere"
    assert find_package("arm", {"arm": other}, around / "urdf") == other
    assert find_package("arm", {}, around / "urdf") == around
    (around / "package.xml").write_text("<package><name>b</name></package>")
    assert find_package("b", {}, around / "urdf") == around
    with pytest.raises(
        iksel.UnknownNameError, match="'leg'; given: c; .*ROS_PACKAGE_P"
    ):
        find_package("leg", {"c": other}, around / "urdf")


def test_a_folders_name_counts_where_no_package_xml_says_it(tmp_path: Path) -> None:
    # As example-robot-data 6 is installed: its package.xml says example_robot_data.
    share = make(tmp_path / "share/robot-data", "robot_data")
    urdf = make(share / "robots/arm/urdf")
    for name in ("robot-data", "robot_data"):
        found = resolve_path(f"package://{name}/a.stl", {}, urdf)
        assert found == share / "a.stl"
    inner = make(share / "robots/robot_data", "other")
    assert find_package("robot_data", {}, urdf) == share
    assert find_package("other", {}, inner) == inner


def test_names_of_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    share = make(tmp_path / "share/arm", "arm")
    near = make(tmp_path / "near")
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"/nowhere:{tmp_path}")
    assert resolve_path("package://arm/a/b.stl", {}, near) == share / "a/b.stl"
    assert resolve_path("model://arm/b.stl", {}, near) == share / "b.stl"
    assert resolve_path("package:///arm/b.stl", {}, near) == share / "b.stl"
    assert resolve_path("a/b.stl", {}, near) == near / "a/b.stl"
    assert resolve_path("file:///a/b.stl", {}, near) == Path("/a/b.stl")
    with pytest.raises(iksel.UnknownNameError, match=r"\(for 'package://leg/b.stl'\)"):
        resolve_path("package://leg/b.stl", {}, near)


MESHED = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="meshed">
  <xacro:arg name="folder" default="nowhere"/>
  <link name="base"><collision><geometry>
    <mesh filename="package://arm/$(arg folder)/corner.obj"/>
  </geometry></collision></link>
  <link name="hand"><collision><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="hand"/>
    <axis xyz="1 0 0"/><limit lower="-2" upper="2" velocity="1" effort="0"/></joint>
</robot>"""
CORNER = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def test_collision_finds_meshes_of_xacro_files(tmp_path: Path) -> None:
    pytest.importorskip("coal")
    pytest.importorskip("xacro")
    from iksel.collision import SelfCollision  # noqa: PLC0415

    package = make(tmp_path / "arm", "arm")
    (make(package / "meshes") / "corner.obj").write_text(CORNER)
    path = make(package / "urdf") / "arm.urdf.xacro"
    path.write_text(MESHED)
    arguments = {"folder": "meshes"}
    robot = iksel.load_robot(path, xacro_args=arguments)
    keep = [("base", "hand")]
    free = SelfCollision(path, robot, xacro_args=arguments, keep=keep)
    assert free([[-0.2], [0.5], [1.2]]).tolist() == [True, False, True]
    with pytest.raises(iksel.UrdfError, match="nowhere/corner.obj"):
        SelfCollision(path, robot)
