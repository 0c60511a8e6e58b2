# SPDX-License-Identifier: BSD-3-Clause
"""Arms from Denavit and Hartenberg's parameters, against the textbook's matrices."""

from __future__ import annotations

import os
import warnings

import numpy as np
import pytest

import iksel

SEED = int(os.environ.get("IKSEL_TEST_SEED", "1"))
# Of a UR5's data sheet: standard parameters.
UR5 = {
    "a": [0, -0.425, -0.39225, 0, 0, 0],
    "alpha": [np.pi / 2, 0, 0, np.pi / 2, -np.pi / 2, 0],
    "d": [0.089159, 0, 0, 0.10915, 0.09465, 0.0823],
}


def turn_z(angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])


def turn_x(angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1.0]])


def shift(x: float, z: float) -> np.ndarray:
    pose = np.eye(4)
    pose[0, 3], pose[2, 3] = x, z
    return pose


def textbook(table: dict, q: np.ndarray) -> np.ndarray:
    """The pose by the four matrices of each row."""
    pose = table["base"]
    rows = zip(
        table["a"],
        table["alpha"],
        table["d"],
        table["theta"],
        table["types"],
        strict=True,
    )
    for value, (a, alpha, d, theta, kind) in zip(q, rows, strict=True):
        if kind == "prismatic":
            z = turn_z(theta) @ shift(0, d + value)
        else:
            z = turn_z(theta + value) @ shift(0, d)
        x = shift(a, 0) @ turn_x(alpha)
        pose = pose @ (z @ x if table["convention"] == "standard" else x @ z)
    return pose @ table["tcp"]


def random_pose(rng: np.random.Generator) -> np.ndarray:
    return iksel.pose_from_rotation_vector(rng.normal(size=3), rng.normal(size=3))


def random_table(rng: np.random.Generator) -> dict:
    n = int(rng.integers(1, 9))
    regular = rng.random(n) < 0.5
    types = rng.choice(["revolute", "prismatic"], n, p=[0.8, 0.2])
    ends = np.sort(rng.uniform(-3, 3, (2, n)), axis=0)
    free = (types == "revolute") & (rng.random(n) < 0.3)
    right = rng.integers(-2, 3, n) * np.pi / 2
    return {
        "a": np.where(rng.random(n) < 0.5, 0, rng.normal(size=n)),
        "alpha": np.where(regular, right, rng.uniform(-3, 3, n)),
        "d": np.where(rng.random(n) < 0.5, 0, rng.normal(size=n)),
        "theta": np.where(regular, right, rng.uniform(-3, 3, n)),
        "convention": str(rng.choice(["standard", "modified"])),
        "types": types.tolist(),
        "lower": np.where(free, -np.inf, ends[0]),
        "upper": np.where(free, np.inf, ends[1]),
        "velocity": np.where(rng.random(n) < 0.5, np.inf, rng.uniform(0.1, 9, n)),
        "names": [f"j {i} & <\"'>" for i in rng.permutation(n)],
        "base": random_pose(rng),
        "tcp": random_pose(rng),
    }


def test_random_tables_are_the_textbooks(cases) -> None:
    rng = np.random.default_rng(SEED)
    for case in range(cases):
        table = random_table(rng)
        where = f"case {case}, seed {SEED}: {table}"
        robot = iksel.Robot.from_dh(**table)
        np.testing.assert_array_equal(robot.lower, table["lower"], where)
        np.testing.assert_array_equal(robot.upper, table["upper"], where)
        np.testing.assert_array_equal(robot.velocity_limit, table["velocity"], where)
        assert robot.joint_names == table["names"], where
        q = robot.random_configurations(5, seed=case)
        expected = [textbook(table, row) for row in q]
        np.testing.assert_allclose(
            robot.fk(q), expected, rtol=0, atol=1e-12, err_msg=where
        )


