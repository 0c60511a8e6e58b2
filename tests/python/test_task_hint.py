# SPDX-License-Identifier: BSD-3-Clause
"""Arms with few joints: which tasks they can do, and where that is said."""

from __future__ import annotations

import re

import numpy as np
import pytest
import urdf_text

import iksel

SEED = 71
CASES = 40


def chain(*axes: str) -> iksel.Robot:
    """Links of 0.3 m that turn about these axes, the last along x, z in turn."""
    names = [f"link{i}" for i in range(len(axes) + 1)]
    joints = [
        urdf_text.joint(
            f"joint{i}",
            names[i],
            names[i + 1],
            axis=axis,
            xyz="0.3 0.05 0.1" if i else "0 0 0",
            inside='<limit lower="-3" upper="3" velocity="3" effort="0"/>',
        )
        for i, axis in enumerate(axes)
    ]
    tip = urdf_text.joint(
        "tip", names[-1], "tip", kind="fixed", xyz="0.2 0 0", inside=""
    )
    return iksel.Robot.from_urdf(
        urdf_text.robot(urdf_text.link(*names, "tip"), *joints, tip), tip_link="tip"
    )


ARMS = {
    "5 joints, none along the tool": chain("0 0 1", "0 1 0", "0 1 0", "0 1 0", "0 0 1"),
    "5 joints, the last along the tool": iksel.load_robot("xarm5"),
    "4 joints": chain("0 0 1", "0 1 0", "0 1 0", "1 0 0"),
    "3 joints": chain("0 0 1", "0 1 0", "0 1 0"),
    "3 joints in a plane": chain("0 0 1", "0 0 1", "0 0 1"),
}


def named_tasks(hint):
    """The tasks that a hint names, made as a reader of it would."""
    calls = re.findall(r"task=(\w+)\((?:'(\w)')?\)", hint)
    return [getattr(iksel.Task, name)(*filter(None, [axis])) for name, axis in calls]


def nearby(robot, n):
    """Poses a little beside reachable ones, in all six directions."""
    rng = np.random.default_rng(SEED)
    middle = (robot.lower + robot.upper) / 2
    half = np.minimum((robot.upper - robot.lower) / 2, 2.0) * 0.6
    poses = robot.fk(middle + rng.uniform(-half, half, (n, robot.dof)))
    off = iksel.pose_from_rotation_vector(
        rng.uniform(-1e-3, 1e-3, (n, 3)), rng.uniform(-1e-3, 1e-3, (n, 3))
    )
    return poses @ off


@pytest.mark.parametrize("name", ARMS)
def test_the_named_tasks_can_be_done(name) -> None:
    robot = ARMS[name]
    solver = iksel.Solver(robot)
    targets = nearby(robot, CASES)
    assert solver.solve_batch(targets).solved <= 0.1 * CASES, f"seed {SEED}"
    tasks = named_tasks(solver.task_hint)
    assert tasks, solver.task_hint
    for task in tasks:
        assert task.constrained_axes <= robot.dof
        solved = solver.solve_batch(targets, task=task).solved
        assert solved >= 0.8 * CASES, f"{task}: {solved} of {CASES}, seed {SEED}"


def test_the_joints_decide_what_is_named() -> None:
    hints = {name: iksel.Solver(robot).task_hint for name, robot in ARMS.items()}
    assert "free_spin" in hints["5 joints, none along the tool"]
    assert "free_spin('z')" not in hints["5 joints, the last along the tool"]
    assert "position_only()" in hints["4 joints"]
    assert "position_only()" in hints["3 joints"]
    assert "planar('z')" in hints["3 joints in a plane"]
    assert "position_only" not in hints["3 joints in a plane"]
    for name, hint in hints.items():
        assert f"the arm has {ARMS[name].dof} joints" in hint
        assert "6 axes" in hint


@pytest.mark.parametrize("name", ["ur3", "panda"])
def test_arms_with_joints_enough_need_no_hint(made, name) -> None:
    assert made.solver(name).task_hint == ""


def test_a_task_that_fits_needs_no_hint(made) -> None:
    options = iksel.SolverOptions(task=iksel.Task.position_only())
    solver = iksel.Solver(made.robot("xarm5"), options, made.solver("xarm5").database)
    assert solver.task_hint == ""


def test_where_it_is_said(made, run) -> None:
    solver = made.solver("xarm5")
    target = nearby(solver.robot, 1)[0]
    assert solver.solve(target).status == iksel.Status.not_converged
    assert solver.task_hint in solver.diagnose(target).message
    words = ["solve", "xarm5", "--pose", *map(str, target.ravel())]
    failed = run(*words)
    assert failed.code == 1
    assert failed.err == f"iksel: hint: {solver.task_hint}\n"
    assert run(*words, "--task", "position_only").err == ""
