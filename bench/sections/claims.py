# SPDX-License-Identifier: BSD-3-Clause
"""What the paper's text says of its tables and figures, tested by the rows."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bench.arms import PAPER_ARMS
from bench.bounds import rate_points
from bench.markdown import NONE, signed, table
from bench.paper import plan as paper_plan
from bench.paper.bounds import Margin, margin
from bench.paper.claims import (
    ALL,
    C0,
    CLAIMS,
    OVERRIDES,
    PUBLISHED,
    UR3,
    AbsentError,
    Claim,
    Row,
    longer,
    published_row,
    spread,
)
from bench.paper.published import ROBOTS, TARGETS
from bench.plans.rivals import rival_cell
from bench.sections.curves import curve

if TYPE_CHECKING:
    from collections.abc import Callable

    from bench.view import View

BETWEEN = range(1, 19)
"""#ReA at which two orders of the same 20 candidates can differ; with 19 all were
tried."""


Margins = list[Margin | None]


def text(view: View) -> str:
    """The table of claims; empty where there are no results."""
    rows = []
    for claim in CLAIMS:
        ours = margins_of(claim, _ours(view))
        if any(margin is not None for margin in ours):
            theirs = margins_of(claim, published_row)
            rows.append(_line(claim.text, claim.unit, ours, theirs))
    for what, unit, ours, theirs in _beyond_the_tables(view):
        if any(margin is not None for margin in ours):
            rows.append(_line(what, unit, ours, theirs))
    if not rows:
        return ""
    header = ["claim", *map(PAPER_ARMS.get, ROBOTS), "here", "published numbers"]
    return "\n\n".join(
        [
            "### What the text says, tested",
            (
                "By how much each claim holds (below 0: does not) [and an interval of "
                "95 %], here and, in round brackets, by the paper's own numbers where "
                "it gives them; times as the longer over the shorter, less 1. It "
                "*holds* where the whole interval is above 0, is *undecided* where 0 "
                "is in it. The figures' times and the footnote have no interval."
            ),
            table([str(name) for name in header], rows),
        ]
    )


def _ours(view: View) -> Callable[[str, int], Row]:
    def look(label: str, i: int) -> Row:
        settings = paper_plan.paper_cell(ROBOTS[i], view.size, OVERRIDES[label])
        cell = view.get(settings)
        if cell is None:
            raise AbsentError(label)
        return Row(
            success=cell["success_percent"],
            mean=cell["mean_us"],
            std=cell["std_us"],
            most=cell["max_us"],
            count=view.size.paper,
        )

    return look


def margins_of(claim: Claim, look: Callable[[str, int], Row]) -> Margins:
    """A claim's margin on each of the paper's robots; None where it has none."""
    found: Margins = []
    for i in ALL:
        try:
            shown = i in claim.robots
            found.append(margin(claim, look, i) if shown else None)
        except AbsentError:
            found.append(None)
    return found


def _line(what: str, unit: str, ours: Margins, theirs: Margins) -> list[str]:
    shown = map(beside, ours, theirs)
    return [f"{what} [{unit}]", *shown, verdict(ours), verdict(theirs)]


def beside(mine: Margin | None, other: Margin | None) -> str:
    """A margin with its interval (and the published one)."""
    if mine is None:
        return NONE
    shown = signed(mine.value)
    if mine.low != mine.high:
        shown += f" [{signed(mine.low)}, {signed(mine.high)}]"
    return shown if other is None else f"{shown} ({signed(other.value)})"


def verdict(margins: Margins) -> str:
    """Whether a claim holds, by its margins on the paper's robots."""
    known = {
        PAPER_ARMS[robot]: found
        for robot, found in zip(ROBOTS, margins, strict=True)
        if found is not None
    }
    if not known:
        return NONE
    bad = [name for name, found in known.items() if found.high <= 0]
    unclear = [name for name, found in known.items() if found.low <= 0 < found.high]
    if len(bad) == len(known):
        return "does not hold"
    parts = [f"not on {', '.join(bad)}"] if bad else []
    if unclear:
        parts.append(f"undecided on {', '.join(unclear)}")
    return "; ".join(parts) or "holds"


