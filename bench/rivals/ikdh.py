# SPDX-License-Identifier: BSD-3-Clause
"""IKDH: all solutions of any six joints by Husty and Pfurner's algorithm."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

import numpy as np

from bench.rivals.dh import dh_table
from bench.rivals.enumerator import Enumerator, Request, fit_frames

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array

HALF_TURN = 180.0


class Ikdh(Enumerator):
    """The package by its Python class, which calls C++."""

    name = "ikdh"
    distribution = "ikdh"
    settings = (
        "DH table made from the axes, limits given, expand_wraps where limits reach "
        "beyond half a turn on one side alone; nearest: solve_from_seed, its Newton "
        "from the posture; it has no tolerance to set"
    )

    def ways(self, arm: Arm) -> dict[str, Request]:
        """All branches, and Newton's method from a posture."""
        module = importlib.import_module("ikdh")
        table = dh_table(arm)
        dh = module.DHTable(
            *(list(v) for v in (table.a, table.d, table.alpha)), list(table.theta)
        )
        limits = np.degrees(_bounded(arm.chain.lower, arm.chain.upper))
        solver = module.Solver(dh, module.JointLimits([tuple(row) for row in limits]))
        frames = fit_frames(arm, lambda q: module.forward_kin(dh, np.degrees(q)))
        beyond = np.abs(limits) > HALF_TURN
        lopsided = bool((beyond[:, 0] != beyond[:, 1]).any())

        def prepare(pose: Array, near: Array) -> tuple[Any, ...]:
            del near
            return frames.target(pose), lopsided

        def prepare_near(pose: Array, near: Array) -> tuple[Any, ...]:
            return frames.target(pose), np.degrees(near)

        return {
            "every": Request(prepare, solver.solve, _radians),
            "nearest": Request(prepare_near, solver.solve_from_seed, _radians),
        }


def _bounded(lower: Array, upper: Array) -> Array:
    """Limits, (6, 2); half a turn each way of a joint that has none."""
    limits = np.column_stack([lower, upper])
    return np.where(np.isfinite(limits), limits, np.array([-np.pi, np.pi]))


def _radians(returned: Any) -> list[Array]:
    return [np.radians(q) for q in returned]
