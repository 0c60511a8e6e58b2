# SPDX-License-Identifier: BSD-3-Clause
"""Laws of the pose helpers, with care near the angles 0 and pi."""

from __future__ import annotations

import math
from collections.abc import Callable

import iksel_cpp
import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import iksel

Array = npt.NDArray[np.float64]

# Angles spread over all magnitudes towards both ends, where naive formulas lose digits.
angles = st.one_of(
    st.floats(0.0, math.pi),
    st.floats(-300.0, -1.0).map(lambda e: 10.0**e),
    st.floats(-15.0, -1.0).map(lambda e: math.pi - 10.0**e),
    st.sampled_from([0.0, 5e-324, math.pi / 2, math.pi]),
)
units = st.floats(-1.0, 1.0)


@st.composite
def axes(draw: st.DrawFn) -> Array:
    vector = np.array([draw(units), draw(units), draw(units)])
    length = float(np.linalg.norm(vector))
    assume(length > 0.1)
    return vector / length


@st.composite
def rotation_vectors(draw: st.DrawFn) -> Array:
    return draw(axes()) * draw(angles)


# Roll, pitch, yaw with the pitch at, near and away from the singularity.
pitches = st.one_of(
    st.floats(-math.pi / 2, math.pi / 2),
    st.tuples(st.sampled_from([-1.0, 1.0]), st.floats(-17.0, -1.0)).map(
        lambda t: t[0] * (math.pi / 2 - 10.0 ** t[1])
    ),
    st.sampled_from([-math.pi / 2, math.pi / 2]),
)
turns = st.floats(-math.pi, math.pi)
eulers = st.tuples(turns, pitches, turns).map(np.array)

positions = st.tuples(*[st.floats(-10.0, 10.0)] * 3).map(np.array)
poses = st.builds(iksel.pose_from_rotation_vector, positions, rotation_vectors())


def rotation_about(axis: str, angle: float) -> Array:
    c, s = math.cos(angle), math.sin(angle)
    return {
        "x": np.array([[1, 0, 0], [0, c, -s], [0, s, c]]),
        "y": np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]),
        "z": np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]),
    }[axis]


def inverse(pose: Array) -> Array:
    rotation = pose[:3, :3].T
    return iksel.pose_from_matrix(-rotation @ pose[:3, 3], rotation)


@given(rotation_vectors())
def test_rotation_vector_comes_back(vector: Array) -> None:
    pose = iksel.pose_from_rotation_vector(np.zeros(3), vector)
    assert iksel.is_rigid(pose, 1e-14)
    back = iksel.rotation_vector_from_pose(pose)
    if np.linalg.norm(vector) > math.pi - 1e-7:
        # Both signs of the axis are the same rotation at pi.
        again = iksel.pose_from_rotation_vector(np.zeros(3), back)
        np.testing.assert_allclose(again, pose, rtol=0, atol=1e-14)
        assert np.linalg.norm(back) == pytest.approx(math.pi, abs=1.1e-7)
    else:
        np.testing.assert_allclose(back, vector, rtol=0, atol=1e-14)


@given(axes(), st.floats(-15.0, -1.0))
def test_tiny_rotations_keep_relative_precision(axis: Array, power: float) -> None:
    vector = axis * 10.0**power
    pose = iksel.pose_from_rotation_vector(np.zeros(3), vector)
    back = iksel.rotation_vector_from_pose(pose)
    np.testing.assert_allclose(back, vector, rtol=0, atol=1e-15 * 10.0**power)


@given(axes(), angles)
def test_rotation_vector_turns_about_its_axis(axis: Array, angle: float) -> None:
    rotation = iksel.pose_from_rotation_vector(np.zeros(3), axis * angle)[:3, :3]
    np.testing.assert_allclose(rotation @ axis, axis, rtol=0, atol=1e-15)
    assert np.trace(rotation) == pytest.approx(1 + 2 * math.cos(angle), abs=1e-14)
    skew = np.array([rotation[2, 1], rotation[0, 2], rotation[1, 0]]) - np.array(
        [rotation[1, 2], rotation[2, 0], rotation[0, 1]]
    )
    np.testing.assert_allclose(skew, 2 * math.sin(angle) * axis, rtol=0, atol=1e-14)


