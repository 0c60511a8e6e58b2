# SPDX-License-Identifier: BSD-3-Clause
"""The extension module: robots, databases, solvers, errors, copies and pickles."""

from __future__ import annotations

import copy
import ctypes
import gc
import pickle
import sys
import threading
import time

import iksel_cpp as core
import numpy as np
import pytest

# Robot


def test_robot_from_path_and_text(robot, tmp_path):
    path = tmp_path / "arm.urdf"
    path.write_text(robot.urdf)
    links = {"base_link": robot.base_link, "tip_link": robot.tip_link}
    for source in (path, str(path), robot.urdf, "\n  " + robot.urdf.lstrip()):
        same = core.Robot.from_urdf(source, **links)
        assert same.chain_hash == robot.chain_hash
        assert same.joint_names == robot.joint_names
    assert repr(robot) == "Robot('ur3', dof=6, base_link='base_link', tip_link='tool0')"


def test_robot_refuses_what_is_no_source(tmp_path):
    with pytest.raises(core.InvalidArgumentError, match="path_or_xml"):
        core.Robot.from_urdf(3)
    with pytest.raises(core.UrdfError, match="missing.urdf"):
        core.Robot.from_urdf(tmp_path / "missing.urdf")
    with pytest.raises(core.UrdfError):
        core.Robot.from_urdf("<robot")


def test_unknown_names_list_what_there_is(robot):
    with pytest.raises(core.UnknownNameError, match="'wrist'.*tool0"):
        core.Robot.from_urdf(robot.urdf, tip_link="wrist")
    with pytest.raises(core.UnknownNameError, match="'knee'.*elbow_joint"):
        core.Robot.from_urdf(robot.urdf, locked_joints={"knee": 0.0})
    with pytest.raises(core.InvalidArgumentError, match=r"^locked_joints\['knee'\]"):
        core.Robot.from_urdf(robot.urdf, locked_joints={"knee": "bent"})
    with pytest.raises(core.InvalidArgumentError, match=r"^locked_joints: "):
        core.Robot.from_urdf(robot.urdf, locked_joints=["knee"])


def test_tcp_and_locked_joints(robot, joints):
    tcp = np.eye(4)
    tcp[:3, 3] = 0.1, 0.2, 0.3
    tool = robot.with_tcp(tcp)
    np.testing.assert_array_equal(tool.tcp, tcp)
    np.testing.assert_allclose(tool.fk(joints), robot.fk(joints) @ tcp, atol=1e-14)
    assert tool.chain_hash == robot.chain_hash
    with pytest.raises(core.InvalidArgumentError, match=r"^tcp: "):
        robot.with_tcp(2 * np.eye(4))

    elbow = robot.joint_names[2]
    locked = core.Robot.from_urdf(
        robot.urdf,
        base_link=robot.base_link,
        tip_link=robot.tip_link,
        locked_joints={elbow: joints[0, 2]},
    )
    assert locked.dof == 5
    assert locked.locked_joints == {elbow: joints[0, 2]}
    np.testing.assert_allclose(
        locked.fk(np.delete(joints[0], 2)), robot.fk(joints[0]), atol=1e-14
    )


def test_robot_facts_have_their_types(robot):
    assert robot.joint_types == [core.JointType.revolute] * 6
    assert isinstance(robot.chain_hash, int)
    assert robot.reach > 0
    assert robot.reach_centre.shape == (3,)
    assert robot.tcp.shape == (4, 4)


# Errors


def test_error_hierarchy():
    for error, bases in (
        (core.Error, (Exception,)),
        (core.UrdfError, (core.Error,)),
        (core.UnknownNameError, (core.UrdfError,)),
        (core.InvalidArgumentError, (core.Error, ValueError)),
        (core.SignatureError, (core.InvalidArgumentError, TypeError)),
        (core.DatabaseError, (core.Error,)),
        (core.DatabaseIoError, (core.DatabaseError,)),
        (core.DatabaseCorruptError, (core.DatabaseError,)),
        (core.DatabaseMismatchError, (core.DatabaseError,)),
    ):
        assert error.__bases__ == bases
        assert error.__doc__
        twin = pickle.loads(pickle.dumps(error("why")))
        assert type(twin) is error
        assert twin.args == ("why",)


# Database


@pytest.fixture(scope="module")
def database(robot):
    options = core.DatabaseOptions(key_scheme="full", rotation_weight=1.0, samples=2000)
    return core.Database.build(robot, options)


def test_database_round_trips(database, tmp_path):
    path = tmp_path / "arm.iksel"
    database.save(path)
    content = database.to_bytes()
    assert path.read_bytes() == content
    for twin in (
        core.Database.load(path),
        core.Database.load(str(path)),
        core.Database.from_bytes(content),
        pickle.loads(pickle.dumps(database)),
        copy.deepcopy(database),
    ):
        assert twin.to_bytes() == content
        assert twin.options == database.options
        assert twin.chain_hash == database.chain_hash


