# SPDX-License-Identifier: BSD-3-Clause
"""So many answers of redundant arms, beside solvers that can be asked for them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench.analytic.counted import CHOSEN_BY
from bench.analytic.plan import COUNTED, NUMBERS, counted_cell
from bench.branches import APART
from bench.markdown import NONE, listed, mean_median, microseconds, table
from bench.rivals import ENUMERATORS

if TYPE_CHECKING:
    from bench.view import View

OURS = "IKSel"
AIMS_US = dict(zip(NUMBERS, (40.0, 100.0), strict=True))
"""Mean times that so many answers of seven joints are to take at most [us]."""


def text(view: View) -> str:
    """The table, and what it says; empty where nothing was measured."""
    cells = _cells(view)
    if not cells:
        return ""
    header = ["arm, solver"]
    for number in NUMBERS:
        header += [
            f"{number}: targets",
            "µs",
            "right answers",
            "µs a right answer",
            "fewer, none",
        ]
    rows = [
        [f"`{robot}`, {name}", *_columns(cell, name)]
        for (robot, name), cell in cells.items()
    ]
    parts = [
        "### So many answers of seven joints",
        _conditions(),
        table(header, rows),
        *(verdict(view, number) for number in NUMBERS),
        _beside(cells),
    ]
    return "\n\n".join(part for part in parts if part)


def _cells(view: View) -> dict[tuple[str, str], dict[str, Any]]:
    """Results by arm and solver."""
    found = {
        (robot, name): view.get(counted_cell(robot, name, view.size))
        for robot in view.robots("counted")
        for name in COUNTED
    }
    return {key: cell for key, cell in found.items() if cell is not None}


def _conditions() -> str:
    sampled = [name for name in COUNTED if ENUMERATORS[name].of_samples]
    numbers = listed(list(map(str, NUMBERS)))
    return (
        f"Reachable targets, asked for {numbers} answers: {OURS}'s `max`, ssik's "
        f"`max_solutions`; {listed(sampled)} get the number of samples, in "
        f"brackets, that gives about as many right answers to {CHOSEN_BY} of them. "
        "Mean (median) of each call. *Right answers*: in the mean, those that are "
        f"{APART:g} rad apart in some joint. *Fewer, none*: targets with fewer than "
        "were asked for, and with none."
    )


def _columns(cell: dict[str, Any], name: str) -> list[str]:
    columns = []
    for number in NUMBERS:
        figures = cell[str(number)]
        samples = f" ({figures['taken']:,})" if ENUMERATORS[name].of_samples else ""
        columns += [
            f"{figures['count']:,}",
            mean_median(figures["us"]),
            f"{figures['answers'] / figures['count']:.1f}{samples}",
            NONE if not figures["answers"] else microseconds(_each(figures)),
            f"{figures['fewer']:,}, {figures['missed']:,}",
        ]
    return columns


def _each(figures: dict[str, Any], of: int = 0) -> float:
    """Time a right answer [us], by the mean or (1) by the median of the calls."""
    return float(figures["us"][of]) * int(figures["count"]) / int(figures["answers"])


def verdict(view: View, number: int) -> str:
    """On which arms the aim is reached, and by how much it is not on others."""
    within, above = [], []
    for (robot, name), cell in _cells(view).items():
        if name != OURS:
            continue
        mean, aim = cell[str(number)]["us"][0], AIMS_US[number]
        shown = f"`{robot}` ({microseconds(mean)}"
        if mean <= aim:
            within.append(shown + ")")
        else:
            above.append(f"{shown}, {mean / aim:.2f} times; {cell['structure']})")
    if not within and not above:
        return ""
    sentences = [
        f"{number} answers in at most {AIMS_US[number]:g} µs in the mean were aimed at"
    ]
    if within:
        sentences.append(f"within on {', '.join(within)}")
    if above:
        sentences.append(f"above on {', '.join(above)}")
    return "; ".join(sentences) + "."


def wrong(view: View) -> list[str]:
    """What must never be: an answer of IKSel's that is wrong or missed."""
    return [
        f"{robot}, {number} answers: {cell[number][what]} {what}"
        for (robot, name), cell in _cells(view).items()
        for number in map(str, NUMBERS)
        for what in ("wrong", "missed")
        if name == OURS and cell[number][what]
    ]


def _beside(cells: dict[tuple[str, str], dict[str, Any]]) -> str:
    """Each solver's time a right answer as a part of IKSel's, by mean and by median."""
    lines = []
    for (robot, name), cell in cells.items():
        ours = cells.get((robot, OURS))
        if name == OURS or ours is None:
            continue
        for number in map(str, NUMBERS):
            theirs = cell[number]
            if not theirs["answers"] or not ours[number]["answers"]:
                continue
            mean, median = (
                _each(theirs, of) / _each(ours[number], of) for of in (0, 1)
            )
            if min(mean, median) >= 1.0:
                continue
            lines.append(
                f"- `{robot}`, {number}: {name} {mean:.2f} of {OURS}'s mean, "
                f"{median:.2f} of its median; fewer than {number} for "
                f"{theirs['fewer']:,} of {theirs['count']:,} targets, none for "
                f"{theirs['missed']:,} ({OURS}: {ours[number]['fewer']:,}, "
                f"{ours[number]['missed']:,})"
            )
    if not lines:
        return f"{OURS} takes the least time a right answer of each arm."
    title = f"Where a right answer takes another solver less than {OURS}:"
    return "\n".join([title, "", *lines])
