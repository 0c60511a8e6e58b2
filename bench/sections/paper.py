# SPDX-License-Identifier: BSD-3-Clause
"""The paper's tables beside the published numbers, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bench import plan
from bench.arms import PAPER_ARMS
from bench.cells import command_line
from bench.markdown import NONE, microseconds, percent, signed, table
from bench.paper import published
from bench.timing import QUANTILES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bench.view import View

POINTS = 4.0
"""A success rate farther than this from the published one needs a reason [percent]."""

ROBOTS = published.ROBOTS
HEADER = [f"{PAPER_ARMS[robot]}" for robot in ROBOTS]

REASONS = {
    ("II", "pinv_rr"): "the row `pinv_rr, 6 steps`: read literally, 7 iterations are 7 "
    "evaluations with 6 steps between them; the reference implementation at its head, "
    "which the preset follows, makes 8 steps, and a restart inside the budget gains most "
    "from the two more",
    (
        "II",
        "cwpi",
    ): "the row `cwpi, growth stop on`: the reference implementation at its "
    "head gives up when both errors grow, though the text says that this test is off",
}
"""What an experiment in the same table shows about rows that differ."""


def text(view: View) -> str:
    """The whole section."""
    if not view.has_any("evaluate") and not view.has_any("attempts"):
        return ""
    size = view.size
    noise = 100.0 * np.sqrt(0.88 * 0.12 / size.paper)
    parts = [
        "## The paper",
        f"{size.paper:,} targets per robot, uniform in the limits, seed 1; times inside "
        "C++ around each solve, failures included. Each cell: success in percent, the "
        "published one, the difference in points "
        f"(one standard deviation of a rate of 88 % is {noise:.1f} points). The "
        "published times are of Python on another machine. "
        f"For example: `{command_line(plan.paper_cell('cvr038', size, {}))}`.",
        *_ablation(view, "I", "size of the database", _rows_1(view)),
        *_ablation(view, "II", "scheme of iteration", _rows_2(view)),
        _cwln_outside(view),
        *_ablation(view, "III", "ranking and number of re-selections", _rows_3(view)),
        _distances(view),
        _orderings(view),
        *_cvt(view),
        *_figures(view),
        *_trac_ik(view),
        *_rotation(view),
        *_artefact(view),
        *_ik_geo(view),
        _learned(),
    ]
    return "\n\n".join(part for part in parts if part)


Rows = list[tuple[str, dict[str, Any], published.Row | None]]
"""Label, overrides, and the published row of that label."""


def _rows_1(view: View) -> Rows:
    del view
    return [
        (scale, plan.sampling_of("grid", scale), row)
        for scale, row in published.ABLATION_1.items()
    ]


def _rows_2(view: View) -> Rows:
    del view
    return [
        (label, plan.ablation_2(label), published.ABLATION_2[label.partition(",")[0]])
        for label in plan.ABLATION_2_ROWS
    ]


def _rows_3(view: View) -> Rows:
    del view
    return [
        (label, changes, published.ABLATION_3[label.partition(",")[0]])
        for label, changes in plan.ABLATION_3_ROWS.items()
    ]


def _ablation(view: View, number: str, what: str, rows: Rows) -> list[str]:
    success, times = [], []
    for label, overrides, row in rows:
        cells = [
            view.get(plan.paper_cell(robot, view.size, overrides)) for robot in ROBOTS
        ]
        if not any(cells):
            continue
        success.append(
            [label, *(_beside(cell, row, i) for i, cell in enumerate(cells))]
        )
        times.append([label, *(_time(cell, row, i) for i, cell in enumerate(cells))])
    if not success:
        return []
    return [
        f"### Ablation {number}: {what}",
        table(["success %", *HEADER], success),
        table(["mean ± std (p99) in µs; published mean in ms", *HEADER], times),
    ]


def _beside(cell: dict[str, Any] | None, row: published.Row | None, i: int) -> str:
    if cell is None:
        return NONE
    ours = cell["success_percent"]
    if row is None:
        return f"{ours:.2f}"
    difference = ours - row.success[i]
    mark = "**" if abs(difference) > POINTS else ""
    return f"{ours:.2f} ({row.success[i]:.2f}, {mark}{signed(difference)}{mark})"


def _time(cell: dict[str, Any] | None, row: published.Row | None, i: int) -> str:
    if cell is None:
        return NONE
    text_ = f"{cell['mean_us']:.0f} ± {cell['std_us']:.0f} ({cell['p99_us']:.0f})"
    return text_ + (f"; {row.mean_ms[i]:.2f}" if row and row.mean_ms else "")


def differences(view: View) -> list[tuple[str, str, str, float]]:
    """Table, row, robot and difference of every success rate that was published."""
    found = []
    for number, rows in (
        ("I", _rows_1(view)),
        ("II", _rows_2(view)),
        ("III", _rows_3(view)),
    ):
        for label, overrides, row in rows:
            for i, robot in enumerate(ROBOTS):
                cell = view.get(plan.paper_cell(robot, view.size, overrides))
                if cell is not None and row is not None:
                    difference = cell["success_percent"] - row.success[i]
                    found.append((number, label, robot, difference))
    return found


def _distances(view: View) -> str:
    found = [entry for entry in differences(view) if ", " not in entry[1]]
    if not found:
        return ""
    near = sum(abs(entry[3]) <= POINTS for entry in found)
    lines = [
        f"{near} of the {len(found)} published rates are met within {POINTS:.0f} points."
    ]
    beyond = [entry for entry in found if abs(entry[3]) > POINTS]
    for number, label in dict.fromkeys((entry[0], entry[1]) for entry in beyond):
        which = ", ".join(
            f"{PAPER_ARMS[robot]} {signed(difference)}"
            for n, row, robot, difference in beyond
            if (n, row) == (number, label)
        )
        reason = REASONS.get((number, label), "no reason was found")
        lines.append(f"- Ablation {number}, `{label}` ({which}): {reason}.")
    return "\n".join(lines)


def _cwln_outside(view: View) -> str:
    rows = []
    for robot in ROBOTS:
        cell = view.get(plan.attempts_cell(robot, view.size, plan.ablation_2("cwln")))
        if cell is not None:
            outside = percent(cell["converged_outside_limits"], cell["count"])
            rows.append(f"{PAPER_ARMS[robot]} {outside} %")
    if not rows:
        return ""
    return (
        "The reference code does not check the limits after CWLN; IKSel does. Converged "
        f"outside the limits, on top of the row `cwln`: {', '.join(rows)}."
    )


def _orderings(view: View) -> str:
    lines = []
    for claim, hold in (
        ("a larger grid is better", _larger(view)),
        ("Eq. (5) is above Eq. (2)", _eq5(view)),
        ("success rises with #ReA", _rising(view)),
        ("farthest is above in order, #ReA 1 to 19", _farthest(view)),
    ):
        if hold:
            bad = [PAPER_ARMS[robot] for robot, yes in hold.items() if not yes]
            lines.append(
                f"- {claim}: " + (f"not on {', '.join(bad)}" if bad else "holds on all")
            )
    return "\n".join(["The paper's orderings:", "", *lines]) if lines else ""


def _percents(view: View, robot: str, rows: Sequence[dict[str, Any]]) -> list[float]:
    cells = [view.get(plan.paper_cell(robot, view.size, row)) for row in rows]
    return [cell["success_percent"] for cell in cells if cell is not None]


def _larger(view: View) -> dict[str, bool]:
    rows = [plan.sampling_of("grid", scale) for scale in published.ABLATION_1]
    return _increasing(view, rows)


def _eq5(view: View) -> dict[str, bool]:
    return _increasing(
        view, [plan.ABLATION_3_ROWS["Eq. (2)"], plan.ABLATION_3_ROWS["Eq. (5)"]]
    )


def _rising(view: View) -> dict[str, bool]:
    labels = ("Eq. (5)", "#ReA 3", "#ReA 5", "#ReA 10", "#ReA 20")
    return _increasing(view, [plan.ABLATION_3_ROWS[label] for label in labels])


def _increasing(view: View, rows: Sequence[dict[str, Any]]) -> dict[str, bool]:
    result = {}
    for robot in ROBOTS:
        values = _percents(view, robot, rows)
        if len(values) == len(rows):
            result[robot] = bool(np.all(np.diff(values) > 0))
    return result


def curve(view: View, robot: str, sampling: str, selection: str) -> list[float] | None:
    """Success in percent at #ReA 0, 1, ... 20."""
    base = plan.sampling_of(sampling)
    cell = view.get(plan.curve_cell(robot, view.size, base, selection))
    return None if cell is None else [100.0 * n / cell["count"] for n in cell["solved"]]


