# SPDX-License-Identifier: BSD-3-Clause
"""The paper's comparisons with other solvers, and two side effects, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bench import plan
from bench.arms import PAPER_ARMS
from bench.markdown import NONE, microseconds, percent, signed, table
from bench.paper import plan as paper_plan
from bench.paper import published
from bench.sections.ablations import HEADER, ROBOTS, beside, rows_2, rows_3
from bench.timing import QUANTILES

if TYPE_CHECKING:
    from bench.view import View


def parts(view: View) -> list[str]:
    """The section's parts; empty where there are no results."""
    return [
        *_trac_ik(view),
        *_rotation(view),
        *_artefact(view),
        *_ik_geo(view),
    ]


def _trac_ik(view: View) -> list[str]:
    ours = _nearest_rows(view, published.BESIDE_TRAC_IK)
    rows = []
    for name in ("TRAC-IK style", "TRAC-IK (pytracik)"):
        cells = [
            view.get(plan.rival_cell(robot, name, "uniform", view.size))
            for robot in ROBOTS
        ]
        if any(cells):
            rows.append([name, *(_trac_cell(cell, i) for i, cell in enumerate(cells))])
            rows.append(
                [
                    f"{name}: time after which the published rate was reached, µs",
                    *(_time_to(cell, i) for i, cell in enumerate(cells)),
                ]
            )
    if not rows and not ours:
        return []
    parts = ["### The comparison with TRAC-IK"]
    if rows:
        parts += [
            (
                "Right to 1e-5 m and 1e-5 rad within 5 ms (published rate at 1e-4 m "
                "and 1e-3 rad, difference), mean time."
            ),
            table(["TRAC-IK", *HEADER], rows),
            (
                "Ended at the times in the second row of each, these searches have the "
                "published rates; a limit on time or restarts that is not stated would "
                "explain them."
            ),
        ]
    if ours:
        parts += [
            (
                "The paper's own row beside TRAC-IK is none of its ablations' rows. "
                "How far ours are from it, the nearest three by their largest "
                "difference:"
            ),
            table(["success %", *HEADER, "largest difference"], ours),
        ]
    return parts


def _trac_cell(cell: dict[str, Any] | None, i: int) -> str:
    if cell is None:
        return NONE
    ours = 100.0 * cell["right"] / cell["count"]
    theirs = published.TRAC_IK.success[i]
    mean = microseconds(cell["mean_us"])
    return f"{ours:.2f} ({theirs:.2f}, {signed(ours - theirs)}), {mean} µs"


def _time_to(cell: dict[str, Any] | None, i: int) -> str:
    """When the share of solved targets passed the published one."""
    if cell is None or not cell["right_quantiles_us"]:
        return NONE
    part = published.TRAC_IK.success[i] / 100.0 * cell["count"] / cell["right"]
    if part > 1.0:
        return "never"
    return microseconds(float(np.interp(part, QUANTILES, cell["right_quantiles_us"])))


def _nearest_rows(view: View, row: published.Row) -> list[list[str]]:
    candidates = []
    for number, rows in (("II", rows_2()), ("III", rows_3())):
        for label, overrides, _ in rows:
            cells = [
                view.get(paper_plan.paper_cell(robot, view.size, overrides))
                for robot in ROBOTS
            ]
            if all(cells):
                values = [cell["success_percent"] for cell in cells if cell]
                far = max(abs(a - b) for a, b in zip(values, row.success, strict=True))
                candidates.append((far, f"{number} {label}", cells))
    candidates.sort(key=lambda candidate: candidate[0])
    return [
        [label, *(beside(cell, row, i) for i, cell in enumerate(cells)), f"{far:.2f}"]
        for far, label, cells in candidates[:3]
    ]


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
        if cell is not None:
            rows.append(
                [
                    label,
                    f"{cell['samples']:,}",
                    *(
                        f"{100.0 * cell[name]:.1f}"
                        for name in (
                            "singular_samples",
                            "singular_neighbours",
                            "singular_first",
                        )
                    ),
                    percent(cell["solved"], cell["count"], 1),
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
        "success %",
    ]
    return [
        "### Why UR3 is so low: singular samples of the grid",
        (
            "With some counts the grid has samples exactly on q3 = 0 or q5 = 0, "
            "where a UR3 is singular. The truncated pseudo-inverse leaves out the "
            "direction that would take long, so Eq. (5) puts these samples first. "
            "Samplings that are not aligned with the set have few, and near it only."
        ),
        table(header, rows),
    ]


def _ik_geo(view: View) -> list[str]:
    rows, reasons = [], []
    for robot in ("cvr038", "cvrb1213", "ur3_wrs"):
        settings = paper_plan.seeds_cell(robot, view.size)
        cell = view.get(settings)
        theirs = [published.IK_GEO[how].get(robot) for how in ("direct", "as seed")]
        if cell is None:
            missing = view.report["missing"].get("IK-Geo")
            reasons.append(f"`{robot}`: {missing or view.why_not(settings)}")
            continue
        rows.append(
            [
                PAPER_ARMS[robot],
                *_pair(
                    cell["direct_right"],
                    cell["count"],
                    cell["direct_mean_us"],
                    theirs[0],
                ),
                *_pair(cell["right"], cell["count"], cell["mean_us"], theirs[1]),
            ]
        )
    parts = [
        "### IK-Geo, directly and as seed",
        (
            "Success in percent (published), mean time. The paper searched joint 4 "
            "of C0 and C1 in 36 divisions in Python; the package ik-geo has closed "
            "forms, and its own one-dimensional search for arms like C0 and C1."
        ),
    ]
    header = ["", "direct %", "µs", "as seed %", "µs"]
    if rows:
        parts.append(table(header, rows))
    if reasons:
        parts.append("Not run: " + "; ".join(reasons) + ".")
    return parts


def _pair(
    right: int, count: int, mean_us: float, theirs: tuple[float, float] | None
) -> list[str]:
    shown = percent(right, count) + (f" ({theirs[0]:.2f})" if theirs else "")
    published_ms = f" ({theirs[1]:.2f} ms)" if theirs else ""
    return [shown, microseconds(mean_us) + published_ms]
