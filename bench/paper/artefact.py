# SPDX-License-Identifier: BSD-3-Clause
"""Why the published grid does badly on UR3: singular samples that look near.

With some counts a grid puts samples exactly on q3 = 0 or q5 = 0, where a UR3 is
singular. The truncated pseudo-inverse of such a sample leaves out the very direction
that would take long, so Eq. (5) under-estimates its adjustment and ranks it first.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import iksel

if TYPE_CHECKING:
    from bench.chain import Array


def singular_first(solver: iksel.Solver, poses: Array) -> dict[str, Any]:
    """How many samples are singular, how often one ranks first, and what comes of it.

    Of the targets, "singular_first" is the share whose first sample by Eq. (5) is
    singular, "singular_both" that whose first two are; "solved_by" are those that the
    first sample solves, singular or regular.

    Args:
        solver: A solver with a full key and no TCP.
        poses: Targets, (N, 4, 4).

    Only the public interface of the database is used: its nearest samples, their poses
    and pseudo-inverses.
    """
    database, options = solver.database, solver.options
    ranks = _ranks(solver)
    full = min(6, database.dof)
    first = np.zeros(len(poses), dtype=bool)
    both = 0
    among = 0.0
    for i, pose in enumerate(poses):
        near = database.nearest(pose, options.strategy.neighbours)
        inverses = np.array([database.pseudo_inverse(k) for k in near])
        differences = _keys(pose) - _keys(np.array([database.pose(k) for k in near]))
        adjustments = np.einsum("kij,kj->ki", inverses, differences)
        best = near[np.argsort(np.linalg.norm(adjustments, axis=1))[:2]]
        among += float(np.mean(ranks[near] < full))
        first[i] = ranks[best[0]] < full
        both += int(np.all(ranks[best] < full))
    result = solver.solve_batch(poses)
    by_first = result.success & (result.attempts == 1)
    return {
        "samples": len(database),
        "singular_samples": float(np.mean(ranks < full)),
        "singular_neighbours": among / len(poses),
        "singular_first": int(first.sum()) / len(poses),
        "singular_both": both / len(poses),
        "solved_by_singular": int(by_first[first].sum()),
        "solved_by_regular": int(by_first[~first].sum()),
        "count": len(poses),
        "solved": int(result.solved),
    }


def _keys(poses: Array) -> Array:
    """[position; rotation vector], as the paper writes poses, (..., 4, 4)."""
    rotations = iksel.rotation_vector_from_pose(poses)
    return np.concatenate([poses[..., :3, 3], rotations], axis=-1)


def _ranks(solver: iksel.Solver) -> Array:
    """Rank of every sample's Jacobian at the database's own cutoff, (samples,)."""
    database, robot = solver.database, solver.robot
    q = np.array([database.q(i) for i in range(len(database))])
    values = np.linalg.svd(robot.jacobian(q), compute_uv=False)
    kept = values > database.options.pinv_cutoff * values[:, :1]
    return np.asarray(kept.sum(axis=1))
