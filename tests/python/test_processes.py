# SPDX-License-Identifier: BSD-3-Clause
"""Solvers across fork, spawn, threads and the interpreter's end; re-entrant calls."""

from __future__ import annotations

import subprocess
import sys
import textwrap
import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import iksel

# Each program ends by itself in a second or two; a deadlock is ended by this.
PATIENCE_S = 60

COMMON = """
import os
import sys
import threading
import time
import numpy as np
import iksel

robot = iksel.load_robot("ur3")
solver = iksel.Solver(robot)
q = robot.random_configurations(200, 1)
poses = robot.fk(q)
"""


def run_program(program: str, tmp_path: Path) -> str:
    """Run in a process of its own; what it printed."""
    path = tmp_path / "program.py"
    path.write_text(COMMON + textwrap.dedent(program))
    done = subprocess.run(
        [sys.executable, "-X", "faulthandler", "-W", "ignore", path],
        capture_output=True,
        text=True,
        check=False,
        timeout=PATIENCE_S,
    )
    assert done.returncode == 0, (done.returncode, done.stderr)
    assert done.stderr == ""
    return done.stdout


def test_a_forked_child_solves_as_its_parent(tmp_path: Path) -> None:
    program = """
    def answers():
        plain = solver.solve_batch(poses, threads=2)
        near = solver.solve_batch(poses, near=q[0], threads=2)
        kept = solver.solve_batch(poses, filter=lambda c: c[:, 0] > 0, threads=2)
        return np.concatenate([plain.q, near.q, kept.q]).tobytes()

    expected = answers()
    for _ in range(3):
        child = os.fork()
        if child == 0:
            os._exit(answers() != expected)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    print("equal")
    """
    assert run_program(program, tmp_path) == "equal\n"


def test_a_child_forked_beneath_running_solves_works(tmp_path: Path) -> None:
    program = """
    stop = threading.Event()

    def keep_solving():
        while not stop.is_set():
            solver.solve_batch(poses, threads=2)

    threads = [threading.Thread(target=keep_solving) for _ in range(2)]
    for thread in threads:
        thread.start()
    expected = solver.solve(poses[0]).q
    for _ in range(20):
        child = os.fork()
        if child == 0:
            same = np.array_equal(solver.solve(poses[0]).q, expected)
            database = iksel.Database.build(robot, iksel.DatabaseOptions(threads=2))
            os._exit(not (same and database.size > 0))
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    stop.set()
    for thread in threads:
        thread.join()
    print("all")
    """
    assert run_program(program, tmp_path) == "all\n"


def test_spawned_workers_solve_with_what_was_pickled(tmp_path: Path) -> None:
    program = """
    import multiprocessing

    def work(task):
        solver, robot, pose = task
        return solver.solve(pose).q, robot.fk(q[0])

    if __name__ == "__main__":
        expected = [solver.solve(pose).q for pose in poses[:4]]
        with multiprocessing.get_context("spawn").Pool(2) as pool:
            results = pool.map(work, [(solver, robot, pose) for pose in poses[:4]])
        for (ours, tip), theirs in zip(results, expected):
            assert np.array_equal(ours, theirs)
            assert np.array_equal(tip, poses[0])
        print("equal")
    """
    assert run_program(program, tmp_path) == "equal\n"


@pytest.mark.parametrize(
    "call",
    [
        "solver.solve_batch(many, threads=2)",
        "solver.solve_batch(many, filter=lambda c: c[:, 0] > 0, threads=2)",
        "solver.solve_batch(poses, objective=lambda q: float(q @ q), threads=2)",
        "solver.solve(poses[0], filter=lambda c: np.zeros(len(c), bool))",
        "solver.solve_path(poses[:20], filter=lambda c: c[:, 0] > -9)",
        "iksel.Database.build(robot, progress=lambda done, total: None)",
        "iksel.Database.build(robot, iksel.DatabaseOptions.paper())",
        "iksel.evaluate(solver, 20000, 1)",
        "robot.fk(np.zeros((100_000, 6)))",
    ],
)
def test_the_interpreter_ends_beneath_daemon_threads(call: str, tmp_path: Path) -> None:
    program = f"""
    many = np.tile(poses, (500, 1, 1))
    entered = threading.Semaphore(0)

    def keep_calling():
        while True:
            entered.release()
            {call}

    for _ in range(2):
        threading.Thread(target=keep_calling, daemon=True).start()
    for _ in range(2):
        entered.acquire()
    time.sleep(0.05)
    print("end", flush=True)
    """
    assert run_program(program, tmp_path) == "end\n"


