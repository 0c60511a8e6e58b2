# SPDX-License-Identifier: BSD-3-Clause
"""The paper's comparisons with other solvers, and two side effects, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench.markdown import NONE, microseconds, percent, table
from bench.paper import plan as paper_plan
from bench.paper import published
from bench.plans.rivals import rival_cell
from bench.sections.ablations import HEADER, ROBOTS, TIMES, beside, timed_row

if TYPE_CHECKING:
    from bench.view import View


def parts(view: View) -> list[str]:
    """The section's parts; empty where there are no results."""
    return [
        *_trac_ik(view),
        *_rotation(view),
        *_artefact(view),
    ]


def _trac_ik(view: View) -> list[str]:
    rows, times = [], []
    for label, overrides, row in (
        ("unsorted baseline (TRAC-IK)", paper_plan.UNSORTED, published.TRAC_IK),
        ("the same with the stop on small steps", paper_plan.UNSORTED_STOPPED, None),
        ("Eq. (5) (proposed)", paper_plan.BESIDE_UNSORTED, published.BESIDE_TRAC_IK),
    ):
        cells = [
            view.get(paper_plan.paper_cell(robot, view.size, overrides))
            for robot in ROBOTS
        ]
        if any(cells):
            shown = row or published.TRAC_IK
            rows.append([label, *(beside(c, shown, i) for i, c in enumerate(cells))])
            times.append([label, *(timed_row(c, row, i) for i, c in enumerate(cells))])
    parts = ["### The comparison with TRAC-IK"]
    if rows:
        log = " / ".join(f"{value:.2f}" for value in published.TRAC_IK_LOG)
        parts += [
            (
                "In the authors' log the published numbers of TRAC-IK, times included, "
                "stand under the label of the unsorted baseline: the nearest sample "
                "alone, iterated by `cwpi` without its stops (`--ranking nearest "
                "--reselection none --max-attempts 1 --iteration cwpi --min-step 0`). "
                f"Under the label of TRAC-IK that log has {log}. The row beside it is "
                "`cwpi` likewise, with Eq. (5) and one re-selection."
            ),
            table(["success % (published, difference)", *HEADER], rows),
            table([TIMES, *HEADER], times),
        ]
    rivals = []
    for name in ("TRAC-IK style", "TRAC-IK (pytracik)"):
        cells = [
            view.get(rival_cell(robot, name, "uniform", view.size)) for robot in ROBOTS
        ]
        if any(cells):
            rivals.append([name, *map(_trac_cell, cells)])
    if rivals:
        parts += [
            (
                "TRAC-IK itself, a search with restarts: right to 1e-5 m and 1e-5 rad "
                "within 5 ms, and mean time."
            ),
            table(["success %", *HEADER], rivals),
        ]
    return parts if len(parts) > 1 else []


def _trac_cell(cell: dict[str, Any] | None) -> str:
    if cell is None:
        return NONE
    right = percent(cell["right"], cell["count"])
    return f"{right}, {microseconds(cell['mean_us'])} µs"


def _rotation(view: View) -> list[str]:
    rows = []
    for key in paper_plan.ROTATION_KEYS:
        row = [key]
        for robot in ROBOTS:
            cell = view.get(
                paper_plan.attempts_cell(
                    robot, view.size, {"database.rotation_key": key}
                )
            )
            row.append(
                NONE if cell is None else percent(cell["solved"][-1], cell["count"])
            )
        if any(cell != NONE for cell in row[1:]):
            rows.append(row)
    if not rows:
        return []
    return [
        "### The representation of rotation in the KD-tree (the paper's footnote)",
        table(["success %", *HEADER], rows),
    ]


def _artefact(view: View) -> list[str]:
    rows = []
    for label, overrides in paper_plan.artefact_rows(view.size).items():
        cell = view.get(paper_plan.artefact_cell("ur3_wrs", view.size, overrides))
        if cell is None:
            continue
        count = cell["count"]
        singular = round(cell["singular_first"] * count)
        shares = (
            "singular_samples",
            "singular_neighbours",
            "singular_first",
            "singular_both",
        )
        rows.append(
            [
                label,
                f"{cell['samples']:,}",
                *(_of(cell.get(name), 1) for name in shares),
                _of(cell.get("solved_by_singular"), singular),
                _of(cell.get("solved_by_regular"), count - singular),
                percent(cell["solved"], count, 1),
            ]
        )
    if not rows:
        return []
    header = [
        "UR3",
        "samples",
        "singular samples %",
        "of the 200 nearest %",
        "ranked first %",
        "first and second %",
        "a singular first seed solves %",
        "a regular one %",
        "success %",
    ]
    return [
        "### UR3: singular samples of the grid",
        (
            "With some counts the grid has samples exactly on q3 = 0 or q5 = 0, "
            "where a UR3 is singular: the rank of the Jacobian at the cutoff of the "
            "pseudo-inverse is below 6. How often such a sample is ranked first by "
            "Eq. (5), and what it solves as the first seed:"
        ),
        table(header, rows),
    ]


def _of(part: float | None, whole: int) -> str:
    return NONE if part is None or whole == 0 else percent(part, whole, 1)
