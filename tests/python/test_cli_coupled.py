# SPDX-License-Identifier: BSD-3-Clause
"""Coupled limits on the command line."""

from __future__ import annotations

import math

import pytest
from command_line import Run
from linkage_arms import ELBOW, WRIST, fanuc_like

import iksel
from iksel.cli._coupled import parse_coupled_limit


@pytest.fixture
def arm(tmp_path) -> str:
    path = tmp_path / "arm.urdf"
    path.write_text(fanuc_like(), encoding="utf-8")
    return str(path)


def parse(text: str) -> iksel.CoupledLimit:
    return parse_coupled_limit(text, lambda joints, value: value)


@pytest.mark.parametrize(
    "limit",
    [
        ELBOW,
        iksel.CoupledLimit({"a": -1, "b": 0.5}, lower=-2),
        iksel.CoupledLimit({"a": 1, "b": -1, "c-d": 2.25}, upper=1e-3),
    ],
)
def test_what_is_printed_is_read(limit: iksel.CoupledLimit) -> None:
    assert parse(str(limit)) == limit


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("-1 <= 2*a - b <= inf", iksel.CoupledLimit({"a": 2, "b": -1}, lower=-1)),
        ("- a + 3 a <= 1", iksel.CoupledLimit({"a": 2}, upper=1)),
        ("0 <= a", iksel.CoupledLimit({"a": 1}, lower=0)),
    ],
)
def test_other_spellings_are_read(text: str, expected: iksel.CoupledLimit) -> None:
    assert parse(text) == expected


@pytest.mark.parametrize(
    "text",
    ["", "a", "a b <= 1", "a + <= 1", "1 <= 2", "a <= b", "1 <= a <= b", "a+1<=b+2"],
)
def test_other_forms_are_refused(text: str) -> None:
    with pytest.raises(iksel.InvalidArgumentError, match="--coupled-limit: expected"):
        parse(text)


def test_info_lists_them(run: Run, arm: str) -> None:
    flags = ["--coupled-limit", str(ELBOW), "--coupled-limit", str(WRIST)]
    shown = run("info", arm, *flags).out
    assert str(ELBOW) in shown
    assert str(WRIST) in shown
    listed = run("info", arm, *flags, "--json").json()["coupled_limits"]
    assert listed[0] == {
        "coefficients": {"joint_2": 1.0, "joint_3": 1.0},
        "lower": -1.2,
        "upper": 2.0,
    }


def test_ends_may_be_degrees(run: Run, arm: str) -> None:
    flags = ["--degrees", "--coupled-limit", "joint_2 + joint_3 <= 90"]
    listed = run("info", arm, *flags, "--json").json()["coupled_limits"]
    assert listed[0]["upper"] == pytest.approx(math.pi / 2)
    assert listed[0]["lower"] is None


def test_solve_keeps_to_them(run: Run, arm: str) -> None:
    robot = iksel.load_robot(arm)
    q = [0.1, 1.4, 1.2, 0.2, 0.9, 0.1]
    flags = ["--from-q", *map(str, q), "--json"]
    assert run("solve", arm, *flags).json()["success"]
    flags += ["--diagnose", "--coupled-limit", str(ELBOW)]
    bound = run("solve", arm, *flags).json()
    every = iksel.Solver(robot).solve_all(robot.fk(q)).q
    some = ((every[:, 1] + every[:, 2]) <= ELBOW.upper) & (
        every[:, 1] + every[:, 2] >= ELBOW.lower
    )
    assert bound["success"] == bool(some.any())
    if not bound["success"]:
        assert bound["diagnosis"]["coupled_limit"] == str(ELBOW)


def test_a_wrong_one_names_the_flag(run: Run, arm: str) -> None:
    failed = run("info", arm, "--coupled-limit", "0 <= joint_2 + elbow")
    assert failed.code != 0
    assert "--coupled-limit" in failed.err
    assert "'elbow'" in failed.err
