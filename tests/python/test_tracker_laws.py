# SPDX-License-Identifier: BSD-3-Clause
"""Trackers follow known motions of random arms, be it through singularities."""

from __future__ import annotations

import os
import pickle

import numpy as np
import pytest

import iksel

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench.random_arms import SIX, random_arm

SEED = int(os.environ.get("IKSEL_TEST_SEED", "0"))
ARMS = int(os.environ.get("IKSEL_TEST_CASES", "20"))
DT = 0.004
FASTEST = 0.66
"""Of the limits of speed, by the motions."""
BUILDS = [name for name in SIX if name != "right_angles_6"]
"""Of these some are singular everywhere, and have no motion of their own."""


def motion(robot: iksel.Robot, seed: int) -> np.ndarray:
    """Straight on in joint space, from rest to rest, (steps, dof)."""
    begin, end = robot.random_configurations(2, seed=seed)
    way = end - begin
    # The fastest moment of this is 1.875 times as fast as its mean.
    seconds = 1.875 / FASTEST * np.abs(way / robot.velocity_limit).max()
    part = np.linspace(0, 1, int(seconds / DT))
    smooth = 10 * part**3 - 15 * part**4 + 6 * part**5
    return np.asarray(begin + smooth[:, None] * way)


@pytest.mark.parametrize("build", BUILDS)
def test_known_motions_of_six_joints_are_followed(build: str) -> None:
    """Where solutions meet, the tracker goes straight on, as the motion does."""
    late = steps = elsewhere = 0
    for seed in range(100 * SEED, 100 * SEED + ARMS):
        robot = random_arm(build, seed).robot
        q = motion(robot, seed)
        tracker = iksel.Solver(robot).tracker(q[0])
        results = [tracker.track(pose, DT) for pose in robot.fk(q[1:])]
        late += sum(not result for result in results)
        steps += len(results)
        elsewhere += np.abs(tracker.q - q[-1]).max() > 1e-3
    assert late <= 1e-4 * steps
    # All but at a standstill in a singularity, which way it goes on is within the
    # tolerances. Before it went straight on, 16 of 100 were late or elsewhere.
    assert elsewhere <= 1 + ARMS // 20


def test_what_it_remembers_is_pickled() -> None:
    """A copy goes through the same singularity on the same side."""
    robot = random_arm("general", 18).robot
    q = motion(robot, 18)
    poses = robot.fk(q)
    tracker = iksel.Solver(robot).tracker(q[0])
    for pose in poses[1:399]:
        tracker.track(pose, DT)
    copy = pickle.loads(pickle.dumps(tracker))
    for pose in poses[399:500]:
        np.testing.assert_array_equal(copy.track(pose, DT).q, tracker.track(pose, DT).q)
    np.testing.assert_allclose(tracker.q, q[499], atol=1e-3)
