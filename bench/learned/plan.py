# SPDX-License-Identifier: BSD-3-Clause
"""Which models there are, where their weights lie, and what is measured of them."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING

from bench.arms import PAPER_ARMS
from bench.settings import WORK
from bench.size import SEED, Job, Size

if TYPE_CHECKING:
    from collections.abc import Collection

    from bench.store import Settings

MODELS = ("mdn", "flow", "diffusion")
LABELS = ("nearest", "drawn")
"""Of a pose: the solver's answer nearest to the middle of the limits, which is what the
report's models learn; the configuration that the pose was drawn by."""

WEIGHTS = Path(__file__).resolve().parent / "weights"

TARGETS = 2_000
"""As many as in the paper's table."""
BESIDE = 0.05
"""Deviation of each joint of what lies beside a label [rad]."""
JUMP = 0.5
"""Labels that differ by more in a joint do not lie beside each other [rad]."""


def weights_path(robot: str, model: str, labels: str = LABELS[0]) -> Path:
    """Where a model's weights are; its curve is beside them, as .csv.

    Those of other labels than the report's are not committed.
    """
    if labels == LABELS[0]:
        return WEIGHTS / f"{robot}_{model}.npz"
    return WORK / "learned" / f"{robot}_{model}_{labels}.npz"


def learned_cell(robot: str, model: str, size: Size) -> Settings:
    """One model's outputs, as they are and as seeds."""
    path = weights_path(robot, model)
    digest = hashlib.sha256(path.read_bytes()).hexdigest() if path.exists() else ""
    return {
        "cell": "learned",
        "robot": robot,
        "model": model,
        "weights": digest[:16],
        "kind": "uniform",
        "count": min(size.paper, TARGETS),
        "seed": SEED,
    }


def learned_jobs(size: Size, models: Collection[str] = MODELS) -> list[Job]:
    """One job for each model."""
    return [
        Job(
            f"learned, {model}",
            "learned",
            [learned_cell(robot, model, size) for robot in PAPER_ARMS],
        )
        for model in models
    ]
