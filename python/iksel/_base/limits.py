# SPDX-License-Identifier: BSD-3-Clause
"""Which limits a configuration violates, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from iksel_cpp import CoupledLimit, Robot

    from iksel._base.arrays import FloatArray


def violated_limits(robot: Robot, q: FloatArray) -> list[str]:
    """Joints outside their limits, and coupled limits that q, (dof,), violates."""
    off = (q < robot.lower) | (q > robot.upper)
    names = [name for name, out in zip(robot.joint_names, off, strict=True) if out]
    values = dict(zip(robot.joint_names, q.tolist(), strict=True))
    names += [str(x) for x in robot.coupled_limits if _is_violated(x, values)]
    # Where mimic joints are in a sum, their values are not at hand.
    return names if names or robot.within_limits(q) else ["a coupled limit"]


def _is_violated(limit: CoupledLimit, values: dict[str, float]) -> bool:
    if not set(limit.coefficients) <= set(values):
        return False
    total = sum(c * values[name] for name, c in limit.coefficients.items())
    return not limit.lower <= total <= limit.upper
