# SPDX-License-Identifier: BSD-3-Clause
"""Laws of solving: what says success is one, and the same input gives the same bits."""

from __future__ import annotations

import math
import re
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import iksel

NAMES = iksel.robot_names()
# One of each kind: the paper's, whole turns, continuous joints, 5, 7 and 10 joints.
SOME = ["cvr038", "ur3_wrs", "irb14050", "gen3_6dof", "xarm5", "pr2_right_arm"]
SCHEMES = [kind.name for kind in iksel.Iteration]
RESULT_FIELDS = (
    "q",
    "success",
    "status",
    "position_error",
    "rotation_error",
    "attempts",
    "iterations",
)

seeds = pytest.mark.parametrize("seed", [1, 2])


def targets(robot: iksel.Robot, n: int, seed: int) -> np.ndarray:
    return robot.fk(robot.random_configurations(n, seed))


def check_answers(
    solver: iksel.Solver, poses: np.ndarray, batch: iksel.BatchResult
) -> float:
    """Check all that a batch says by KDL; the part that is solved."""
    robot, options = solver.robot, solver.options
    solved = np.asarray(batch.success)
    np.testing.assert_array_equal(np.isnan(batch.q).all(axis=1), ~solved)
    np.testing.assert_array_equal(np.isnan(batch.q).any(axis=1), ~solved)
    np.testing.assert_array_equal(np.isnan(batch.position_error), ~solved)
    np.testing.assert_array_equal(np.isnan(batch.rotation_error), ~solved)
    np.testing.assert_array_equal(solved, batch.status == iksel.Status.solved.value)
    q = batch.q[solved]
    assert (q >= robot.lower).all()
    assert (q <= robot.upper).all()
    reached = robot.fk(q, kinematics="kdl")
    position, rotation = iksel.pose_error(poses[solved], reached)
    assert (position <= options.position_tolerance + 1e-12).all()
    assert (rotation <= options.rotation_tolerance + 1e-12).all()
    np.testing.assert_allclose(
        batch.position_error[solved], position, rtol=0, atol=1e-12
    )
    np.testing.assert_allclose(
        batch.rotation_error[solved], rotation, rtol=0, atol=1e-12
    )
    assert (batch.attempts <= options.max_attempts).all()
    assert (batch.iterations <= batch.attempts * options.max_iterations).all()
    return float(solved.mean())


def assert_same_batch(a: iksel.BatchResult, b: iksel.BatchResult) -> None:
    for field in RESULT_FIELDS:
        np.testing.assert_array_equal(getattr(a, field), getattr(b, field), field)


def assert_same_result(a: iksel.Result, b: iksel.Result) -> None:
    for field in RESULT_FIELDS:
        np.testing.assert_array_equal(getattr(a, field), getattr(b, field), field)


@seeds
@pytest.mark.parametrize("name", NAMES)
def test_default_preset_solves_reachable_targets(
    made, cases: int, name: str, seed: int
) -> None:
    solver = made.solver(name)
    poses = targets(solver.robot, cases, seed)
    assert check_answers(solver, poses, solver.solve_batch(poses)) >= 0.995


@seeds
@pytest.mark.parametrize("name", ["cvr038", "cvrb1213", "ur3_wrs", "ur5", "vs060"])
def test_paper_preset_answers_are_answers(
    made, cases: int, name: str, seed: int
) -> None:
    solver = made.solver(name, "paper")
    poses = targets(solver.robot, cases, seed)
    assert check_answers(solver, poses, solver.solve_batch(poses)) >= 0.6


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("name", ["cvr038", "gen3_6dof", "xarm5"])
def test_every_scheme_gives_answers(made, cases: int, name: str, scheme: str) -> None:
    options = iksel.SolverOptions.paper().replace(
        strategy=iksel.Paper(iteration=scheme)
    )
    full = iksel.DatabaseOptions.paper().replace(
        sampling="low_discrepancy", samples=10_000
    )
    solver = iksel.Solver(made.robot(name), options.replace(database=full))
    poses = targets(solver.robot, cases, 3)
    assert check_answers(solver, poses, solver.solve_batch(poses)) > 0.3