def test_frames_of_the_table_are_links() -> None:
    rng = np.random.default_rng(SEED)
    table = {**random_table(rng), "tcp": np.eye(4)}
    robot = iksel.Robot.from_dh(**table)
    q = robot.random_configurations(1, seed=SEED)[0]
    n = robot.dof
    for i in range(1, n + 1):
        columns = ("a", "alpha", "d", "theta", "types")
        first = table | {name: table[name][:i] for name in columns}
        at = robot.link_names.index(f"link{i}")
        pose = robot.link_poses(q)[at]
        np.testing.assert_allclose(pose, textbook(first, q[:i]), rtol=0, atol=1e-12)


def test_a_ur5_of_its_data_sheet(made) -> None:
    arm = iksel.Robot.from_dh(**UR5, name="sheet")
    assert (arm.name, arm.base_link, arm.tip_link) == ("sheet", "base", "link6")
    assert arm.joint_names == [f"joint{i}" for i in range(1, 7)]
    assert {kind.name for kind in arm.joint_types} == {"continuous"}
    assert arm.structure.kind == iksel.StructureKind.closed_form
    poses = arm.fk(arm.random_configurations(100, seed=SEED))
    found = iksel.Solver(arm).solve_batch(poses)
    assert found.success.all()
    again = iksel.Robot.from_dh(**UR5, convention=iksel.DhConvention.standard)
    assert again.chain_hash == arm.chain_hash


REFUSED = {
    "alpha: expected 6 as of a, got 5": {"alpha": [0] * 5},
    r"d: expected an \(N,\) array, a number for each joint": {"d": [[0] * 6]},
    "theta: expected an array of real numbers": {"theta": ["0"] * 6},
    r"joints\[2\]: a, alpha, d or theta is nan": {"d": [0, 0, np.nan, 0, 0, 0]},
    r"joints\[0\]: limits -1 to inf: give both, or none": {"lower": [-1] * 6},
    r"joints\[0\]: limits nan to nan: give both, or none": {
        "lower": [np.nan] * 6,
        "upper": [np.nan] * 6,
    },
    r"joints\[1\]: velocity is nan": {"velocity": [1, np.nan, 1, 1, 1, 1]},
    r"joints\[3\]: velocity is -1": {"velocity": [1, 1, 1, -1, 1, 1]},
    r"joints\[1\]: a prismatic joint needs limits": {
        "types": ["revolute", "prismatic"] + ["revolute"] * 4
    },
    r"joints\[0\]: a continuous joint has no limits": {
        "types": ["continuous"] * 6,
        "lower": [-1] * 6,
        "upper": [1] * 6,
    },
    r"types\[5\]: expected one of revolute, continuous": {
        "types": ["revolute"] * 5 + ["screw"]
    },
    r"joints\[3\]: a second 'b'": {"names": ["a", "b", "c", "b", "d", "e"]},
    "names: expected 6 as of a, got 1": {"names": ["a"]},
    "convention: expected one of standard, modified": {"convention": "craig"},
    "base.*not rigid": {"base": 2 * np.eye(4)},
    "tcp.*not rigid": {"tcp": np.ones((4, 4))},
}


@pytest.mark.parametrize("message", REFUSED)
def test_what_is_no_table_is_refused(message) -> None:
    with pytest.raises(iksel.InvalidArgumentError, match=message):
        iksel.Robot.from_dh(**{**UR5, **REFUSED[message]})


def test_a_table_without_rows_and_limits_without_a_range() -> None:
    with pytest.raises(iksel.InvalidArgumentError, match="one row or more"):
        iksel.Robot.from_dh([], [], [])
    with pytest.raises(iksel.UrdfError, match="joint1"):
        iksel.Robot.from_dh([0], [0], [0], lower=[1], upper=[-1])


def test_degrees_are_suspected() -> None:
    degrees = {**UR5, "alpha": [90, 0, 0, 90, -90, 0]}
    with pytest.warns(iksel.AngleUnitWarning, match="^alpha: .*degrees"):
        iksel.Robot.from_dh(**degrees)
    with pytest.warns(iksel.AngleUnitWarning, match="^upper: .*degrees"):
        iksel.Robot.from_dh(**UR5, lower=[-6] * 6, upper=[180] * 6)
    slide = {"types": ["prismatic"], "lower": [-50], "upper": [50]}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        iksel.Robot.from_dh([0], [0], [0], **slide)  # metres
