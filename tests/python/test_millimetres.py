# SPDX-License-Identifier: BSD-3-Clause
"""Millimetres, suspected where metres are meant."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from command_line import Run

import iksel

SEED = 5


@pytest.mark.parametrize("name", ["ur3", "panda", "wx250", "irb120"])
def test_reachable_poses_in_millimetres_are_suspected(
    run: Run, tmp_path: Path, name: str
) -> None:
    """Those that a robot reaches far from its base; metres of the same never are."""
    robot = iksel.load_robot(name)
    rng = np.random.default_rng(SEED)
    near = robot.random_configurations(20, seed=SEED)
    poses = robot.fk(near)
    far = np.linalg.norm(poses[:, :3, 3] - robot.reach_centre, axis=1) > robot.reach / 4
    poses = poses[far]
    assert len(poses) > 5
    good, bad = tmp_path / "metres.npy", tmp_path / "millimetres.npy"
    np.save(good, poses)
    poses[:, :3, 3] *= 1000
    np.save(bad, poses)
    pose = " ".join(map(repr, poses[rng.integers(len(poses))].ravel().tolist()))
    hint = "looks like millimetres, and is taken as metres"
    few = ["--samples", "500"]
    for words, flag in (
        (["solve", name, *few, "--pose", pose], "--pose"),
        (["solve", name, *few, "--poses", bad, "--chunk", "3"], str(bad)),
        (["path", name, bad, *few], str(bad)),
    ):
        output = run(*words)
        assert output.code == 1, SEED
        assert output.err.startswith(f"iksel: warning: {flag}: the position "), SEED
        assert hint in output.err
        assert output.err.count("\n") == 1
    assert run("solve", name, *few, "--poses", good).err == ""


def test_metres_far_away_are_not_suspected(run: Run) -> None:
    for position in ("9 15 30", "0 0 20000", "nan 0 300"):
        words = f"solve ur3 --samples 500 --pose {position} 0 3 0"
        assert "millimetres" not in run(words).err
