# SPDX-License-Identifier: BSD-3-Clause
"""Solves with wishes, as Python offers them, and against EAIK where it is installed."""

from __future__ import annotations

import math
import pickle
from typing import TYPE_CHECKING

import numpy as np
import pytest

import iksel

if TYPE_CHECKING:
    from collections.abc import Callable

SEED = 5


def noisy_targets(robot: iksel.Robot, n: int, scale: float):
    rng = np.random.default_rng(SEED)
    q = robot.random_configurations(n, seed=SEED)
    return q, q + rng.normal(0, scale, q.shape), robot.fk(q)


@pytest.mark.parametrize("norm", ["two", iksel.MoveNorm.max])
def test_near_moves_no_more_than_any_branch(made, cases, norm) -> None:
    solver = made.solver("ur3")
    _, near, targets = noisy_targets(solver.robot, cases, 0.3)
    for here, target in zip(near, targets, strict=True):
        result = solver.solve(target, near=here, norm=norm)
        branches = solver.solve_all(target, near=here, norm=norm)
        assert result.success
        assert result.move <= branches.move.min() + 1e-3
        difference = np.abs(result.q - here)
        length = difference.max() if norm != "two" else np.linalg.norm(difference)
        assert result.move == pytest.approx(length)


def test_weights_count(made) -> None:
    solver = made.solver("panda")
    _, near, targets = noisy_targets(solver.robot, 20, 0.2)
    heavy = np.array([100.0, 1, 1, 1, 1, 1, 1])
    for here, target in zip(near, targets, strict=True):
        plain = solver.solve(target, near=here).q
        weighted = solver.solve(target, near=here, weights=heavy).q
        assert abs(weighted[0] - here[0]) <= abs(plain[0] - here[0]) + 1e-6


def test_solutions_are_a_sequence_of_results(made) -> None:
    solver = made.solver("ur3")
    target = solver.robot.fk(np.full(6, 0.7))
    found = solver.solve_all(target)
    assert found.success
    assert found.status is iksel.Status.solved
    assert len(found) == len(found.q) == len(list(found))
    assert found.q.shape == (len(found), 6)
    np.testing.assert_array_equal(found[-1].q, found.q[-1])
    for one in found:
        assert iksel.pose_error(solver.robot.fk(one.q), target)[0] <= 1e-6
    with pytest.raises(IndexError, match="solution 99"):
        found[99]
    none = solver.solve_all(iksel.pose_from_euler([9, 9, 9], [0, 0, 0]))
    assert (len(none), none.status.name) == (0, "out_of_reach")


def test_filter_gets_many_and_decides(made, cases) -> None:
    solver = made.solver("ur3")
    shapes = []

    def low_shoulder(q):
        shapes.append(q.shape)
        return q[:, 1] <= 0

    q = solver.robot.random_configurations(cases, seed=SEED)
    for target in solver.robot.fk(q):
        passing = solver.solve_all(target, 100_000, whole_turns=True).q[:, 1] <= 0
        result = solver.solve(target, filter=low_shoulder)
        assert result.success or not passing.any()
        assert not result.success or result.q[1] <= 0
        kept = solver.solve_all(target, filter=low_shoulder)
        assert (kept.q[:, 1] <= 0).all()
    assert max(n for n, _ in shapes) > 1
    assert {dof for _, dof in shapes} == {6}


def test_filter_is_asked_about_both_of_what_almost_meets(made) -> None:
    """Beside a fold, where two solutions differ by a thousandth of a radian."""
    solver = made.solver("ur3")
    elbow = 2
    random = np.random.default_rng(SEED)
    for q in 0.3 * solver.robot.random_configurations(60, seed=SEED):
        q[elbow] = random.choice([-1, 1]) * 10 ** random.uniform(-3.6, -3)
        side = lambda given, q=q: given[:, elbow] * q[elbow] > 0  # noqa: E731
        assert solver.solve(solver.robot.fk(q), filter=side), f"{q!r}"


def test_a_filter_may_give_a_list_and_is_never_asked_about_none(made, cases) -> None:
    solver = made.solver("irb120")
    counts = []

    def far_away(q):
        counts.append(len(q))
        return [bool(abs(each[0]) > 0.5) for each in q]

    q = solver.robot.random_configurations(2 * cases, seed=SEED)
    for near, target in zip(q[::2], solver.robot.fk(q[1::2]), strict=True):
        solver.solve(target, near=near, filter=far_away)
    assert min(counts) > 0


def test_filter_that_refuses_all(made) -> None:
    solver = made.solver("ur3")
    target = solver.robot.fk(np.full(6, 0.7))
    result = solver.solve(target, filter=lambda q: np.zeros(len(q), dtype=bool))
    assert result.status is iksel.Status.rejected
    assert result.q is None