@pytest.mark.parametrize(
    ("base", "change", "reader"),
    [
        ({"iteration": "cwln"}, {"damping": 0.1}, "'dls' and 'lm'"),
        ({"iteration": "cwln"}, {"min_step": 0.1}, "'pinv_rr'"),
        ({"iteration": "cwln"}, {"pinv_cutoff": 0.1}, "'cwpi'"),
        ({"iteration": "lm"}, {"position_clamp": 0.2}, "all iterations but 'lm'"),
        ({"iteration": "lm"}, {"rotation_clamp": 0.2}, "all iterations but 'lm'"),
        ({"iteration": "cwln"}, {"limits_stop": True}, "'cwpi'"),
        ({"iteration": "cwpi"}, {"null_space_gain": 0.2}, "'pinv' and 'pinv_rr'"),
        ({}, {"limit_margin": 0.2}, "'cwln' and 'cwpi'"),
        ({"reselection": "none"}, {"candidates": 5}, "a re-selection"),
        (
            {"ranking": "nearest"},
            {"rotation_difference": "geodesic"},
            "'joint_adjustment'",
        ),
    ],
    ids=str,
)
def test_options_that_nothing_reads_are_refused(base, change, reader: str) -> None:
    (name,) = change
    with pytest.raises(
        iksel.InvalidArgumentError, match=f"{name}: only read .*{reader}"
    ):
        iksel.Paper(**base, **change)


def test_neighbours_bound_what_lanes_take_from_the_database(made) -> None:
    few = iksel.Solver(
        made.robot("irb14050"), iksel.SolverOptions(strategy=iksel.Lanes(neighbours=16))
    )
    pose = few.robot.fk(few.robot.random_configurations(1, 12)[0])
    all_of_few = few.solve_all(pose)
    all_of_many = made.solver("irb14050").solve_all(pose)
    assert all_of_few.success
    assert all_of_few.q.shape != all_of_many.q.shape or (
        (all_of_few.q != all_of_many.q).any()
    )


def test_without_reselection_there_is_one_attempt(made) -> None:
    options = iksel.SolverOptions(strategy=iksel.Paper(reselection="none"))
    solver = iksel.Solver(made.robot("ur3"), options)
    batch = solver.solve_batch(targets(solver.robot, 100, 11))
    assert (batch.attempts == 1).all()
    assert not batch.success.all()


# What each strategy reads changes its answers; what it does not, it refuses.
LANES = iksel.Lanes()
PAPER = iksel.Paper(limit_aware=True, candidates=100, whole_turns=True)


@pytest.mark.parametrize(
    ("strategy", "change"),
    [
        *[
            (strategy, change)
            for strategy in (LANES, PAPER)
            for change in (
                {"max_iterations": 1},
                {"position_tolerance": 1e-9, "rotation_tolerance": 1e-9},
                {"position_tolerance": 1e-2, "rotation_tolerance": 1e-1},
            )
        ],
        (LANES, {"damping": 1.0}),
        (PAPER, {"kinematics": "kernel"}),
        (PAPER, {"ranking": "nearest"}),
        (PAPER, {"rotation_difference": "geodesic"}),
        (PAPER, {"limit_aware": False}),
        (PAPER, {"reselection": "next"}),
        (PAPER, {"whole_turns": False}),
        (PAPER, {"neighbours": 1, "candidates": 1}),
        (PAPER, {"neighbour_radius": 0.3}),
        (PAPER, {"neighbours": 1_000_000, "candidates": 1_000_000}),
        (PAPER, {"candidates": 3, "max_attempts": 50}),
        (PAPER, {"damping": 0.1}),
        (PAPER, {"pinv_cutoff": 0.2}),
        (PAPER, {"position_clamp": 0.01}),
        (PAPER, {"rotation_clamp": 0.01}),
        (PAPER, {"min_step": 0.1}),
        (PAPER, {"limits_stop": True}),
        (PAPER, {"null_space_gain": 0.2}),
        (PAPER.replace(iteration="cwln"), {"limit_margin": 0.3}),
        (PAPER.replace(iteration="pinv_rr"), {"growth_stop": "off"}),
        (PAPER.replace(iteration="cwpi"), {"growth_stop": "on"}),
        (PAPER.replace(iteration="cwpi"), {"min_step": 0.1}),
        (PAPER.replace(iteration="pinv_rr"), {"seed": 5}),
    ],
    ids=str,
)
def test_every_option_changes_the_answers_and_keeps_them_right(
    made, strategy, change
) -> None:
    few = iksel.DatabaseOptions(samples=2000)
    options = iksel.SolverOptions(database=few, strategy=strategy)
    plain = iksel.Solver(made.robot("pr2_right_arm"), options)
    of_strategy = {k: v for k, v in change.items() if hasattr(strategy, k)}
    rest = {k: v for k, v in change.items() if k not in of_strategy}
    changed = options.replace(strategy=strategy.replace(**of_strategy), **rest)
    other = iksel.Solver(plain.robot, changed, plain.database)
    poses = targets(plain.robot, 50, 4)
    answers = [solver.solve_batch(poses) for solver in (plain, other)]
    for solver, batch in zip((plain, other), answers, strict=True):
        check_answers(solver, poses, batch)
    assert answers[0].solved >= 40
    with pytest.raises(AssertionError):
        assert_same_batch(*answers)


