# SPDX-License-Identifier: BSD-3-Clause
"""Which other solver is the fastest at what is asked, in a cell of README's tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench.analytic.plan import asked_cell
from bench.markdown import microseconds, percent
from bench.plans.no import NO_RIVALS
from bench.plans.rivals import rival_cell
from bench.rivals import ENUMERATORS, RIVALS
from bench.sections.cut_offs import PROVING, least_cut_off
from bench.sections.rivals import ANALYTIC, OURS

if TYPE_CHECKING:
    from bench.view import View

FEW_MISSED = 0.01
"""Part of the targets with an answer that a solver may say no to: the time of one that
says it to more is that of not looking."""

Result = dict[str, Any]


def asked(view: View, robot: str, kind: str) -> dict[str, Result]:
    """What the solvers that enumerate gave on a kind of targets, by name."""
    cells = {
        name: view.get(asked_cell(robot, name, kind, view.size)) for name in ENUMERATORS
    }
    return {name: cell for name, cell in cells.items() if cell is not None}


def numerical(view: View, robot: str) -> dict[str, Result]:
    """The cells of rivals that iterate from a start, and solve any."""
    cells = {
        name: view.get(rival_cell(robot, name, "uniform", view.size))
        for name in RIVALS
        if not name.startswith(OURS) and name not in ANALYTIC
    }
    return {name: cell for name, cell in cells.items() if cell and cell["right"]}


def next_numerical(view: View, robot: str, ours_us: float) -> str:
    """The least mean [us] of these, and how many times IKSel's that is."""
    found = numerical(view, robot)
    if not found:
        return "not measured"
    name = min(found, key=lambda solver: float(found[solver]["mean_us"]))
    mean = found[name]["mean_us"]
    share = percent(found[name]["right"], found[name]["count"], 1)
    return f"{name} {microseconds(mean)} µs ({share} %), {mean / ours_us:.0f} times"


def _of_enumerators(found: dict[str, Result]) -> dict[str, Result]:
    return {
        name: cell
        for name, cell in found.items()
        if not name.startswith(OURS) and not ENUMERATORS[name].numerical
    }


def enumerating(found: dict[str, Result]) -> str:
    """The fastest that misses none, for one answer or else for all, beside IKSel.

    Where all miss some, the one that misses least.

    Args:
        found: Results of reachable targets, of IKSel and of solvers that enumerate.
    """
    if not found:
        return "not measured"
    rows = {}
    for name, cell in _of_enumerators(found).items():
        way = "one" if cell.get("one") else "every"
        figures = cell.get(way)
        if figures and figures["us"] and figures["missed"] < figures["count"]:
            rows[name] = (way, figures)
    if not rows:
        return "none of those asked"

    def worth(name: str) -> tuple[int, float]:
        figures = rows[name][1]
        return figures["missed"] + figures["wrong"], figures["us"][0]

    name = min(rows, key=worth)
    way, figures = rows[name]
    ours = found.get(OURS, {}).get(way)
    notes = [f"IKSel {microseconds(ours['us'][0])}"] if ours and ours["us"] else []
    notes += [
        f"{figures[what]:,} of {figures['count']:,} {what}"
        for what in ("missed", "wrong")
        if figures[what]
    ]
    asked_for = " for all" if way == "every" else ""
    text = f"{name} {microseconds(figures['us'][0])} µs{asked_for}"
    return text + (f" ({', '.join(notes)})" if notes else "")


def enumerators_no(found: dict[str, Result]) -> str:
    """The fastest no of a solver that enumerates, with what it calls a no wrongly.

    Args:
        found: Results of turned targets, of solvers that enumerate.
    """
    rows = {
        name: cell
        for name, cell in _of_enumerators(found).items()
        if cell["us"] and cell["missed"] <= FEW_MISSED * (cell["count"] - cell["noes"])
    }
    if not rows:
        return "none of those asked" if found else "not measured"
    name = min(rows, key=lambda solver: float(rows[solver]["us"][0]))
    cell = rows[name]
    missed = f" (misses {cell['missed']} of {cell['count'] - cell['noes']:,})"
    text = f"{name} {microseconds(cell['us'][0])} µs"
    return text + (missed if cell["missed"] else "")


def cut_off(view: View, robot: str) -> str:
    """The least cut-off of a numerical solver that leaves enough solved."""
    least = {
        name: us
        for name, cell in numerical(view, robot).items()
        if name in NO_RIVALS and name not in PROVING
        if (us := least_cut_off(cell)) is not None
    }
    if not least:
        return "no cut-off would do"
    name = min(least, key=lambda solver: least[solver])
    return f"cut-off of {name} {microseconds(least[name])} µs"
