# SPDX-License-Identifier: BSD-3-Clause
"""The slowest of many single calls, and their causes, as text."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from bench.markdown import microseconds, percent, table
from bench.sections.branches import KIND_WORDS
from bench.tails.plan import KINDS, calls_cell
from bench.tails.slowest import AGAIN, AROUND_M, AROUND_RAD, OTHERS, SLOWEST

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from bench.store import Settings
    from bench.view import View

STAGE_WORDS = {
    "query_us": "what is known of the solutions (closed form, roots, sweep, intervals) "
    "and the choice of seeds",
    "rank_us": "the ranking of the leaf's seeds",
    "iterate_us": "iterations from seeds and to the limits",
    "reselect_us": "the choice of further seeds",
}
"""What the stages of a solve are."""


def results_of(
    view: View, cell: str, settings: Callable[[str], Settings]
) -> list[tuple[str, dict[str, Any]]]:
    """The results of a cell by robot."""
    found = [(robot, view.get(settings(robot))) for robot in view.robots(cell)]
    return [(robot, result) for robot, result in found if result is not None]


def _cells(view: View, kind: str) -> list[tuple[str, dict[str, Any]]]:
    of_kind = partial(calls_cell, kind=kind, size=view.size)
    return results_of(view, "tail_calls", of_kind)


def parts(view: View) -> list[str]:
    """Title, table, causes and what they come to; none where nothing was measured."""
    rows, lines = [], []
    for kind in KINDS:
        for robot, cell in _cells(view, kind):
            name = f"`{robot}`, {KIND_WORDS[kind]}"
            count = calls_cell(robot, kind, view.size)["count"]
            rows.append([f"{name}, {count:,}", *_columns(cell)])
            first, again = cell["slowest"][0], cell["slowest_again"][0]
            lines.append(f"- {name}: {call_text(first, cause(first))}")
            lines.append(f"  - again: {call_text(again, by_target(again))}")
    if not rows:
        return []
    header = [
        "targets",
        "mean",
        "median",
        "p99",
        "p99.9",
        "of the targets",
        "worst",
        "of the targets",
        "slow by the machine %",
        "query / seeds / iterate",
    ]
    title = "### The slowest calls, µs"
    return [title, headline(view), table(header, rows), NOTE, "\n".join(lines)]


NOTE = (
    f"The slowest {100 * SLOWEST:g} % of the calls are called {AGAIN} times again, "
    "and those that then are the slowest; "
    "*of the targets*: with the least time of each, so without interruptions, "
    "other work and data that left the caches. *Slow by the machine*: of these "
    f"calls those that took more than {OTHERS:g} times their least. Stages: means "
    "inside C++ over reachable targets. Then the slowest call as it came, and the one "
    "that is the slowest again and again; of what is slow by the target the share of "
    f"its stages, and how many of the poses {1e3 * AROUND_M:g} mm and "
    f"{1e3 * AROUND_RAD:g} mrad away from it have an answer:"
)


def _columns(cell: dict[str, Any]) -> list[str]:
    came, least = cell["came"], cell["least"]
    return [
        *(microseconds(came[of]) for of in ("mean_us", "median_us", "p99_us")),
        *(microseconds(times["p999_us"]) for times in (came, least)),
        *(microseconds(times["max_us"]) for times in (came, least)),
        percent(cell["by_machine"], cell["again"], 0),
        " / ".join(f"{stage:.2f}" for stage in cell["stages"]),
    ]


def call_text(call: dict[str, Any], why: str) -> str:
    """One call and its cause."""
    answer = "yes" if call["answer"] else f"no ({call['proof']})"
    seed, number = call["where"]
    return (
        f"{microseconds(call['us'])} µs, again {microseconds(call['again_us'])}: "
        f"{why}; {answer}, {call['attempts']} attempts, {call['iterations']} steps; "
        f"target {number} of seed {seed}"
    )


def cause(call: dict[str, Any]) -> str:
    """Whether a call is slow by the machine, and else why."""
    if call["us"] > OTHERS * call["again_us"]:
        return "by the machine"
    return f"by the target, {by_target(call)}"


def by_target(call: dict[str, Any]) -> str:
    """Which stage takes the time of a target, and what is around it."""
    return f"{_stage(call)}; {_around(call)}"


def _stage(call: dict[str, Any]) -> str:
    """The stage that takes most, and its share."""
    stages = call["stages"]
    most = max(stages, key=stages.__getitem__)
    share = percent(stages[most], sum(stages.values()), 0)
    return f"{share} % of it in {STAGE_WORDS[most]}"


def _around(call: dict[str, Any]) -> str:
    around = call["around"]
    count, answers = around["count"], around["answers"]
    where = (
        f"all {count} poses around have an answer"
        if answers == count
        else f"none of {count} poses around has an answer"
        if answers == 0
        else f"at the edge of what has answers ({answers} of {count} poses around have)"
    )
    return f"{where}, median {microseconds(around['median_us'])} µs"


def headline(view: View) -> str:
    """p99.9 and the worst, with the robots that they are of; "" of no results."""
    sentences = []
    for kind in KINDS:
        cells = dict(_cells(view, kind))
        if not cells:
            continue
        count = calls_cell(next(iter(cells)), kind, view.size)["count"]
        first = {robot: cell["slowest"][0] for robot, cell in cells.items()}
        again = {robot: cell["slowest_again"][0] for robot, cell in cells.items()}
        came = max(cells, key=lambda robot: first[robot]["us"])
        slow = max(cells, key=lambda robot: again[robot]["again_us"])
        worst = again[slow]
        sentences.append(
            f"Of {count:,} targets a robot ({KIND_WORDS[kind]}) p99.9 is at most "
            f"{_most(cells, 'came')}, of the targets alone {_most(cells, 'least')}. "
            f"The slowest call took {microseconds(first[came]['us'])} µs (`{came}`, "
            f"{cause(first[came])}), the slowest by its target "
            f"{microseconds(worst['again_us'])} µs (`{slow}`, {by_target(worst)}). "
            + _edges([cell["edges"] for cell in cells.values()])
        )
    return " ".join(sentences)


def _edges(counts: Sequence[dict[str, int]]) -> str:
    """How much more often slow targets lie at an edge of what has answers."""
    looked = sum(edges["looked"] for edges in counts)
    slow, others = (sum(edges[of] for edges in counts) for of in ("slow", "others"))
    return (
        f"Of the {looked:,} targets that are the slowest by themselves "
        f"{percent(slow, looked, 0)} % lie at such an edge, of as many others "
        f"{percent(others, looked, 0)} %."
    )


def _most(cells: dict[str, dict[str, Any]], times: str) -> str:
    """The largest p99.9 and its robot."""
    robot = max(cells, key=lambda name: float(cells[name][times]["p999_us"]))
    return f"{microseconds(cells[robot][times]['p999_us'])} µs (`{robot}`)"
