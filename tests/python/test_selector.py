# SPDX-License-Identifier: BSD-3-Clause
"""The paper's loop made by hand of a Selector, against the preset that makes it."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import iksel

SEED = 3


def make_solver(name: str, **changes: object) -> iksel.Solver:
    options = iksel.SolverOptions.paper()
    options.database.scale = "small"
    options.strategy = iksel.Paper(**changes)
    return iksel.Solver(iksel.load_robot(name), options)


@pytest.fixture(scope="module")
def solver() -> iksel.Solver:
    return make_solver("cvr038")


@pytest.fixture
def selector(solver: iksel.Solver) -> iksel.Selector:
    return iksel.Selector(solver.database)


def solve_by_hand(solver: iksel.Solver, selector: iksel.Selector, pose: np.ndarray):
    selector.candidates(pose @ np.linalg.inv(solver.robot.tcp))
    tried: list[int] = []
    while len(tried) < solver.options.max_attempts:
        sample = selector.next(tried)
        tried.append(sample)
        seed = solver.database.q(sample)
        result = solver.solve(pose, seeds=[seed], database_seeds=False)
        if result:
            return result.q
    return None


@pytest.mark.parametrize("name", ["cvr038", "cvrb1213", "ur3_wrs", "irb14050"])
@pytest.mark.parametrize(
    "changes",
    [{}, {"ranking": "nearest", "reselection": "next"}, {"kinematics": "kernel"}],
)
def test_the_loop_by_hand_gives_what_the_preset_gives(name: str, changes) -> None:
    solver = make_solver(name, **changes)
    selector = iksel.Selector(solver.database, solver.options.strategy)
    robot = solver.robot
    for pose in robot.fk(robot.random_configurations(60, SEED)):
        result = solver.solve(pose)
        q = solve_by_hand(solver, selector, pose)
        assert (q is None) is not result.success, f"seed {SEED}"
        np.testing.assert_array_equal(q, result.q)


def test_candidates_are_arrays(solver, selector) -> None:
    robot, database = solver.robot, solver.database
    pose = robot.with_tcp(np.eye(4)).fk(robot.random_configurations(1, SEED)[0])
    indices, distances, adjustments, q = selector.candidates(pose, 50, "nearest")
    np.testing.assert_array_equal(indices, database.nearest(pose, 50))
    assert (np.diff(distances) >= 0).all()
    assert (adjustments >= 0).all()
    np.testing.assert_array_equal(q, [database.q(i) for i in indices])
    again = selector.rank(iksel.Ranking.joint_adjustment)
    order = np.argsort(adjustments, kind="stable")
    np.testing.assert_array_equal(again[2], adjustments[order])
    assert sorted(again[0]) == sorted(indices)
    assert selector.next() == again[0][0]
    assert selector.next(again[0][:1]) in again[0][:20]
    assert selector.next(again[0][:20]) is None
    assert len(selector.candidates(pose)[0]) == selector.scheme.neighbours == 200
    assert len(selector.candidates(pose, 10**9)[0]) == len(database)


def test_a_selector_survives_pickling(solver, selector) -> None:
    pose = np.eye(4)
    expected = selector.candidates(pose, 5)
    again = pickle.loads(pickle.dumps(selector))
    for one, other in zip(again.candidates(pose, 5), expected, strict=True):
        np.testing.assert_array_equal(one, other)
    assert again.scheme == selector.scheme


def test_errors_name_the_culprit(made, solver, selector) -> None:
    wrong = iksel.InvalidArgumentError
    for match, call in (
        ("next: there is no target", lambda: selector.next([])),
        ("rank: there is no target", lambda: selector.rank("nearest")),
        ("count: 0", lambda: selector.candidates(np.eye(4), 0)),
        ("count: expected an int", lambda: selector.candidates(np.eye(4), 1.5)),
        ("ranking: expected one of", lambda: selector.candidates(np.eye(4), 1, "x")),
        ("pose", lambda: selector.candidates(2 * np.eye(4))),
        ("failed: expected a sequence", lambda: selector.next(3)),
        (r"failed\[1\]: expected an int", lambda: selector.next([0, "1"])),
        ("database: expected a Database", lambda: iksel.Selector(solver)),
        ("key_scheme full", lambda: iksel.Selector(made.solver("ur3").database)),
        (
            "limit_aware",
            lambda: iksel.Selector(solver.database, iksel.Paper(limit_aware=True)),
        ),
    ):
        with pytest.raises(wrong, match=match):
            call()
    best = selector.candidates(np.eye(4))[0]
    with pytest.raises(wrong, match=f"failed: sample {best[30]} is none of the 20"):
        selector.next([best[30]])
    with pytest.raises(wrong, match=f"failed: sample {best[0]} comes twice"):
        selector.next([best[0], best[0]])
