# SPDX-License-Identifier: BSD-3-Clause
"""What the extension module takes as arrays, and what it refuses."""

from __future__ import annotations

import iksel_cpp as core
import numpy as np
import pytest


def without_rigidity(pose):
    """Poses that are none, and a word of what is said of each."""
    scaled = pose.copy()
    scaled[:3, :3] *= 1.01
    mirrored = pose.copy()
    mirrored[:3, 0] *= -1
    projective = pose.copy()
    projective[3, 0] = 0.1
    nan = pose.copy()
    nan[0, 3] = np.nan
    infinite = pose.copy()
    infinite[1, 1] = np.inf
    return scaled, mirrored, projective, nan, infinite


@pytest.mark.parametrize("shape", [(3, 5), (4,), (16,), (1, 4, 4), (4, 5), (), (0,)])
def test_pose_of_wrong_shape_is_named(solver, shape):
    with pytest.raises(core.InvalidArgumentError) as error:
        solver.solve(np.zeros(shape))
    assert str(error.value) == f"pose: expected a (4, 4) array, got shape {shape}"


@pytest.mark.parametrize("shape", [(4, 4), (2, 3, 5), (2, 16), (1, 2, 4, 4), (0,)])
def test_poses_of_wrong_shape_are_named(solver, shape):
    with pytest.raises(core.InvalidArgumentError) as error:
        solver.solve_batch(np.zeros(shape))
    text = f"poses: expected an (N, 4, 4) array, got shape {shape}"
    assert str(error.value).startswith(text)


def test_single_pose_to_solve_batch_points_to_solve(solver):
    with pytest.raises(core.InvalidArgumentError, match=r"solve\(\)"):
        solver.solve_batch(np.eye(4))


@pytest.mark.parametrize("shape", [(5,), (7,), (3, 5), (6, 3), (2, 3, 6), ()])
def test_q_of_wrong_shape_is_named(robot, shape):
    for function in (robot.fk, robot.jacobian):
        with pytest.raises(core.InvalidArgumentError, match=r"^q: expected a \(6,\)"):
            function(np.zeros(shape))


def test_seed_of_wrong_shape_is_named(solver, poses):
    with pytest.raises(core.InvalidArgumentError, match=r"^seeds: expected a \(6,\)"):
        solver.solve(poses[0], seeds=np.zeros(5))


@pytest.mark.parametrize(
    "dtype", ["complex128", "object", "bool", "<U3", "S3", "datetime64[s]"]
)
def test_dtype_that_is_no_real_number_is_named(robot, solver, dtype):
    eye = np.zeros((4, 4)).astype(dtype)
    for name, function, array in (
        ("pose", solver.solve, eye),
        ("poses", solver.solve_batch, eye[None]),
        ("q", robot.fk, np.zeros(6).astype(dtype)),
    ):
        with pytest.raises(core.InvalidArgumentError) as error:
            function(array)
        expected = f"{name}: expected real numbers, got dtype {array.dtype}"
        assert str(error.value) == expected


@pytest.mark.parametrize("value", [None, "pose", {}, [[1.0], [1.0, 2.0]], object()])
def test_what_is_no_array_is_named(solver, value):
    for name, function in (("pose", solver.solve), ("poses", solver.solve_batch)):
        with pytest.raises(core.InvalidArgumentError, match=rf"^{name}: "):
            function(value)


@pytest.mark.parametrize("dtype", ["f2", "f4", ">f8", "i4", "u1", "longdouble"])
def test_real_dtypes_are_converted(robot, dtype):
    q = np.array([0, 1, 0, 1, 1, 0], dtype=dtype)
    np.testing.assert_array_equal(robot.fk(q), robot.fk(q.astype(float)))
    np.testing.assert_array_equal(robot.fk(q[None]), robot.fk(q[None].astype(float)))


def strided(array):
    out = np.zeros((*array.shape[:-1], 2 * array.shape[-1]))
    out[..., ::2] = array
    return out[..., ::2]


def unaligned(array):
    room = np.zeros(array.nbytes + 1, dtype=np.uint8)
    out = room[1:].view(float).reshape(array.shape)
    out[...] = array
    return out


