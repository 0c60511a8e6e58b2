# SPDX-License-Identifier: BSD-3-Clause
"""Lengths and joint values beyond what double precision serves are refused by name."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from urdf_text import arm, joint, limits, link, mimic, robot

import iksel

BOUND = 1e8
"""Largest length [m] and joint value [rad or m], as the documentation has it."""

BEYOND = ("1e160", "-1e9", "1.1e8", "1e308", "inf", "nan")


def refuse(xml: str, match: str, error=iksel.UrdfError, **settings: object) -> str:
    with pytest.raises(error, match=match) as caught:
        iksel.Robot.from_urdf(xml, **settings)
    return str(caught.value)


@pytest.mark.parametrize("length", BEYOND)
@pytest.mark.parametrize("where", ["{} 0 0", "0 {} 0", "0 0 {}"])
def test_long_links_are_refused(length: str, where: str) -> None:
    refuse(arm(xyz=where.format(length)), "second.*origin|origin.*second")
    # The way to the first joint is part of every pose.
    first = joint("first", "base", "hand", xyz=where.format(length))
    refuse(robot(link("base", "hand"), first), "first.*origin|origin.*first")


def test_fixed_joints_are_measured() -> None:
    tool = link("tool") + joint("flange", "hand", "tool", kind="fixed", xyz="1e160 0 0")
    refuse(arm(tool), "'flange'.*origin", tip_link="tool")
    assert iksel.Robot.from_urdf(arm(tool), tip_link="hand").dof == 2


@pytest.mark.parametrize("value", ["1e200", "1.1e8"])
def test_limits_without_end_are_none(value: str) -> None:
    turning = iksel.Robot.from_urdf(
        arm(kind="revolute", inside=limits("-" + value, value))
    )
    assert np.isinf(turning.upper).any()
    for ends in (("-" + value, value), ("-1", value)):
        refuse(arm(kind="prismatic", inside=limits(*ends)), "'second'.*default_limits")


def test_many_long_links_are_refused_as_a_whole() -> None:
    names = [f"l{i}" for i in range(31)]
    joints = [
        joint(f"j{i}", a, b, xyz="9e6 0 0", axis="0 1 0")
        for i, (a, b) in enumerate(itertools.pairwise(names))
    ]
    refuse(robot(link(*names), *joints), "'j11'.*length up to it is 1.08e\\+08 m")


def test_tools_are_measured() -> None:
    far = iksel.pose_from_euler([0, 0, 1.1e8], [0, 0, 0])
    refuse(arm(), "tcp", iksel.InvalidArgumentError, tcp=far)
    made = iksel.Robot.from_urdf(arm())
    with pytest.raises(iksel.InvalidArgumentError, match=r"tcp.*1\.1e\+08 m"):
        made.with_tcp(far)


@pytest.mark.parametrize("value", [1e200, -1.1e8, np.inf, np.nan])
def test_locked_values_are_measured(value: float) -> None:
    for kind in ("revolute", "prismatic"):
        refuse(
            arm(kind=kind),
            "locked joint 'second'",
            iksel.InvalidArgumentError,
            locked_joints={"second": value},
        )


@pytest.mark.parametrize(
    "extra", ['multiplier="1e9"', 'offset="1e200"', 'offset="inf"']
)
def test_mimics_are_measured(extra: str) -> None:
    refuse(arm(inside=mimic(extra=extra)), "second")
    refuse(
        arm(inside=mimic(extra=extra)), "second|movable", locked_joints={"first": 1e7}
    )


def test_slides_that_follow_without_end_are_refused() -> None:
    rack = joint(
        "rack", "base", "slide", kind="prismatic", inside=mimic("pinion", "", "")
    )
    pinion = joint("pinion", "slide", "hand", kind="continuous", inside="")
    xml = robot(link("base", "slide", "hand"), rack, pinion)
    refuse(xml, "'rack' has no limits, and 'pinion'.*turns without end")


def test_axes_are_measured() -> None:
    refuse(arm(axis="1e200 0 0"), "'second'.*axis")


@pytest.mark.parametrize("size", [1e-4, 1.0, 1e3])
def test_what_is_not_refused_can_be_solved(size: float) -> None:
    rows = ((0, 0, 1), (0, 1, 0), (0, 1, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))
    names = [f"l{i}" for i in range(7)]
    joints = [
        joint(
            f"j{i}",
            names[i],
            names[i + 1],
            xyz=f"0 {size / 9} {size}",
            axis=f"{x} {y} {z}",
        )
        for i, (x, y, z) in enumerate(rows)
    ]
    made = iksel.Robot.from_urdf(robot(link(*names), *joints))
    solver = iksel.Solver(made, iksel.SolverOptions(position_tolerance=1e-6 * size))
    q = made.random_configurations(20, 3)
    answers = solver.solve_batch(made.fk(q))
    assert answers.success.mean() > 0.9
    errors = iksel.pose_error(made.fk(q), made.fk(np.nan_to_num(answers.q)))
    assert (errors[0][answers.success] <= 1.001e-6 * size).all()


def test_the_largest_robot_is_computed_to_the_default_tolerance() -> None:
    """The bound's reason: kernel and KDL, which round otherwise, still agree."""
    names = [f"l{i}" for i in range(33)]
    length = 0.999 * BOUND / 32
    joints = [
        joint(f"j{i}", names[i], names[i + 1], xyz=f"0 0 {length}", axis="0 1 0")
        for i in range(32)
    ]
    made = iksel.Robot.from_urdf(robot(link(*names), *joints))
    q = made.random_configurations(50, 4)
    distance, angle = iksel.pose_error(made.fk(q), made.fk(q, "kdl"))
    assert distance.max() < 1e-6
    assert angle.max() < 1e-6


@pytest.mark.parametrize("far", [1e9, 1e155, 1e300, 1.7e308])
@pytest.mark.parametrize("task", [None, iksel.Task.position_only()])
def test_how_far_a_target_is_beyond_reach_is_a_number(
    far: float, task: iksel.Task | None
) -> None:
    solver = iksel.Solver(iksel.load_robot("ur3"))
    pose = np.eye(4)
    pose[:2, 3] = far
    why = solver.diagnose(pose, task=task)
    assert why.cause == iksel.Cause.out_of_reach
    # Of the farthest not even the length is a double.
    length = min(2**0.5 * far, np.finfo(float).max)
    assert why.beyond_reach == pytest.approx(length, rel=1e-6)
    assert "inf" not in why.message
    closest = solver.solve(pose, task=task, closest=True)
    assert closest.position_error == pytest.approx(length, rel=1e-6)
