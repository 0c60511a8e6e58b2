# SPDX-License-Identifier: BSD-3-Clause
"""How far a model's outputs are from the poses that were asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bench.check import errors

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array

STATISTICS = ("mean", "min", "max", "q1", "q3")
"""Of a batch's errors, as in the paper."""
QUANTILES = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Of the first outputs' errors over the targets."""


def batch_errors(arm: Arm, poses: Array, q: Array) -> dict[str, Any]:
    """Errors of outputs (N, count, dof) for poses (N, 4, 4), as `_figures` has them."""
    count = q.shape[1]
    position, rotation = errors(
        arm.chain, np.repeat(poses, count, axis=0), q.reshape(-1, q.shape[-1])
    )
    return {
        "position_mm": _figures(1e3 * position.reshape(-1, count)),
        "rotation_deg": _figures(np.degrees(rotation.reshape(-1, count))),
    }


def _figures(values: Array) -> dict[str, Any]:
    """STATISTICS of each batch, (N, count), averaged over the targets.

    With them the deviation of a batch's mean between targets, and QUANTILES over the
    targets of the first output's error.
    """
    each = (
        values.mean(axis=1),
        values.min(axis=1),
        values.max(axis=1),
        *np.quantile(values, [0.25, 0.75], axis=1),
    )
    figures: dict[str, Any] = {
        name: float(part.mean()) for name, part in zip(STATISTICS, each, strict=True)
    }
    figures["deviation"] = float(each[0].std())
    figures["first"] = np.quantile(values[:, 0], QUANTILES).tolist()
    return figures
