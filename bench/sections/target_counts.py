# SPDX-License-Identifier: BSD-3-Clause
"""How many targets of a kind each of the rivals got, as text under a table."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from bench.arms import RIVAL_ARMS
from bench.plans.rivals import rival_cell
from bench.rivals import RIVALS
from bench.size import SEED

if TYPE_CHECKING:
    from bench.view import View


def text(view: View, kind: str) -> str:
    """The count that most solvers have, and those of the others; "" of no results."""
    by_name = {name: _count(view, name, kind) for name in RIVALS}
    found = {name: count for name, count in by_name.items() if count}
    if not found:
        return ""
    usual, _ = Counter(found.values()).most_common(1)[0]
    others: dict[str, list[str]] = {}
    for name, count in found.items():
        if count != usual:
            others.setdefault(count, []).append(name)
    rest = "; ".join(f"{', '.join(names)}: {count}" for count, names in others.items())
    return f"Targets per robot, seed {SEED}: {usual}" + (f" ({rest})." if rest else ".")


def _count(view: View, name: str, kind: str) -> str:
    """Of all robots the least and the most; "" where nothing was measured."""
    cells = [view.get(rival_cell(robot, name, kind, view.size)) for robot in RIVAL_ARMS]
    counts = sorted({cell["count"] for cell in cells if cell is not None})
    return " to ".join(
        f"{count:,}" for count in dict.fromkeys([*counts[:1], *counts[-1:]])
    )