def test_database_file_errors(database, tmp_path):
    with pytest.raises(core.DatabaseIoError):
        core.Database.load(tmp_path / "missing.iksel")
    with pytest.raises(core.DatabaseIoError):
        database.save(tmp_path / "missing" / "arm.iksel")
    with pytest.raises(core.DatabaseCorruptError):
        core.Database.from_bytes(b"no database at all")
    with pytest.raises(core.InvalidArgumentError, match=r"^path: expected a path"):
        core.Database.load(3)


def test_database_facts(robot, database):
    assert len(database) == database.size == 2000
    assert database.dof == robot.dof
    assert database.chain_hash == robot.chain_hash
    assert database.nbytes > 2000 * 8 * (6 + 6 + 36)
    assert database.key_dimension == 6
    text = f"Database(2000 samples, dof=6, {database.options!r})"
    assert repr(database) == text


class _Allocated(ctypes.Structure):
    """The struct mallinfo2 of glibc, of which two fields count here."""

    _fields_ = tuple(
        (name, ctypes.c_size_t)
        for name in (
            *("arena", "ordblks", "smblks", "hblks", "hblkhd"),
            *("usmblks", "fsmblks", "uordblks", "fordblks", "keepcost"),
        )
    )


def allocated() -> int:
    """Bytes that the process has from malloc."""
    mallinfo = getattr(ctypes.CDLL(None), "mallinfo2", None)
    if mallinfo is None:
        pytest.skip("this C library does not tell what is allocated")
    mallinfo.restype = _Allocated
    found = mallinfo()
    return int(found.uordblks + found.hblkhd)


@pytest.mark.parametrize("preset", ["default", "paper"])
def test_nbytes_is_what_a_database_takes(made, preset):
    robot = made.robot("ur3")
    options = core.SolverOptions.paper() if preset == "paper" else core.SolverOptions()
    core.Database.build(robot, options.database)  # what is made once
    gc.collect()
    before = allocated()
    database = core.Database.build(robot, options.database)
    taken = allocated() - before
    assert database.nbytes == pytest.approx(taken, rel=0.03)


def test_samples_are_consistent(robot, database):
    for i in (0, 1234, np.int64(1999)):
        q = database.q(i)
        np.testing.assert_allclose(robot.fk(q), database.pose(i), atol=1e-12)
        inverse = database.pseudo_inverse(i)
        assert inverse.shape == (6, 6)
        jacobian = robot.jacobian(q)
        np.testing.assert_allclose(
            inverse, np.linalg.pinv(jacobian, rcond=1e-4), atol=1e-6
        )


@pytest.mark.parametrize("i", [-1, 2000, 10**9])
def test_sample_index_is_checked(database, i):
    for function in (database.q, database.pose, database.pseudo_inverse):
        with pytest.raises(core.InvalidArgumentError, match=r"^i: "):
            function(i)


def test_nearest_finds_a_sample_at_its_own_pose(database):
    found = database.nearest(database.pose(17), 5)
    assert found.dtype == np.int64
    assert found.shape == (5,)
    assert found[0] == 17
    with pytest.raises(core.InvalidArgumentError, match=r"^pose: "):
        database.nearest(np.zeros((4, 4)), 5)


def test_database_of_another_robot_is_refused(made, database):
    with pytest.raises(core.DatabaseMismatchError, match="ur5"):
        core.Solver(made.robot("ur5"), database=database)


def test_build_reports_progress_and_stops_on_an_exception(robot):
    options = core.DatabaseOptions(samples=5000)
    calls = []
    built = core.Database.build(
        robot, options, progress=lambda done, total: calls.append((done, total))
    )
    assert len(built) == 5000
    assert calls == sorted(calls)
    assert calls[-1] == (5000, 5000)

    def refuse(done, total):
        raise LookupError

    with pytest.raises(LookupError):
        core.Database.build(robot, options, progress=refuse)


@pytest.mark.skipif(sys.platform == "win32", reason="signals to oneself")
@pytest.mark.skipif(
    threading.current_thread() is not threading.main_thread(), reason="main thread only"
)
def test_interrupt_ends_a_long_build(robot, interrupted):
    endless = core.DatabaseOptions(sampling="cvt", samples=1000, cvt_updates=10**9)
    with interrupted():
        core.Database.build(robot, endless)


# Solver


def test_solver_round_trips(solver, poses):
    expected = solver.solve_batch(poses)
    for twin in (
        pickle.loads(pickle.dumps(solver)),
        copy.copy(solver),
        copy.deepcopy(solver),
    ):
        np.testing.assert_array_equal(twin.solve_batch(poses).q, expected.q)
        assert repr(twin) == repr(solver)


def test_robot_round_trips(robot, joints):
    tcp = np.eye(4)
    tcp[:3, 3] = 0.0, 0.0, 0.1
    for original in (robot, robot.with_tcp(tcp)):
        for twin in (
            pickle.loads(pickle.dumps(original)),
            copy.copy(original),
            copy.deepcopy(original),
        ):
            np.testing.assert_array_equal(twin.fk(joints), original.fk(joints))
            assert twin.chain_hash == original.chain_hash
            assert repr(twin) == repr(original)


