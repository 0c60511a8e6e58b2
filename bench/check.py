# SPDX-License-Identifier: BSD-3-Clause
"""The judge: is an answer one? The same for every solver, by bench.chain and numpy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    from bench.chain import Array, Chain

POSITION_TOLERANCE = 1e-5
"""An answer's position is at most this far from the target's [m]."""
ROTATION_TOLERANCE = 1e-5
"""An answer's rotation is at most this far from the target's [rad]."""
LIMIT_SLACK = 1e-6
"""Rounding allowed at a joint limit [rad or m]: TRAC-IK keeps limits as floats."""


@dataclass(frozen=True)
class Verdict:
    """What many answers are worth, each array (N,)."""

    claimed: npt.NDArray[np.bool_]
    """The solver said that it has an answer."""
    right: npt.NDArray[np.bool_]
    """It has one: within both tolerances and inside the limits."""

    @property
    def false_claims(self) -> int:
        """Answers that are none."""
        return int(np.count_nonzero(self.claimed & ~self.right))


def rotation_distance(a: Array, b: Array) -> Array:
    """Angle between rotations, (N, 3, 3) each [rad]; exact near 0 and near pi alike.

    The Frobenius norm of the difference of two rotations an angle t apart is
    2 sqrt(2) sin(t / 2).
    """
    half = np.linalg.norm(a - b, axis=(1, 2)) / (2.0 * np.sqrt(2.0))
    return np.asarray(2.0 * np.arcsin(np.minimum(half, 1.0)))


def errors(chain: Chain, poses: Array, q: Array) -> tuple[Array, Array]:
    """Position [m] and rotation [rad] errors of q, (N, dof), at poses, (N, 4, 4)."""
    reached = chain.fk(q)
    position = np.linalg.norm(reached[:, :3, 3] - poses[:, :3, 3], axis=1)
    rotation = rotation_distance(reached[:, :3, :3], poses[:, :3, :3])
    return position, rotation


def right(
    chain: Chain,
    poses: Array,
    q: Array,
    position_tolerance: float = POSITION_TOLERANCE,
    rotation_tolerance: float = ROTATION_TOLERANCE,
    *,
    slack: float = LIMIT_SLACK,
) -> npt.NDArray[np.bool_]:
    """Which answers q, (N, dof), are right at their poses, (N, 4, 4)."""
    usable = np.isfinite(q).all(axis=1)
    result = np.zeros(len(q), dtype=bool)
    position, rotation = errors(chain, poses[usable], q[usable])
    result[usable] = (
        (position <= position_tolerance)
        & (rotation <= rotation_tolerance)
        & chain.within_limits(q[usable], slack)
    )
    return result


def judge(chain: Chain, poses: Array, answers: Sequence[Sequence[Array]]) -> Verdict:
    """Judge the answers of one solver.

    Args:
        chain: The robot.
        poses: Targets T_base_tip, (N, 4, 4).
        answers: For each target the configurations that the solver returned as answers,
            each (dof,); none where it said that there is none. One that is right makes
            the target solved: analytic solvers return every branch and know no limits.
    """
    claimed = np.array([len(branches) > 0 for branches in answers], dtype=bool)
    owner = [i for i, branches in enumerate(answers) for _ in branches]
    flat = [q for branches in answers for q in branches]
    result = np.zeros(len(answers), dtype=bool)
    if flat:
        good = right(chain, poses[owner], np.array(flat, dtype=float))
        np.logical_or.at(result, owner, good)
    return Verdict(claimed, result)
