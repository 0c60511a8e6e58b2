# SPDX-License-Identifier: BSD-3-Clause
"""What the extension module gives back as arrays."""

from __future__ import annotations

import gc
import pickle
import sys

import iksel_cpp as core
import numpy as np
import pytest


@pytest.mark.parametrize("kinematics", ["kernel", "kdl", core.Kinematics.kdl])
def test_rows_equal_single_calls(robot, joints, kinematics):
    for function in (robot.fk, robot.jacobian):
        rows = function(joints, kinematics=kinematics)
        assert rows.flags.c_contiguous
        single = [function(q, kinematics=kinematics) for q in joints]
        np.testing.assert_array_equal(rows, single)


def test_batch_equals_loop(robot, poses):
    options = core.SolverOptions.paper()
    options.database.scale = "small"
    solver = core.Solver(robot, options)
    batch = solver.solve_batch(poses)
    assert len(batch) == len(poses)
    for pose, row, status in zip(poses, batch, batch.statuses(), strict=True):
        single = solver.solve(pose)
        assert row.success == single.success
        assert row.status is single.status is status
        assert row.attempts == single.attempts
        assert row.iterations == single.iterations
        np.testing.assert_array_equal(row.q, single.q)
        np.testing.assert_equal(row.position_error, single.position_error)
        np.testing.assert_equal(row.rotation_error, single.rotation_error)


def test_batch_in_lanes_solves_what_a_loop_solves(robot, solver, poses):
    batch = solver.solve_batch(poses)
    for pose, row in zip(poses, batch, strict=True):
        assert row.status is solver.solve(pose).status
        if row.success:
            np.testing.assert_allclose(robot.fk(row.q), pose, atol=3e-6)


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_threads_do_not_change_bits(solver, poses, threads):
    expected = solver.solve_batch(poses)
    batch = solver.solve_batch(poses, threads=threads)
    np.testing.assert_array_equal(batch.q, expected.q)
    np.testing.assert_array_equal(batch.status, expected.status)
    np.testing.assert_array_equal(batch.iterations, expected.iterations)


def test_unsolved_has_no_q(solver, poses):
    far = poses[:2].copy()
    far[1, :3, 3] = 50.0
    single = solver.solve(far[1])
    assert not single.success
    assert single.status is core.Status.out_of_reach
    assert single.q is None
    assert np.isnan(single.position_error)
    assert np.isnan(single.rotation_error)
    batch = solver.solve_batch(far)
    assert batch.success.tolist() == [True, False]
    assert batch.status.tolist() == [
        core.Status.solved.value,
        core.Status.out_of_reach.value,
    ]
    assert batch.solved == 1
    assert np.isfinite(batch.q[0]).all()
    assert np.isnan(batch.q[1]).all()
    assert np.isnan(batch.position_error[1])
    assert batch[1].q is None
    assert repr(batch) == "BatchResult(1 of 2 solved)"


def test_batch_arrays_have_the_documented_types(solver, poses):
    batch = solver.solve_batch(poses)
    n = len(poses)
    for name, dtype, shape in (
        ("q", "float64", (n, 6)),
        ("success", "bool", (n,)),
        ("status", "uint8", (n,)),
        ("proof", "uint8", (n,)),
        ("position_error", "float64", (n,)),
        ("rotation_error", "float64", (n,)),
        ("attempts", "int32", (n,)),
        ("iterations", "int32", (n,)),
    ):
        array = getattr(batch, name)
        assert array.dtype == dtype
        assert array.shape == shape
        assert getattr(batch, name) is array


def test_batch_rows_are_found_from_both_ends(solver, poses):
    batch = solver.solve_batch(poses[:3])
    np.testing.assert_array_equal(batch[-1].q, batch[2].q)
    np.testing.assert_array_equal(batch[np.int64(1)].q, batch.q[1])
    for row in (3, -4):
        with pytest.raises(IndexError, match=r"row -?\d of 3"):
            batch[row]


def test_what_a_result_says_cannot_be_written_to(solver, poses):
    single = solver.solve(poses[0])
    closest = solver.solve(poses[0] + 5 * np.eye(4, k=3), closest=True)
    batch = solver.solve_batch(poses[:2])
    for result in (single, closest, batch[0], *solver.solve_all(poses[0])):
        before = result.q.copy()
        with pytest.raises(ValueError, match="read-only"):
            result.q[0] = 9.0
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(result)).q, before)
        result.q.copy()[0] = 9.0
        np.testing.assert_array_equal(result.q, before)


