# SPDX-License-Identifier: BSD-3-Clause
"""How good configurations are: manipulability, and distance from the limits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from iksel_cpp import Robot

    from iksel._base.arrays import FloatArray


def manipulability(robot: Robot, q: FloatArray) -> FloatArray:
    """Yoshikawa's measure (1985) of configurations (n, dof): sqrt(det(J J^T)), (n,).

    With fewer joints than the Jacobian has rows, six a tip, sqrt(det(J^T J)): with any
    number of joints it is the product of the singular values, which take several times
    as long to compute.
    """
    jacobian = robot.jacobian(q)
    rows, columns = jacobian.shape[-2:]
    if columns == rows:
        return np.asarray(np.abs(np.linalg.det(jacobian)))
    turned = np.swapaxes(jacobian, -1, -2)
    square = turned @ jacobian if columns < rows else jacobian @ turned
    return np.asarray(np.sqrt(np.maximum(np.linalg.det(square), 0.0)))


def limit_distance(robot: Robot, q: FloatArray) -> FloatArray:
    """Distance of configurations (n, dof) from the limits, relative to each range.

    0 at a limit, 0.5 in the middle, (n,); joints without limits have none. Coupled
    limits are not counted.
    """
    lower, upper = robot.lower, robot.upper
    limited = np.isfinite(upper - lower) & (upper > lower)
    lower, upper, q = lower[limited], upper[limited], q[:, limited]
    nearest = np.minimum(q - lower, upper - q) / (upper - lower)
    return np.asarray(nearest.min(axis=-1, initial=0.5))
