# SPDX-License-Identifier: BSD-3-Clause
"""Xacro that was not expanded is told from URDF; a missing file is missing first."""

from __future__ import annotations

from pathlib import Path

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
    run: Run, tmp_path: Path, xml: str, suffix: str
) -> None:
    path = tmp_path / ("arm" + suffix)
    path.write_text(xml, encoding="utf-8")
    for source in (xml, path):
        for settings in ({}, {"tip_link": "tool"}):
            with pytest.raises(iksel.UrdfError, match="xacro FILE > robot.urdf"):
                iksel.Robot.from_urdf(source, **settings)
    assert_bad(run("info", path), r"it is xacro \(.*xacro FILE > robot\.urdf")


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
