# SPDX-License-Identifier: BSD-3-Clause
"""Success over the number of attempts: the paper's figures, and its runs with CVT."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bench.arms import PAPER_ARMS
from bench.markdown import NONE, percent, signed, table
from bench.paper import plan as paper_plan
from bench.paper import published

if TYPE_CHECKING:
    from bench.view import View

ROBOTS = published.ROBOTS
HEADER = [PAPER_ARMS[robot] for robot in ROBOTS]


def parts(view: View) -> list[str]:
    """The section's parts; empty where there are no results."""
    return [*_figures(view), *_second_seeds(view), *_beside_authors(view)]


def curve(view: View, robot: str, sampling: str, selection: str) -> list[float] | None:
    """Success in percent at #ReA 0, 1, ... 20."""
    base = paper_plan.sampling_of(sampling)
    cell = view.get(paper_plan.curve_cell(robot, view.size, base, selection))
    return None if cell is None else [100.0 * n / cell["count"] for n in cell["solved"]]


def _second_seeds(view: View) -> list[str]:
    """What the second seed is worth, farthest and in order."""
    rows = []
    for sampling in ("grid", "cvt"):
        row = []
        for robot in ROBOTS:
            curves = [
                curve(view, robot, sampling, selection)
                for selection in ("Eq. (5), farthest", "Eq. (5), in order")
            ]
            row.append(" / ".join(map(_second_seed, curves)))
        if any(NONE not in cell for cell in row):
            rows.append([sampling, *row])
    if not rows:
        return []
    what = (
        "Of the targets that the first seed misses, the second solves (percent; the "
        "farthest of 20 / the next in the ranking):"
    )
    return [what, table(["", *HEADER], rows)]


def _second_seed(values: list[float] | None) -> str:
    if values is None:
        return NONE
    return f"{100.0 * (values[1] - values[0]) / (100.0 - values[0]):.1f}"


def _beside_authors(view: View) -> list[str]:
    rows = []
    for i, attempts in enumerate(published.CVT_ATTEMPTS):
        row = []
        for robot in ROBOTS:
            ours = curve(view, robot, "cvt", "Eq. (5), in order")
            theirs = published.CVT[robot][i]
            if ours is not None:
                value = ours[attempts - 1]
                row.append(f"{value:.2f} ({theirs:.1f}, {signed(value - theirs)})")
            else:
                row.append(NONE)
        rows.append([f"{attempts} attempts", *row])
    if all(cell == NONE for row in rows for cell in row[1:]):
        return []
    return [
        (
            "Beside the authors' own runs with CVT at the medium counts, in which the "
            "seeds follow one another in the order of Eq. (5):"
        ),
        table(["success %, cvt, Eq. (5), in order", *HEADER], rows),
    ]


def _figures(view: View) -> list[str]:
    rows = []
    for sampling in ("grid", "cvt"):
        curves = [
            (
                f"{sampling}, {selection}",
                [curve(view, robot, sampling, selection) for robot in ROBOTS],
            )
            for selection in paper_plan.SELECTIONS
        ]
        rows += [
            [label, *(_at_attempts(values) for values in found)]
            for label, found in curves
            if any(found)
        ]
        base = paper_plan.sampling_of(sampling)
        cells = [
            view.get(paper_plan.ceiling_cell(robot, view.size, base))
            for robot in ROBOTS
        ]
        row = [
            NONE if cell is None else percent(cell["solved"][-1], cell["count"])
            for cell in cells
        ]
        if any(cells):
            rows.append([f"{sampling}, 100 attempts", *row])
    if not rows:
        return []
    shown = ", ".join(map(str, SHOWN_REA))
    last = SHOWN_REA[-1]
    note = (
        f"At #ReA {last} all {last + 1} seeds that are selected among have been tried: "
        f'the tables\' "#ReA {last + 1}" is the same.'
    )
    return [
        "### The two figures",
        "![Success and mean time over #ReA](plots/paper_attempts.svg)",
        "![Mean and standard deviation of the time](plots/paper_times.svg)",
        table([f"success % at #ReA {shown}", *HEADER], rows),
        note,
        *_beside_figures(view),
    ]


PUBLISHED_POINTS = {
    ("Eq. (5), farthest", 1): published.ABLATION_3["Eq. (5)"],
    ("Eq. (5), farthest", 3): published.ABLATION_3["#ReA 3"],
    ("Eq. (5), farthest", 5): published.ABLATION_3["#ReA 5"],
    ("Eq. (5), farthest", 10): published.ABLATION_3["#ReA 10"],
    ("Eq. (5), farthest", 20): published.ABLATION_3["#ReA 20"],
    ("Eq. (2), in order", 1): published.ABLATION_3["Eq. (2)"],
}
"""Points of the figures' curves, selection and #ReA, whose rows are published."""


def _beside_figures(view: View) -> list[str]:
    """How far the curves are from the published points."""
    rows = []
    for selection in dict.fromkeys(selection for selection, _ in PUBLISHED_POINTS):
        row = []
        for i, robot in enumerate(ROBOTS):
            ours = curve(view, robot, "grid", selection)
            if ours is None:
                row.append(NONE)
                continue
            far = [
                abs(ours[rea] - published_row.success[i])
                for (name, rea), published_row in PUBLISHED_POINTS.items()
                if name == selection
            ]
            row.append(f"{np.mean(far):.2f} ({max(far):.2f})")
        at = ", ".join(str(rea) for name, rea in PUBLISHED_POINTS if name == selection)
        rows.append([f"{selection}, #ReA {at}", *row])
    if all(cell == NONE for row in rows for cell in row[1:]):
        return []
    return [
        (
            "The published figures are pictures, not given as numbers; of their "
            "curves the tables have these points. Mean absolute difference of ours "
            "from them (largest), in points:"
        ),
        table(["grid", *HEADER], rows),
    ]


SHOWN_REA = (1, 3, 5, 10, 19)
"""Points of the figure's curves that the text has too."""


def _at_attempts(values: list[float] | None) -> str:
    if values is None:
        return NONE
    return " / ".join(f"{values[rea]:.2f}" for rea in SHOWN_REA)
