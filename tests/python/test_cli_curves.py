# SPDX-License-Identifier: BSD-3-Clause
"""Curves by which joints follow others, on the command line."""

from __future__ import annotations

from pathlib import Path

import curve_arms
import numpy as np
import pytest
from command_line import Run, assert_bad

import iksel


@pytest.fixture
def arm(tmp_path: Path) -> list[str]:
    path = tmp_path / "lift.urdf"
    path.write_text(curve_arms.description(), encoding="utf-8")
    return [str(path), "--tip", "flange"]


@pytest.fixture
def points(tmp_path: Path) -> Path:
    lengths = np.linspace(*curve_arms.CYLINDER, 30)
    angles, slopes = curve_arms.shoulder(lengths)
    path = tmp_path / "lift.csv"
    np.savetxt(path, np.transpose([lengths, angles, slopes]), delimiter=",")
    return path


def test_info_lists_them(run: Run, arm: list[str], points: Path) -> None:
    flag = ["--mimic-curve", f"joint_2=cylinder:{points}"]
    assert (
        "joint_2 follows cylinder (30 points, 0.42 to 0.72)"
        in run("info", *arm, *flag).out
    )
    listed = run("info", *arm, *flag, "--json").json()["mimic_curves"]
    assert (listed[0]["joint"], listed[0]["follows"]) == ("joint_2", "cylinder")
    assert listed[0]["slopes"][0] == pytest.approx(curve_arms.shoulder(0.42)[1])


def test_fk_goes_through_them(run: Run, arm: list[str], points: Path) -> None:
    flag = ["--mimic-curve", f"joint_2=cylinder:{points}"]
    q = [0.1, 0.5, 0.3, 0.2, 0.4, 0.0]
    out = run("fk", *arm, *flag, *map(str, q), "--json").json()
    plain = iksel.load_robot(curve_arms.description(followers=False), tip_link="flange")
    q[1] = curve_arms.shoulder(0.5)[0]
    np.testing.assert_allclose(out["pose"], plain.fk(q), atol=1e-6)


@pytest.mark.parametrize(
    ("text", "culprit"),
    [
        (None, "--mimic-curve: .*No such file"),
        ("", "expected 2 or 3 columns"),
        ("0.5,1,2,3", r"expected 2 or 3 columns \(q of cylinder.*got 4"),
        ("0.5,a", "--mimic-curve: .*could not convert"),
        ("0.5,0.1", r"--mimic-curve\[0\].*q: expected 2 to"),
    ],
)
def test_wrong_files_are_named(
    run: Run, arm: list[str], tmp_path: Path, text: str | None, culprit: str
) -> None:
    path = tmp_path / "points.csv"
    if text is not None:
        path.write_text(text, encoding="utf-8")
    assert_bad(run("info", *arm, "--mimic-curve", f"joint_2=cylinder:{path}"), culprit)


def test_wrong_forms_are_refused(run: Run, arm: list[str]) -> None:
    for text in ("joint_2", "joint_2=cylinder", "=cylinder:file", "joint_2=:file"):
        assert_bad(
            run("info", *arm, "--mimic-curve", text), "expected JOINT=SOURCE:FILE"
        )
