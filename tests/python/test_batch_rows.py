# SPDX-License-Identifier: BSD-3-Clause
"""Rows of a batch that are no poses have a status of their own and change no other."""

from __future__ import annotations

import numpy as np
import pytest

import iksel

SEED = 41
FIELDS = (
    "q",
    "status",
    "position_error",
    "rotation_error",
    "attempts",
    "iterations",
    "move",
    "proof",
)


def bad_poses():
    nan, row = np.eye(4), np.eye(4)
    nan[0, 3], row[3, 0] = np.nan, 0.5
    return [
        nan,
        row,
        np.diag([1.0, 1.0, -1.0, 1.0]),
        np.diag([1.01, 1.0, 1.0, 1.0]),
        np.full((4, 4), np.inf),
        np.zeros((4, 4)),
        np.full((4, 4), 1e200),
    ]


def mixed(good):
    """Bad rows among the good, and where the good ones are."""
    rng = np.random.default_rng(SEED)
    bad = bad_poses()
    is_good = rng.random(2 * len(good)).argsort().argsort() < len(good)
    poses = np.array([bad[i % len(bad)] for i in range(len(is_good))])
    poses[is_good] = good
    return poses, is_good


def wishes(name, n):
    return {
        "plain": {},
        "near": {"near": np.zeros(6)},
        "filter": {"filter": lambda q: q[:, 0] > 0},
        "task": {"task": iksel.Task.free_spin()},
        "seeds": {"seeds": np.zeros((1, 6))},
        "near of each": {"near": np.linspace(-1, 1, 6 * n).reshape(n, 6)},
    }[name]


@pytest.mark.parametrize("threads", [1, 2, 5])
@pytest.mark.parametrize(
    "name", ["plain", "near", "filter", "task", "seeds", "near of each"]
)
@pytest.mark.parametrize("preset", ["default", "paper"])
def test_bad_rows_change_no_other(made, preset, name, threads) -> None:
    solver = made.solver("ur3", preset)
    n = 300 if name == "plain" and preset == "default" else 30
    good = solver.robot.fk(solver.robot.random_configurations(n, SEED))
    good[::7, :3, 3] += 5.0
    # Some are rounded.
    good[1::3] = np.round(good[1::3], 6)
    alone = solver.solve_batch(good, **wishes(name, n))
    poses, is_good = mixed(good)
    request = wishes(name, n)
    if name == "near of each":
        spread = np.zeros((len(poses), 6))
        spread[is_good] = request["near"]
        request["near"] = spread
    batch = solver.solve_batch(poses, threads=threads, **request)
    for field in FIELDS:
        ours = getattr(batch, field)
        np.testing.assert_array_equal(ours[is_good], getattr(alone, field), field)
        if field == "status":
            assert (ours[~is_good] == iksel.Status.invalid_pose).all(), f"seed {SEED}"
        elif ours.dtype.kind == "f":
            assert np.isnan(ours[~is_good]).all()
        else:
            assert (ours[~is_good] == 0).all()
    assert batch.solved == alone.solved > 0
    assert not batch.success[~is_good].any()


def test_a_row_says_what_it_is(made) -> None:
    poses = np.array([np.eye(4), bad_poses()[0]])
    batch = made.solver("ur3").solve_batch(poses)
    assert batch[1].status is iksel.Status.invalid_pose
    assert batch[1].q is None
    assert not batch[1].success
    assert batch.statuses()[1].name == "invalid_pose"
    assert int(batch.status[1]) == int(iksel.Status.invalid_pose)


@pytest.mark.parametrize("bad", bad_poses())
def test_all_rows_may_be_bad(made, bad) -> None:
    batch = made.solver("ur3").solve_batch(np.array([bad] * 3), near=np.zeros(6))
    assert [status.name for status in batch.statuses()] == ["invalid_pose"] * 3


@pytest.mark.parametrize("bad", bad_poses())
def test_raise_names_the_first_and_solves_none(made, bad) -> None:
    solver = made.solver("ur3")
    poses = np.tile(np.eye(4), (9, 1, 1))
    poses[5] = poses[7] = bad
    for request in ({}, {"near": np.zeros(6)}):
        with pytest.raises(iksel.InvalidArgumentError, match=r"^poses\[5\]: not"):
            solver.solve_batch(poses, on_invalid_pose="raise", threads=2, **request)

    def never(_q):
        raise AssertionError

    with pytest.raises(iksel.InvalidArgumentError, match=r"^poses\[5\]"):
        solver.solve_batch(poses, filter=never, on_invalid_pose="raise")
    assert len(solver.solve_batch(poses[:5], on_invalid_pose="raise")) == 5


@pytest.mark.parametrize("bad", bad_poses())
def test_single_poses_and_paths_still_raise(made, bad) -> None:
    solver = made.solver("ur3")
    for call in (
        solver.solve,
        solver.solve_all,
        solver.diagnose,
        lambda pose: solver.solve(pose, near=np.zeros(6)),
        lambda pose: solver.tracker(np.zeros(6)).track(pose, 0.1),
    ):
        with pytest.raises(iksel.InvalidArgumentError, match=r"^pose: not"):
            call(bad)
    with pytest.raises(iksel.InvalidArgumentError, match=r"^poses\[1\]: not"):
        solver.solve_path(np.array([np.eye(4), bad]))


def test_the_wish_is_checked(made) -> None:
    with pytest.raises(
        iksel.InvalidArgumentError, match=r"on_invalid_pose.*status, raise"
    ):
        made.solver("ur3").solve_batch(np.eye(4)[None], on_invalid_pose="ignore")
