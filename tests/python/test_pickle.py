# SPDX-License-Identifier: BSD-3-Clause
"""Everything survives pickling, copying and the trip to another process."""

from __future__ import annotations

import copy
import multiprocessing
import pickle

import numpy as np
import pytest

import iksel

PROTOCOLS = range(2, pickle.HIGHEST_PROTOCOL + 1)

each_protocol = pytest.mark.parametrize("protocol", PROTOCOLS)


def again(thing, protocol: int = pickle.HIGHEST_PROTOCOL):
    return pickle.loads(pickle.dumps(thing, protocol))


@each_protocol
@pytest.mark.parametrize("name", ["cvr038", "panda", "gen3_6dof"])
def test_robots(made, name: str, protocol: int) -> None:
    locked = made.robot(name).joint_names[1]
    for robot in (
        made.robot(name),
        iksel.load_robot(name, locked_joints={locked: 0.3}, soft_limits=True),
        made.robot(name).with_tcp(iksel.pose_from_euler([0, 0, 1], [0.1, 0.2, 0.3])),
    ):
        other = again(robot, protocol)
        q = robot.random_configurations(3, 1)
        np.testing.assert_array_equal(other.fk(q), robot.fk(q))
        np.testing.assert_array_equal(other.lower, robot.lower)
        assert other.joint_names == robot.joint_names
        assert other.chain_hash == robot.chain_hash
        assert (other.name, other.base_link, other.tip_link) == (
            robot.name,
            robot.base_link,
            robot.tip_link,
        )


@each_protocol
def test_options(protocol: int) -> None:
    for options in (
        iksel.SolverOptions(),
        iksel.SolverOptions.paper(),
        iksel.SolverOptions.paper(2026),
        iksel.SolverOptions(
            strategy=iksel.Paper(iteration="cwpi"),
            database={"sampling": "cvt", "seed": 5},
        ),
        iksel.DatabaseOptions.paper(),
        iksel.DatabaseOptions(key_scheme="full", rotation_key="matrix", samples=3),
    ):
        other = again(options, protocol)
        assert other == options
        assert other.to_dict() == options.to_dict()
        assert other is not options


@each_protocol
def test_enums(protocol: int) -> None:
    for kind in (iksel.Iteration, iksel.Status, iksel.Proof, iksel.StructureKind):
        for member in kind:
            assert again(member, protocol) is member


@each_protocol
def test_solvers_databases_and_results(made, protocol: int) -> None:
    robot = made.robot("ur3")
    options = iksel.SolverOptions(max_attempts=7, database={"samples": 500})
    solver = iksel.Solver(robot, options)
    other = again(solver, protocol)
    assert other.options == options
    assert other.database.to_bytes() == solver.database.to_bytes()
    assert again(solver.database, protocol).to_bytes() == solver.database.to_bytes()

    poses = robot.fk(robot.random_configurations(20, 2))
    poses[3, 0, 3] += 10.0
    batch = solver.solve_batch(poses)
    for same in (other.solve_batch(poses), again(batch, protocol)):
        for field in ("q", "success", "status", "proof", "position_error"):
            np.testing.assert_array_equal(getattr(same, field), getattr(batch, field))
    for pose in poses[2:4]:
        result = solver.solve(pose)
        same = again(result, protocol)
        assert same.status == result.status
        assert same.proof == result.proof
        assert same.iterations == result.iterations
        np.testing.assert_array_equal(same.q, result.q)
        np.testing.assert_array_equal(same.position_error, result.position_error)


def test_copies(made) -> None:
    solver = made.solver("ur3")
    pose = solver.robot.fk([0.1, -1.0, 1.0, 0.2, 0.3, 0.4])
    expected = solver.solve(pose).q
    for how in (copy.copy, copy.deepcopy):
        np.testing.assert_array_equal(how(solver).solve(pose).q, expected)
        pose_again = how(solver.robot).fk(expected)
        np.testing.assert_array_equal(pose_again, solver.robot.fk(expected))
        assert how(solver.options) == solver.options
        assert len(how(solver.database)) == len(solver.database)


def test_a_changed_copy_of_options_leaves_the_original() -> None:
    options = iksel.SolverOptions()
    other = copy.deepcopy(options)
    other.max_attempts = 3
    other.database.samples = 17
    assert options == iksel.SolverOptions()


def test_solvers_travel_to_other_processes(made) -> None:
    robot = made.robot("ur3")
    solver = iksel.Solver(robot, iksel.SolverOptions(database={"samples": 500}))
    poses = robot.fk(robot.random_configurations(4, 3))
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        theirs = pool.map(solver.solve, poses)
    for pose, result in zip(poses, theirs, strict=True):
        np.testing.assert_array_equal(result.q, solver.solve(pose).q)


@pytest.mark.parametrize("spoil", [lambda b: b[:-3], lambda b: b[:50] + b"x" + b[51:]])
def test_damaged_databases_are_refused(made, spoil) -> None:
    content = iksel.Database.build(
        made.robot("ur3"), iksel.DatabaseOptions(samples=50)
    ).to_bytes()
    with pytest.raises(iksel.DatabaseCorruptError):
        iksel.Database.from_bytes(spoil(content))
