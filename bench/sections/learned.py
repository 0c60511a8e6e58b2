# SPDX-License-Identifier: BSD-3-Clause
"""Seeds from learned models beside the published ones, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench.arms import PAPER_ARMS
from bench.learned.plan import BESIDE, JUMP, MODELS, learned_cell
from bench.markdown import NONE, microseconds, percent, signed, table
from bench.paper.learned import LEARNED

if TYPE_CHECKING:
    from collections.abc import Iterator

    from bench.paper.learned import LearnedRow
    from bench.view import View

TITLES = {"mdn": "MDN", "flow": "flow (IKFlow)", "diffusion": "diffusion (IKDP)"}

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
    cells = list(_cells(view))
    tables = (
        [_success(cells), *_why(cells), _costs(cells), *_curves(cells)] if cells else []
    )
    parts = ["## Learned seeds", CONDITIONS, *tables, *_missing(view)]
    return "\n\n".join(parts)


Row = tuple[str, dict[str, Any], "LearnedRow"]


def _cells(view: View) -> Iterator[Row]:
    """Label, result and published row of each model that was measured."""
    for model in MODELS:
        for robot, short in PAPER_ARMS.items():
            cell = view.get(learned_cell(robot, model, view.size))
            if cell is not None:
                yield f"{TITLES[model]}, {short}", cell, LEARNED[model][robot]


def _missing(view: View) -> list[str]:
    reasons = [
        f"{TITLES[model]}, {short}: {reason}"
        for model in MODELS
        for robot, short in PAPER_ARMS.items()
        if (reason := view.why_not(learned_cell(robot, model, view.size)))
    ]
    return [f"Not run: {'; '.join(reasons)}."] if reasons else []


def _success(cells: list[Row]) -> str:
    rows = []
    for label, cell, published in cells:
        first, best = cell["first"], cell.get("best")
        rows.append(
            [
                label,
                percent(first["direct_right"], cell["count"]),
                f"{cell['position_mm']['mean']:.1f} ({published.position_mm:.1f})",
                f"{cell['rotation_deg']['mean']:.1f} ({published.rotation_deg:.1f})",
                _beside(first["right"], cell["count"], published.first),
                NONE
                if best is None or published.best is None
                else _beside(best["right"], cell["count"], published.best),
            ]
        )
    header = [
        "success %",
        "direct",
        "position error, mm",
        "rotation error, °",
        "first as seed",
        "best of 32 as seed",
    ]
    return table(header, rows)


def _beside(right: int, count: int, published: float) -> str:
    """Percent (published, difference)."""
    difference = signed(100.0 * right / count - published)
    return f"{percent(right, count)} ({published:.2f}, {difference})"


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


def _why(cells: list[Row]) -> list[str]:
    rows = [
        [
            label,
            f"{why['singular']:.2f}",
            f"{why['regular']:.2f}",
            f"{why['at_jumps']:.2f} ({why['jumps']:.1f})",
            f"{why['elsewhere']:.2f}",
            _to_best(why["ranked"], published.best),
            f"{why['any']:.2f}",
            f"{why['beside_label']:.2f}",
        ]
        for label, cell, published in cells
        if (why := cell.get("why")) and published.best is not None
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


def _costs(cells: list[Row]) -> str:
    rows = []
    for label, cell, published in cells:
        first, best = cell["first"], cell.get("best")
        rows.append(
            [
                label,
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


PARTS = (0.25, 0.5, 1.0)
"""Of the training, where the curve is shown."""


def _curves(cells: list[Row]) -> list[str]:
    rows = []
    for label, cell, _ in cells:
        curve = cell["curve"]
        points = [curve[max(0, round(part * len(curve)) - 1)] for part in PARTS]
        shown = "best" if "best" in cell else "first"
        rows.append([f"{label}, {shown}", *(_point(point, shown) for point in points)])
    header = ["success %", *(f"{part:.0%} of training" for part in PARTS)]
    return [
        (
            "What more time would bring: success of the seeds on 500 other poses while "
            "training, the running mean of the weights; whole curves are in "
            "`bench/learned/weights/*.csv`. While these were trained, the best was "
            "still picked by poses that may lie outside the limits."
        ),
        table(header, rows),
    ]


def _point(point: dict[str, float], shown: str) -> str:
    return f"{point[shown]:.1f} at {point['minutes']:.1f} min"
