# SPDX-License-Identifier: BSD-3-Clause
"""Random arms of which some joints follow others, as mimic tags say."""

from __future__ import annotations

import re

import numpy as np
import pytest

import iksel

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench.random_arms import BUILDS, sketch

FACTORS = (1.0, -1.0, 0.5, -0.5, 2.0)


def with_follower(
    urdf: str, follower: int, leader: int, factor: float, offset: float = 0.0
) -> str:
    """The URDF of a random arm, a joint of which follows another by a mimic tag."""
    tag = f'<mimic joint="j{leader}" multiplier="{factor}" offset="{offset}"/>'
    joint = rf'(<joint name="j{follower}".*?)</joint>'
    return re.sub(joint, rf"\1{tag}</joint>", urdf)


def following_arm(seed: int) -> iksel.Robot | None:
    """An arm of some build, one or two of whose joints follow others.

    None, if limits of joints and their followers leave nothing.
    """
    rng = np.random.default_rng([seed, 77])
    build = list(BUILDS)[rng.integers(len(BUILDS))]
    urdf = sketch(build, int(rng.integers(1_000_000))).urdf()
    count = len(re.findall(r'<joint name="j\d+"', urdf))
    order = rng.permutation(count) + 1
    for i in range(int(rng.integers(1, 3))):
        follower, leader = order[2 * i : 2 * i + 2]
        factor = rng.uniform(-2, 2) if rng.random() < 0.2 else rng.choice(FACTORS)
        offset = rng.uniform(-1, 1) if rng.random() < 0.5 else 0.0
        urdf = with_follower(urdf, follower, leader, factor, offset)
    try:
        return iksel.Robot.from_urdf(urdf, "l0", "tip")
    except iksel.UrdfError:
        return None
