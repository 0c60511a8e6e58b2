# SPDX-License-Identifier: BSD-3-Clause
"""What tests share: robots and solvers made once, the number of random cases."""

from __future__ import annotations

import contextlib
import functools
import os
import shlex
import signal
import threading
import time

import hypothesis
import numpy as np
import pytest
from command_line import Output, Run

import iksel
from iksel import cli

CASES = int(os.environ.get("IKSEL_TEST_CASES", "200"))

hypothesis.settings.register_profile(
    "iksel", deadline=None, max_examples=CASES, print_blob=True
)
hypothesis.settings.load_profile("iksel")


def pytest_report_header() -> str:
    """Say how many random cases run and how to change that."""
    return f"iksel: {CASES} random cases per test (IKSEL_TEST_CASES)"


@functools.cache
def _load(name: str) -> iksel.Robot:
    return iksel.load_robot(name)


@functools.cache
def _solve(name: str, preset: str) -> iksel.Solver:
    paper = preset == "paper"
    options = iksel.SolverOptions.paper() if paper else iksel.SolverOptions()
    return iksel.Solver(_load(name), options)


class Made:
    """Built-in robots and their solvers, each made once."""

    def robot(self, name: str) -> iksel.Robot:
        """The built-in robot of that name."""
        return _load(name)

    def solver(self, name: str, preset: str = "default") -> iksel.Solver:
        """A solver of the preset 'default' or 'paper'."""
        return _solve(name, preset)


@pytest.fixture(scope="session")
def made() -> Made:
    """Robots and solvers that the tests share."""
    return Made()


@pytest.fixture(scope="session")
def robot(made) -> iksel.Robot:
    """A UR3; files with another robot have a fixture of their own."""
    return made.robot("ur3")


@pytest.fixture(scope="session")
def solver(robot) -> iksel.Solver:
    """A solver for it with a small database."""
    options = iksel.SolverOptions(database={"samples": 2000})
    return iksel.Solver(robot, options)


@pytest.fixture(scope="session")
def joints(robot) -> np.ndarray:
    """50 of its configurations."""
    return robot.random_configurations(50, seed=7)


@pytest.fixture(scope="session")
def poses(robot, joints) -> np.ndarray:
    """Where they put the tip."""
    return robot.fk(joints)


@pytest.fixture(scope="session")
def cases() -> int:
    """Number of random cases that a test tries."""
    return CASES


@pytest.fixture
def run(capfd: pytest.CaptureFixture[str]) -> Run:
    """Run the command line in this process; one string is split as a shell would."""

    def run_(*arguments: object) -> Output:
        words = [str(word) for word in arguments]
        if len(words) == 1:
            words = shlex.split(words[0])
        capfd.readouterr()
        code = cli.main(words)
        out, err = capfd.readouterr()
        return Output(code, out, err)

    return run_


@contextlib.contextmanager
def _interrupted():
    # A shell's background jobs start with the signal ignored.
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    started = time.monotonic()
    try:
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        with pytest.raises(KeyboardInterrupt):
            yield
    finally:
        signal.signal(signal.SIGINT, handler)
    assert time.monotonic() - started < 30


@pytest.fixture
def interrupted():
    """A context that Ctrl-C ends after a moment, long before its body would end."""
    return _interrupted