@given(rotation_vectors())
def test_quaternion_comes_back(vector: Array) -> None:
    pose = iksel.pose_from_rotation_vector([0.1, 0.2, 0.3], vector)
    q = iksel.quaternion_from_pose(pose)
    assert q[0] >= 0
    assert np.linalg.norm(q) == pytest.approx(1.0, abs=1e-15)
    for sign in (1.0, -1.0):
        again = iksel.pose_from_quaternion([0.1, 0.2, 0.3], sign * q)
        np.testing.assert_allclose(again, pose, rtol=0, atol=1e-14)


@pytest.mark.parametrize("axis", np.vstack([np.eye(3), -np.eye(3)]))
def test_half_turns_have_one_quaternion(axis: Array) -> None:
    pose = iksel.pose_from_quaternion(np.zeros(3), [0.0, *axis])
    np.testing.assert_array_equal(
        iksel.quaternion_from_pose(pose), [0.0, *np.abs(axis)]
    )
    assert np.linalg.norm(iksel.rotation_vector_from_pose(pose)) == math.pi


def test_identity_is_exact() -> None:
    np.testing.assert_array_equal(
        iksel.pose_from_quaternion(np.zeros(3), [1, 0, 0, 0]), np.eye(4)
    )
    np.testing.assert_array_equal(
        iksel.pose_from_rotation_vector(np.zeros(3), np.zeros(3)), np.eye(4)
    )
    np.testing.assert_array_equal(iksel.pose_from_euler([0] * 3, [0] * 3), np.eye(4))
    np.testing.assert_array_equal(iksel.quaternion_from_pose(np.eye(4)), [1, 0, 0, 0])
    np.testing.assert_array_equal(iksel.rotation_vector_from_pose(np.eye(4)), [0] * 3)
    np.testing.assert_array_equal(iksel.euler_from_pose(np.eye(4)), [0] * 3)


@given(eulers)
def test_euler_is_the_urdf_convention(rpy: Array) -> None:
    roll, pitch, yaw = rpy
    expected = rotation_about("z", yaw) @ rotation_about("y", pitch)
    expected = expected @ rotation_about("x", roll)
    pose = iksel.pose_from_euler([1.0, 2.0, 3.0], rpy)
    np.testing.assert_allclose(pose[:3, :3], expected, rtol=0, atol=1e-15)
    np.testing.assert_array_equal(pose[:3, 3], [1.0, 2.0, 3.0])
    np.testing.assert_array_equal(pose[3], [0.0, 0.0, 0.0, 1.0])


@given(eulers)
def test_euler_comes_back_as_the_same_rotation(rpy: Array) -> None:
    pose = iksel.pose_from_euler(np.zeros(3), rpy)
    back = iksel.euler_from_pose(pose)
    assert abs(back[1]) <= math.pi / 2 + 1e-15
    again = iksel.pose_from_euler(np.zeros(3), back)
    np.testing.assert_allclose(again, pose, rtol=0, atol=1e-14)
    if abs(rpy[1]) < 1.5:
        turned = (back - rpy + math.pi) % (2 * math.pi) - math.pi
        np.testing.assert_allclose(turned, 0.0, rtol=0, atol=1e-13)


@given(poses)
def test_matrix_comes_back(pose: Array) -> None:
    again = iksel.pose_from_matrix(pose[:3, 3], pose[:3, :3])
    np.testing.assert_array_equal(again, pose)


@given(poses, poses)
def test_pose_error_is_a_distance(a: Array, b: Array) -> None:
    position, rotation = iksel.pose_error(a, b)
    assert position >= 0
    assert 0 <= rotation <= math.pi + 1e-15
    assert iksel.pose_error(a, a) == (0.0, pytest.approx(0.0, abs=1e-15))
    back = iksel.pose_error(b, a)
    assert back[0] == position
    assert back[1] == pytest.approx(rotation, abs=1e-14)
    # Not changed by seeing both from another frame.
    moved = iksel.pose_error(inverse(a) @ a, inverse(a) @ b)
    assert moved[0] == pytest.approx(position, abs=1e-13)
    assert moved[1] == pytest.approx(rotation, abs=1e-13)


@given(positions, rotation_vectors(), axes(), angles)
def test_pose_error_is_the_angle_between(
    position: Array, vector: Array, axis: Array, angle: float
) -> None:
    pose = iksel.pose_from_rotation_vector(position, vector)
    turned = pose.copy()
    turn = iksel.pose_from_rotation_vector(np.zeros(3), axis * angle)
    turned[:3, :3] = turn[:3, :3] @ pose[:3, :3]
    assert iksel.pose_error(turned, pose)[1] == pytest.approx(angle, abs=1e-14)


