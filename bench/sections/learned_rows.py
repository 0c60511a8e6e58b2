# SPDX-License-Identifier: BSD-3-Clause
"""The learned models that were measured, each beside its published row."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from bench.arms import PAPER_ARMS
from bench.bounds import rate_points
from bench.learned.plan import CURVE, GAUSSIANS, MODELS, Recipe, learned_cell, recipes
from bench.markdown import NONE, percent, signed
from bench.paper.learned import LEARNED

if TYPE_CHECKING:
    from bench.paper.learned import LearnedRow
    from bench.view import View

TITLES = {"mdn": "MDN", "flow": "flow (IKFlow)", "diffusion": "diffusion (IKDP)"}
LABELS = {"nearest": "nearest answer", "drawn": "drawn"}
INPUTS = {"rotation": "nine entries", "quaternion": "quaternion"}
BESIDE_PUBLISHED = (
    "position error, mm",
    "rotation error, °",
    "first as seed",
    "best of 32 as seed",
)


@dataclass(frozen=True)
class Row:
    """One model for one robot by one recipe."""

    model: str
    robot: str
    recipe: Recipe
    cell: dict[str, Any]
    """What was measured."""

    @property
    def title(self) -> str:
        """Model and robot."""
        return f"{TITLES[self.model]}, {PAPER_ARMS[self.robot]}"

    @property
    def learned(self) -> str:
        """The recipe in words."""
        words = [LABELS[self.recipe.labels], INPUTS[self.recipe.inputs]]
        if self.recipe.gaussians != GAUSSIANS:
            words.append(f"{self.recipe.gaussians} Gaussians")
        return ", ".join(words)

    @property
    def published(self) -> LearnedRow:
        """The paper's row."""
        return LEARNED[self.model][self.robot]

    @property
    def shown(self) -> str:
        """The seed that its curve is told of."""
        return "best" if "best" in self.cell else "first"

    def rate(self, seed: str) -> float:
        """Success of "first" or "best" in percent."""
        return float(100.0 * self.cell[seed]["right"] / self.cell["count"])

    def beside_published(self) -> list[str]:
        """Its figures under BESIDE_PUBLISHED."""
        position, rotation = self.cell["position_mm"], self.cell["rotation_deg"]
        return [
            f"{position['mean']:.1f} ({self.published.position_mm:.1f})",
            f"{rotation['mean']:.1f} ({self.published.rotation_deg:.1f})",
            self._success("first", self.published.first),
            self._success("best", self.published.best),
        ]

    def _success(self, seed: str, published: float | None) -> str:
        """Percent (published, difference)."""
        if published is None or seed not in self.cell:
            return NONE
        shown = percent(self.cell[seed]["right"], self.cell["count"])
        return f"{shown} ({published:.2f}, {signed(self.rate(seed) - published)})"

    def late_gain(self) -> tuple[float, float]:
        """What the last half of training brought on the curve's poses, and its bound.

        The bound takes both points' poses for others, so it is wider than need be.
        """
        curve = self.cell["curve"]
        half = curve[max(0, round(0.5 * len(curve)) - 1)][self.shown]
        last = curve[-1][self.shown]
        bound = np.hypot(rate_points(half, CURVE), rate_points(last, CURVE))
        return last - half, float(bound)

    def after(self, seed: str, minutes: float) -> float:
        """Success on the curve's poses at its point nearest to so many minutes."""
        curve = self.cell["curve"]
        nearest = min(curve, key=lambda point: abs(point["minutes"] - minutes))
        return float(nearest[seed])

    def late_gain_text(self) -> str:
        """The same in words."""
        gain, bound = self.late_gain()
        return f"{signed(gain, 1)} ± {bound:.1f}"


def rows(view: View) -> list[Row]:
    """All that was measured, those of a model and robot beside each other."""
    found = []
    for model, robot, recipe in _known():
        cell = view.get(learned_cell(robot, model, view.size, recipe))
        if cell is not None:
            found.append(Row(model, robot, recipe, cell))
    return found


def missing(view: View) -> list[str]:
    """Why the others were not."""
    found = []
    for model, robot, recipe in _known():
        reason = view.why_not(learned_cell(robot, model, view.size, recipe))
        if reason:
            title = Row(model, robot, recipe, {})
            what = "" if recipe == Recipe() else f" ({title.learned})"
            found.append(f"{title.title}{what}: {reason}")
    return found


def _known() -> list[tuple[str, str, Recipe]]:
    return [
        (model, robot, recipe)
        for model in MODELS
        for robot in PAPER_ARMS
        for recipe in recipes(robot, model)
    ]
