# SPDX-License-Identifier: BSD-3-Clause
"""How spheres are chosen: the one that holds most of what is left, each time."""

from __future__ import annotations

import numpy as np

from iksel.collision._sphere_cover import _choose, _fill

SEED = 4


def test_the_ball_that_holds_most_of_those_left_is_chosen() -> None:
    rng = np.random.default_rng(SEED)
    samples = rng.uniform(-1, 1, (2_000, 3))
    centres, radii = rng.uniform(-1, 1, (150, 3)), rng.uniform(0.05, 0.6, 150)
    holds = np.linalg.norm(samples - centres[:, None], axis=2) <= radii[:, None]
    left = np.ones(len(samples), dtype=bool)
    expected = []
    while (gains := (holds & left).sum(axis=1)).max() > 0:
        expected.append(gains.argmax())
        left &= ~holds[expected[-1]]
    chosen, rest = _choose(centres, radii, samples)
    np.testing.assert_array_equal(chosen, expected)
    np.testing.assert_array_equal(rest, samples[left])
    assert 0 < left.sum() < len(samples)


def test_what_is_left_is_near_some_of_it() -> None:
    samples = np.random.default_rng(SEED).uniform(-1, 1, (2_000, 3))
    chosen = _fill(samples, 0.3)
    apart = np.linalg.norm(samples[:, None] - chosen, axis=2)
    assert apart.min(axis=1).max() <= 0.3
    among = np.linalg.norm(chosen[:, None] - chosen, axis=2)
    assert np.all(among[~np.eye(len(chosen), dtype=bool)] > 0.3)
    assert _fill(np.zeros((0, 3)), 0.3).shape == (0, 3)
    assert len(_choose(np.zeros((0, 3)), np.zeros(0), samples)[0]) == 0
