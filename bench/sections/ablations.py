# SPDX-License-Identifier: BSD-3-Clause
"""The paper's ablations and figures beside the published numbers, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench.arms import PAPER_ARMS
from bench.markdown import NONE, percent, signed, table
from bench.paper import plan as paper_plan
from bench.paper import published

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bench.view import View

POINTS = 4.0
"""A success rate farther than this from the published one is shown in bold [points]."""

ROBOTS = published.ROBOTS
HEADER = [f"{PAPER_ARMS[robot]}" for robot in ROBOTS]


def parts(view: View) -> list[str]:
    """The section's parts; empty where there are no results."""
    return [
        *_ablation(view, "Ablation I: size of the database", rows_1()),
        _sizes(view),
        *_ablation(view, "Ablation II: scheme of iteration", rows_2()),
        _readings(view),
        _cwln_outside(view),
        *_ablation(view, "Ablation III: ranking and number of re-selections", rows_3()),
        _distances(view),
        *_ablation(view, "Kinematics: KDL, as in the paper, and IKSel", kinematics()),
        *_cvt(view),
    ]


Rows = list[tuple[str, dict[str, Any], published.Row | None]]
"""Label, overrides, and the published row of that label."""


def rows_1() -> Rows:
    """Ablation I."""
    return [
        (scale, paper_plan.sampling_of("grid", scale), row)
        for scale, row in published.ABLATION_1.items()
    ]


def rows_2() -> Rows:
    """Ablation II, with the second readings."""
    return [
        (
            label,
            changes,
            published.ABLATION_2[label.partition(",")[0]],
        )
        for label, changes in paper_plan.ABLATION_2_ROWS.items()
    ]


def rows_3() -> Rows:
    """Ablation III, with the second reading."""
    return [
        (label, changes, published.ABLATION_3[label.partition(",")[0]])
        for label, changes in paper_plan.ABLATION_3_ROWS.items()
    ]


def kinematics() -> Rows:
    """The preset by KDL's kinematics, and by the library's."""
    return [(name, row, None) for name, row in paper_plan.KINEMATICS_ROWS.items()]


def _ablation(view: View, title: str, rows: Rows) -> list[str]:
    success, times = [], []
    for label, overrides, row in rows:
        cells = [
            view.get(paper_plan.paper_cell(robot, view.size, overrides))
            for robot in ROBOTS
        ]
        if not any(cells):
            continue
        success.append([label, *(beside(cell, row, i) for i, cell in enumerate(cells))])
        times.append(
            [label, *(timed_row(cell, row, i) for i, cell in enumerate(cells))]
        )
    if not success:
        return []
    return [
        f"### {title}",
        table(["success %", *HEADER], success),
        table([TIMES, *HEADER], times),
    ]


def beside(cell: dict[str, Any] | None, row: published.Row | None, i: int) -> str:
    """A success rate with the published one and the difference."""
    if cell is None:
        return NONE
    ours = cell["success_percent"]
    if row is None:
        return f"{ours:.2f}"
    difference = ours - row.success[i]
    mark = "**" if abs(difference) > POINTS else ""
    return f"{ours:.2f} ({row.success[i]:.2f}, {mark}{signed(difference)}{mark})"


TIMES = "mean ± std [min, max], here in µs; published in ms"


def timed_row(cell: dict[str, Any] | None, row: published.Row | None, i: int) -> str:
    """A cell's times beside the published ones of robot i."""
    return NONE if cell is None else timed(cell, None if row is None else row.times[i])


def timed(cell: dict[str, Any], theirs: published.Times | None) -> str:
    """A cell's times beside published ones, as TIMES says."""
    ours = (
        f"{cell['mean_us']:.0f} ± {cell['std_us']:.0f} "
        f"[{cell['min_us']:.0f}, {cell['max_us']:.0f}]"
    )
    if theirs is None:
        return ours
    return (
        f"{ours}; {theirs.mean:.2f} ± {theirs.std:.2f} "
        f"[{theirs.least:.2f}, {theirs.most:.2f}]"
    )


def differences(view: View) -> list[tuple[str, str, str, float]]:
    """Table, row, robot and difference of every success rate that was published."""
    found = []
    for number, rows in (
        ("I", rows_1()),
        ("II", rows_2()),
        ("III", rows_3()),
    ):
        for label, overrides, row in rows:
            for i, robot in enumerate(ROBOTS):
                cell = view.get(paper_plan.paper_cell(robot, view.size, overrides))
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
        f"{near} of {len(found)} published rates are met within {POINTS:.0f} points."
    ]
    beyond = [entry for entry in found if abs(entry[3]) > POINTS]
    lines += [
        f"Ablation {number}, `{label}`, {PAPER_ARMS[robot]} is not: "
        f"{signed(difference)} points."
        for number, label, robot, difference in beyond
    ]
    return " ".join(lines)


