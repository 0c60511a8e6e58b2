# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C ends long work within 0.2 s."""

from __future__ import annotations

import signal
import sys
import threading
import time

import numpy as np
import pytest
from trees import two_armed

import iksel

pytestmark = [
    pytest.mark.skipif(sys.platform == "win32", reason="no timers that signal"),
    pytest.mark.skipif(
        threading.current_thread() is not threading.main_thread(),
        reason="signals reach the main thread only",
    ),
]

ROWS = 3_000_000


def time_to_interrupt(work) -> float:
    """How long work goes on after Ctrl-C [s]."""
    rung = []

    def ring(number: int, frame: object) -> None:
        rung.append(time.monotonic())
        raise KeyboardInterrupt

    sent = time.monotonic() + 0.05
    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, 0.05)
    try:
        with pytest.raises(KeyboardInterrupt):
            work()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert rung
    return time.monotonic() - sent


@pytest.fixture(scope="module")
def rows(made) -> np.ndarray:
    return np.tile(
        made.robot("panda").random_configurations(1000, 1), (ROWS // 1000, 1)
    )


@pytest.mark.parametrize("name", ["fk", "jacobian", "inverse_jacobian"])
@pytest.mark.parametrize("kinematics", ["kernel", "kdl"])
def test_kinematics_of_many_rows(made, rows, name: str, kinematics: str) -> None:
    robot = made.robot("panda")
    function = getattr(robot, name)
    how = {} if name == "inverse_jacobian" else {"kinematics": kinematics}
    function(rows[:1000], **how)
    # A machine that other work keeps busy is given a second chance.
    assert min(time_to_interrupt(lambda: function(rows, **how)) for _ in range(2)) < 0.2


@pytest.mark.parametrize("preset", ["default", "paper"])
@pytest.mark.parametrize("stages", [False, True])
def test_evaluation(made, preset: str, *, stages: bool) -> None:
    solver = made.solver("ur3", preset)
    work = lambda: iksel.evaluate(solver, 200_000, 1, stages=stages)  # noqa: E731
    assert min(time_to_interrupt(work) for _ in range(2)) < 0.2


@pytest.mark.parametrize("preset", ["default", "paper"])
def test_evaluation_of_very_many_targets(made, preset: str) -> None:
    solver = made.solver("ur3", preset)
    work = lambda: iksel.evaluate(solver, 20_000_000, 1)  # noqa: E731
    assert min(time_to_interrupt(work) for _ in range(2)) < 0.2


def test_random_configurations(made) -> None:
    arm = made.robot("ur3")
    for robot in (arm, two_armed(arm)):
        work = lambda robot=robot: robot.random_configurations(20_000_000, 1)  # noqa: E731
        assert min(time_to_interrupt(work) for _ in range(2)) < 0.2


def test_progress_of_an_evaluation_is_told_now_and_then(made) -> None:
    told: list[float] = []

    def progress(done: int, total: int) -> None:
        told.append(time.monotonic())

    iksel.evaluate(made.solver("ur3", "paper"), 400, 1, progress=progress)
    assert 2 <= len(told) < 400