def test_proof_of_a_success_is_the_answer(made, solver, poses):
    answer = core.Proof.answer
    batch = solver.solve_batch(poses)
    assert (batch.proof == answer).tolist() == batch.success.tolist()
    far = poses[0] + 5 * np.eye(4, k=3)
    for pose in (*poses[:5], far):
        for any_solver in (solver, made.solver("ur3", "paper")):
            for found in (
                any_solver.solve(pose),
                any_solver.solve(pose, near=np.zeros(6)),
                any_solver.solve(pose, objective="limits"),
            ):
                assert (found.proof is answer) is found.success
                assert not (found.success and found.proven)
                assert found.status is not core.Status.closest
        found = solver.solve_all(pose)
        assert all(one.proof is answer for one in found)
        assert not (found.success and found.proof is core.Proof.none)
        why = solver.diagnose(pose)
        assert (why.proof is answer) is why.q_is_solution
    tracker = solver.tracker(np.zeros(6))
    assert tracker.track(solver.robot.fk(np.zeros(6)), 0.1).proof is answer
    assert tracker.track(far, 0.1).proof is core.Proof.none


def test_result_is_explicit_about_success(solver, poses):
    result = solver.solve(poses[0])
    assert result.success is True
    assert bool(result) is True
    assert result.q is result.q
    with pytest.raises(AttributeError):
        result.success = False
    assert repr(result).startswith("Result(solved, q=[")
    assert "], position_error=" in repr(result)


@pytest.mark.parametrize(
    "name", ["lower", "upper", "velocity_limit", "soft_lower", "soft_upper"]
)
def test_joint_vectors_are_read_only_views(robot, name):
    vector = getattr(robot, name)
    assert vector.shape == (robot.dof,)
    assert vector.base is robot
    assert np.shares_memory(vector, getattr(robot, name))
    with pytest.raises(ValueError, match="read-only"):
        vector[0] = 0.0


def test_view_outlives_the_name_of_its_robot(robot):
    other = pickle.loads(pickle.dumps(robot))
    lower = other.lower
    del other
    gc.collect()
    np.testing.assert_array_equal(lower, robot.lower)


def test_calls_leak_no_references(robot, solver, joints, poses):
    pose, q = poses[0].copy(), joints[0].copy()
    arguments = (pose, q, poses, joints)
    solver.solve_batch(poses)
    before = [sys.getrefcount(a) for a in arguments]
    for _ in range(20):
        robot.fk(q)
        robot.jacobian(joints)
        solver.solve(pose, seeds=[q], near=q)
        solver.solve_batch(poses[:2])
        with pytest.raises(core.InvalidArgumentError):
            solver.solve(q)
    del _
    gc.collect()
    assert [sys.getrefcount(a) for a in arguments] == before


def test_inputs_are_left_alone(robot, solver, joints, poses):
    joints_before, poses_before = joints.copy(), poses.copy()
    robot.fk(joints)
    solver.solve_batch(poses)
    solver.solve(poses[0], seeds=joints)
    np.testing.assert_array_equal(joints, joints_before)
    np.testing.assert_array_equal(poses, poses_before)


def test_random_configurations_depend_on_the_seed_alone(robot):
    first = robot.random_configurations(20, 3)
    assert first.shape == (20, 6)
    assert first.flags.c_contiguous
    np.testing.assert_array_equal(first, robot.random_configurations(20, seed=3))
    assert (first != robot.random_configurations(20, 4)).any()
    assert all(robot.within_limits(q) for q in first)
    assert not robot.within_limits(robot.upper + 1e-3)


def test_random_configurations_without_a_seed_are_fresh(robot):
    draws = [robot.random_configurations(3) for _ in range(4)]
    draws.append(robot.random_configurations(3, seed=None))
    assert len({draw.tobytes() for draw in draws}) == len(draws)
    assert robot.within_limits(np.concatenate(draws)).all()


def test_limits_are_asked_of_one_and_of_many(robot):
    rows = robot.random_configurations(100, 8) * 1.1
    many = robot.within_limits(rows)
    assert many.dtype == bool
    assert many.shape == (100,)
    expected = ((rows >= robot.lower) & (rows <= robot.upper)).all(axis=1)
    np.testing.assert_array_equal(many, expected)
    assert 0 < many.sum() < 100
    for q, inside in zip(rows, many, strict=True):
        assert robot.within_limits(q) is bool(inside)
    assert robot.within_limits(np.zeros((0, 6))).shape == (0,)
    with pytest.raises(core.InvalidArgumentError, match=r"^q: expected a \(6,\)"):
        robot.within_limits(np.zeros((2, 5)))


@pytest.mark.parametrize("count", [-1, 1.5, "3", True, None])
def test_bad_count_is_named(robot, count):
    with pytest.raises(core.InvalidArgumentError, match=r"^n: expected an int"):
        robot.random_configurations(count, 0)