def _farthest(view: View) -> dict[str, bool]:
    result = {}
    for robot in ROBOTS:
        farthest = curve(view, robot, "grid", "Eq. (5), farthest")
        in_order = curve(view, robot, "grid", "Eq. (5), in order")
        if farthest and in_order:
            # With all 20 candidates tried, both have tried the same.
            result[robot] = all(
                a > b for a, b in zip(farthest[1:19], in_order[1:19], strict=True)
            )
    return result


def _cvt(view: View) -> list[str]:
    rows = []
    for scale in view.size.cvt_scales:
        cells = [
            view.get(plan.paper_cell(robot, view.size, plan.sampling_of("cvt", scale)))
            for robot in ROBOTS
        ]
        if any(cells):
            rows.append([f"I {scale}", *(_beside(cell, None, 0) for cell in cells)])
    if "medium" in view.size.cvt_scales:
        more = [("II", _rows_2(view)), ("III", _rows_3(view))]
        for number, table_rows in more:
            for label, overrides, _ in table_rows:
                changes = {**plan.sampling_of("cvt"), **overrides}
                cells = [
                    view.get(plan.paper_cell(robot, view.size, changes))
                    for robot in ROBOTS
                ]
                if any(cells):
                    row = [_beside(cell, None, 0) for cell in cells]
                    rows.append([f"{number} {label}", *row])
    if not rows:
        return []
    parts = [
        "### The same with CVT, as in the authors' revision",
        table(["success %", *HEADER], rows),
    ]
    beside = []
    for i, attempts in enumerate(published.CVT_ATTEMPTS):
        row = []
        for robot in ROBOTS:
            ours = curve(view, robot, "cvt", "Eq. (5), farthest")
            if ours is None:
                row.append(NONE)
                continue
            value = ours[attempts - 1]
            theirs = published.CVT[robot][i]
            row.append(f"{value:.2f} ({theirs:.1f}, {signed(value - theirs)})")
        beside.append([f"{attempts} attempts", *row])
    if any(cell != NONE for row in beside for cell in row[1:]):
        parts.append("Beside the authors' own runs with CVT at these counts:")
        parts.append(table(["success %", *HEADER], beside))
    return parts


