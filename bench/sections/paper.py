# SPDX-License-Identifier: BSD-3-Clause
"""The paper's tables and figures beside the published numbers, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bench.paper import plan as paper_plan
from bench.sections import ablations, choices, claims, comparisons, curves, newer
from bench.settings import command_line

if TYPE_CHECKING:
    from bench.view import View


def text(view: View) -> str:
    """The whole section."""
    if not view.has_any("evaluate") and not view.has_any("attempts"):
        return ""
    size = view.size
    noise = 100.0 * np.sqrt(0.88 * 0.12 / size.paper)
    example = command_line(paper_plan.paper_cell("cvr038", size, {}))
    conditions = (
        f"{size.paper:,} targets per robot, uniform in the limits, seed 1; times "
        "inside C++ around each solve, failures included. A cell has the success in "
        "percent and, in brackets, the published one and the difference in points "
        f"(one standard deviation of a rate of 88 % is {noise:.1f} points). The "
        "published times are of Python on another machine. One row by itself, for "
        f"example: `{example}`."
    )
    parts = [
        "## The paper",
        conditions,
        *ablations.parts(view),
        *curves.parts(view),
        claims.text(view),
        choices.text(view),
        *comparisons.parts(view),
        newer.text(view),
    ]
    return "\n\n".join(part for part in parts if part)
