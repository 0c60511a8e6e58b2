# SPDX-License-Identifier: BSD-3-Clause
"""Where paths without a start begin, and what is reached in time."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

import iksel

SEED = 61


def random_paths(robot, n, seed):
    """Straight lines in joint space, as poses: each can be followed."""
    rng = np.random.default_rng(seed)
    half = np.minimum((robot.upper - robot.lower) / 2, np.pi)
    middle = (robot.upper + robot.lower) / 2
    for _ in range(n):
        begin = middle + rng.uniform(-half, half)
        end = begin + rng.uniform(-0.5, 0.5, robot.dof)
        yield robot.fk(np.linspace(begin, end, 15))


@pytest.mark.parametrize("name", ["ur5e", "ur3"])
@pytest.mark.parametrize("dt", [0.0, 0.1])
def test_paths_begin_at_the_turns_nearest_the_middle(made, name, dt) -> None:
    solver = made.solver(name)
    robot = solver.robot
    assert robot.upper[0] > np.pi + 1
    wound, solved, wound_by_solve = 0, 0, 0
    for poses in random_paths(robot, 40, SEED):
        path = solver.solve_path(poses, dt=dt)
        if not path.success:
            continue
        solved += 1
        wound += bool(np.abs(path.q[0]).max() > np.pi)
        wound_by_solve += bool(np.abs(solver.solve(poses[0]).q).max() > np.pi)
        np.testing.assert_allclose(robot.fk(path.q), poses, rtol=0, atol=1e-5)
    assert solved >= 36, f"seed {SEED}"
    assert wound <= wound_by_solve, f"seed {SEED}: {wound} of {solved} paths"


def test_the_cost_of_a_path_is_the_least_of_all_turns(made) -> None:
    solver = made.solver("ur5e")
    robot = solver.robot
    shifts = [
        np.array(s) for s in itertools.product([0, 2 * np.pi, -2 * np.pi], repeat=2)
    ]
    for poses in random_paths(robot, 5, SEED + 1):
        path = solver.solve_path(poses)
        tried = 0
        for shift in shifts:
            start = path.q[0].copy()
            start[:2] += shift
            if not robot.within_limits(start):
                continue
            tried += 1
            other = solver.solve_path(poses[1:], start)
            assert not other.success or other.move >= path.move - 1e-6, f"seed {SEED}"
        assert tried >= 2


def test_a_path_that_needs_more_than_half_a_turn_begins_where_it_can(made) -> None:
    """From the middle turn a joint would run into its limit."""
    solver = made.solver("ur5e")
    robot = solver.robot
    q = np.tile([0, -1.2, 1.5, -0.5, 1.2, 0.3], (60, 1))
    q[:, 0] = np.linspace(-5.5, 5.5, 60)
    path = solver.solve_path(robot.fk(q))
    assert path.success
    np.testing.assert_allclose(path.q[:, 0], q[:, 0], atol=1e-5)


def test_limits_without_a_turn_to_spare_change_nothing(made) -> None:
    solver = made.solver("panda")
    for poses in random_paths(solver.robot, 3, SEED + 2):
        path = solver.solve_path(poses)
        assert path.success
        assert all(map(solver.robot.within_limits, path.q))


@pytest.mark.parametrize("name", ["panda", "iiwa14"])
def test_a_known_motion_is_followed_in_time(made, name) -> None:
    # The cheapest way there was too fast in 7 and 2 of these.
    solver = made.solver(name)
    robot = solver.robot
    for k in range(20):
        rng = np.random.default_rng((7, k))
        begin, end = robot.random_configurations(2, int(rng.integers(1 << 30)))
        q = np.linspace(begin, end, 200)
        dt = 1.5 * np.max(np.abs(q[1] - q[0]) / robot.velocity_limit)
        path = solver.solve_path(robot.fk(q), start=begin, dt=dt)
        assert path.success, f"motion {k}"
        steps = np.abs(np.diff(path.q, axis=0, prepend=begin[None]))
        assert (steps <= robot.velocity_limit * dt * (1 + 1e-8)).all(), f"motion {k}"
        # Its length is by the request's own measure.
        lengths = np.linalg.norm(np.diff(path.q, axis=0, prepend=begin[None]), axis=1)
        assert path.move == pytest.approx(lengths.sum()), f"motion {k}"


@pytest.mark.parametrize("build", ["srs", "rail"])
def test_few_candidates_do_not_make_it_too_fast(build) -> None:
    """Made shorter, a path keeps what it passed, however few candidates there are."""
    arms = pytest.importorskip("bench.random_arms")
    for seed in (16, 50, 82, 154):
        robot = arms.random_arm(build, seed).robot
        solver = iksel.Solver(robot)
        begin, end = robot.random_configurations(2, seed=seed)
        rng = np.random.default_rng(seed)
        q = begin + 0.3 * np.linspace(0, 1, 24)[1:, None] * (end - begin)
        q = np.clip(q + 0.01 * rng.normal(size=q.shape), robot.lower, robot.upper)
        poses = robot.fk(q)
        for candidates in (1, 2, 3):
            dt = 1.0
            for share in (0.97, 1.0001) * 3:
                path = solver.solve_path(
                    poses, start=begin, dt=dt, candidates=candidates
                )
                if not path:
                    continue
                speeds = np.abs(np.diff(path.q, axis=0, prepend=begin[None]))
                times = (speeds / robot.velocity_limit).max()
                assert times <= dt * (1 + 1e-9), (seed, candidates)
                dt = share * times


def in_time(solver, poses, begin, dt, **options):
    """Whether there is a path, whose joints are not faster than they can be."""
    path = solver.solve_path(poses, start=begin, dt=dt, **options)
    if not path:
        return False
    np.testing.assert_allclose(solver.robot.fk(path.q), poses, rtol=0, atol=1e-5)
    steps = np.abs(np.diff(path.q, axis=0, prepend=begin[None]))
    assert (steps <= solver.robot.velocity_limit * dt * (1 + 1e-8)).all()
    return True


@pytest.mark.parametrize("name", ["ur5e", "irb120"])
@pytest.mark.parametrize(("stays", "spare"), [(0, 1.05), (5, 1.5)])
def test_a_motion_through_a_singular_wrist_is_followed_in_time(
    made, name, stays, spare
) -> None:
    """At the waypoint where two axes line up, any of a family may be found."""
    solver = made.solver(name)
    robot = solver.robot
    wrist = np.linspace(-0.2, 0.2, 41)
    wrist[20 - stays : 21 + stays] = 0
    failed = 0
    for seed in range(20):
        a, b = robot.random_configurations(2, seed=seed)
        q = a + 0.4 * np.linspace(0, 1, 41)[:, None] * (b - a)
        q[:, 4] = wrist
        dt = spare * np.max(np.abs(np.diff(q, axis=0)) / robot.velocity_limit)
        failed += not in_time(solver, robot.fk(q[1:]), q[0], dt)
    assert failed == 0


@pytest.mark.parametrize("name", ["panda", "xarm7"])
def test_the_first_waypoint_is_reached_in_time(made, name) -> None:
    """Where the nearest answer takes too long, another on the self-motion does not."""
    solver = made.solver(name)
    robot = solver.robot
    failed = 0
    for begin, end in robot.random_configurations(100, seed=SEED).reshape(50, 2, -1):
        q = begin + 0.03 * (end - begin) / np.abs(end - begin).max()
        dt = 1.05 * np.max(np.abs(q - begin) / robot.velocity_limit)
        failed += not in_time(solver, robot.fk(q[None]), begin, dt)
    assert failed == 0, f"seed {SEED}"


def test_a_filter_that_changes_its_mind_makes_no_path_too_fast(made) -> None:
    """What the path passed may be refused while it is made shorter: then it stays."""
    solver = made.solver("panda")
    robot = solver.robot
    begin, end = robot.random_configurations(2, seed=1)
    q = begin + 0.4 * np.linspace(0, 1, 12)[:, None] * (end - begin)
    dt = 1.3 * np.max(np.abs(np.diff(q, axis=0)) / robot.velocity_limit)
    solved = 0
    for kind in range(18, 34):
        rng = np.random.default_rng(kind)
        times = itertools.count()

        def keep(asked, times=times, kind=kind, rng=rng):
            return (next(times) < kind) | (rng.random(len(asked)) < 0.5)

        solved += in_time(solver, robot.fk(q[1:]), begin, dt, filter=keep)
    assert solved > 0


@pytest.mark.parametrize("largest", [1e300, 1e101, 1e-101])
def test_weights_whose_squares_are_no_numbers_are_refused(made, largest) -> None:
    solver = made.solver("panda")
    poses = solver.robot.fk(np.full((3, 7), 0.5) * [1, -1, 1, -3, 1, 3, 1])
    weights = np.r_[largest, np.zeros(6)]
    with pytest.raises(iksel.InvalidArgumentError, match=r"^weights\[0\]"):
        solver.solve_path(poses, weights=weights)
    with pytest.raises(iksel.InvalidArgumentError, match=r"^weights\[0\]"):
        solver.solve(poses[0], near=np.zeros(7), weights=weights)
