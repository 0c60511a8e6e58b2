# SPDX-License-Identifier: BSD-3-Clause
"""Poses that were printed with a few decimals stand for the nearest rigid ones."""

from __future__ import annotations

import re

import iksel_cpp as core
import numpy as np
import pytest

import iksel

SEED = 31
LIMIT = 1e-3
SLACK = 1e-12


def polar(pose):
    """The nearest rigid transform, by numpy's SVD."""
    out = np.array(pose, dtype=float)
    u, _, vt = np.linalg.svd(out[..., :3, :3])
    out[..., :3, :3] = u @ vt
    return out


def deviation(pose):
    r = pose[..., :3, :3]
    gram = np.swapaxes(r, -1, -2) @ r - np.eye(3)
    return np.abs(gram).max(axis=(-2, -1))


def random_poses(n, seed=SEED):
    rng = np.random.default_rng(seed)
    return iksel.pose_from_rotation_vector(
        rng.uniform(-1, 1, (n, 3)), rng.uniform(-1.8, 1.8, (n, 3))
    )


def nearly_rigid(n, size):
    """Random poses whose rotations are off by `size`, each in a random direction."""
    poses = random_poses(n)
    noise = np.random.default_rng(SEED + 1).normal(size=(n, 3, 3))
    noise /= np.abs(noise + np.swapaxes(noise, -1, -2)).max(axis=(1, 2))[:, None, None]
    poses[:, :3, :3] = poses[:, :3, :3] @ (np.eye(3) + size * noise)
    return poses


