# SPDX-License-Identifier: BSD-3-Clause
"""Follows targets as a control loop does, as near as it gets."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from iksel_cpp import Status

if TYPE_CHECKING:
    from iksel_cpp import Result, Scene, Solver, Tracker

    from iksel._base.arrays import FloatArray

STEP = 1e3  # [s]: whoever drags does not wait for the joints
OTHER_TASKS = "a Tracker keeps to the solver's own task: choose that for every tip"


class Tracking:
    """A Tracker that begins anew where something else has moved the robot."""

    def __init__(self, solver: Solver, scene: Scene | None) -> None:
        self._solver = solver
        self._scene = scene
        self._tracker: Tracker | None = None

    def follow(self, q: FloatArray, target: FloatArray) -> Result:
        """Move on from q (dof,) towards the targets of all tips at once."""
        if self._tracker is None or not np.array_equal(self._tracker.q, q):
            self._tracker = self._solver.tracker(q, closest=True)
        return self._tracker.track(target, STEP, self._scene)


def words(status: Status) -> str:
    """What a status of a Tracker means, where it is not there."""
    known = {
        Status.solved: "",
        Status.closest: "as near as it gets from here",
        Status.too_fast: "on the way",
        Status.in_collision: "something is in the way",
    }
    return known.get(status, "there is no way on from here")