def test_bad_filters_are_named(made) -> None:
    solver = made.solver("ur3")
    target = solver.robot.fk(np.full(6, 0.7))
    for answer, got in [
        (0.5, r"shape \(\) of dtype float64"),
        ([True] * 99, r"shape \(99,\) of dtype bool"),
        ([[True]], r"shape \(1, 1\)"),
        ([1, 0], "dtype int64"),
        ("no", "dtype <U2"),
        (None, "dtype object"),
    ]:
        with pytest.raises(
            iksel.InvalidArgumentError, match=f"filter: expected to get back .*{got}"
        ):
            solver.solve(target, filter=lambda q, answer=answer: answer)
    with pytest.raises(TypeError, match="filter"):
        solver.solve(target, filter=3)

    def broken(q):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        solver.solve(target, filter=broken)


def test_seeds_alone(made) -> None:
    solver = made.solver("iiwa14")
    q = solver.robot.random_configurations(10, seed=SEED)
    for i, target in enumerate(solver.robot.fk(q)):
        alone = solver.solve(target, seeds=q[i : i + 1], database_seeds=False)
        assert alone.attempts == 1
        one_of_all = solver.solve(target, seeds=q, database_seeds=False)
        assert one_of_all.attempts <= len(q)
        # A seed that is a solution already is the best of them.
        for result in (alone, one_of_all):
            np.testing.assert_allclose(result.q, q[i], rtol=0, atol=1e-9)
    # From far away an attempt may fail; no other follows it.
    for given in (solver, made.solver("iiwa14", "paper")):
        results = [
            given.solve(target, seeds=q[-1], database_seeds=False)
            for target in solver.robot.fk(q[:-1])
        ]
        assert {result.attempts for result in results} == {1}
        assert not all(result.success for result in results)
    nothing = solver.solve(target, seeds=np.zeros((0, 7)), database_seeds=False)
    assert (nothing.status.name, nothing.attempts) == ("not_converged", 0)


def test_deadline(made) -> None:
    solver = made.solver("ur3")
    target = solver.robot.fk(np.full(6, 0.7))
    assert solver.solve(target, deadline=1e-9).status is iksel.Status.out_of_time
    assert solver.solve(target, deadline=10).success


@pytest.mark.parametrize(
    ("wish", "named"),
    [
        ({"near": np.zeros(5)}, r"near: expected a \(6,\) array, got shape \(5,\)"),
        ({"near": np.full(6, np.nan)}, "near: expected finite numbers.* joint 0"),
        ({"near": "here"}, "near: expected (an array of )?real numbers"),
        ({"weights": np.full(6, -1.0)}, r"weights\[0\]: -1.*negative"),
        ({"weights": np.full(6, np.nan)}, "weights: expected finite numbers"),
        ({"weights": np.zeros(6)}, "weights: all are 0"),
        ({"norm": "one"}, "norm: expected one of two, max"),
        ({"seeds": np.zeros(5)}, r"seeds: expected a \(6,\) or \(N, 6\) array"),
        ({"seeds": np.full((2, 6), np.inf)}, r"seeds\[0\]: expected finite"),
        ({"database_seeds": 1}, "database_seeds: expected True or False"),
        ({"deadline": 0}, "deadline: 0.* s is not above 0"),
        ({"deadline": -1}, "deadline: -1.* s is not above 0"),
        ({"deadline": math.nan}, "deadline"),
        ({"deadline": "soon"}, "deadline: expected a number, got 'soon'"),
    ],
)
def test_bad_wishes_are_named(made, wish, named) -> None:
    solver = made.solver("ur3")
    for call in (solver.solve, solver.solve_all):
        with pytest.raises(iksel.InvalidArgumentError, match=named):
            call(np.eye(4), **wish)
    if "near" not in wish:
        with pytest.raises(iksel.InvalidArgumentError, match=named):
            solver.solve_batch(np.eye(4)[None], **wish)


@pytest.mark.parametrize(
    ("wish", "named"),
    [
        ({"order": "best"}, "order: expected one of move, limit_distance, manip"),
        ({"max": 0}, "max: 0 is less than 1"),
        ({"max": 1.5}, "max: expected an int"),
        ({"min_distance": 0}, "min_distance"),
        ({"min_distance": math.nan}, "min_distance"),
        ({"whole_turns": "no"}, "whole_turns: expected True or False"),
    ],
)
def test_bad_options_of_solve_all_are_named(made, wish, named) -> None:
    with pytest.raises(iksel.InvalidArgumentError, match=named):
        made.solver("ur3").solve_all(np.eye(4), **wish)


