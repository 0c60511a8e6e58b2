# SPDX-License-Identifier: BSD-3-Clause
"""Seeds from learned models beside the published ones, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bench.learned.plan import BESIDE, CURVE, JUMP, MINUTES, OURS
from bench.markdown import NONE, microseconds, percent, signed, table
from bench.sections import learned_causes, learned_claims, learned_errors
from bench.sections.learned_rows import BESIDE_PUBLISHED, missing, rows

if TYPE_CHECKING:
    from bench.sections.learned_rows import Row
    from bench.view import View

CONDITIONS = (
    "Models trained here with JAX, each for the minutes and with the parameters that "
    "the table of what they took says; the authors' are not public. The label of a "
    "pose is not any configuration that reaches it, but the solver's answer nearest to "
    "the middle of the limits (on IRB the one farthest from all limits), so that what "
    "is learned is a function of the pose. Targets uniform in the joint limits, none "
    "of them learned from. *Direct*: the first output is itself an answer at 1e-4 m "
    "and 1e-3 rad. *First*, *best of 32*: one attempt of the paper's iteration from "
    "that output and from no other seed; the best is the one whose pose, as position "
    "in m and quaternion, is nearest once it is inside the limits, where the iteration "
    "starts. Answers are judged by bench's own forward kinematics. Errors: mean over a "
    "batch of 32 (of an MDN: of its one output), then over the targets. In brackets: "
    "published, difference."
)


def text(view: View) -> str:
    """The whole section."""
    if not view.has_any("learned"):
        return ""
    every = rows(view)
    ours = [row for row in every if row.recipe == OURS]
    tables = [_success(ours), *_why(ours)] if ours else []
    if every:
        tables += [
            learned_causes.text(every),
            learned_errors.text(every),
            learned_claims.text(view),
        ]
    if ours:
        tables += [_costs(ours), *_curves(ours)]
    absent = missing(view)
    if absent:
        tables.append(f"Not run: {'; '.join(absent)}.")
    parts = ["## Learned seeds", CONDITIONS, *tables]
    return "\n\n".join(part for part in parts if part)


def _success(ours: list[Row]) -> str:
    lines = [
        [
            row.title,
            percent(row.cell["first"]["direct_right"], row.cell["count"]),
            *row.beside_published(),
        ]
        for row in ours
    ]
    header = ["success %", "direct", *BESIDE_PUBLISHED]
    return table(header, lines)


def _to_best(share: float, published: float) -> str:
    """A share in percent (its difference to the published best)."""
    return f"{share:.2f} ({signed(share - published)})"


WHY = (
    "Why the best of 32 fails where it does: not for want of a good seed, which *any* "
    "of the 32 is nearly everywhere. Where the label jumps, which it must where an "
    "answer ends at a limit or another is as near to the middle, some outputs lie "
    "between two answers; and near a singular configuration, where poses change "
    "least, such a one may reach nearest. *Singular*: the fourth of the targets at "
    "which the smallest singular value of the Jacobian at the best output is least. "
    f"*At a jump*: {BESIDE} rad beside its label (deviation of each joint) the pose "
    f"has a label that is more than {JUMP} rad off; in brackets their share. *Eq. "
    "(5)*: one attempt from that of the 32 which the paper's own ranking of seeds, by "
    "joint adjustment, puts first. *Beside the label*: one attempt from there."
)


def _why(ours: list[Row]) -> list[str]:
    rows = [
        [
            row.title,
            f"{why['singular']:.2f}",
            f"{why['regular']:.2f}",
            f"{why['at_jumps']:.2f} ({why['jumps']:.1f})",
            f"{why['elsewhere']:.2f}",
            _to_best(why["ranked"], row.published.best),
            f"{why['any']:.2f}",
            f"{why['beside_label']:.2f}",
        ]
        for row in ours
        if (why := row.cell.get("why")) and row.published.best is not None
    ]
    header = [
        "success %",
        "best, singular",
        "other",
        "best, at a jump",
        "elsewhere",
        "first of 32 by Eq. (5)",
        "any of 32",
        "beside the label",
    ]
    return [WHY, table(header, rows)] if rows else []


def _costs(ours: list[Row]) -> str:
    rows = []
    for row in ours:
        cell, published = row.cell, row.published
        first, best = cell["first"], cell.get("best")
        rows.append(
            [
                row.title,
                f"{cell['minutes']:.1f}",
                f"{cell['steps']:,}",
                f"{cell['parameters']:,}",
                f"{cell['bytes'] / 1e3:.0f}",
                _time(first, published.first_ms),
                NONE
                if best is None or published.best_ms is None
                else _time(best, published.best_ms),
            ]
        )
    header = [
        "",
        "minutes trained",
        "steps",
        "parameters",
        "file, kB",
        "first: output + iteration, µs (ms)",
        "best of 32, µs (ms)",
    ]
    took = (
        "What they took: minutes of CPU time on one thread; mean time of a pose, "
        "failures included, as output + iteration: the output by JAX's jitted call for "
        "one pose (for the best of 32 with the picking), the iteration by "
        "`Solver.solve`. In brackets the published sum, in Python on another machine."
    )
    return took + "\n\n" + table(header, rows)


def _time(figures: dict[str, float], published_ms: float) -> str:
    output = microseconds(figures["output_us"])
    solve = microseconds(figures["solve_us"])
    return f"{output} + {solve} ({published_ms:.2f})"


CURVES = (
    f"What more time would bring: success of the seeds on {CURVE} other poses while "
    "training, the running mean of the weights; whole curves are in "
    "`bench/learned/weights/*.csv`. While these were trained, the best was still "
    "picked by poses that may lie outside the limits. In the last column what the last "
    "half of the training brought, and its bound (95 %)."
)

PARTS = (0.25, 0.5, 1.0)
"""Of the training, where the curve is shown."""


def _curves(ours: list[Row]) -> list[str]:
    lines = []
    for row in ours:
        curve = row.cell["curve"]
        points = [curve[max(0, round(part * len(curve)) - 1)] for part in PARTS]
        shown = [_point(point, row.shown) for point in points]
        lines.append([f"{row.title}, {row.shown}", *shown, row.late_gain_text()])
    header = [
        "success %",
        *(f"{part:.0%} of training" for part in PARTS),
        "the last half brought",
    ]
    return [CURVES, table(header, lines), _budgets(ours)]


def _budgets(ours: list[Row]) -> str:
    """Whether more minutes would bring more, as far as the curves show it."""
    short = [row for row in ours if row.cell["minutes"] < MINUTES]
    rising = [row.title for row in short if row.late_gain()[0] > row.late_gain()[1]]
    flat = [row for row in short if row.title not in rising]
    asked = f"the {MINUTES:g} minutes that `bench train` gives by default"
    parts = [f"{len(short)} of {len(ours)} had less than {asked}."]
    if rising:
        parts.append(f"Still rising by more than chance: {', '.join(rising)}.")
    if flat:
        most = max(sum(row.late_gain()) for row in flat)
        parts.append(
            f"Of the other {len(flat)} a gain in the last half is not shown, nor that "
            f"there was none: it is at most {most:.1f} points (95 %). What the minutes "
            "up to there would bring is not known."
        )
    return " ".join(parts)


def _point(point: dict[str, float], shown: str) -> str:
    return f"{point[shown]:.1f} at {point['minutes']:.1f} min"