def read_only(array):
    out = array.copy()
    out.flags.writeable = False
    return out


@pytest.mark.parametrize(
    "layout",
    [
        np.asfortranarray,
        strided,
        unaligned,
        read_only,
        lambda a: a[::-1][::-1],
        lambda a: a.tolist(),
    ],
    ids=["fortran", "strided", "unaligned", "read_only", "reversed", "list"],
)
def test_layout_does_not_matter(robot, solver, joints, poses, layout):
    expected = solver.solve_batch(poses)
    np.testing.assert_array_equal(robot.fk(layout(joints)), poses)
    np.testing.assert_array_equal(solver.solve_batch(layout(poses)).q, expected.q)
    np.testing.assert_array_equal(solver.solve(layout(poses[0])).q, expected.q[0])


def test_non_rigid_pose_is_refused(solver, poses):
    for bad in without_rigidity(poses[0]):
        with pytest.raises(core.InvalidArgumentError, match=r"^pose: "):
            solver.solve(bad)


def test_first_bad_pose_of_a_batch_is_named(solver, poses):
    for bad in without_rigidity(poses[0]):
        batch = poses.copy()
        batch[31] = bad
        batch[40] = bad
        with pytest.raises(core.InvalidArgumentError, match=r"^poses\[31\]: "):
            solver.solve_batch(batch, on_invalid_pose="raise")


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_non_finite_joints_are_named(robot, solver, joints, poses, bad):
    rows = joints.copy()
    rows[3, 2] = rows[5, 0] = bad
    for function in (robot.fk, robot.jacobian):
        with pytest.raises(core.InvalidArgumentError, match=r"^q: .* at joint 2"):
            function(rows[3])
        with pytest.raises(core.InvalidArgumentError, match=r"^q\[3\]: .* at joint 2"):
            function(rows)
    with pytest.raises(core.InvalidArgumentError, match=r"^seeds: "):
        solver.solve(poses[0], seeds=rows[3])


def test_empty_batches_are_fine(robot, solver):
    assert robot.fk(np.zeros((0, 6))).shape == (0, 4, 4)
    assert robot.jacobian(np.zeros((0, 6))).shape == (0, 6, 6)
    for nothing in (np.zeros((0, 4, 4)), [], ()):
        batch = solver.solve_batch(nothing)
        assert len(batch) == 0
        assert batch.q.shape == (0, 6)
        assert repr(batch) == "BatchResult(0 of 0 solved)"
    with pytest.raises(core.InvalidArgumentError, match=r"^poses: there are none"):
        solver.solve_path([])


@pytest.mark.parametrize("threads", [-1, 10**6, 2**40])
def test_bad_thread_count_is_refused(solver, poses, threads):
    with pytest.raises(core.InvalidArgumentError, match=r"^threads: "):
        solver.solve_batch(poses, threads=threads)


def test_masked_entries_are_refused(robot, solver, poses):
    q = np.ma.array(np.zeros(6), mask=[0, 1, 0, 0, 0, 0])
    pose = np.ma.array(poses[0], mask=np.eye(4))
    for function, array in (
        (robot.fk, q),
        (solver.solve, pose),
        (solver.solve, pose[:3]),
        (solver.solve_batch, pose[None]),
    ):
        with pytest.raises(core.InvalidArgumentError, match="masked entries"):
            function(array)
    np.testing.assert_array_equal(robot.fk(np.ma.array(q.data)), robot.fk(q.data))


def test_numbers_that_are_too_large_are_said_to_be(robot):
    for n, expected in ((10**20, f"from 0 to {2**64 - 1}"), (-1, "of 0 or more")):
        with pytest.raises(core.InvalidArgumentError, match=f"^n: .*{expected}"):
            robot.random_configurations(n)


def test_a_last_row_is_told_with_all_digits(solver):
    pose = np.eye(4)
    pose[3, 3] = 1 + 2e-16
    with pytest.raises(
        core.InvalidArgumentError, match=r"not 0 0 0 1\.0000000000000002"
    ):
        solver.solve(pose)