@pytest.mark.parametrize("decimals", [4, 5, 6, 8])
@pytest.mark.parametrize("preset", ["default", "paper"])
def test_answers_to_rounded_poses_are_answers_to_the_nearest(
    made, cases, decimals, preset
) -> None:
    solver = made.solver("ur3", preset)
    robot = solver.robot
    exact = robot.fk(robot.random_configurations(cases, SEED))
    poses = np.round(exact, decimals)
    assert deviation(poses).min() > SLACK
    nearest = polar(poses)
    batch = solver.solve_batch(poses)
    assert batch.solved >= 0.9 * solver.solve_batch(exact).solved, f"seed {SEED}"
    for target, pose, row in zip(nearest, poses, batch, strict=True):
        single = solver.solve(pose)
        assert single.status == row.status
        for result in (single, row):
            if result.q is None:
                continue
            error = core.pose_error(target, robot.fk(result.q, "kdl"))
            assert (
                np.linalg.norm(error[:3]) <= solver.options.position_tolerance + SLACK
            )
            assert (
                np.linalg.norm(error[3:]) <= solver.options.rotation_tolerance + SLACK
            )
    many = solver.solve_batch(nearest)
    same = np.isclose(
        many.position_error, batch.position_error, atol=1e-9, equal_nan=True
    )
    # They differ in their last bits, by which the paper's search may end elsewhere.
    assert (~same).sum() <= (0 if preset == "default" else 1 + cases // 50)


@pytest.mark.parametrize("size", [1e-11, 1e-9, 1e-7, 1e-5, 5e-4, 0.99e-3])
def test_projection_is_the_polar_factor(cases, size) -> None:
    poses = nearly_rigid(cases, size)
    assert deviation(poses).max() <= LIMIT
    made_rigid = iksel.check_pose(poses)
    np.testing.assert_allclose(made_rigid, polar(poses), rtol=0, atol=1e-14)
    np.testing.assert_array_equal(made_rigid[:, :, 3], poses[:, :, 3])
    assert deviation(made_rigid).max() <= 1e-14
    np.testing.assert_array_equal(iksel.check_pose(made_rigid), made_rigid)


def test_poses_that_are_rigid_to_rounding_keep_their_bits(made, cases) -> None:
    robot = made.robot("panda")
    for poses in (
        robot.fk(robot.random_configurations(cases, SEED)),
        robot.fk(robot.random_configurations(cases, SEED), "kdl"),
        random_poses(cases) @ random_poses(cases, SEED + 5),
    ):
        assert deviation(poses).max() > 0
        np.testing.assert_array_equal(iksel.check_pose(poses), poses)
        np.testing.assert_array_equal(iksel.orthonormalized(poses), poses)


def test_every_entrance_takes_rounded_poses(made, run) -> None:
    solver = made.solver("ur3")
    robot = solver.robot
    start = robot.random_configurations(1, SEED)[0]
    pose = np.round(robot.fk(start), 5)
    nearest = polar(pose)
    assert deviation(pose) > 1e-7

    def check(q, target=nearest):
        assert np.abs(iksel.pose_error(target, robot.fk(q))).max() <= 1e-6 + SLACK

    check(solver.solve(pose).q)
    check(solver.solve(pose, seeds=[start]).q)
    check(solver.solve(pose, near=start).q)
    check(solver.solve_all(pose).q[-1])
    check(solver.solve_path([pose], start).q[0])
    tracker = solver.tracker(start)
    assert tracker.track(pose, 1.0).success
    check(tracker.q)
    assert solver.diagnose(pose).cause == iksel.Cause.none
    assert list(solver.database.nearest(pose, 1)) == list(
        solver.database.nearest(nearest, 1)
    )
    np.testing.assert_allclose(robot.with_tcp(pose).tcp, nearest, rtol=0, atol=1e-14)
    urdf = iksel.Robot.from_urdf(robot.urdf, robot.base_link, robot.tip_link, tcp=pose)
    np.testing.assert_allclose(urdf.tcp, nearest, rtol=0, atol=1e-14)
    np.testing.assert_allclose(core.pose_error(pose, nearest), 0, atol=1e-14)
    assert max(iksel.pose_error(pose, nearest)) <= 1e-14
    np.testing.assert_allclose(
        iksel.pose_from_quaternion(pose[:3, 3], iksel.quaternion_from_pose(pose)),
        nearest,
        rtol=0,
        atol=1e-14,
    )
    np.testing.assert_allclose(
        iksel.pose_from_matrix(pose[:3, 3], pose[:3, :3]), nearest, rtol=0, atol=1e-14
    )
    words = ["solve", "ur3", "--json", "--pose", *map(str, pose.ravel())]
    assert run(*words).code == 0


def test_beyond_the_bound_the_error_says_how_far_and_what_helps(made) -> None:
    solver = made.solver("ur3")
    poses = nearly_rigid(9, 5e-4)
    poses[5, :3, :3] *= 1.01
    poses[7, :3, :3] *= 1.5
    off = f"{deviation(poses)[5]:.4g}"[:5]
    words = (
        rf"not rigid, R\^T R differs from the identity by {re.escape(off)}.*0\.001.*"
    )
    words += r"orthonormalized\(pose\)"
    with pytest.raises(iksel.InvalidArgumentError, match="^pose: " + words):
        solver.solve(poses[5])
    with pytest.raises(iksel.InvalidArgumentError, match=r"^poses\[5\]: " + words):
        solver.solve_batch(poses, on_invalid_pose="raise")
    with pytest.raises(iksel.InvalidArgumentError, match=r"^poses\[5\]: " + words):
        solver.solve_path(poses)
    with pytest.raises(iksel.InvalidArgumentError, match=r"^goal\[1, 2\]: " + words):
        iksel.check_pose(poses.reshape(3, 3, 4, 4), "goal")
    assert iksel.is_rigid(poses).tolist() == [i not in (5, 7) for i in range(9)]
    solver.solve(iksel.orthonormalized(poses[5]))


@pytest.mark.parametrize("factor", [1e-150, 1e-3, 0.7, 1.0, 25.4, 1e150])
def test_orthonormalized_is_the_polar_factor(cases, factor) -> None:
    rng = np.random.default_rng(SEED)
    poses = random_poses(cases)
    poses[:, :3, :3] += rng.uniform(-0.3, 0.3, (cases, 3, 3))
    poses = poses[np.linalg.det(poses[:, :3, :3]) > 0.05]
    assert len(poses) > cases / 2
    poses[:, :3, :3] *= factor
    nearest = iksel.orthonormalized(poses)
    assert deviation(nearest).max() <= 1e-14
    np.testing.assert_allclose(nearest, polar(poses), rtol=0, atol=1e-12)
    np.testing.assert_array_equal(nearest[:, :, 3], poses[:, :, 3])
    assert np.linalg.det(nearest[:, :3, :3]).min() > 0


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        ((0, 3, np.nan), "not finite"),
        ((1, 1, np.inf), "not finite"),
        ((3, 0, 0.1), "last row"),
        ((slice(3), 0, 0.0), "singular"),
        ((slice(3), slice(3), 0.0), "singular"),
        ((slice(3), slice(3), -np.eye(3)), "reflection"),
    ],
)
def test_orthonormalized_refuses_what_has_no_nearest(spoil, message) -> None:
    row, column, value = spoil
    pose = np.eye(4)
    pose[row, column] = value
    with pytest.raises(iksel.InvalidArgumentError, match=f"^pose.*{message}"):
        iksel.orthonormalized(pose)
