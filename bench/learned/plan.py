# SPDX-License-Identifier: BSD-3-Clause
"""Which models there are, where their weights lie, and what is measured of them."""

from __future__ import annotations

import hashlib
from dataclasses import asdict, dataclass
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
"""Of a pose: the solver's answer nearest to the middle of the limits; the configuration
that the pose was drawn by."""
INPUTS = ("rotation", "quaternion")
"""What a model sees of a pose beside its position: the nine entries of the rotation, or
its quaternion."""


GAUSSIANS = 8
"""Of an MDN's mixture."""


@dataclass(frozen=True)
class Recipe:
    """What a model learns from, and what of its size is not the same for all."""

    labels: str = LABELS[0]
    inputs: str = INPUTS[0]
    gaussians: int = GAUSSIANS
    """Of an MDN; the others have none."""


OURS = Recipe()
PAPERS = Recipe("drawn", "quaternion")
BETWEEN = (Recipe("drawn", "rotation"), Recipe("nearest", "quaternion"))
"""Either of the paper's choices without the other."""
MANY = Recipe("drawn", "quaternion", 64)
"""The paper's for an MDN with room for all configurations of a pose."""

WEIGHTS = Path(__file__).resolve().parent / "weights"

AS_PUBLISHED = ("cvr038", "cvrb1213")
"""Robots whose models are trained by the paper's recipe as well."""

TARGETS = 2_000
"""As many as in the paper's table."""
FEWER = 1_000
"""Of models by another recipe than ours: the first of the others."""
MINUTES = 45.0
"""Of training, where not told otherwise: CPU time on one thread."""
CURVE = 500
"""Poses of a point of a training's curve."""
BESIDE = 0.05
"""Deviation of each joint of what lies beside a label [rad]."""
JUMP = 0.5
"""Labels that differ by more in a joint do not lie beside each other [rad]."""


def recipes(robot: str, model: str) -> tuple[Recipe, ...]:
    """Which of them the report measures."""
    more = (*BETWEEN, MANY) if (robot, model) == ("cvrb1213", "mdn") else ()
    return (OURS, PAPERS, *more) if robot in AS_PUBLISHED else (OURS,)


def name_of(robot: str, model: str, recipe: Recipe) -> str:
    """Of files of one training."""
    words = [robot, model]
    if recipe != OURS:
        words += [recipe.labels, recipe.inputs]
    if recipe.gaussians != GAUSSIANS:
        words.append(str(recipe.gaussians))
    return "_".join(words)


def weights_path(robot: str, model: str, recipe: Recipe = OURS) -> Path:
    """Where a model's weights are; its curve is beside them, as .csv.

    Those that the report does not measure are not committed.
    """
    reported = recipe in recipes(robot, model)
    folder = WEIGHTS if reported else WORK / "learned"
    return folder / f"{name_of(robot, model, recipe)}.npz"


def learned_cell(robot: str, model: str, size: Size, recipe: Recipe = OURS) -> Settings:
    """One model's outputs, as they are and as seeds."""
    path = weights_path(robot, model, recipe)
    digest = hashlib.sha256(path.read_bytes()).hexdigest() if path.exists() else ""
    cell = {
        "cell": "learned",
        "robot": robot,
        "model": model,
        "weights": digest[:16],
        "kind": "uniform",
        "count": min(size.paper, TARGETS),
        "seed": SEED,
    }
    if recipe == OURS:
        return cell
    return {**cell, **asdict(recipe), "count": min(size.paper, FEWER)}


def learned_jobs(size: Size, models: Collection[str] = MODELS) -> list[Job]:
    """For each model, of our recipe and of the others that are reported."""
    others = [
        Job(
            f"learned, {model}, other recipes",
            "learned",
            [
                learned_cell(robot, model, size, recipe)
                for robot in PAPER_ARMS
                for recipe in recipes(robot, model)[1:]
            ],
        )
        for model in models
    ]
    return [*our_jobs(size, models), *others]


def our_jobs(size: Size, models: Collection[str] = MODELS) -> list[Job]:
    """One job for each model of our recipe."""
    return [
        Job(
            f"learned, {model}",
            "learned",
            [learned_cell(robot, model, size) for robot in PAPER_ARMS],
        )
        for model in models
    ]