def test_callables_may_solve_themselves(tmp_path: Path) -> None:
    program = """
    class Nested:
        depth = 0  # of all threads together

    nested = Nested()

    def keep(candidates):
        if nested.depth < 1:
            nested.depth += 1
            assert solver.solve(poses[0]).success
            assert solver.solve(poses[1], near=q[0]).success
            solver.solve(poses[2], filter=keep)
            solver.solve_all(poses[3], filter=keep)
            solver.solve_batch(poses[:5], filter=keep, threads=2)
            solver.solve_path(poses[:2], filter=keep)
            nested.depth -= 1
        return candidates[:, 0] > 0

    def plain(candidates):
        return candidates[:, 0] > 0

    def cost(at):
        if nested.depth < 1:
            nested.depth += 1
            solver.solve_batch(poses[:3], objective=cost, threads=2)
            nested.depth -= 1
        return float(at @ at)

    def plain_cost(at):
        return float(at @ at)

    for threads in (1, 2, 4):
        a = solver.solve_batch(poses[:10], filter=keep, threads=threads)
        b = solver.solve_batch(poses[:10], filter=plain, threads=threads)
        assert np.array_equal(a.q, b.q, equal_nan=True)
        a = solver.solve_batch(poses[:4], objective=cost, threads=threads)
        b = solver.solve_batch(poses[:4], objective=plain_cost, threads=threads)
        assert np.array_equal(a.q, b.q, equal_nan=True)

    def tell(done, total):
        assert solver.solve(poses[0]).success
        solver.solve_batch(poses[:20], threads=2)

    iksel.Database.build(robot, progress=tell)
    print("done")
    """
    assert run_program(program, tmp_path) == "done\n"


def test_threads_with_filters_of_their_own_do_not_wait_for_each_other(
    tmp_path: Path,
) -> None:
    program = """
    def solve(results, i):
        def keep(candidates):
            time.sleep(1e-4)
            return candidates[:, i] > 0

        batch = solver.solve_batch(poses, filter=keep, threads=3)
        results[i] = batch.q[batch.success][:, i]

    results = {}
    threads = [threading.Thread(target=solve, args=(results, i)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for i in range(4):
        assert len(results[i]) > 0
        assert (results[i] > 0).all()
    print("done")
    """
    assert run_program(program, tmp_path) == "done\n"


class StopError(Exception):
    pass


@pytest.mark.parametrize("kind", [StopError, KeyboardInterrupt, SystemExit])
@pytest.mark.parametrize("after", [0, 3])
def test_what_callables_raise_comes_through_and_leaves_the_solver_whole(
    made, kind: type[BaseException], after: int
) -> None:
    robot = made.robot("ur3")
    solver = made.solver("ur3")
    q = robot.random_configurations(40, 1)
    poses = robot.fk(q)
    before = solver.solve_batch(poses).q
    calls = 0

    def repeat(call: Callable[[], object]) -> None:
        # Not every solve asks often enough.
        for _ in range(after + 1):
            call()

    def fail(*_: object) -> None:
        nonlocal calls
        calls += 1
        if calls > after:
            raise kind("stop")

    def keep(candidates: np.ndarray) -> np.ndarray:
        fail()
        return np.zeros(len(candidates), bool)

    def cost(at: np.ndarray) -> float:
        fail()
        return float(at @ at)

    for call in (
        lambda: solver.solve(poses[0], filter=keep),
        lambda: solver.solve_all(poses[0], filter=keep),
        lambda: solver.solve_batch(poses, filter=keep, threads=1),
        lambda: solver.solve_batch(poses, filter=keep, threads=4),
        lambda: solver.solve_path(poses[:5], filter=keep),
        lambda: solver.solve(poses[0], objective=cost),
        lambda: solver.solve_batch(poses, objective=cost, threads=4),
        lambda: iksel.Database.build(robot, progress=fail),
    ):
        calls = 0
        with pytest.raises(kind, match="stop"):
            repeat(call)
        np.testing.assert_array_equal(solver.solve_batch(poses).q, before)


def test_many_threads_share_a_solver(made) -> None:
    robot = made.robot("ur3")
    solver = made.solver("ur3")
    poses = robot.fk(robot.random_configurations(50, 2))
    expected = np.stack([solver.solve(pose).q for pose in poses])
    wrong = []

    def solve() -> None:
        rows = np.stack([solver.solve(pose).q for pose in poses])
        if not np.array_equal(rows, expected):
            wrong.append(rows)

    threads = [threading.Thread(target=solve) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong
