# SPDX-License-Identifier: BSD-3-Clause
"""Degrees: asked for by --degrees, and suspected where radians are meant."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np
import pytest
from command_line import Run, assert_good
from urdf_text import LIMIT, arm

import iksel

Q = [0.1, -1.0, 1.0, 0.2, 0.3, -0.4]
FEW = ["--samples", "500"]


def words(numbers) -> list[str]:
    return [repr(float(x)) for x in numbers]


@pytest.fixture
def slide(tmp_path: Path) -> Path:
    path = tmp_path / "slide.urdf"
    path.write_text(arm(kind="prismatic", axis="0 1 0"), encoding="utf-8")
    return path


def test_info_shows_both_units(run: Run) -> None:
    text = assert_good(run("info panda")).out
    (row,) = (line for line in text.splitlines() if line.startswith("panda_joint1 "))
    assert row.split()[2:] == [
        *("-2.8973", "2.8973", "2.1750", "rad"),
        *("-166.00", "166.00", "124.62", "deg"),
    ]
    plain = run("info panda --json").json()
    degrees = run("info panda --json --degrees").json()
    assert (plain["angle_unit"], degrees["angle_unit"]) == ("rad", "deg")
    for one, other in zip(plain["joints"], degrees["joints"], strict=True):
        for field in ("lower", "upper", "velocity_limit"):
            assert other[field] == pytest.approx(math.degrees(one[field]))
    assert degrees["reach"] == plain["reach"]


def test_robots_are_listed_in_both_units(run: Run) -> None:
    plain = assert_good(run("robots --json")).json()
    degrees = assert_good(run("robots --json --degrees")).json()
    assert (plain["angle_unit"], degrees["angle_unit"]) == ("rad", "deg")
    for one, other in zip(plain["robots"], degrees["robots"], strict=True):
        kinds = iksel.load_robot(one["name"]).joint_types
        for kind, a, b in zip(kinds, one["upper"], other["upper"], strict=True):
            slides = kind == iksel.JointType.prismatic
            expected = a if a is None or slides else math.degrees(a)
            assert b == pytest.approx(expected)
    assert run("robots").out == run("robots --degrees").out


def test_solve_in_degrees(run: Run, made) -> None:
    robot = made.robot("ur3")
    pose = robot.fk(Q)
    rpy = iksel.euler_from_pose(pose)
    command = ["solve", "ur3", *FEW, "--json"]
    plain = run(*command, "--pose", *words([*pose[:3, 3], *rpy])).json()
    answer = run(
        *command, "--degrees", "--pose", *words([*pose[:3, 3], *np.degrees(rpy)])
    ).json()
    np.testing.assert_allclose(answer["target"], pose, atol=1e-12)
    np.testing.assert_allclose(answer["q"], np.degrees(plain["q"]), atol=1e-6)
    assert (plain["angle_unit"], answer["angle_unit"]) == ("rad", "deg")
    for flag in ("--near", "--seed-q"):
        near = run(
            *(*command, "--degrees", "--from-q", *words(np.degrees(Q))),
            *(flag, *words(np.degrees(Q))),
        ).json()
        np.testing.assert_allclose(near["q"], np.degrees(Q), atol=1e-4)
    every = run(
        *(*command, "--degrees", "--all", "--from-q", *words(np.degrees(Q))),
    ).json()
    assert min(np.abs(np.array(every["q"]) - np.degrees(Q)).max(axis=1)) < 1e-3
    far = ["--pose", "9 0 0 0 0 0", "--diagnose"]
    best = run(*command, "--degrees", *far).json()["diagnosis"]["best_effort_q"]
    other = run(*command, *far).json()["diagnosis"]["best_effort_q"]
    np.testing.assert_allclose(best, np.degrees(other), atol=1e-6)
    text = run(*command[:-1], "--degrees", "--all", "--from-q", *words(np.degrees(Q)))
    assert "[deg or m]" in assert_good(text).out


def test_slides_stay_metres(run: Run, slide: Path) -> None:
    command = ["solve", slide, "--json", "--task", "position_only", "--degrees"]
    answer = assert_good(run(*command, "--from-q", "30", "0.5")).json()
    made = iksel.Robot.from_urdf(slide)
    np.testing.assert_allclose(answer["target"], made.fk([math.radians(30), 0.5]))
    np.testing.assert_allclose(answer["q"], [30, 0.5], atol=1e-3)
    locked = ["info", slide, "--json", "--degrees"]
    for joint, value, q in (("first", "90", [0.5]), ("second", "0.5", [0.5])):
        info = assert_good(run(*locked, "--lock", f"{joint}={value}")).json()
        radians = math.radians(90) if joint == "first" else 0.5
        expected = iksel.Robot.from_urdf(slide, locked_joints={joint: radians})
        assert info["chain_hash"] == f"{expected.chain_hash:016x}"
        assert expected.fk(q).shape == (4, 4)
    tool = assert_good(run(*locked, "--tcp", "0 0 0.1 0 90 0")).json()["tcp"]
    expected = iksel.pose_from_euler([0, 0, 0.1], [0, math.pi / 2, 0])
    np.testing.assert_allclose(tool, expected, atol=1e-12)


def test_default_limits_in_degrees(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(arm(inside=LIMIT.replace("-1", "0").replace("2", "0")), "utf-8")
    command = ["info", path, "--json", "--degrees", "--default-limits", "-90", "45"]
    joint = assert_good(run(*command)).json()["joints"][1]
    assert (joint["lower"], joint["upper"]) == pytest.approx((-90, 45))


def test_path_in_degrees(run: Run, made, tmp_path: Path) -> None:
    robot = made.robot("ur3")
    file = tmp_path / "poses.txt"
    lines, degrees = [], []
    for i in range(4):
        pose = robot.fk([Q[0] + 0.01 * i, *Q[1:]])
        rpy = iksel.euler_from_pose(pose)
        lines.append(" ".join(words([*pose[:3, 3], *rpy])))
        degrees.append(" ".join(words([*pose[:3, 3], *np.degrees(rpy)])))
    file.write_text("\n".join(lines), "utf-8")
    command = ["path", "ur3", file, *FEW, "--json"]
    plain = assert_good(run(*command, "--start", *words(Q))).json()
    file.write_text("\n".join(degrees), "utf-8")
    command += ["--degrees", "--start", *words(np.degrees(Q))]
    answer = assert_good(run(*command)).json()
    np.testing.assert_allclose(answer["q"], np.degrees(plain["q"]), atol=1e-4)
    assert answer["largest_step"] == pytest.approx(
        math.degrees(plain["largest_step"]), abs=1e-4
    )
    far = [Q[0] + 0.5, *Q[1:]]
    hasty = [*command[:-6], *words(np.degrees(far)), "--dt", "0.01"]
    why = assert_good(run(*hasty), code=1).json()["too_fast"]
    assert why["speed"] == pytest.approx(math.degrees(0.5) / 0.01, rel=0.01)
    assert why["velocity_limit"] == pytest.approx(math.degrees(robot.velocity_limit[0]))
    command.remove("--json")
    text = assert_good(run(*command)).out
    assert "[deg or m]" in text
    assert " deg, shoulder_pan_joint" in text


@pytest.mark.parametrize(
    ("given", "flag"),
    [
        ("--from-q 0 -90 90 0 0 0", "--from-q"),
        ("--pose 0.2 0.15 0.3 0 180 0", "--pose"),
        ("--pose 0.2 0.15 0.3 0 3.1416 0 --near 0 -90 90 0 0 0", "--near"),
        ("--from-q 0 0 0 0 0 0 --tcp 0 0 0.1 90 0 0", "--tcp"),
    ],
)
def test_degrees_are_suspected(run: Run, given: str, flag: str) -> None:
    output = run(f"solve ur3 --json --samples 500 {given}")
    assert output.code in (0, 1)
    assert output.err.startswith(f"iksel: warning: {flag}: ")
    assert "--degrees" in output.err
    assert output.err.count("\n") == 1
    assert run(f"solve ur3 --json --samples 500 {given} --degrees").err == ""


@pytest.mark.parametrize(
    "given",
    [
        "--from-q 0 -1 1 6 0 0",
        "--from-q 0 -7.5 1 6 0 0",
        "--pose 9 15 30 0 3 0",
        "--pose 0.2 0.15 0.3 0 3.1416 6.5",
    ],
)
def test_radians_are_not_suspected(run: Run, given: str) -> None:
    assert run(f"solve ur3 --json --samples 500 {given}").err == ""


WINCH = LIMIT.replace("-1", "-100").replace('"2"', '"100"')


@pytest.mark.parametrize("kind", ["revolute", "continuous"])
def test_joints_of_many_turns_are_not_suspected(
    run: Run, tmp_path: Path, kind: str
) -> None:
    """Of an arm whose first joint turns from -1 to 2 rad, and whose second far."""
    path = tmp_path / "winch.urdf"
    path.write_text(arm(kind=kind, axis="0 1 0", inside=WINCH), "utf-8")
    for far in ("7", "90", "-90", "99"):
        for first in ("0", "1", "-1", "4"):
            assert run("fk", path, first, far).err == ""
            command = ["solve", path, "--from-q", "0", "0", "--near"]
            assert run(*command, first, far).err == ""
        assert run("info", path, "--lock", f"second={far}").err == ""
    output = run("fk", path, "90", "0")
    assert output.err.startswith("iksel: warning: Q: 90 0 look like degrees")
    assert run("fk", path, "90", "0", "--degrees").err == ""
    assert "--lock first: 90 look" in run("info", path, "--lock", "first=90").err
    # What as degrees lies outside the limits is just as strange.
    assert run("fk", path, "200", "0").err == ""


def test_joints_suspected_need_no_whole_numbers(run: Run) -> None:
    assert "look like degrees" in run("fk ur3 0.5 -90.25 90 0 0 0").err


def test_locks_work_in_files_of_other_encodings(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_bytes(arm().encode().replace(b"<robot", b"<!-- \xe9 --><robot"))
    assert_good(run("info", path, "--lock", "second=0.3"))


def test_limits_of_many_turns_are_not_suspected(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(arm(inside=LIMIT.replace("-1", "0").replace("2", "0")), "utf-8")
    assert_good(run("info", path, "--default-limits", "-20", "20"))


def test_slides_are_not_suspected(run: Run, slide: Path) -> None:
    output = run("solve", slide, "--from-q", "1", "90", "--task", "position_only")
    assert output.err == ""


def test_degrees_are_suspected_in_python() -> None:
    with pytest.warns(iksel.AngleUnitWarning, match="rpy.*degrees") as caught:
        iksel.pose_from_euler([0, 0, 0], [0, 90, 0])
    assert caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for rpy in ([0, 3, 6], [0.5, 7.25, 0], [math.pi, -math.pi, 2 * math.pi]):
            iksel.pose_from_euler([0, 0, 0], rpy)


def test_joint_values_in_degrees_are_suspected(made, slide: Path) -> None:
    solver = made.solver("ur3")
    pose = solver.robot.fk(Q)
    degrees = [0, -90, 90, 0, 0, 0]
    for name, solve in (
        ("near", lambda q: solver.solve(pose, near=q)),
        ("seeds", lambda q: solver.solve(pose, seeds=[q])),
        ("near", lambda q: solver.solve_all(pose, near=q)),
        ("near", lambda q: solver.solve_batch([pose], near=q)),
        ("start", lambda q: solver.solve_path([pose], start=q)),
    ):
        with pytest.warns(iksel.AngleUnitWarning, match=f"{name}: .*degrees") as caught:
            solve(degrees)
        assert caught[0].filename == __file__
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            solve([0, -3, 6, 0, 0, 0])
            solve([0, -7.25, 6, 0, 0, 0])
    sliding = iksel.Robot.from_urdf(slide)
    options = iksel.SolverOptions(task=iksel.Task.position_only())
    solver = iksel.Solver(sliding, options)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        solver.solve(sliding.fk([0.1, 0.2]), near=[0, 90])


def test_objectives_have_a_cost(run: Run) -> None:
    command = "solve panda --from-q 0 -0.5 0 -2 0 1.6 0.8 --samples 500"
    for objective in ("limits", "manipulability"):
        answer = assert_good(run(f"{command} --objective {objective} --json")).json()
        assert isinstance(answer["cost"], float)
        text = assert_good(run(f"{command} --objective {objective}")).out
        assert "\ncost " in text
    assert run(f"{command} --json").json()["cost"] is None
    assert "\ncost " not in run(command).out
