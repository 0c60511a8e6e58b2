# SPDX-License-Identifier: BSD-3-Clause
"""Random arms among obstacles: where an answer is known to be free, one is found."""

from __future__ import annotations

import os
import zlib

import numpy as np
import pytest

import iksel

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench.random_arms import BUILDS, random_arm

SEED = int(os.environ.get("IKSEL_TEST_SEED", "7"))
ARMS = int(os.environ.get("IKSEL_TEST_CASES", "6"))
POSES = 25


def scene_of(robot: iksel.Robot, rng: np.random.Generator) -> iksel.Scene:
    """Two balls at every link, and others around the arm."""
    balls = {
        name: [[*rng.uniform(-0.05, 0.05, 3), rng.uniform(0.03, 0.08)] for _ in "ab"]
        for name in robot.link_names[1:]
    }
    scene = iksel.Scene(robot, iksel.RobotSpheres(balls))
    for i in range(int(rng.integers(3, 12))):
        pose = np.eye(4)
        pose[:3, 3] = rng.normal(size=3) * 0.5
        scene.add_sphere(f"obstacle {i}", rng.uniform(0.05, 0.25), pose)
    return scene


@pytest.mark.parametrize("build", [name for name in BUILDS if name != "right_angles_7"])
def test_a_free_answer_is_found(build: str) -> None:
    looked = 0
    for i in range(ARMS):
        robot = random_arm(build, 100 * SEED + i).robot
        rng = np.random.default_rng([SEED, i, zlib.crc32(build.encode())])
        scene = scene_of(robot, rng)
        q = robot.random_configurations(20 * POSES, seed=SEED + i)
        poses = robot.fk(q[scene.is_free(q)][:POSES])
        solver = iksel.Solver(robot)
        batch = solver.solve_batch(poses, scene=scene)
        assert batch.success.all(), f"{build}, arm {100 * SEED + i}"
        assert scene.is_free(batch.q).all()
        looked += len(poses)
        for pose in poses:
            for count in (1, 16):
                every = solver.solve_all(pose, count, scene=scene)
                assert len(every) > 0, f"{build}, arm {100 * SEED + i}, {count}"
                assert scene.is_free(every.q).all()
    assert looked > 0
