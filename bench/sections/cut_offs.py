# SPDX-License-Identifier: BSD-3-Clause
"""What a numerical rival's no is, as text: the cut-off that it was given."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bench.arms import RIVAL_ARMS
from bench.markdown import NONE, microseconds, percent, table
from bench.plans.no import BRANCH_RIVAL, NO_KINDS, NO_RIVALS
from bench.plans.rivals import rival_cell
from bench.timing import QUANTILES

if TYPE_CHECKING:
    from bench.view import View

PROVING = ("IKSel", BRANCH_RIVAL)
"""Solvers whose no is none of these."""
ENOUGH = 0.999
"""Part of the reachable targets that a cut-off is to leave solved."""


def text(view: View) -> str:
    """What a numerical rival's no is, and the least cut-off that would do."""
    rows = []
    for name in NO_RIVALS:
        cells = [
            view.get(rival_cell(robot, name, NO_KINDS[0], view.size))
            for robot in RIVAL_ARMS
        ]
        if any(cells) and name not in PROVING:
            counts = sorted({f"{cell['count']:,}" for cell in cells if cell})
            shown = (NONE if cell is None else enough(cell) for cell in cells)
            rows.append([f"{name} ({' to '.join(counts)})", *shown])
    what = (
        "A numerical rival proves nothing: its no is the cut-off that the bench gives "
        "it, a time or a number of starts (the settings of the rivals say which)."
    )
    if not rows:
        return what
    least = (
        f"With this cut-off, in µs a call, it would still solve {100 * ENOUGH:.1f} % "
        "of the reachable targets of the rivals' section, in brackets how many these "
        "are; *never*: it solves no more than that share of them, however long it may "
        "take within the bench's own cut-off:"
    )
    header = ["solver", *(f"`{robot}`" for robot in RIVAL_ARMS)]
    return "\n\n".join([f"{what} {least}", table(header, rows)])


def enough(cell: dict[str, Any]) -> str:
    """The least cut-off that leaves ENOUGH, or how much there is without one."""
    least = least_cut_off(cell)
    if least is None:
        return f"never ({percent(cell['right'], cell['count'])} %)"
    return microseconds(least)


def least_cut_off(cell: dict[str, Any]) -> float | None:
    """The time [us] by which ENOUGH of a cell's targets have their right answer."""
    if cell["right"] < ENOUGH * cell["count"]:
        return None
    # The quantiles are of the right answers' times alone.
    part = ENOUGH * cell["count"] / cell["right"]
    return float(np.interp(part, QUANTILES, cell["right_quantiles_us"]))
