# SPDX-License-Identifier: BSD-3-Clause
"""What holds functions of Python goes when nobody needs it, or with Python."""

from __future__ import annotations

import copy
import gc
import pickle
import subprocess
import sys
import textwrap
import weakref
from pathlib import Path

import numpy as np
import pytest

import iksel

# A program that ends does so in a second or two.
PATIENCE_S = 60


def run_program(program: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-W", "ignore", "-c", textwrap.dedent(program)],
        capture_output=True,
        text=True,
        check=False,
        timeout=PATIENCE_S,
    )


class Loop:
    """A control loop whose tracker, or objective, asks it for the cost."""

    def __init__(self, solver: iksel.Solver, how: str) -> None:
        start = np.zeros(solver.robot.dof)
        if how == "tracker":
            self.held = solver.tracker(start, objective=self.cost)
        elif how == "objective":
            self.held = iksel.Objective.custom(self.cost, self.gradient)
        elif how == "both":
            self.objective = iksel.Objective.custom(self.cost, self.gradient)
            self.held = solver.tracker(start, objective=self.objective)
        else:
            self.first = solver.tracker(start, objective=self.cost)
            self.held = copy.copy(self.first)

    def cost(self, q: np.ndarray) -> float:
        return float(q @ q)

    def gradient(self, q: np.ndarray) -> np.ndarray:
        return 2 * q


@pytest.mark.parametrize("how", ["tracker", "objective", "both", "copy"])
def test_cycles_through_callables_are_collected(made, how: str) -> None:
    loop = Loop(made.solver("panda"), how)
    held, seen = weakref.ref(loop.held), weakref.ref(loop)
    gc.collect()
    assert seen() is loop
    del loop
    gc.collect()
    assert seen() is None
    assert held() is None


def test_what_is_held_elsewhere_is_not_collected(made) -> None:
    solver = made.solver("panda")
    robot = solver.robot
    target = robot.fk(robot.random_configurations(1, 4)[0])
    loop = Loop(solver, "both")
    kept = loop.held, copy.copy(loop.held), copy.deepcopy(loop.objective)
    del loop
    calls = 0

    def cost(q: np.ndarray) -> float:
        nonlocal calls
        calls += 1
        if calls % 300 == 1:
            gc.collect()
        return float(q @ q)

    plain = solver.solve(target, objective=lambda q: float(q @ q))
    mine = iksel.Objective.custom(cost)
    for objective in (cost, mine):
        result = solver.solve(target, objective=objective)
        np.testing.assert_array_equal(result.q, plain.q)
    assert calls > 300
    for tracker in kept[:2]:
        tracker.track(target, dt=0.01)
    np.testing.assert_array_equal(kept[0].q, kept[1].q)
    result = solver.solve(target, objective=kept[2])
    assert result.success


def test_an_objective_is_still_pickled_with_its_functions() -> None:
    objective = iksel.Objective.custom(np.linalg.norm)
    again = pickle.loads(pickle.dumps(objective))
    assert again.__getstate__()["cost"] is np.linalg.norm
    assert again.__getstate__()["gradient"] is None


HOLDS = {
    "objective": "held = iksel.Objective.custom(np.linalg.norm)",
    "tracker": "held = solver.tracker(q, objective=np.linalg.norm)",
    "cycle": "held = solver.tracker(q, objective=lambda q: float(q @ q))",
    "default": "import builtins; builtins.held = solver.tracker(q, objective=len)",
}


@pytest.mark.parametrize("hold", HOLDS)
def test_a_program_ends_that_holds_functions(hold: str, tmp_path: Path) -> None:
    file = tmp_path / "written.txt"
    program = f"""
    import iksel
    import numpy as np

    robot = iksel.load_robot("ur3")
    solver, q = iksel.Solver(robot), np.zeros(6)
    file = open({str(file)!r}, "w")
    file.write("all")  # is in the file when Python closes it
    {HOLDS[hold]}
    """
    done = run_program(program)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert file.read_text() == "all"


@pytest.mark.parametrize(
    "call",
    [
        "solver.solve(pose).success",
        "solver.solve(pose, filter=keep).success",
        "solver.solve(pose, objective=cost).success",
        "solver.solve_batch(pose[None], threads=1).solved",
        "solver.solve_all(pose, filter=keep).success",
        "solver.tracker(q, objective=cost).track(pose, dt=10.0).success",
        "len(iksel.Database.build(robot, options)) > 0",
        "iksel.evaluate(solver, 10, 1).false_success == 0",
    ],
)
def test_what_dies_with_python_may_still_solve(call: str) -> None:
    program = f"""
    import iksel
    import numpy as np

    class Last:
        def __del__(self, iksel=iksel, np=np):
            robot, solver, pose, q = self.of
            keep = lambda candidates: candidates[:, 0] > -9
            cost = lambda q: float(q @ q)
            options = iksel.DatabaseOptions(samples=50, threads=1)
            print(bool({call}))

    robot = iksel.load_robot("panda")
    q = robot.random_configurations(1, 1)[0]
    last = Last()
    last.of = robot, iksel.Solver(robot), robot.fk(q), q
    """
    done = run_program(program)
    assert (done.returncode, done.stdout, done.stderr) == (0, "True\n", "")


def test_a_subinterpreter_is_told_to_keep_out() -> None:
    interpreters = (
        "_interpreters" if sys.version_info >= (3, 13) else "_xxsubinterpreters"
    )
    program = f"""
    import {interpreters} as interpreters

    def import_it():
        one = interpreters.create()
        try:
            error = interpreters.run_string(one, "import iksel")
            print(error.msg if error else "no error")
        except interpreters.RunFailedError as error:
            print(error)

    import_it()
    import iksel

    import_it()
    print(iksel.load_robot("ur3").dof)
    """
    done = run_program(program)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert len(lines) == 3
    for line in lines[:2]:
        assert "subinterpreter" in line
        assert "Install the package" not in line
    assert lines[2] == "6"
