# SPDX-License-Identifier: BSD-3-Clause
"""One pose by a search over joint 4, as the paper used IK-Geo on C0 and C1.

For arms of six joints whose axes 2 and 3 are parallel and 5 and 6 meet. Given q4,
subproblem 4 gives q1, subproblem 3 gives q3 and subproblem 1 gives q2: four branches
that reach the position. What is left is a condition on q4 alone,

    e(q4) = h5 . (R04^T R06 h6) - h5 . h6 = 0,

and then subproblem 1 gives q5 and q6. Zeros are looked for where e changes its sign
between neighbouring values of q4 on one branch.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from bench.ikgeo.subproblems import (
    dot,
    subproblem_1,
    subproblem_3,
    subproblem_4,
    turned,
)
from bench.rivals.axes import axes_of
from bench.rivals.base import UnsupportedError

if TYPE_CHECKING:
    import numpy.typing as npt

    from bench.arms import Arm
    from bench.chain import Array

Between = Literal["lower end", "interpolated", "bisected"]
"""What becomes of a change of sign between two values of q4.

lower end: q4 by linear interpolation, joints 1 to 3 as they were at the lower value.
interpolated: q4 by linear interpolation, joints 1 to 3 anew for it.
bisected: q4 by bisection to the last digits, joints 1 to 3 anew for it.
"""

BISECTIONS = 36
"""Halvings of the distance between two values of q4, for 360 of them to 1e-12 rad."""
ZERO = 1e-6
"""Of e, where bisection ended; above it the sign changed where a branch has a gap."""


class Goal(NamedTuple):
    """What the search reads of a target."""

    rotation: Array
    """R06, (3, 3)."""
    position: Array
    """From the origin of joint 1 to that of joint 6 in the base frame, (3,) [m]."""


class Branches(NamedTuple):
    """Joints 1 to 3 for M values of q4, each (4, M)."""

    q1: Array
    q2: Array
    q3: Array
    error: Array
    """e(q4); NaN where a branch does not reach the position."""


class Search:
    """The search for one arm."""

    def __init__(self, arm: Arm, values: int, between: Between) -> None:
        """Take the axes, and the values of q4 over the range of its joint.

        Args:
            arm: The robot, with its tool.
            values: How many values of q4.
            between: What becomes of a change of sign between two of them.

        Raises:
            UnsupportedError: The axes lie otherwise.
        """
        axes = axes_of(arm)
        if not axes.parallel(1, 2) or np.linalg.norm(axes.p[5]) > 1e-9:
            raise UnsupportedError(
                f"axes 2 and 3 parallel, 5 and 6 meeting only; {arm.name} has others"
            )
        self._axes = axes
        self._chain = arm.chain
        self._q4 = np.linspace(arm.chain.lower[3], arm.chain.upper[3], values)
        self._between = between

    def __call__(self, pose: Array) -> Array:
        """The candidates for T_base_tip, (4, 4), inside the limits: (n, 6) [rad].

        In the order of the branches, on each in that of q4.
        """
        rotation = self._axes.rotation_for(pose)
        p = self._axes.p
        goal = Goal(rotation, pose[:3, 3] - p[0] - rotation @ p[6])
        branches = self._branches(goal, self._q4)
        error = branches.error
        # A product with NaN is not negative.
        branch, left = np.nonzero(error[:, :-1] * error[:, 1:] < 0.0)
        low, high = self._q4[left], self._q4[left + 1]
        e_low, e_high = error[branch, left], error[branch, left + 1]
        if self._between == "bisected":
            q4 = self._bisected(goal, branch, low, high, e_low)
        else:
            q4 = low + (high - low) * e_low / (e_low - e_high)
        each = left
        if self._between != "lower end":
            branches, each = self._branches(goal, q4), np.arange(len(q4))
        q1, q2, q3, error = (values[branch, each] for values in branches)
        q = self._with_wrist(goal, q1, q2, q3, q4)
        kept = self._chain.within_limits(q)
        if self._between == "bisected":
            kept &= np.abs(error) < ZERO
        return np.asarray(q[kept])

    def _branches(self, goal: Goal, q4: Array) -> Branches:
        """Joints 1 to 3 that reach the position with q4, (M,)."""
        h, p = self._axes.h, self._axes.p
        beyond_3 = p[3] + turned(h[3], q4, p[4])
        along = dot(h[1], p[1] + p[2] + beyond_3)
        q1, missed_1 = subproblem_4(h[1], goal.position, -h[0], along)
        from_2 = turned(-h[0], q1, goal.position) - p[1]
        distance = np.sqrt(dot(from_2, from_2))
        q3, missed_3 = subproblem_3(beyond_3, -p[2], h[2], distance)
        q2 = subproblem_1(p[2] + turned(h[2], q3, beyond_3), from_2, h[1]).angle
        q1 = np.broadcast_to(q1, q3.shape)
        error = dot(self._axis_5(q1, q2, q3, q4), goal.rotation @ h[5]) - h[4] @ h[5]
        error = np.where(missed_1 | missed_3, np.nan, error)
        return Branches(*(x.reshape(4, len(q4)) for x in (q1, q2, q3, error)))

    def _bisected(
        self,
        goal: Goal,
        branch: npt.NDArray[np.intp],
        low: Array,
        high: Array,
        e_low: Array,
    ) -> Array:
        """Zeros of the error on branches between values of q4, (n,)."""
        each = np.arange(len(branch))
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            error = self._branches(goal, middle).error[branch, each]
            before = error * e_low <= 0.0
            low, high = np.where(before, low, middle), np.where(before, middle, high)
        return np.asarray(0.5 * (low + high))

    def _axis_5(self, q1: Array, q2: Array, q3: Array, q4: Array) -> Array:
        """R04 h5, (..., 3)."""
        h = self._axes.h
        axis: Array = h[4]
        for k, angle in ((h[3], q4), (h[2], q3), (h[1], q2), (h[0], q1)):
            axis = turned(k, angle, axis)
        return axis

    def _with_wrist(
        self, goal: Goal, q1: Array, q2: Array, q3: Array, q4: Array
    ) -> Array:
        """The wrist's joints behind the others, (n,) each: (n, 6)."""
        h = self._axes.h
        # R06^T R04 h5 = R(h6, -q6) h5, and R04^T R06 h6 = R(h5, q5) h6.
        q6 = subproblem_1(h[4], self._axis_5(q1, q2, q3, q4) @ goal.rotation, -h[5])
        axis_6 = goal.rotation @ h[5]
        for k, angle in ((h[0], q1), (h[1], q2), (h[2], q3), (h[3], q4)):
            axis_6 = turned(-k, angle, axis_6)
        q5 = subproblem_1(h[5], axis_6, h[4])
        return np.stack([q1, q2, q3, q4, q5.angle, q6.angle], axis=-1)