@pytest.mark.parametrize("sampling", [kind.name for kind in iksel.Sampling])
@pytest.mark.parametrize("key", [kind.name for kind in iksel.RotationKey])
def test_every_database_gives_answers(made, sampling: str, key: str) -> None:
    few = iksel.DatabaseOptions(samples=2000, scale="small", key_scheme="full")
    work = {"kmeans": {"kmeans_pool": 5000}, "cvt": {"cvt_updates": 5000}}
    own = work.get(sampling, {})
    database = few.replace(sampling=sampling, rotation_key=key, **own)
    solver = iksel.Solver(made.robot("cvr038"), iksel.SolverOptions(database=database))
    poses = targets(solver.robot, 50, 5)
    assert check_answers(solver, poses, solver.solve_batch(poses)) >= 0.9


@pytest.mark.parametrize("name", ["cvr038", "ur3_wrs", "gen3_6dof"])
def test_batch_in_lanes_solves_what_the_loop_solves(made, name: str) -> None:
    solver = made.solver(name)
    poses = targets(solver.robot, 60, 6)
    poses[::7, :3, 3] += 5.0
    batch = solver.solve_batch(poses, threads=2)
    check_answers(solver, poses, batch)
    for i, pose in enumerate(poses):
        assert solver.solve(pose).status is batch[i].status


@pytest.mark.parametrize("name", ["cvr038", "ur3_wrs", "gen3_6dof"])
def test_batch_is_the_loop_bit_for_bit(made, name: str) -> None:
    solver = made.solver(name, "paper")
    poses = targets(solver.robot, 60, 6)
    poses[::7, :3, 3] += 5.0
    batch = solver.solve_batch(poses, threads=2)
    for i, pose in enumerate(poses):
        one = solver.solve(pose)
        row = batch[i]
        assert_same_result(one, row)
        if one.q is not None:
            np.testing.assert_array_equal(one.q, batch.q[i])


@pytest.mark.parametrize("scheme", ["lanes", "dls", "pinv_rr"])
@pytest.mark.parametrize("name", ["cvr038", "irb14050"])
def test_threads_and_order_change_no_bit(made, name: str, scheme: str) -> None:
    strategy = iksel.Lanes() if scheme == "lanes" else iksel.Paper(iteration=scheme)
    options = iksel.SolverOptions(strategy=strategy, max_attempts=4)
    solver = iksel.Solver(made.robot(name), options, made.solver(name).database)
    poses = targets(solver.robot, 101, 7)
    one = solver.solve_batch(poses, threads=1)
    for threads in (2, 8, 0):
        assert_same_batch(one, solver.solve_batch(poses, threads=threads))
    order = np.random.default_rng(7).permutation(len(poses))
    shuffled = solver.solve_batch(poses[order], threads=2)
    np.testing.assert_array_equal(shuffled.q, one.q[order])
    np.testing.assert_array_equal(shuffled.iterations, one.iterations[order])


def test_one_solver_serves_many_python_threads(made) -> None:
    solver = made.solver("panda")
    poses = targets(solver.robot, 100, 8)
    alone = [solver.solve(pose) for pose in poses]
    with ThreadPoolExecutor(8) as pool:
        together = list(pool.map(solver.solve, poses))
    for a, b in zip(alone, together, strict=True):
        assert_same_result(a, b)


def test_two_solvers_of_the_same_make_agree(made) -> None:
    robot = made.robot("ur3")
    poses = targets(robot, 50, 9)
    first, second = (iksel.Solver(robot).solve_batch(poses) for _ in range(2))
    assert_same_batch(first, second)


@pytest.mark.parametrize("name", SOME)
def test_unreachable_poses_have_a_status(made, name: str) -> None:
    solver = made.solver(name)
    direction = np.array([1.0, 2.0, -2.0]) / 3.0
    for far in (1.01 * solver.robot.reach, 100.0, 1e12, 1e300):
        position = solver.robot.reach_centre + far * direction
        result = solver.solve(iksel.pose_from_euler(position, [0.1, 0.2, 0.3]))
        assert result.status == iksel.Status.out_of_reach
        assert not result.success
        assert result.q is None
        assert math.isnan(result.position_error)
        assert math.isnan(result.rotation_error)
        assert result.attempts == result.iterations == 0


@pytest.mark.parametrize(
    ("name", "preset"),
    [*((name, "default") for name in SOME), ("cvr038", "paper"), ("ur3_wrs", "paper")],
)
def test_work_is_bounded_where_there_is_no_solution(
    made, name: str, preset: str
) -> None:
    solver = made.solver(name, preset)
    # Inside the base, hand pointing down: no arm gets there.
    pose = iksel.pose_from_euler(solver.robot.reach_centre, [0.0, math.pi / 2, 0.0])
    result = solver.solve(pose)
    assert result.attempts <= solver.options.max_attempts
    assert result.iterations <= result.attempts * solver.options.max_iterations
    if not result.success:
        assert result.q is None
        assert result.status != iksel.Status.out_of_reach


