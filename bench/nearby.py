# SPDX-License-Identifier: BSD-3-Clause
"""Whether a move of a redundant arm is a local minimum: beside solutions around it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import iksel

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array

STEPS = (0.02, 0.05, 0.1)
"""How far from an answer along its self-motion [rad]."""
OF_EACH = 50
"""Directions of each."""
RIGHT = 6
"""Equations of a pose: the singular vectors after these are of the self-motion."""
GAIN = 1e-6
"""A move that is shorter by less is not [rad]."""


def is_least_nearby(arm: Arm, pose: Array, near: Array, q: Array) -> bool:
    """Whether no solution around q has a shorter move from `near`.

    The neighbours are steps along random directions of the self-motion, put back inside
    the limits and onto the pose by the iteration alone.

    Args:
        arm: Has more joints than a pose has equations.
        pose: T_base_tip that q reaches, (4, 4).
        near: Where the move begins, (dof,).
        q: A solution, (dof,).
    """
    solver = iksel.Solver(arm.robot, iksel.SolverOptions(max_attempts=1))
    random = np.random.default_rng(1)
    free = np.linalg.svd(arm.chain.fk_jacobian(q[None])[1][0])[2][RIGHT:]
    move = np.linalg.norm(q - near)
    for step in STEPS:
        for weights in random.normal(size=(OF_EACH, len(free))):
            way = weights @ free
            beside = q + step * way / np.linalg.norm(way)
            start = np.clip(beside, arm.chain.lower, arm.chain.upper)
            found = solver.solve(pose, seeds=start[None], database_seeds=False)
            if found.success and np.linalg.norm(found.q - near) < move - GAIN:
                return False
    return True
