# SPDX-License-Identifier: BSD-3-Clause
"""Every answer and the nearest, beside EAIK where it knows the arm, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench import branches, nearby
from bench.markdown import NONE, bullets, microseconds, percent, table
from bench.plans import no as plan

if TYPE_CHECKING:
    from collections.abc import Iterator

    from bench.view import View

Result = dict[str, Any]
KIND_WORDS = {plan.NO_KINDS[0]: "reachable", plan.NO_KINDS[1]: "random rotations"}
TIMES_OF_RIVAL = 1.0
"""Times of the analytic solver's mean that all solutions may take."""
NEAR_US = 10.0
"""Mean that the nearest answer may take in closed form [us]."""


def parts(view: View) -> list[str]:
    """The table, what is in it, and what it says of the aims."""
    return [_branches(view), *_longer(view), *_verdicts(view)]


def _measured(view: View) -> Iterator[tuple[str, str, Result, Result]]:
    """Robot; the same with the kind of targets; results of `solve_all` and `near`."""
    for robot in view.robots("all_branches"):
        for kind in plan.NO_KINDS:
            every, near = (
                view.get(plan.branch_cell(cell, robot, kind, view.size))
                for cell in ("all_branches", "near_branches")
            )
            if every is not None and near is not None:
                yield robot, f"`{robot}`, {KIND_WORDS[kind]}", every, near


def _branches(view: View) -> str:
    rows = [
        [
            f"{where}, {every['count']:,}",
            *_every_columns(every),
            microseconds(near["mean_us"]),
            _smallest(near),
        ]
        for _, where, every, near in _measured(view)
    ]
    header = [
        "targets",
        f"`solve_all` (p99) beside {plan.BRANCH_RIVAL}",
        "solutions",
        f"{plan.BRANCH_RIVAL}'s set in %",
        "`near`",
        "smallest move in %",
    ]
    return table(header, rows) + "\n\n" + bullets(NOTES)


NOTES = (
    (
        f"*near* is a solution with normal noise of {branches.NOISE} rad on every "
        "joint where one is known, else any configuration."
    ),
    (
        "*Smallest move*: not longer than that to any answer that is known, with its "
        f"whole turns, give or take {branches.SAME_MOVE:g} rad. Known are all that "
        f"IKSel's own `solve_all` gives, and {plan.BRANCH_RIVAL}'s branches where its "
        "set is named. Of seven joints and more `solve_all` has 64 samples of the "
        "self-motion at most: there 100 % says that `near` is no worse than these."
    ),
    (
        f"(n fewer): poses where {plan.BRANCH_RIVAL} has a branch that is right within "
        "1e-6 m and 1e-6 rad, and `solve_all` has not; (n more): the other way round."
    ),
    (
        "Both are called in turns in one process, three times each, of each call the "
        "least time."
    ),
)


def _longer(view: View) -> list[str]:
    """Why moves of redundant arms are not the least that is known."""
    lines = [
        f"{where}: {near['least_nearby']} of {near['looked_around']}"
        for _, where, _, near in _measured(view)
        if near.get("looked_around")
    ]
    if not lines:
        return []
    around = (
        f"{len(nearby.STEPS) * nearby.OF_EACH} solutions {nearby.STEPS[0]:g} to "
        f"{nearby.STEPS[-1]:g} rad away along the self-motion"
    )
    return [
        (
            "Moves of redundant arms that are longer than one that is known, and of "
            f"these the local minima, beside which none of {around} has a shorter "
            f"move: {'; '.join(lines)}. At these `near` has gone down into another "
            "valley than the least."
        )
    ]


def _every_columns(cell: dict[str, Any]) -> list[str]:
    mean = f"{microseconds(cell['mean_us'])} ({microseconds(cell['p99_us'])})"
    count = f"{cell['branches']:,}"
    if "same" not in cell:
        return [mean, count, NONE]
    notes = [f"{cell[what]} {what}" for what in ("fewer", "more") if cell[what]]
    same = percent(cell["same"], cell["count"])
    return [
        f"{mean}, {microseconds(cell['rival_mean_us'])}",
        count,
        same + (f" ({', '.join(notes)})" if notes else ""),
    ]


def _smallest(cell: dict[str, Any]) -> str:
    if not cell["solvable"]:
        return NONE
    return percent(cell["smallest"], cell["solvable"])


def _verdicts(view: View) -> list[str]:
    """The aims in closed form, each with what it missed by."""
    lines: list[str] = []
    compared: dict[str, int] = {}
    for robot, where, every, near in _measured(view):
        if "same" not in every:
            continue
        compared[robot] = compared.get(robot, 0) + every["count"]
        times = every["mean_us"] / every["rival_mean_us"]
        if times > TIMES_OF_RIVAL:
            lines.append(f"{where}: `solve_all` {times:.2f} times {plan.BRANCH_RIVAL}")
        if every["fewer"]:
            lines.append(f"{where}: {every['fewer']} sets lack a branch")
        if near["mean_us"] > NEAR_US:
            lines.append(f"{where}: `near` {microseconds(near['mean_us'])} µs")
        if near["smallest"] < near["solvable"]:
            lines.append(
                f"{where}: {near['solvable'] - near['smallest']} moves not smallest"
            )
    if not compared:
        return []
    aims = (
        f"In closed form the aims are `solve_all` in {plan.BRANCH_RIVAL}'s time and "
        f"with all its branches, and `near` in {NEAR_US:.0f} µs and with the smallest "
        f"move. On {sum(compared.values()):,} targets of "
        f"{', '.join(f'`{robot}`' for robot in compared)}, half of them reachable, "
        f"half with random rotations, seed {view.size.no_seed}"
    )
    return [f"{aims}, {'missed by ' + '; '.join(lines) if lines else 'all hold'}."]