def test_limits_are_told_from_failure(made) -> None:
    # A target that only configurations outside the limits reach.
    robot = made.robot("valkyrie_right_arm")
    wide = iksel.Robot.from_urdf(
        re.sub(r'lower="[^"]*" upper="[^"]*"', 'lower="-3.1" upper="3.1"', robot.urdf),
        base_link=robot.base_link,
        tip_link=robot.tip_link,
    )
    q = wide.random_configurations(200, 10)
    outside = ((q < robot.lower - 0.3) | (q > robot.upper + 0.3)).any(axis=1)
    options = iksel.SolverOptions(strategy="paper", max_attempts=20)
    solver = iksel.Solver(robot, options, made.solver("valkyrie_right_arm").database)
    batch = solver.solve_batch(wide.fk(q[outside]))
    assert (batch.status == iksel.Status.outside_limits.value).any()
    check_answers(solver, wide.fk(q[outside]), batch)


def without_turns(difference: np.ndarray) -> np.ndarray:
    """Differences of joint values, whole turns aside."""
    return difference - 2 * math.pi * np.round(difference / (2 * math.pi))


@pytest.mark.parametrize("name", SOME)
def test_a_seed_that_solves_is_the_answer(made, name: str) -> None:
    solver = made.solver(name)
    for q in solver.robot.random_configurations(20, 11):
        result = solver.solve(solver.robot.fk(q), seeds=[q])
        assert result.success
        assert result.attempts == 1
        np.testing.assert_allclose(without_turns(result.q - q), 0, atol=1e-9)


@pytest.mark.parametrize("name", ["ur3", "cvr038", "gen3_6dof"])
def test_seeds_near_the_answer_stay_near(made, name: str) -> None:
    solver = made.solver(name)
    random = np.random.default_rng(12)
    near = 0
    for q in solver.robot.random_configurations(50, 12):
        seed = q + random.normal(0.0, 0.01, solver.robot.dof)
        result = solver.solve(solver.robot.fk(q), seeds=[seed])
        assert result.success
        near += bool(np.abs(without_turns(result.q - q)).max() < 0.5)
    assert near >= 40


@pytest.mark.parametrize("name", ["ur3", "cvrb1213", "panda", "gen3_6dof"])
def test_seeds_may_lie_outside_the_limits(made, name: str) -> None:
    solver = made.solver(name)
    for q in solver.robot.random_configurations(20, 13):
        for shift in (2 * math.pi, -4 * math.pi, 50.0):
            result = solver.solve(solver.robot.fk(q), seeds=[q + shift])
            assert result.success
            assert solver.robot.within_limits(result.q)


def test_whole_turns_bring_answers_inside(made) -> None:
    # Two turns beyond the limits; the wide joints of a UR3 allow +-1 turn.
    solver = made.solver("ur3")
    for q in solver.robot.random_configurations(20, 14):
        turned = q.copy()
        turned[0] += 2 * math.pi * (2 if q[0] > 0 else -2)
        result = solver.solve(solver.robot.fk(q), seeds=[turned])
        assert result.attempts == 1
        assert result.success
        turns = (result.q - turned) / (2 * math.pi)
        np.testing.assert_allclose(turns, np.round(turns), rtol=0, atol=1e-8)
        assert round(turns[0]) != 0


def test_continuous_joints_come_back_as_principal_values(made) -> None:
    solver = made.solver("gen3_6dof")
    free = np.isinf(solver.robot.upper)
    assert free.any()
    for q in solver.robot.random_configurations(20, 15):
        seed = q + np.where(free, 6 * math.pi, 0.0)
        result = solver.solve(solver.robot.fk(q), seeds=[seed])
        assert result.success
        assert np.abs(result.q[free]).max() <= math.pi
    batch = solver.solve_batch(targets(solver.robot, 100, 16))
    assert np.nanmax(np.abs(batch.q[:, free])) <= math.pi


@pytest.mark.parametrize("name", ["cvr038", "irb14050"])
def test_tools_share_a_database(made, name: str) -> None:
    tool = iksel.pose_from_euler([0.05, 0.02, 0.1], [0.4, -0.3, 0.2])
    robot = made.robot(name).with_tcp(tool)
    solver = iksel.Solver(robot, database=made.solver(name).database)
    poses = targets(robot, 100, 17)
    assert check_answers(solver, poses, solver.solve_batch(poses)) >= 0.99
