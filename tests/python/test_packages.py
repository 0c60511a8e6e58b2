# SPDX-License-Identifier: BSD-3-Clause
"""package:// names of meshes are found as ROS finds packages."""

from __future__ import annotations

from pathlib import Path

import pytest

import iksel
from iksel._packages import find_package, resolve_path


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
        iksel.UnknownNameError, match="'arm'; given: c; .*ROS_PACKAGE_P"
    ):
        find_package("arm", {"c": other}, around / "urdf")


def test_names_of_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    share = make(tmp_path / "share/arm", "arm")
    near = make(tmp_path / "near")
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"/nowhere:{tmp_path}")
    assert resolve_path("package://arm/a/b.stl", {}, near) == share / "a/b.stl"
    assert resolve_path("model://arm/b.stl", {}, near) == share / "b.stl"
    assert resolve_path("a/b.stl", {}, near) == near / "a/b.stl"
    assert resolve_path("file:///a/b.stl", {}, near) == Path("/a/b.stl")
    with pytest.raises(iksel.UnknownNameError, match=r"\(for 'package://leg/b.stl'\)"):
        resolve_path("package://leg/b.stl", {}, near)
