# SPDX-License-Identifier: BSD-3-Clause
"""What Python adds to closest=True; that it is nearest is shown in C++."""

import copy
import pickle

import numpy as np
import pytest
from command_line import assert_bad
from tubes import LENGTHS, NAMES, URDF

import iksel


@pytest.fixture(scope="module")
def solver():
    return iksel.Solver(iksel.load_robot("ur5e"))


@pytest.fixture(scope="module")
def far(solver):
    """A target beyond reach."""
    pose = solver.robot.fk(np.full(6, 0.5))
    pose[:3, 3] *= 3
    return pose


def test_closest_has_joints_and_is_no_success(solver, far):
    assert solver.solve(far).q is None
    result = solver.solve(far, closest=True)
    assert not result
    assert result.status == iksel.Status.closest
    assert solver.robot.within_limits(result.q)
    position, rotation = iksel.pose_error(far, solver.robot.fk(result.q))
    assert result.position_error == pytest.approx(position)
    assert result.rotation_error == pytest.approx(rotation)
    assert "closest" in repr(result)
    assert "q=" in repr(result)
    assert np.array_equal(pickle.loads(pickle.dumps(result)).q, result.q)


def test_false_and_none_ask_for_nothing(solver, far):
    assert solver.solve(far, closest=False).q is None
    assert solver.solve(far, closest=None).q is None


def test_weights_choose_what_counts(solver, far):
    position = solver.solve(far, closest=[1, 1, 1, 0.001, 0.001, 0.001])
    rotation = solver.solve(far, closest=(0.001, 0.001, 0.001, 1, 1, 1))
    assert position.position_error < rotation.position_error
    assert position.rotation_error > rotation.rotation_error
    only_height = solver.solve(far, closest=[0, 0, 1, 0, 0, 0])
    assert only_height.status == iksel.Status.closest


def test_rows_of_a_batch_are_those_of_solve(solver, far):
    poses = np.array([far, solver.robot.fk(np.full(6, 0.4)), far])
    for threads in (1, 2):
        batch = solver.solve_batch(poses, closest=True, threads=threads)
        assert [status.name for status in batch.statuses()] == [
            "closest",
            "solved",
            "closest",
        ]
        assert np.array_equal(batch.q[0], solver.solve(far, closest=True).q)
        assert np.array_equal(batch.q[0], batch[2].q)
        assert np.isfinite(batch.q).all()
        again = pickle.loads(pickle.dumps(batch))
        assert np.array_equal(again.q, batch.q)
        assert "closest" in batch._repr_html_()


@pytest.mark.parametrize(
    "weights",
    [[1, 1, 1], "near", [0] * 6, [1, 1, 1, 1, 1, -1], [1, 1, 1, 1, 1, np.nan], 7],
)
def test_wrong_weights_are_named(solver, far, weights):
    with pytest.raises(iksel.InvalidArgumentError, match="closest"):
        solver.solve(far, closest=weights)


def test_tracker_stays_at_the_edge(solver, far):
    start = np.full(6, 0.5)
    stays = iksel.Tracker(solver, start)
    assert stays.track(far, 10.0).q is None
    assert np.array_equal(stays.q, start)
    goes = solver.tracker(start, closest=True)
    result = goes.track(far, 1000.0)
    assert result.status == iksel.Status.closest
    assert np.array_equal(result.q, goes.q)
    assert not np.array_equal(goes.q, start)
    for weights in (True, None, [1.0, 1.0, 1.0, 0.5, 0.5, 0.5]):
        tracker = iksel.Tracker(solver, start, closest=weights)
        again = copy.deepcopy(tracker)
        first, second = tracker.track(far, 1000.0), again.track(far, 1000.0)
        assert first.status == second.status
        assert np.array_equal(tracker.q, again.q)
    with pytest.raises(iksel.InvalidArgumentError, match="closest"):
        iksel.Tracker(solver, start, closest=[1, 2])


def test_copies_of_a_tracker_come_back_alike(solver):
    tracker = solver.tracker([0.3, -0.8, 0.6, -0.4, -1.2, 0.2], closest=True)
    pose = solver.robot.fk(tracker.q)
    start = tracker.q
    away = pose.copy()
    away[:3, 3] *= 1.5
    for _ in range(500):
        status = tracker.track(away, 0.01).status
    assert status == iksel.Status.closest
    assert np.allclose(tracker.reached, start, atol=1e-6)
    again = pickle.loads(pickle.dumps(tracker))
    for _ in range(500):
        tracker.track(pose, 0.01)
        again.track(pose, 0.01)
        assert np.array_equal(tracker.q, again.q)
    assert np.allclose(solver.robot.fk(tracker.q), pose, atol=1e-5)
    assert np.array_equal(tracker.reached, tracker.q)


def test_in_a_scene_it_is_free():
    arm = iksel.Robot.from_urdf(URDF, base_link="l0", tip_link="l6")
    links = {
        name: np.array([[0, 0, z, 0.045] for z in np.linspace(0, length, 8)])
        for name, length in zip(NAMES, LENGTHS, strict=True)
    }
    solver = iksel.Solver(arm)
    rng = np.random.default_rng(3)
    given = none = 0
    for q in arm.random_configurations(300, seed=3):
        pose = arm.fk(q)
        pose[:3, 3] *= 1.3
        scene = iksel.Scene(arm, iksel.RobotSpheres(links, []))
        scene.add_box("box", rng.uniform(0.1, 0.3, 3), rng.uniform(-0.6, 0.6, 3))
        alone = solver.solve(pose, closest=True)
        result = solver.solve(pose, closest=True, scene=scene)
        if alone.status != iksel.Status.closest:
            continue
        if result.status != iksel.Status.closest:
            assert result.q is None
            assert not scene.is_free(alone.q)
            none += 1
            continue
        assert scene.is_free(result.q)
        given += 1
        if scene.is_free(alone.q):
            assert np.array_equal(result.q, alone.q)
        else:
            assert missing(solver, pose, result.q) > missing(solver, pose, alone.q)
    assert given > 20
    assert 0 < none < given


def test_an_answer_that_the_search_had_missed_has_a_cost(solver):
    """One iteration is too few for the search, not for what looks for the closest."""
    hasty = iksel.Solver(solver.robot, iksel.SolverOptions(max_iterations=1))
    q = solver.robot.random_configurations(1, seed=3)[0]
    wish = {
        "seeds": [q + 0.1],
        "database_seeds": False,
        "objective": iksel.Objective.far_from_limits(),
    }
    assert not hasty.solve(solver.robot.fk(q), **wish)
    found = hasty.solve(solver.robot.fk(q), closest=True, **wish)
    assert found
    assert np.isfinite(found.cost)


def missing(solver, pose, q):
    """What is missing by the default weights."""
    position, rotation = iksel.pose_error(pose, solver.robot.fk(q))
    return np.hypot(position, rotation * solver.robot.reach / 4)


def test_command_line(run):
    pose = ["--pose", "2", "0", "0.3", "0", "0", "0"]
    output = run("solve", "ur5e", *pose, "--closest", "--json")
    assert output.code == 1
    report = output.json()
    assert report["status"] == "closest"
    assert not report["success"]
    assert len(report["q"]) == 6
    assert_bad(run("solve", "ur5e", *pose, "--closest", "--all"), "--closest")
