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
            rows.append([name, *(NONE if c is None else enough(c) for c in cells)])
    what = (
        "A numerical rival proves nothing: its no is the cut-off that the bench gives "
        "it, a time or a number of starts (the settings of the rivals say which)."
    )
    if not rows:
        return what
    least = (
        f"With this cut-off, in µs a call, it would still solve {100 * ENOUGH:.1f} % "
        "of the reachable targets of the rivals' section; *never*: it does not at all:"
    )
    header = ["solver", *(f"`{robot}`" for robot in RIVAL_ARMS)]
    return "\n\n".join([f"{what} {least}", table(header, rows)])


def enough(cell: dict[str, Any]) -> str:
    """The time by which ENOUGH of a cell's targets have their right answer."""
    if cell["right"] < ENOUGH * cell["count"]:
        return f"never ({percent(cell['right'], cell['count'])} %)"
    # The quantiles are of the right answers' times alone.
    part = ENOUGH * cell["count"] / cell["right"]
    return microseconds(float(np.interp(part, QUANTILES, cell["right_quantiles_us"])))
