# SPDX-License-Identifier: BSD-3-Clause
"""iksel fk and iksel jacobian: text, JSON and plain matrices."""

from __future__ import annotations

import math

import numpy as np
import pytest
from command_line import Run, assert_bad, assert_good

import iksel

ROBOTS = ["ur3", "panda", "so100", "cvr038"]
SEED = 11


def words(numbers) -> list[str]:
    return [repr(float(x)) for x in numbers]


def matrix(text: str) -> np.ndarray:
    return np.array([[float(x) for x in line.split()] for line in text.splitlines()])


@pytest.fixture(params=ROBOTS)
def robot(request, made) -> iksel.Robot:
    return made.robot(request.param)


def test_fk_says_what_the_robot_does(run: Run, robot) -> None:
    for q in robot.random_configurations(3, seed=SEED):
        pose = robot.fk(q)
        command = ["fk", robot.name, *words(q)]
        plain = assert_good(run(*command, "--matrix")).out
        np.testing.assert_array_equal(matrix(plain), pose)
        answer = assert_good(run(*command, "--json")).json()
        np.testing.assert_array_equal(answer["pose"], pose)
        np.testing.assert_array_equal(answer["q"], q)
        assert answer["angle_unit"] == "rad"
        assert answer["within_limits"] is True
        assert answer["joint_names"] == robot.joint_names
        for made in (
            iksel.pose_from_euler(answer["position"], answer["rpy"]),
            iksel.pose_from_quaternion(answer["position"], answer["quaternion_wxyz"]),
        ):
            np.testing.assert_allclose(made, pose, rtol=0, atol=1e-14)


def test_fk_in_degrees(run: Run, made) -> None:
    robot = made.robot("ur3")
    q = robot.random_configurations(1, seed=SEED)[0]
    plain = run("fk", "ur3", *words(q), "--json").json()
    answer = run("fk", "ur3", "--degrees", *words(np.degrees(q)), "--json").json()
    np.testing.assert_allclose(answer["pose"], plain["pose"], rtol=0, atol=1e-14)
    np.testing.assert_allclose(answer["rpy"], np.degrees(plain["rpy"]), atol=1e-12)
    np.testing.assert_allclose(answer["q"], np.degrees(q), atol=1e-12)
    text = assert_good(run("fk", "ur3", "--degrees", *words(np.degrees(q)))).out
    assert " deg\n" in text
    assert " rad\n" not in text


def test_fk_with_a_tool_and_other_links(run: Run, made) -> None:
    robot = made.robot("ur3")
    q = words([0.1, -1, 1, 0.2, 0.3, -0.4])
    tool = iksel.pose_from_euler([0, 0, 0.1], [0, 0.5, 0])
    plain = run("fk", "ur3", *q, "--tcp", "0 0 0.1 0 0.5 0", "--matrix").out
    expected = robot.with_tcp(tool).fk([float(x) for x in q])
    np.testing.assert_allclose(matrix(plain), expected, rtol=0, atol=1e-15)


def test_fk_names_the_joints_outside_their_limits(run: Run) -> None:
    text = assert_good(run("fk ur3 0 -1 7 0 0 -6.5")).out
    assert "limits      outside: elbow_joint, wrist_3_joint\n" in text
    answer = run("fk ur3 0 -1 7 0 0 -6.5 --json").json()
    assert answer["within_limits"] is False
    assert "limits      inside\n" in run("fk ur3 0 -1 1 0 0 0").out


def test_jacobian_is_the_difference_quotient(run: Run, robot) -> None:
    step = 1e-6
    for q in robot.random_configurations(3, seed=SEED):
        command = ["jacobian", robot.name, *words(q)]
        plain = matrix(assert_good(run(*command, "--matrix")).out)
        answer = assert_good(run(*command, "--json")).json()
        np.testing.assert_array_equal(answer["jacobian"], plain)
        assert answer["rows"] == ["vx", "vy", "vz", "wx", "wy", "wz"]
        for joint in range(robot.dof):
            ends = np.array([q, q])
            ends[:, joint] += -step, step
            low, high = robot.fk(ends)
            turn = high[:3, :3] @ low[:3, :3].T
            linear = (high[:3, 3] - low[:3, 3]) / (2 * step)
            angular = np.array(
                [
                    turn[2, 1] - turn[1, 2],
                    turn[0, 2] - turn[2, 0],
                    turn[1, 0] - turn[0, 1],
                ]
            ) / (4 * step)
            column = np.concatenate([linear, angular])
            np.testing.assert_allclose(plain[:, joint], column, rtol=0, atol=1e-8)


def test_manipulability_is_that_of_yoshikawa(run: Run, robot) -> None:
    q = robot.random_configurations(1, seed=SEED)[0]
    answer = run("jacobian", robot.name, *words(q), "--json").json()
    jacobian = robot.jacobian(q)
    small = jacobian @ jacobian.T if robot.dof >= 6 else jacobian.T @ jacobian
    expected = math.sqrt(np.linalg.det(small))
    assert answer["manipulability"] == pytest.approx(expected, rel=1e-9)
    assert answer["singular_values"] == sorted(answer["singular_values"], reverse=True)


def test_jacobian_stays_per_radian(run: Run, made) -> None:
    q = made.robot("ur3").random_configurations(1, seed=SEED)[0]
    plain = matrix(run("jacobian", "ur3", *words(q), "--matrix").out)
    command = ["jacobian", "ur3", "--degrees", *words(np.degrees(q))]
    np.testing.assert_allclose(matrix(run(*command, "--matrix").out), plain, atol=1e-14)
    text = assert_good(run(*command)).out
    for word in ("singular values", "manipulability", "wrist_3_joint", "\nwz "):
        assert word in text


@pytest.mark.parametrize("command", ["fk", "jacobian"])
@pytest.mark.parametrize(
    ("given", "culprit"),
    [
        ("ur3", "Q"),
        ("ur33 0", "no built-in robot 'ur33'; did you mean ur3"),
        ("ur3 1 2 3", "Q: expected 6 numbers.*elbow_joint.*got 3"),
        ("ur3 1 2 3 4 5 x", "Q: not all numbers in '1 2 3 4 5 x'"),
        ("ur3 1 2 3 4 5 nan", "q.*not finite|nan"),
        ("ur3 0 0 0 0 0 0 --json --matrix", "--matrix: not allowed with.*--json"),
        ("ur3 0 0 0 0 0 0 --tip hand", "'hand'.*tool0"),
    ],
)
def test_bad_input_is_one_line(
    run: Run, command: str, given: str, culprit: str
) -> None:
    assert_bad(run(f"{command} {given}"), culprit)