@pytest.mark.parametrize("name", ["ur3", "panda"])
@pytest.mark.parametrize("threads", [1, 2, 8])
def test_batch_near_is_the_loop(made, cases, name, threads) -> None:
    solver = made.solver(name)
    _, near, targets = noisy_targets(solver.robot, min(cases, 60), 0.3)
    rows = solver.solve_batch(targets, threads, near=near, norm="max")
    for row, here, target in zip(rows, near, targets, strict=True):
        one = solver.solve(target, near=here, norm="max")
        np.testing.assert_array_equal(row.q, one.q)
        assert row.move == one.move
    same = solver.solve_batch(targets, threads, near=near[0])
    one = solver.solve(targets[-1], near=near[0])
    np.testing.assert_array_equal(same.q[-1], one.q)
    assert rows.move.shape == (len(targets),)
    again = pickle.loads(pickle.dumps(rows))
    np.testing.assert_array_equal(again.move, rows.move)
    assert np.isnan(solver.solve_batch(targets).move).all()


def test_batch_asks_a_filter_about_many(made, cases) -> None:
    solver = made.solver("ur3")
    _, _, targets = noisy_targets(solver.robot, cases, 0)
    asked = []

    def low_shoulder(q):
        asked.append(len(q))
        return q[:, 1] <= 0

    rows = solver.solve_batch(targets, 2, filter=low_shoulder)
    assert asked[0] == min(cases, 256)
    assert (rows.q[rows.success, 1] <= 0).all()
    assert rows.solved > cases // 2
    for row, target in zip(rows, targets, strict=True):
        assert row.status is solver.solve(target, filter=low_shoulder).status


def test_bad_wishes_of_a_batch_are_named(made) -> None:
    solver = made.solver("ur3")
    targets = solver.robot.fk(np.full((3, 6), 0.5))
    for near in (np.zeros((2, 6)), np.zeros((3, 5)), np.zeros(5)):
        with pytest.raises(iksel.InvalidArgumentError, match=r"near: .*\(6,\)"):
            solver.solve_batch(targets, near=near)
    near = np.zeros((3, 6))
    near[1, 4] = np.nan
    with pytest.raises(iksel.InvalidArgumentError, match=r"near\[1\]"):
        solver.solve_batch(targets, near=near)
    with pytest.raises(
        iksel.InvalidArgumentError, match="filter: expected to get back"
    ):
        solver.solve_batch(targets, filter=lambda q: True)

    def broken(q):
        raise ZeroDivisionError

    for threads in (1, 4):
        with pytest.raises(ZeroDivisionError):
            solver.solve_batch(np.repeat(targets, 300, 0), threads, filter=broken)


def test_path_and_tracker(made) -> None:
    solver = made.solver("panda")
    robot = solver.robot
    start = np.array([0.0, -0.4, 0.0, -2.2, 0.0, 1.8, 0.8])
    line = np.repeat(robot.fk(start)[None], 50, axis=0)
    line[:, 1, 3] += 0.002 * np.arange(1, 51)
    path = solver.solve_path(line, start, dt=0.02)
    assert path.success
    assert path.first_unreachable is None
    steps = np.abs(np.diff(path.q, axis=0, prepend=start[None]))
    assert (steps <= robot.velocity_limit * 0.02 * (1 + 1e-8)).all()
    assert path.largest_step == steps.max()
    farthest = steps[path.largest_step_waypoint, path.largest_step_joint]
    assert farthest == path.largest_step
    tracker = solver.tracker(start)
    for pose in line:
        assert tracker.track(pose, 0.02).success
    np.testing.assert_allclose(robot.fk(tracker.q), line[-1], atol=1e-5)

    with pytest.raises(iksel.InvalidArgumentError, match="pose"):
        tracker.track(np.eye(3), 0.02)
    for dt in (0, -0.1, math.nan):
        with pytest.raises(iksel.InvalidArgumentError, match="dt: .*not above 0"):
            tracker.track(line[0], dt)
    for bad in (np.zeros(6), np.full(7, np.nan)):
        with pytest.raises(iksel.InvalidArgumentError, match="start: expected"):
            solver.tracker(bad)

    line[30:, 0, 3] += 5
    broken = solver.solve_path(line, start, dt=0.02)
    assert (broken.first_unreachable, len(broken.q)) == (30, 30)
    assert broken.status is iksel.Status.out_of_reach


