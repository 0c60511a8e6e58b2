# SPDX-License-Identifier: BSD-3-Clause
"""Moves of redundant arms, branches beside restarts, and paths, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench import branches, restarts
from bench.bounds import at_least, share_text
from bench.markdown import microseconds, percent, table
from bench.plans import requests as plan

if TYPE_CHECKING:
    from bench.view import View

RESTARTS_PERCENT = 99.5
"""Poses of which no branch that restarts find is to be lacking."""


def text(view: View) -> str:
    """The whole section."""
    parts = [*_moves(view), *_restarts(view), *_paths(view)]
    if not parts:
        return ""
    conditions = (
        "Targets uniform in the joint limits, seed 1, default options, called from "
        "Python one pose at a time; every answer judged by bench's own forward "
        f"kinematics and the limits. *near* is a solution with normal noise of "
        f"{branches.NOISE} rad on every joint."
    )
    return "\n\n".join(["## Moves, restarts, paths", conditions, *parts])


def _verdict(part: int, whole: int, enough: float) -> str:
    word = (
        "holds"
        if 100.0 * at_least(part, whole) >= enough
        else "not refuted"
        if 100.0 * part >= enough * whole
        else "missed"
    )
    proven = share_text(part, whole)
    return f"{percent(part, whole)} % ({proven}; {enough} % aimed at: {word})"


def _moves(view: View) -> list[str]:
    rows = []
    for robot in plan.MOVE_ARMS:
        cells = {
            name: cell
            for name in plan.MOVE_RIVALS
            if (cell := view.get(plan.moves_cell(robot, name, view.size))) is not None
        }
        kinds = [
            (name, cell, cell["rival"], cell["rival_mean_us"])
            for name, cell in cells.items()
        ]
        # The same beside every rival, but for the time.
        for cell in list(cells.values())[:1]:
            for solver, norm in (("IKSel", "two"), ("IKSel, norm max", "max")):
                kinds.append((solver, cell, cell[norm], cell[norm]["mean_us"]))
        for solver, cell, moves, mean in kinds:
            rows.append([f"`{robot}`, {solver}", *_move_columns(cell, moves, mean)])
    if not rows:
        return []
    header = ["largest joint move, rad", "targets", "right %", "median", "p99"]
    title = "### Moves of redundant arms from the same seed"
    return [title, table([*header, "mean µs"], rows)]


def _move_columns(
    cell: dict[str, Any], moves: dict[str, Any], mean: float
) -> list[str]:
    return [
        f"{cell['count']:,}",
        percent(moves["right"], cell["count"]),
        f"{moves['median_largest']:.4f}",
        f"{moves['p99_largest']:.4f}",
        microseconds(mean),
    ]


def _restarts(view: View) -> list[str]:
    lines = []
    for robot in plan.RESTART_ARMS:
        cell = view.get(plan.request_cell("restarts", robot, view.size.restarts))
        if cell is None:
            continue
        count, again = cell["count"], cell["again"]
        complete = _verdict(count - cell["lacking"], count, RESTARTS_PERCENT)
        added = f"{cell['added']:,} more branches in {cell['more']:,} poses"
        if again["branches"]:
            added += (
                f" (of {again['branches']:,} of these {restarts.MORE_RESTARTS:,} "
                f"restarts find {again['found']:,})"
            )
        lines.append(
            f"- `{robot}`, {count:,} poses, {cell['branches']:,} branches: none of "
            f"{branches.RESTARTS:,} random restarts' is lacking in {complete}; "
            f"{added}; wrong or the same twice {cell['wrong']:,}; mean "
            f"{microseconds(cell['mean_us'])} µs."
        )
    if not lines:
        return []
    note = (
        "Of sets, not of their sizes; both are judged by bench's own forward "
        f"kinematics and the limits, branches are {branches.APART:g} rad apart in some "
        "joint:"
    )
    return ["### Branches beside random restarts", note, "\n".join(lines)]


PATH_TITLES = {
    "line": "1 m straight at 1 mm and 0.1 m/s",
    "flip": "a circle of 8 cm in 8 s, begun on the branch whose q5 changes its sign",
    "flip_beside": "the same with the tool tilted by 0.02 rad, which keeps q5 from 0",
    "flip_free": "the tilted one, begun on any branch",
}


def _paths(view: View) -> list[str]:
    rows = []
    for robot, name in plan.PATHS:
        cell = view.get(plan.path_cell(robot, name))
        if cell is None:
            continue
        title = f"`{robot}`, {PATH_TITLES[name]}"
        broken = "" if cell["broken"] is None else f" at waypoint {cell['broken']}"
        for solver in ("path", "points"):
            result = cell[solver]
            word = f"`solve_path`: {cell['status']}{broken}"
            label = word if solver == "path" else "point by point, `near`"
            rows.append(
                [
                    f"{title}; {label}",
                    f"{result['right']} of {cell['count']}",
                    f"{result.get('move', 0.0):.3f}",
                    f"{result.get('largest_step', 0.0):.4f}",
                    str(result.get("too_fast", 0)),
                    f"{1e6 * cell[f'{solver}_s'] / cell['count']:.0f}",
                ]
            )
    if not rows:
        return []
    header = [
        "path",
        "waypoints right",
        "joint move, rad",
        "largest step, rad",
        "steps over a velocity limit",
        "µs per waypoint",
    ]
    return ["### Paths", table(header, rows)]
