# SPDX-License-Identifier: BSD-3-Clause
"""What a solver is given: arrays of any layout, and errors that name bad arguments."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

import iksel


def test_array_layouts_give_the_same_bits(made) -> None:
    solver = made.solver("ur3")
    poses = solver.robot.fk(solver.robot.random_configurations(20, 18))
    plain = solver.solve_batch(poses)
    strided = np.empty((40, 4, 4))
    strided[::2] = poses
    unaligned = np.frombuffer(b"x" + poses.tobytes(), dtype=np.uint8)[1:]
    for same in (
        np.asfortranarray(poses),
        strided[::2],
        poses.tolist(),
        poses.astype(poses.dtype.newbyteorder()),
        unaligned.view(np.float64).reshape(poses.shape),
    ):
        np.testing.assert_array_equal(solver.solve_batch(same).q, plain.q)


def test_the_pose_may_be_named(made) -> None:
    robot, solver = made.robot("ur3"), made.solver("ur3")
    pose = robot.fk([0.1, -0.5, 0.4, -1.2, 0.6, 0.3])
    # By names that are not interned, as of keywords that are read from a file.
    spelled = dict(zip(json.loads('["pose", "scene"]'), (pose, None), strict=True))
    q = solver.solve(pose).q
    for result in (
        solver.solve(pose=pose),
        solver.solve(**spelled),
        solver.solve(scene=None, pose=pose),
        solver.solve(pose, scene=None),
    ):
        np.testing.assert_array_equal(result.q, q)
    assert len(solver.solve_all(pose=pose, max=1)) == 1
    with pytest.raises(TypeError, match="'pose' twice"):
        solver.solve(pose, pose=pose, scene=None)
    with pytest.raises(TypeError, match="pose"):
        solver.solve(scene=None)


def test_no_targets_have_no_answers(made) -> None:
    solver = made.solver("ur3")
    batch = solver.solve_batch(np.empty((0, 4, 4)))
    assert len(batch) == 0
    assert batch.q.shape == (0, 6)


def test_arguments_are_not_changed(made) -> None:
    solver = made.solver("ur3")
    pose = solver.robot.fk(solver.robot.random_configurations(1, 19)[0])
    q = solver.robot.random_configurations(1, 19)[0]
    pose_before, q_before = pose.copy(), q.copy()
    solver.solve(pose, seeds=q)
    np.testing.assert_array_equal(pose, pose_before)
    np.testing.assert_array_equal(q, q_before)
    with pytest.raises(ValueError, match="read-only"):
        solver.robot.lower[0] = 0.0


def bad_poses() -> dict[str, object]:
    nan, sheared, row = np.eye(4), np.eye(4), np.eye(4)
    nan[1, 3] = math.nan
    sheared[0, 1] = 0.1
    row[3, 0] = 0.5
    return {
        "NaN": nan,
        "sheared": sheared,
        "last row": row,
        "mirrored": np.diag([1.0, 1.0, -1.0, 1.0]),
        "3x3": np.eye(3),
        "flat": np.eye(4).ravel(),
        "text": "pose",
        "nothing": None,
        "complex": np.eye(4, dtype=complex),
    }


@pytest.mark.parametrize("culprit", bad_poses())
def test_bad_poses_are_refused(made, culprit: str) -> None:
    solver, pose = made.solver("ur3"), bad_poses()[culprit]
    with pytest.raises(iksel.InvalidArgumentError, match="^pose"):
        solver.solve(pose)
    with pytest.raises(iksel.InvalidArgumentError, match="^poses"):
        solver.solve_batch(pose)


@pytest.mark.parametrize("culprit", ["NaN", "sheared", "last row", "mirrored"])
def test_the_first_bad_pose_of_a_batch_is_named(made, culprit: str) -> None:
    poses = np.tile(np.eye(4), (9, 1, 1))
    poses[5] = poses[7] = bad_poses()[culprit]
    with pytest.raises(iksel.InvalidArgumentError, match=r"^poses\[5\]"):
        made.solver("ur3").solve_batch(poses, threads=2, on_invalid_pose="raise")


@pytest.mark.parametrize(
    "seeds", [[0.0] * 5, [[0.0] * 7], [0, 0, 0, 0, 0, math.inf], "seed", 1.0]
)
def test_bad_seeds_are_refused(made, seeds) -> None:
    with pytest.raises(iksel.InvalidArgumentError, match="^seeds"):
        made.solver("ur3").solve(np.eye(4), seeds=seeds)


@pytest.mark.parametrize("threads", [-1, 10**9, 1.5, "two", None])
def test_bad_thread_counts_are_refused(made, threads) -> None:
    with pytest.raises(iksel.InvalidArgumentError, match="threads"):
        made.solver("ur3").solve_batch(np.tile(np.eye(4), (2, 1, 1)), threads=threads)


@pytest.mark.parametrize(
    ("options", "culprit"),
    [
        ({"position_tolerance": 0.0}, "position_tolerance"),
        ({"position_tolerance": math.nan}, "position_tolerance"),
        ({"rotation_tolerance": -1.0}, "rotation_tolerance"),
        ({"strategy": {"name": "lanes", "neighbours": 0}}, "neighbours"),
        ({"strategy": {"name": "paper", "candidates": -1}}, "candidates"),
        ({"max_attempts": 0}, "max_attempts"),
        ({"max_iterations": 2.5}, "max_iterations"),
        ({"strategy": {"name": "lanes", "damping": "small"}}, "damping"),
        ({"strategy": {"name": "paper", "whole_turns": 1}}, "whole_turns"),
        ({"seed": -1}, "seed"),
        ({"strategy": {"name": "paper", "iteration": "newton"}}, "iteration.*dls.*lm"),
        ({"strategy": {"name": "paper", "ranking": 3}}, "ranking.*nearest"),
        ({"strategy": "newton"}, "no strategy 'newton'; there are: lanes, paper"),
        ({"strategy": 3}, "strategy: expected Lanes, Paper"),
        ({"strategy": {"damping": 1}}, "strategy: a mapping needs 'name'"),
        ({"database": {"sampling": "sobol"}}, "sampling.*grid.*cvt"),
        ({"database": {"threads": -2}}, "threads"),
        ({"database": {"rotation_weight": -1.0}}, "rotation_weight"),
    ],
    ids=str,
)
def test_bad_options_are_named(options, culprit: str) -> None:
    with pytest.raises(iksel.InvalidArgumentError, match=culprit):
        iksel.SolverOptions(**options)
    with pytest.raises(iksel.InvalidArgumentError, match=culprit):
        iksel.SolverOptions().replace(**options)


@pytest.mark.parametrize("field", ["ranking", "iteration", "damping"])
def test_fields_of_a_strategy_are_told_where_they_belong(field: str) -> None:
    where = rf"no field '{field}'; it belongs to the strategy: .*Paper\({field}="
    with pytest.raises(iksel.SignatureError, match=where):
        iksel.SolverOptions(**{field: 1})
    assert not hasattr(iksel.SolverOptions(), field)


def test_unknown_options_list_the_known() -> None:
    with pytest.raises(TypeError, match="max_attempts"):
        iksel.SolverOptions(attempts=3)
