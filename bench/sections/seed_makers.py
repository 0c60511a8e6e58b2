# SPDX-License-Identifier: BSD-3-Clause
"""All makers of seeds on the same targets, and what they lead to, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from bench.arms import PAPER_ARMS
from bench.markdown import NONE, microseconds, percent, signed, table
from bench.paper import seeding
from bench.seed_makers import MAKERS, Learned

if TYPE_CHECKING:
    from bench.view import View

HEADER = [
    "language",
    "seeds per target",
    "time for seeds, µs",
    "iterations",
    "success of the first attempt, %",
    "failed",
    "of these without a seed",
]

EQ_5 = "paper's database, Eq. (5)"
EQ_2 = "paper's database, nearest, Eq. (2)"
RANDOM = "random"
REDUCED = "reduced database, Eq. (5)"
AWARE = "reduced database, Eq. (5), limits"


def text(view: View) -> str:
    """The whole section."""
    if not view.has_any("first_attempt"):
        return ""
    conditions = (
        f"{seeding.seeding_cell('', '', view.size)['count']:,} targets per robot, the "
        "same for all, uniform in the limits, seed 1. One attempt from the first seed "
        "by the paper's iteration (`dls`, its 7 iterations, 1e-4 m and 1e-3 rad), "
        "nothing after it. One pose a call; C++: query and ranking inside `solve`, the "
        "others around a call from Python. The reduced database is the default "
        "preset's, 2,000 samples, searched and ranked as the paper does (the default "
        "preset itself asks one leaf and iterates otherwise); *limits*: candidates "
        "that a first step takes out of them come last."
    )
    rows = [_row(view, robot, name) for robot in PAPER_ARMS for name in MAKERS]
    parts = [
        "## Where the seeds come from",
        conditions,
        table(["", *HEADER], rows),
        where_it_leads(view),
    ]
    return "\n\n".join(part for part in parts if part)


def _row(view: View, robot: str, name: str) -> list[str]:
    cell = _measured(view, robot, name)
    head = [f"{PAPER_ARMS[robot]}, {name}", MAKERS[name].language]
    if cell is None:
        why = view.why_not(seeding.maker_cell(robot, name, view.size))
        return [*head, *[NONE] * (len(HEADER) - 2), why]
    return [
        *head,
        f"{cell['seeds']:.3g}",
        microseconds(cell["seeds_us"]),
        f"{cell['iterations']:.2f}",
        percent(cell["right"], cell["count"]),
        f"{cell['count'] - cell['right']:,}",
        f"{cell['without_seed']:,}",
    ]


def _measured(view: View, robot: str, name: str) -> dict[str, Any] | None:
    """What a maker's first seeds were worth on a robot; None: not measured."""
    cell = view.get(seeding.maker_cell(robot, name, view.size))
    maker = MAKERS[name]
    if cell is None or not isinstance(maker, Learned):
        return cell
    figures = cell[maker.output]
    given = {"count": cell["count"], "seeds": 1.0, "without_seed": 0}
    return {**figures, **given, "seeds_us": figures["output_us"]}


class Mean(NamedTuple):
    """A maker over the robots that it was measured on."""

    robots: list[str]
    success: float
    """Percent."""
    seeds_us: float


def means(view: View) -> dict[str, Mean]:
    """Each maker that was measured, over its robots."""
    found = {}
    for name in MAKERS:
        cells: dict[str, dict[str, Any]] = {
            robot: cell
            for robot in PAPER_ARMS
            if (cell := _measured(view, robot, name))
        }
        if cells:
            found[name] = Mean(
                list(cells),
                _mean(100.0 * c["right"] / c["count"] for c in cells.values()),
                _mean(c["seeds_us"] for c in cells.values()),
            )
    return found


def _mean(values: Any) -> float:
    each = list(values)
    return float(sum(each) / len(each))


def where_it_leads(view: View) -> str:
    """What the paper asks, answered in three sentences with figures of the cells."""
    found = means(view)
    needed = EQ_5, EQ_2, RANDOM, REDUCED, AWARE
    if any(name not in found for name in needed):
        return ""
    eq_5, eq_2, random, reduced, aware = (found[name] for name in needed)
    everywhere = {n: m for n, m in found.items() if m.robots == eq_5.robots}
    best = max(everywhere, key=lambda name: everywhere[name].success)
    first = (
        f"Over {_names(eq_5.robots)}, a first attempt arrives from "
        f"{eq_5.success:.1f} % of the seeds that Eq. (5) selects, from "
        f"{eq_2.success:.1f} % of the nearest (Eq. 2) and {random.success:.1f} % of "
        f"random ones; the most, {everywhere[best].success:.1f} %, from {best}."
    )
    second = (
        "The reduced database in the place of the paper's is worth "
        f"{signed(reduced.success - eq_5.success, 1)} points, and looking at the "
        f"limits too {signed(aware.success - reduced.success, 1)} more, at "
        f"{microseconds(aware.seeds_us)} µs for the seeds against "
        f"{microseconds(eq_5.seeds_us)}."
    )
    return " ".join([first, second, _others(found)])


def _others(found: dict[str, Mean]) -> str:
    """Those that do not select from a database, each where it was measured."""
    others = [
        f"{name} {mean.success:.1f} % at {microseconds(mean.seeds_us)} µs "
        f"({_names(mean.robots)})"
        for name, mean in found.items()
        if "database" not in name and name != RANDOM
    ]
    if not others:
        return ""
    return f"What makes a seed instead of selecting it: {'; '.join(others)}."


def _names(robots: list[str]) -> str:
    return ", ".join(PAPER_ARMS[robot] for robot in robots)
