# SPDX-License-Identifier: BSD-3-Clause
"""Positions that were meant as millimetres."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import numpy as np

from iksel.cli._parser import warning_line

if TYPE_CHECKING:
    from iksel_cpp import Robot

    from iksel._base.arrays import FloatArray

FARTHEST = 100.0
"""How many times the robot's reach a position in metres may be away unsuspected."""


def warn_of_millimetres(robot: Robot, flag: str, poses: FloatArray) -> bool:
    """Warn if the positions of some poses look like millimetres.

    As metres they are far out of reach, and as millimetres within it.

    Args:
        robot: Whose reach counts, of several tips that of each chain.
        flag: What the poses were given by, for the warning.
        poses: T_base_tcp, (..., 4, 4), of k tips (..., k, 4, 4); of NaN where there is
            none.

    Returns:
        Whether there was a warning.
    """
    positions = poses[..., :3, 3].reshape(-1, robot.tips, 3)
    for tip in range(robot.tips):
        chain = robot.chain(tip)
        found = _suspects(chain, positions[:, tip])
        if len(found):
            text = " ".join(f"{x:g}" for x in found[0])
            sys.stderr.write(
                warning_line(
                    f"{flag}: the position {text} looks like millimetres, and is taken "
                    f"as metres; the robot reaches {chain.reach:.3g} m"
                )
            )
            return True
    return False


def _suspects(chain: Robot, positions: FloatArray) -> FloatArray:
    """Which of the positions (N, 3) [m] look like millimetres, (n, 3)."""
    centre, reach = chain.reach_centre, chain.reach
    far = np.linalg.norm(positions - centre, axis=1) > FARTHEST * reach
    near = np.linalg.norm(positions / 1000.0 - centre, axis=1) <= reach
    return np.asarray(positions[far & near])