def _figures(view: View) -> list[str]:
    rows = []
    for sampling in ("grid", "cvt"):
        row = []
        for robot in ROBOTS:
            base = plan.sampling_of(sampling)
            cell = view.get(plan.ceiling_cell(robot, view.size, base))
            row.append(
                NONE if cell is None else percent(cell["solved"][-1], cell["count"])
            )
        if any(cell != NONE for cell in row):
            rows.append([f"{sampling}, 100 attempts", *row])
    if not rows and not view.has_any("attempts"):
        return []
    return [
        "### The two figures",
        "![Success and mean time over the number of re-selections]"
        "(plots/paper_attempts.svg)",
        "![Mean and standard deviation of the time](plots/paper_times.svg)",
        table(["ceiling, success %", *HEADER], rows) if rows else "",
    ]


def _trac_ik(view: View) -> list[str]:
    ours = _nearest_rows(view, published.BESIDE_TRAC_IK)
    rows = []
    for label, name in (
        ("TRAC-IK style in C++", "TRAC-IK style"),
        ("pytracik", "TRAC-IK"),
    ):
        cells = [
            view.get(plan.rival_cell(robot, name, "uniform", view.size))
            for robot in ROBOTS
        ]
        if any(cells):
            rows.append([label, *(_trac_cell(cell, i) for i, cell in enumerate(cells))])
            rows.append(
                [
                    f"{label}: time after which the published rate was reached, µs",
                    *(_time_to(cell, i) for i, cell in enumerate(cells)),
                ]
            )
    if not rows and not ours:
        return []
    parts = ["### The comparison with TRAC-IK"]
    if rows:
        parts += [
            "Right to 1e-5 m and 1e-5 rad within 5 ms (published rate at 1e-4 m and "
            "1e-3 rad, difference), mean time.",
            table(["TRAC-IK", *HEADER], rows),
            "The published rates are those of a search that was ended early: the same "
            "search reaches them in a small part of its 5 ms, and goes on from there.",
        ]
    if ours:
        parts += [
            "The paper's own row beside TRAC-IK is not one of its ablations' rows. How far "
            "ours are from it, by their largest difference:",
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
    for number, rows in (("II", _rows_2(view)), ("III", _rows_3(view))):
        for label, overrides, _ in rows:
            cells = [
                view.get(plan.paper_cell(robot, view.size, overrides))
                for robot in ROBOTS
            ]
            if all(cells):
                values = [cell["success_percent"] for cell in cells if cell]
                far = max(abs(a - b) for a, b in zip(values, row.success, strict=True))
                candidates.append((far, f"{number} {label}", cells))
    candidates.sort(key=lambda candidate: candidate[0])
    return [
        [label, *(_beside(cell, row, i) for i, cell in enumerate(cells)), f"{far:.2f}"]
        for far, label, cells in candidates[:3]
    ]


def _rotation(view: View) -> list[str]:
    rows = []
    for key in plan.ROTATION_KEYS:
        row = [key]
        for robot in ROBOTS:
            cell = view.get(
                plan.attempts_cell(robot, view.size, {"database.rotation_key": key})
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
    for label, overrides in plan.ARTEFACT_ROWS.items():
        cell = view.get(plan.artefact_cell("ur3_wrs", view.size, overrides))
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
        "With some counts the grid has samples exactly on q3 = 0 or q5 = 0, where a UR3 "
        "is singular. The truncated pseudo-inverse leaves out the direction that would "
        "take long, so Eq. (5) puts these samples first. Another sampling has none.",
        table(header, rows),
    ]


def _ik_geo(view: View) -> list[str]:
    rows, reasons = [], []
    for robot in ("cvr038", "cvrb1213", "ur3_wrs"):
        settings = plan.seeds_cell(robot, view.size)
        cell = view.get(settings)
        theirs = [published.IK_GEO[how].get(robot) for how in ("direct", "as seed")]
        if cell is None:
            reasons.append(f"`{robot}`: {view.why_not(settings)}")
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
        "Success in percent (published), mean time. The paper searched joint 4 of C0 and "
        "C1 in 36 divisions in Python; the package ik-geo has closed forms, and its own "
        "one-dimensional search for arms like C0 and C1.",
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


def _learned() -> str:
    rows = [
        [name, *(f"{value:.2f}" for value in values)]
        for name, values in published.LEARNED.items()
    ]
    return "\n\n".join(
        [
            "### Not run: learned seeds",
            "Published only; the trained models are not public.",
            table(["success %", *HEADER], rows),
        ]
    )