def test_results_round_trip(solver, poses):
    far = np.eye(4)
    far[0, 3] = 9.0
    for pose in (poses[0], far):
        result = solver.solve(pose)
        twin = pickle.loads(pickle.dumps(result))
        assert repr(twin) == repr(result)
        np.testing.assert_array_equal(twin.q, result.q)
    batch = solver.solve_batch(poses)
    twin = pickle.loads(pickle.dumps(batch))
    for name in ("q", "success", "status", "position_error", "attempts", "iterations"):
        np.testing.assert_array_equal(getattr(twin, name), getattr(batch, name))
    assert repr(copy.deepcopy(batch)) == repr(batch)


def test_seed_is_tried_first(robot, solver, joints, poses):
    for q, pose in zip(joints, poses, strict=True):
        result = solver.solve(pose, seeds=[q])
        assert result.success
        assert result.attempts == 1
        np.testing.assert_allclose(result.q, q, atol=1e-5)


def test_batch_lets_other_threads_run(robot, solver):
    slow = core.Solver(robot, core.SolverOptions.paper(), solver.database)
    poses = robot.fk(robot.random_configurations(2000, 1))
    ticks = 0
    finished = threading.Event()

    def tick():
        nonlocal ticks
        while not finished.wait(0.001):
            ticks += 1

    thread = threading.Thread(target=tick)
    thread.start()
    slow.solve_batch(poses, threads=1)
    seen = ticks
    finished.set()
    thread.join()
    assert seen > 0


# Evaluation


def test_evaluation(solver):
    calls = []
    outcome = core.evaluate(
        solver, 200, seed=3, progress=lambda done, total: calls.append((done, total))
    )
    assert outcome.targets == 200
    assert outcome.seed == 3
    assert outcome.false_success == 0
    assert outcome.success_percent == pytest.approx(100 * outcome.solved / 200)
    assert outcome.min_us <= outcome.median_us <= outcome.p99_us <= outcome.max_us
    assert outcome.ratio == pytest.approx(outcome.mean_us / outcome.kdl_fk_jac_us)
    assert outcome.query_us == 0
    assert calls[-1] == (200, 200)
    assert pickle.loads(pickle.dumps(outcome)) == outcome
    assert outcome.to_dict()["seed"] == 3
    with pytest.raises(AttributeError):
        outcome.solved = 200


def test_evaluation_beside_other_work_solves_the_same(solver):
    alone = core.evaluate(solver, 20, 3)
    beside = core.evaluate(solver, 20, 3, touched=1 << 20)
    for name in ("solved", "mean_attempts", "mean_iterations", "max_iterations"):
        assert getattr(beside, name) == getattr(alone, name)
    with pytest.raises(core.InvalidArgumentError, match=r"^touched: at most \d+ bytes"):
        core.evaluate(solver, 20, 3, touched=(1 << 30) + 1)


def test_evaluation_with_stages(solver):
    outcome = core.evaluate(solver, 200, 3, stages=True)
    assert outcome.iterate_us > 0


def test_stages_of_one_solve(solver, poses):
    """Each is part of a call, and a call has no more than they are together."""
    begin = time.perf_counter()
    stages = core.stage_times(solver, poses[0])
    whole_us = 1e6 * (time.perf_counter() - begin)
    assert set(stages) == {"query_us", "rank_us", "iterate_us", "reselect_us"}
    assert min(stages.values()) >= 0
    assert 0 < sum(stages.values()) <= whole_us


def test_kdl_time_is_a_time(robot):
    assert 0 < core.time_kdl_fk_jacobian(robot) < 1e4


def test_pose_error_is_zero_only_between_equals(poses):
    np.testing.assert_allclose(core.pose_error(poses[0], poses[0]), 0, atol=1e-12)
    moved = poses[0].copy()
    moved[2, 3] += 0.25
    error = core.pose_error(moved, poses[0])
    np.testing.assert_allclose(error, [0, 0, 0.25, 0, 0, 0], atol=1e-12)
    rows = core.pose_error(poses, poses[::-1])
    assert rows.shape == (len(poses), 6)
    for row, target, pose in zip(rows, poses, poses[::-1], strict=True):
        np.testing.assert_array_equal(row, core.pose_error(target, pose))
    with pytest.raises(core.InvalidArgumentError, match="as many poses as targets"):
        core.pose_error(poses, poses[1:])
    with pytest.raises(core.InvalidArgumentError, match=r"pose: .*\(4, 4\)"):
        core.pose_error(poses[0], poses)


def test_grid_counts_are_the_papers():
    assert core.grid_counts(6, "medium") == [8, 7, 6, 6, 5, 4]
    assert core.grid_counts(7, core.Scale.small) == [6, 5, 5, 5, 4, 4, 4]
