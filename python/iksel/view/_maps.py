# SPDX-License-Identifier: BSD-3-Clause
"""Which reachability maps a robot is shown with."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from iksel_cpp import InvalidArgumentError

if TYPE_CHECKING:
    from iksel_cpp import Robot

    from iksel.reach import Map


def check_map(robot: Robot, reach_map: Map) -> None:
    """Refuse a map that is of none of a robot's tips.

    Raises:
        InvalidArgumentError: It is of another robot, or of another tool.
    """
    its = reach_map.robot
    chains = [robot.chain(tip) for tip in range(robot.tips)]
    same = [chain for chain in chains if chain.chain_hash == its.chain_hash]
    if not same:
        raise InvalidArgumentError(
            f"map: it is of {its.name}, {its.base_link} -> {its.tip_link}, and the "
            f"viewer shows {robot.name}, {robot.base_link} -> "
            f"{', '.join(robot.tip_links)}"
        )
    if not any(np.allclose(c.tcp, its.tcp, rtol=0, atol=1e-9) for c in same):
        raise InvalidArgumentError(
            "map: its tool is another than the robot's; load the robot with the "
            f"map's tcp, which is at {its.tcp[:3, 3]} in the tip link's frame"
        )