def _beyond_the_tables(view: View) -> list[tuple[str, str, Margins, Margins]]:
    """Claims of the figures, the footnote and the comparison."""
    farthest, in_order, nearest = paper_plan.SELECTIONS
    absent: Margins = [None] * 4
    found = []
    margins: Margins
    for sampling in ("grid", "cvt"):
        for other in (in_order, nearest):
            what = f"figure, {sampling}: farthest is above {other} at each #ReA to 18"
            margins = [
                _above(view, robot, sampling, farthest, other) for robot in ROBOTS
            ]
            found.append((what, "points", margins, absent))
    late: Margins = [
        _late(view, robot, farthest, nearest) if i in (C0, UR3) else None
        for i, robot in enumerate(ROBOTS)
    ]
    what = "figure: Eq. (2) with #ReA 20 stays below farthest with 5 on C0 and UR3"
    found.append((what, "points", late, absent))
    for name, what in (("mean_us", "time"), ("std_us", "deviation of the time")):
        for other in (nearest, in_order):
            margins = [_saved(view, robot, farthest, other, name) for robot in ROBOTS]
            line = f"figure: farthest has a smaller {what} than {other}, mean over #ReA"
            found.append((line, "%", margins, absent))
    what = "footnote: rotation keys differ by less than 1.96 standard deviations"
    found.append((what, "points", [_alike(view, robot) for robot in ROBOTS], absent))
    what = "comparison: more is solved than by TRAC-IK (here: TRAC-IK style, 5 ms)"
    theirs: Margins = [
        _points(
            PUBLISHED["beside TRAC-IK"].success[i],
            PUBLISHED["TRAC-IK"].success[i],
            TARGETS,
        )
        for i in ALL
    ]
    found.append((what, "points", [_trac_ik(view, i) for i in ALL], theirs))
    return found


def _above(
    view: View, robot: str, sampling: str, selection: str, other: str
) -> Margin | None:
    ours, theirs = (curve(view, robot, sampling, s) for s in (selection, other))
    if ours is None or theirs is None:
        return None
    rea = min(BETWEEN, key=lambda rea: ours[rea] - theirs[rea])
    return _points(ours[rea], theirs[rea], view.size.paper)


def _late(view: View, robot: str, selection: str, other: str) -> Margin | None:
    ours, theirs = (curve(view, robot, "grid", s) for s in (selection, other))
    if ours is None or theirs is None:
        return None
    return _points(ours[5], theirs[20], view.size.paper)


def _points(ours: float, theirs: float, count: int) -> Margin:
    """The difference of two rates, as if each had targets of its own."""
    value = ours - theirs
    bound = float(np.hypot(rate_points(ours, count), rate_points(theirs, count)))
    return Margin(value, value - bound, value + bound)


def _sure(value: float) -> Margin:
    """A margin without an interval."""
    return Margin(value, value, value)


def _saved(
    view: View, robot: str, selection: str, other: str, name: str
) -> Margin | None:
    parts = []
    for rea in view.size.figure_attempts:
        ours, theirs = (
            view.get(paper_plan.figure_cell(robot, view.size, s, rea))
            for s in (selection, other)
        )
        if ours is not None and theirs is not None:
            parts.append(longer(ours[name], theirs[name]))
    return _sure(float(np.mean(parts))) if parts else None


def _alike(view: View, robot: str) -> Margin | None:
    cells = [
        view.get(
            paper_plan.attempts_cell(robot, view.size, {"database.rotation_key": key})
        )
        for key in paper_plan.ROTATION_KEYS
    ]
    rates = [cell["solved"][-1] / cell["count"] for cell in cells if cell is not None]
    counts = [cell["count"] for cell in cells if cell is not None]
    if len(rates) < 2:
        return None
    mean = float(np.mean(rates))
    deviation = np.sqrt(2.0 * mean * (1.0 - mean) / counts[0])
    return _sure(float(100.0 * (1.96 * deviation - spread(rates))))


def _trac_ik(view: View, i: int) -> Margin | None:
    cell = view.get(rival_cell(ROBOTS[i], "TRAC-IK style", "uniform", view.size))
    try:
        ours = _ours(view)("beside TRAC-IK", i).success
    except AbsentError:
        return None
    if cell is None:
        return None
    return _points(ours, 100.0 * cell["right"] / cell["count"], cell["count"])
