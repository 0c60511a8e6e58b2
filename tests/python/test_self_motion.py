# SPDX-License-Identifier: BSD-3-Clause
"""The arcs of a self-motion in Python."""

from __future__ import annotations

import itertools
import pickle

import numpy as np
import pytest

import iksel


@pytest.fixture(scope="module", params=["panda", "iiwa14", "xarm7"])
def solver(made, request) -> iksel.Solver:
    return made.solver(request.param)


def poses_of(solver: iksel.Solver, count: int) -> np.ndarray:
    return solver.robot.fk(solver.robot.random_configurations(count, 5))


def test_every_configuration_reaches_the_pose(solver) -> None:
    robot = solver.robot
    for pose in poses_of(solver, 5):
        motion = solver.self_motion(pose, spacing=0.2)
        assert motion
        assert motion.success
        assert motion.status is iksel.Status.solved
        assert len(motion) == len(list(motion))
        for arc in motion:
            assert arc.q.shape == (len(arc), 7)
            assert arc.elbow.shape in {(0,), (len(arc),)}
            error = iksel.pose_error(
                np.broadcast_to(pose, (len(arc), 4, 4)), robot.fk(arc.q)
            )
            assert np.abs(error).max() <= 2e-6
            assert ((arc.q >= robot.lower) & (arc.q <= robot.upper)).all()


def test_ends_name_a_joint_at_its_limit(solver) -> None:
    robot = solver.robot
    for pose in poses_of(solver, 20):
        for arc in solver.self_motion(pose):
            assert arc.is_closed == (arc.begin.kind is iksel.ArcEnd.closed)
            for end, q in ((arc.begin, arc.q[0]), (arc.end, arc.q[-1])):
                if end.kind is not iksel.ArcEnd.limit:
                    assert end.joint == -1
                    continue
                limit = robot.upper if end.at_upper else robot.lower
                assert q[end.joint] == pytest.approx(limit[end.joint], abs=1e-5)
                assert f"joint {end.joint + 1} at its" in repr(end)


def test_no_loop_is_given_twice(made) -> None:
    """Also where a place that a sweep finds lies on the piece that closes a loop."""
    solver = made.solver("xarm7")
    q = solver.robot.random_configurations(4000, 5)
    for pose in solver.robot.fk(q[[2770, 3008, 3218, 3307, 3653, *range(50)]]):
        loops = [
            arc.q for arc in solver.self_motion(pose, spacing=0.3) if arc.is_closed
        ]
        for first, second in itertools.combinations(loops, 2):
            pieces = wrapped(np.roll(first, -1, axis=0) - first)
            away = wrapped(second[0] - first)
            place = (away * pieces).sum(axis=1) / (pieces**2).sum(axis=1)
            off = away - np.clip(place, 0, 1)[:, None] * pieces
            assert np.linalg.norm(off, axis=1).min() > 0.02


def wrapped(angles: np.ndarray) -> np.ndarray:
    return (angles + np.pi) % (2 * np.pi) - np.pi


def test_only_an_arm_with_an_elbow_has_its_angle(made) -> None:
    for name, has_elbow in (("iiwa14", True), ("panda", False), ("xarm7", False)):
        solver = made.solver(name)
        arc = solver.self_motion(poses_of(solver, 1)[0])[0]
        assert (len(arc.elbow) > 0) == has_elbow


def test_near_lies_on_an_arc(solver) -> None:
    robot = solver.robot
    near = robot.random_configurations(5, 8)
    for pose, q in zip(poses_of(solver, 5), near, strict=True):
        answer = solver.solve(pose, near=q)
        turns = 2 * np.pi * (robot.upper - robot.lower >= 2 * np.pi)
        least = np.inf
        for arc in solver.self_motion(pose, spacing=0.02):
            away = arc.q - answer.q
            away -= np.where(turns > 0, 2 * np.pi * np.round(away / (2 * np.pi)), 0.0)
            least = min(least, np.abs(away).max(axis=1).min())
        assert least <= 0.02


@pytest.mark.parametrize(("name", "joint"), [("panda", 3), ("panda", 5), ("fr3", 3)])
def test_an_arc_goes_on_where_it_touches_a_limit(made, name, joint) -> None:
    """The curve turns back there: both of its sides are inside."""
    solver = made.solver(name)
    robot = solver.robot
    for known in robot.random_configurations(30, 4):
        q = known.copy()
        q[joint], q[4] = robot.upper[joint], 0.0
        pose = robot.fk(q)
        every = np.vstack([arc.q for arc in solver.self_motion(pose, spacing=0.05)])
        for turn in (-0.3, 0.3):
            start = q.copy()
            start[6] = np.clip(q[6] + turn, robot.lower[6], robot.upper[6])
            near = solver.solve(pose, near=start)
            assert near
            assert np.abs(every - near.q).max(axis=1).min() <= 0.06


def test_out_of_reach_and_indices(solver) -> None:
    far = np.eye(4)
    far[0, 3] = 9.0
    none = solver.self_motion(far)
    assert not none
    assert len(none) == 0
    assert none.status is iksel.Status.out_of_reach
    assert none.proof is iksel.Proof.reach
    assert none.proven
    with pytest.raises(IndexError):
        none[0]


def test_pickle(solver) -> None:
    motion = solver.self_motion(poses_of(solver, 1)[0])
    again = pickle.loads(pickle.dumps(motion))
    assert again.status is motion.status
    for a, b in zip(again, motion, strict=True):
        np.testing.assert_array_equal(a.q, b.q)
        np.testing.assert_array_equal(a.elbow, b.elbow)
        assert a.length == b.length
        assert (a.end.kind, a.end.joint) == (b.end.kind, b.end.joint)
    assert repr(again) == repr(motion)


def test_errors_name_the_culprit(made) -> None:
    pose = np.eye(4)
    with pytest.raises(
        iksel.InvalidArgumentError, match="robot 'ur3' has no self-motion"
    ):
        made.solver("ur3").self_motion(pose)
    panda = made.solver("panda")
    with pytest.raises(iksel.InvalidArgumentError, match=r"^spacing: "):
        panda.self_motion(pose, spacing=0.0)
    with pytest.raises(iksel.InvalidArgumentError, match=r"^spacing: "):
        panda.self_motion(pose, spacing="wide")
    with pytest.raises(iksel.InvalidArgumentError, match=r"^pose: "):
        panda.self_motion(np.zeros((3, 3)))
    options = iksel.SolverOptions(task=iksel.Task.free_spin())
    spins = iksel.Solver(panda.robot, options)
    with pytest.raises(iksel.InvalidArgumentError, match="task with free axes"):
        spins.self_motion(pose)