def _readings(view: View) -> str:
    """What the rows of Table II are, and how much the readings of pinv_rr differ."""
    parts_ = [
        (
            "`dls` is what the reference implementation has under that name, truncated "
            "least squares: damping 0, and so in exact arithmetic `pinv`. Rows without "
            "a comma follow the reference implementation: `pinv_rr` with its stop when "
            "both errors grow and 7 steps (`--iteration pinv_rr --max-iterations 7`; "
            "there are versions with 8), "
            "`cwpi` with that stop and the one on small steps (`--iteration cwpi "
            "--growth-stop on`), `cwln` with neither. The text says that growth is "
            "allowed in `cwln` and `cwpi`."
        )
    ]
    rates = _rates(
        view, "cvrb1213", ("pinv_rr, 6 steps", "pinv_rr", "pinv_rr, 8 steps")
    )
    if rates is not None:
        c1 = ROBOTS.index("cvrb1213")
        least, most = published.PINV_RR_C1_RUNS
        own = " / ".join(f"{value:.2f}" for value in published.PINV_RR_LOG)
        six, seven, eight = rates
        parts_.append(
            f"C1 with 6, 7 and 8 steps of `pinv_rr`: {six:.2f}, {seven:.2f}, "
            f"{eight:.2f}; published: "
            f"{published.ABLATION_2['pinv_rr'].success[c1]:.2f}. The authors' own log "
            "of the run as the "
            f"implementation reads has {own}; their runs of one day on C1 range from "
            f"{least} to {most}. Which of them is the published one is not known."
        )
    return "\n\n".join(parts_)


def _rates(view: View, robot: str, labels: Sequence[str]) -> list[float] | None:
    """Success in percent of some rows of Table II; None if one is missing."""
    rates = []
    for label in labels:
        row = paper_plan.ABLATION_2_ROWS[label]
        cell = view.get(paper_plan.paper_cell(robot, view.size, row))
        if cell is None:
            return None
        rates.append(cell["success_percent"])
    return rates


def _sizes(view: View) -> str:
    """Files of the databases beside the published sizes."""
    rows = []
    for scale, theirs in published.DATABASE_SIZES.items():
        row = [scale]
        for i, robot in enumerate(ROBOTS):
            settings = paper_plan.sampling_of("grid", scale)
            cell = view.get(paper_plan.paper_cell(robot, view.size, settings))
            samples, megabytes = theirs[i == IRB]
            if cell is None or "bytes" not in cell:
                row.append(NONE)
                continue
            each = cell["bytes"] / cell["samples"]
            row.append(
                f"{cell['samples']:,} ({samples:,}); {cell['bytes'] / 1e6:.1f} MB "
                f"({megabytes} MB); {each:.0f} B ({1e6 * megabytes / samples:.0f} B)"
            )
        if any(cell != NONE for cell in row[1:]):
            rows.append(row)
    if not rows:
        return ""
    header = ["samples; file; of it each sample (published)", *HEADER]
    what = (
        "Our file has the key, the pose, the joint values and the pseudo-inverse of "
        'each sample in double precision; what the published "query file" has is '
        "not known."
    )
    return "\n\n".join([table(header, rows), what])


IRB = ROBOTS.index("irb14050")


def _cwln_outside(view: View) -> str:
    rows = []
    for robot in ROBOTS:
        cell = view.get(
            paper_plan.attempts_cell(
                robot, view.size, paper_plan.ABLATION_2_ROWS["cwln"]
            )
        )
        if cell is not None:
            outside = percent(cell["converged_outside_limits"], cell["count"])
            rows.append(f"{PAPER_ARMS[robot]} {outside} %")
    if not rows:
        return ""
    return (
        "The reference code does not check the limits after CWLN; IKSel does. "
        f"Converged outside the limits, on top of the row `cwln`: {', '.join(rows)}."
    )


def _solved(cell: dict[str, Any] | None) -> str:
    return NONE if cell is None else percent(cell["solved"][-1], cell["count"])


def _cvt(view: View) -> list[str]:
    rows = []
    for label, row in paper_plan.table_rows("cvt", view.size.cvt_scales).items():
        cells = [
            view.get(paper_plan.attempts_cell(robot, view.size, row))
            for robot in ROBOTS
        ]
        if any(cells):
            rows.append([label, *map(_solved, cells)])
    if not rows:
        return []
    return [
        "### The same with CVT, as in the authors' revision",
        table(["success %", *HEADER], rows),
    ]