def test_interrupt_ends_a_long_path(made, interrupted) -> None:
    solver = made.solver("panda")
    q = solver.robot.random_configurations(1, seed=SEED)[0]
    endless = np.repeat(solver.robot.fk(q)[None], 1_000_000, axis=0)
    with interrupted():
        solver.solve_path(endless, q)


@pytest.mark.parametrize(
    ("wish", "named"),
    [
        ({"poses": np.zeros((0, 4, 4))}, "poses: there are none"),
        ({"poses": np.eye(4)}, r"poses: expected an \(N, 4, 4\) array"),
        ({"poses": np.ones((2, 4, 4))}, r"poses\[0\]"),
        ({"start": np.zeros(5)}, r"start: expected a \(6,\) array"),
        ({"start": np.full(6, np.nan)}, "start: expected finite numbers"),
        ({"dt": -1}, "dt: -1"),
        ({"dt": math.nan}, "dt: nan"),
        ({"dt": "fast"}, "dt: expected a number"),
        ({"weights": np.full(6, np.nan)}, "weights: expected finite numbers"),
        ({"norm": "one"}, "norm: expected one of two, max"),
        ({"candidates": 0}, "candidates: 0"),
        ({"filter": lambda q: q}, "filter: expected to get back"),
    ],
)
def test_bad_paths_are_named(made, wish, named) -> None:
    solver = made.solver("ur3")
    poses = solver.robot.fk(np.full((2, 6), 0.5))
    with pytest.raises(iksel.InvalidArgumentError, match=named):
        solver.solve_path(**{"poses": poses, **wish})


@pytest.mark.parametrize("name", ["ur3", "ur10e"])
def test_branches_are_those_of_eaik(made, cases, tmp_path, name) -> None:
    urdf = pytest.importorskip("eaik.IK_URDF")
    solver = made.solver(name)
    robot = solver.robot
    path = tmp_path / "arm.urdf"
    path.write_text(robot.urdf, encoding="utf-8")
    analytic = urdf.UrdfRobot(str(path))
    differ = 0
    for q in robot.random_configurations(cases, seed=SEED):
        answer = analytic.IK(analytic.fwdKin(q))
        exact = [
            np.asarray(b)
            for b, approximate in zip(answer.Q, answer.is_LS, strict=True)
            if not approximate
        ]
        found = solver.solve_all(robot.fk(q)).q
        differ += not same_branches(found, exact, robot)
    assert differ <= max(1, cases // 200)


def same_branches(found, exact, robot) -> bool:
    """Whether each has the other's, where whole turns and limits do not count."""

    def near(a, b):
        difference = np.abs((a - b + np.pi) % (2 * np.pi) - np.pi)
        return difference.max() < 0.03

    inside = []
    for q in exact:
        for turns in (-2 * np.pi, 0, 2 * np.pi):
            copy = np.where(q + turns > robot.upper, q, q + turns)
            if (copy >= robot.lower).all() and (copy <= robot.upper).all():
                inside.append(q)
                break
    return all(any(near(a, b) for b in found) for a in inside) and all(
        any(near(a, b) for b in exact) for a in found
    )


def keeps_joint_beside(
    q: np.ndarray, joint: int, width: float
) -> Callable[[np.ndarray], np.ndarray]:
    """A filter that lets a joint be so far from where it is in q [rad]."""

    def is_beside(rows: np.ndarray) -> np.ndarray:
        return np.abs(rows[:, joint] - q[joint]) < width

    return is_beside


@pytest.mark.parametrize("name", ["panda", "iiwa14"])
def test_a_filter_sees_more_of_a_self_motion_than_few(made, name: str) -> None:
    """However few of what it lets through are asked for."""
    solver = made.solver(name)
    for known in solver.robot.random_configurations(60, seed=11):
        keep = keeps_joint_beside(known, joint=2, width=0.3)
        pose = solver.robot.fk(known)
        few = solver.solve_all(pose, max=2, filter=keep)
        assert 0 < len(few) <= 2
        assert keep(few.q).all()


@pytest.mark.parametrize("name", ["panda", "iiwa14"])
def test_the_nearest_that_a_filter_lets_through(made, name: str) -> None:
    """Along the self-motion, where the nearest of all is refused."""
    solver = made.solver(name)
    rng = np.random.default_rng(5)
    longer = 0
    for known in solver.robot.random_configurations(100, seed=12):
        near = known + rng.uniform(-0.5, 0.5, 7)
        joint = int(rng.integers(7))
        keep = keeps_joint_beside(known, joint, width=0.2)
        result = solver.solve(solver.robot.fk(known), near=near, filter=keep)
        assert result
        assert keep(result.q[None]).all()
        longer += result.move > np.linalg.norm(known - near) + 0.05
    assert longer <= 1
