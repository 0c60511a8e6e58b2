# SPDX-License-Identifier: BSD-3-Clause
"""How far learned models' outputs are from the poses asked for, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench.learned.plan import OURS
from bench.markdown import table
from bench.paper.learned import SPREADS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bench.sections.learned_rows import Row

UNITS = {"position_mm": "position, mm", "rotation_deg": "rotation, °"}
SPREAD = ("min", "max", "q1", "q3")
QUANTILES = ("min", "Q1", "median", "Q3", "max")

INTRODUCTION = (
    "How the errors are spread. *Of a batch*: mean, least, largest and quartiles of "
    "the errors of a target's 32 outputs, each averaged over the targets, as in the "
    "paper; in brackets published. *Of the first*: the first output's errors over the "
    "targets. An MDN has one output, so its batch has no spread."
)


def text(rows: Sequence[Row]) -> str:
    """A table for positions and one for rotations."""
    header = [
        *(f"of a batch: {name}" for name in ("mean", "min", "max", "Q1", "Q3")),
        *(f"of the first: {name}" for name in QUANTILES),
    ]
    tables = [
        table([title, *header], [_line(row, unit) for row in rows])
        for unit, title in UNITS.items()
    ]
    return "\n\n".join([INTRODUCTION, *tables])


def _line(row: Row, unit: str) -> list[str]:
    figures: dict[str, Any] = row.cell[unit]
    mean = (
        row.published.position_mm
        if unit == "position_mm"
        else row.published.rotation_deg
    )
    spreads = SPREADS[row.model].get(row.robot)
    spread = dict(
        zip(SPREAD, spreads[list(UNITS).index(unit)] if spreads else (), strict=False)
    )
    batch = [f"{figures['mean']:.1f} ({mean:.1f})"]
    for name in SPREAD:
        beside = f" ({spread[name]:.1f})" if name in spread else ""
        batch.append(f"{figures[name]:.1f}{beside}")
    title = row.title if row.recipe == OURS else f"{row.title}, {row.learned}"
    return [title, *batch, *(f"{value:.1f}" for value in figures["first"])]
