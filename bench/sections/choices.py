# SPDX-License-Identifier: BSD-3-Clause
"""The paper's text, claim by claim, as text: choices, files, times and their stages."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bench.arms import PAPER_ARMS
from bench.bounds import mean_bound, paired_points, rate_points, verdict
from bench.markdown import NONE, signed, table
from bench.paper import published
from bench.paper.choices import (
    CHOICES,
    DISTANCES,
    TIMES,
    Choice,
    Slower,
    paired_cell,
    shown_cell,
    tree_cell,
)
from bench.paper.plan import paper_cell

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bench.view import View

ROBOTS = published.ROBOTS
HEADER = [str(PAPER_ARMS[robot]) for robot in ROBOTS]
STAGES = ("query_us", "rank_us", "iterate_us", "reselect_us")
STAGE_WORDS = ("query", "rank", "iterate", "re-select")

Verdicts = list[str | None]
"""One of each robot; None where it was not measured."""

HOLDS, FAILS, OPEN = "holds", "does not hold", "undecided"


def text(view: View) -> str:
    """The whole section; empty where there are no results."""
    makers = (_choices, _distances, _files, _times, _figures)
    found = [part for make in makers if (part := make(view))]
    if not found:
        return ""
    conditions = (
        f"{view.size.paper:,} targets per robot, seed 1, at the paper's preset but for "
        "what a row names. ± is half of a confidence interval of 95 %; two settings "
        "are compared on the same targets, by those that only one of them solves. A "
        "claim *holds* on a robot where the whole interval speaks for it, *does not "
        "hold* where all of it speaks against it, and is *undecided* in between. "
        "`python -m bench text` makes this section alone."
    )
    return "\n\n".join(["### The text, choice by choice", conditions, *found])


def _figures(view: View) -> str:
    """The figures that are pictures of seeds."""
    if view.get(shown_cell(view.size)) is None:
        return ""
    what = (
        "Figures 1 to 3, of the database and the first targets of C0 that show what "
        "the captions say: the nearest seed leads away and that of the least "
        "adjustment arrives; the first seed ends outside a limit and the one selected "
        "again arrives; the order of three attempts among the candidates."
    )
    plots = [f"![Figure {n}](plots/paper_figure_{n}.svg)" for n in (1, 2, 3)]
    return "\n\n".join([what, *plots])


def _choices(view: View) -> str:
    rows = []
    for choice in CHOICES:
        rows += _choice_rows(view, choice)
    if not rows:
        return ""
    what = (
        "In the row of a claim: success in percent with the choice (published). Below "
        "it, with another choice: success, and by how many points the paper's is above."
    )
    return "\n\n".join([what, table(["claim", *HEADER, "verdict"], rows)])


def _choice_rows(view: View, choice: Choice) -> list[list[str]]:
    cells = {
        label: [
            view.get(paired_cell(robot, view.size, choice.chosen, other))
            for robot in ROBOTS
        ]
        for label, other in choice.others.items()
    }
    known = [
        next(filter(None, some), None) for some in zip(*cells.values(), strict=True)
    ]
    if not any(known):
        return []
    first = [f"**{choice.says}**: {choice.chosen_label}"]
    rates: Verdicts = []
    for i, cell in enumerate(known):
        if cell is None:
            first.append(NONE)
            rates.append(None)
            continue
        ours, theirs = _percent(cell, "solved"), published.MEDIUM.success[i]
        first.append(f"{ours:.2f} ({theirs:.2f})")
        rates.append(_alike(ours, theirs, cell["count"]))
    by_published = choice.wanted == "published"
    first.append(f"as published: {said(rates)}" if by_published else "")
    rows = [first]
    for label, found in cells.items():
        verdicts = [_verdict(cell, choice.wanted) for cell in found]
        last = "" if by_published else said(verdicts)
        rows.append([label, *map(_beside, found), last])
    return rows


def _percent(cell: dict[str, Any], what: str) -> float:
    return float(100.0 * cell[what] / cell["count"])


def _alike(ours: float, theirs: float, count: int) -> str:
    """Whether two rates, each of its own targets, can be of one setting."""
    bound = float(
        np.hypot(rate_points(ours, count), rate_points(theirs, published.TARGETS))
    )
    return HOLDS if abs(ours - theirs) <= bound else FAILS


def _difference(cell: dict[str, Any]) -> tuple[float, float]:
    """Points that the choice is above the other, and their bound."""
    won, lost, count = cell["won"], cell["lost"], cell["count"]
    return 100.0 * (won - lost) / count, paired_points(won, lost, count)


def _verdict(cell: dict[str, Any] | None, wanted: str) -> str | None:
    if cell is None:
        return None
    value, bound = _difference(cell)
    if wanted == "no less":
        return FAILS if value + bound <= 0.0 else HOLDS
    return verdict(value, bound)


def _beside(cell: dict[str, Any] | None) -> str:
    if cell is None:
        return NONE
    value, bound = _difference(cell)
    return f"{_percent(cell, 'against_solved'):.2f}; {signed(value)} ± {bound:.2f}"


def said(verdicts: Sequence[str | None]) -> str:
    """What is said of some robots in one cell."""
    known = {
        short: found
        for short, found in zip(HEADER, verdicts, strict=True)
        if found is not None
    }
    if not known:
        return NONE
    if len(set(known.values())) == 1:
        return next(iter(known.values()))
    return "; ".join(
        f"{word} on {', '.join(names)}"
        for word in (HOLDS, FAILS, OPEN)
        if (names := [short for short, found in known.items() if found == word])
    )


def _distances(view: View) -> str:
    rows = []
    for label, radius in DISTANCES.items():
        found = [
            view.get(paired_cell(robot, view.size, radius, {})) for robot in ROBOTS
        ]
        if any(found):
            rows.append([label, *map(_against, found)])
    if not rows:
        return ""
    what = (
        "Thresholds of Eq. (3) on the distance of the keys (its square is δ; the "
        "published runs had none): success in percent, and points above that without."
    )
    return "\n\n".join([what, table(["distance", *HEADER], rows)])


def _against(cell: dict[str, Any] | None) -> str:
    if cell is None:
        return NONE
    value, bound = _difference(cell)
    return f"{_percent(cell, 'solved'):.2f}; {signed(value)} ± {bound:.2f}"


def _files(view: View) -> str:
    rows = []
    for scale, theirs in published.DATABASE_SIZES.items():
        row = [scale]
        verdicts: Verdicts = []
        for robot in ROBOTS:
            cell = view.get(tree_cell(robot, scale, view.size))
            samples, megabytes = theirs[robot == "irb14050"]
            if cell is None:
                row.append(NONE)
                verdicts.append(None)
                continue
            ours = cell["bytes"] / 1e6
            each = (cell["bytes"] / cell["samples"], 1e6 * megabytes / samples)
            row.append(f"{ours:.2f} MB ({megabytes}); {each[0]:.1f} B ({each[1]:.1f})")
            # As far as a figure with one decimal can be met, and another release of
            # SciPy writes the same.
            verdicts.append(HOLDS if abs(ours / megabytes - 1.0) < ALIKE else FAILS)
        if any(verdicts):
            rows.append([*row, said(verdicts)])
    if not rows:
        return ""
    what = (
        'The published "query file" is SciPy\'s tree of the keys alone, pickled: file, '
        f"and of it each sample (published); *holds* within {100 * ALIKE:.0f} %."
    )
    return "\n\n".join([what, table(["file", *HEADER, "verdict"], rows)])


ALIKE = 0.05
"""Part by which a size may differ from a published one, of one or two digits."""


def _times(view: View) -> str:
    rows = []
    for claim in TIMES:
        rows += _time_rows(view, claim)
    if not rows:
        return ""
    what = (
        "What the text has take less time: mean in µs ± its bound [query, rank, "
        "iterate, re-select] (published mean in ms). Below, of each row that is to be "
        "slower, by how much it is, and by which stages: the cause where the claim "
        "does not hold."
    )
    return "\n\n".join([what, table(["claim", *HEADER, "verdict"], rows)])


def _time_rows(view: View, claim: Slower) -> list[list[str]]:
    label, overrides = claim.faster
    fast = _staged(view, overrides)
    if not any(fast):
        return []
    rows = [[f"**{claim.says}**: {label}", *_means(fast, label), ""]]
    for other, changes in claim.slower.items():
        slow = _staged(view, changes)
        rows.append([other, *_means(slow, other), ""])
        shown: list[str] = []
        verdicts: Verdicts = []
        for ours, theirs in zip(fast, slow, strict=True):
            if ours is None or theirs is None:
                shown.append(NONE)
                verdicts.append(None)
                continue
            gap = theirs["mean_us"] - ours["mean_us"]
            bound = float(np.hypot(_bound(ours), _bound(theirs)))
            stages = ", ".join(
                f"{word} {signed(theirs[stage] - ours[stage], 1)}"
                for word, stage in zip(STAGE_WORDS, STAGES, strict=True)
            )
            shown.append(f"{signed(gap, 1)} ± {bound:.1f}: {stages}")
            verdicts.append(verdict(gap, bound))
        rows.append([f"{other} less {label}", *shown, said(verdicts)])
    return rows


def _staged(view: View, overrides: dict[str, Any]) -> list[dict[str, Any] | None]:
    return [view.get(paper_cell(robot, view.size, overrides)) for robot in ROBOTS]


def _bound(cell: dict[str, Any]) -> float:
    return mean_bound(cell["std_us"], cell["targets"])


PUBLISHED = {
    **published.ABLATION_1,
    **published.ABLATION_2,
    **published.ABLATION_3,
}


def _means(cells: list[dict[str, Any] | None], label: str) -> list[str]:
    shown = []
    for i, cell in enumerate(cells):
        if cell is None:
            shown.append(NONE)
            continue
        stages = ", ".join(f"{cell[stage]:.1f}" for stage in STAGES)
        theirs = PUBLISHED[label].times[i].mean
        shown.append(
            f"{cell['mean_us']:.1f} ± {_bound(cell):.1f} [{stages}] ({theirs:.2f})"
        )
    return shown