@given(poses, poses)
def test_pose_error_agrees_with_the_core(a: Array, b: Array) -> None:
    position, rotation = iksel.pose_error(a, b)
    core = iksel_cpp.pose_error(a, b)
    assert position == pytest.approx(np.linalg.norm(core[:3]), abs=1e-14)
    assert rotation == pytest.approx(np.linalg.norm(core[3:]), abs=1e-13)


def test_leading_axes_are_kept() -> None:
    random = np.random.default_rng(4)
    position = random.normal(size=(5, 2, 3))
    vector = random.normal(size=(5, 2, 3))
    poses_ = iksel.pose_from_rotation_vector(position, vector)
    assert poses_.shape == (5, 2, 4, 4)
    for index in np.ndindex(5, 2):
        one = iksel.pose_from_rotation_vector(position[index], vector[index])
        np.testing.assert_array_equal(poses_[index], one)
    for function, tail in (
        (iksel.quaternion_from_pose, (4,)),
        (iksel.rotation_vector_from_pose, (3,)),
        (iksel.euler_from_pose, (3,)),
        (iksel.is_rigid, ()),
    ):
        many = function(poses_)
        assert many.shape == (5, 2, *tail)
        np.testing.assert_array_equal(many[3, 1], function(poses_[3, 1]))


def test_leading_axes_are_broadcast() -> None:
    rpy = np.random.default_rng(5).normal(size=(7, 3))
    many = iksel.pose_from_euler([1.0, 2.0, 3.0], rpy)
    assert many.shape == (7, 4, 4)
    np.testing.assert_array_equal(many[:, :3, 3], np.tile([1.0, 2.0, 3.0], (7, 1)))
    position, rotation = iksel.pose_error(many, many[2])
    assert position.shape == rotation.shape == (7,)
    assert rotation[2] == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize(
    ("function", "width"),
    [
        (iksel.pose_from_quaternion, 4),
        (iksel.pose_from_rotation_vector, 3),
        (iksel.pose_from_euler, 3),
    ],
)
def test_no_poses_are_no_poses(function: Callable[..., Array], width: int) -> None:
    none = function(np.empty((0, 3)), np.empty((0, width)))
    assert none.shape == (0, 4, 4)
    assert iksel.check_pose(none).shape == (0, 4, 4)
    assert iksel.quaternion_from_pose(none).shape == (0, 4)


def test_inputs_are_not_written() -> None:
    pose = iksel.pose_from_euler([1, 2, 3], [0.1, 0.2, 0.3])
    before = pose.copy()
    made = iksel.pose_from_matrix(pose[:3, 3], pose[:3, :3])
    made[:] = 0.0
    np.testing.assert_array_equal(pose, before)


def test_small_denormalisation_is_taken_out() -> None:
    q = np.array([0.5, 0.5, 0.5, 0.5]) * 1.0009
    pose = iksel.pose_from_quaternion(np.zeros(3), q)
    assert iksel.is_rigid(pose, 1e-15)


def test_float32_poses_are_rigid() -> None:
    pose = iksel.pose_from_euler([1, 2, 3], [0.1, 0.2, 0.3]).astype(np.float32)
    assert iksel.is_rigid(pose)
    assert iksel.check_pose(pose).dtype == np.float64


def test_agrees_with_scipy() -> None:
    spatial = pytest.importorskip("scipy.spatial.transform")
    longest = math.pi / math.sqrt(3)
    vector = np.random.default_rng(6).uniform(-longest, longest, (300, 3))
    theirs = spatial.Rotation.from_rotvec(vector)
    ours = iksel.pose_from_rotation_vector(np.zeros(3), vector)
    np.testing.assert_allclose(ours[:, :3, :3], theirs.as_matrix(), rtol=0, atol=1e-14)
    quaternion = iksel.quaternion_from_pose(ours)[:, [1, 2, 3, 0]]
    np.testing.assert_allclose(
        quaternion, theirs.as_quat(canonical=True), rtol=0, atol=1e-14
    )
    np.testing.assert_allclose(
        iksel.euler_from_pose(ours), theirs.as_euler("xyz"), rtol=0, atol=1e-12
    )
