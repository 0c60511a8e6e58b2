# SPDX-License-Identifier: BSD-3-Clause
"""IKSel beside its rivals, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench.arms import RIVAL_ARMS
from bench.bounds import at_least, share_text
from bench.check import POSITION_TOLERANCE, ROTATION_TOLERANCE
from bench.markdown import (
    NONE,
    bullets,
    listed,
    microseconds,
    percent,
    table,
    text_table,
)
from bench.plans.rivals import rival_cell
from bench.plans.shared import BESIDE_LEVEL, at_level
from bench.rivals import RIVALS, timed_in_cpp
from bench.sections import batches, target_counts
from bench.size import SEED
from bench.timing import PASSES, SHORT_S

if TYPE_CHECKING:
    from collections.abc import Callable

    from bench.view import View

OURS = "IKSel"
ANALYTIC = ("EAIK", "IK-Geo")
TIMES_FASTER = 20.0
"""Times that IKSel is to be faster than a numerical rival."""
ENOUGH_PERCENT = 99.99
"""Success that the default preset is to have near limits and singularities."""

KIND_TITLES = {
    "near_limits": "Near the limits: at least one joint within 2 % of its range of one",
    "near_singular": "Near singularities: smallest singular value in the lowest 1 %",
    "lines": "Along straight lines of 0.1 m in 50 steps, every pose by itself",
}


def text(view: View) -> str:
    """The whole section."""
    if not view.has_any("rival"):
        return ""
    parts = [
        "## IKSel beside its rivals",
        _conditions(),
        "![Share of targets solved over time](plots/success_over_time.svg)",
        "### Random targets: mean (p99) in µs",
        _times(view, "uniform"),
        target_counts.text(view, "uniform"),
        *_verdicts(view),
        "### Random targets: right answers in percent",
        _rights(view, "uniform"),
        "![Latency of each solver](plots/latency.svg)",
    ]
    for kind, title in KIND_TITLES.items():
        parts += [f"### {title}", _rights_and_times(view, kind)]
        parts.append(target_counts.text(view, kind))
        if kind == "lines":
            continue
        parts.append(_enough(view, kind))
    parts += [
        "### Out of reach: mean (p99) in µs until a solver says so",
        _times(view, "unreachable"),
        target_counts.text(view, "unreachable"),
        _unreachable_claims(view),
        "### In batches",
        batches.text(view),
        "### Versions and settings",
        _settings(view),
    ]
    return "\n\n".join(part for part in parts if part)


TIMES = (
    "Times are of each call, failures included, from Python, but those of "
    f"{listed(timed_in_cpp(RIVALS))} in C++."
)
"""What a time of this section is of."""


def _conditions() -> str:
    return bullets(
        (
            (
                "Solvers with the same count of targets, which is under each table, "
                "get the same ones; of fewer, a slow solver gets others by the same "
                "seed (the first of the random ones, of the singular ones and of the "
                "lines)."
            ),
            (
                "One after another in one process per solver, on one thread where the "
                f"solver lets us choose. {TIMES}"
            ),
            (
                "An answer is right if bench's own forward kinematics is within "
                f"{POSITION_TOLERANCE:g} m and {ROTATION_TOLERANCE:g} rad of the "
                "target and it lies inside the limits (of an analytic solver's "
                "branches, one has to be)."
            ),
            (
                "Solvers that need a start all get the same random one. Their "
                "tolerances are set so that their answers can pass: some defaults are "
                "of a squared error."
            ),
        )
    )


def _cells(
    view: View, kind: str, show: Callable[[dict[str, Any]], str]
) -> list[list[str]]:
    rows = []
    for name in RIVALS:
        settings = [rival_cell(robot, name, kind, view.size) for robot in RIVAL_ARMS]
        labelled = {name: settings}
        if name == OURS:
            others = [at_level(cell, BESIDE_LEVEL) for cell in settings]
            labelled[f"{OURS}, {BESIDE_LEVEL}"] = others
        for label, cells in labelled.items():
            found = [view.get(cell) for cell in cells]
            if any(found):
                shown = (NONE if cell is None else show(cell) for cell in found)
                rows.append([label, *shown])
    return rows


def _header(first: str) -> list[str]:
    return [first, *(f"`{robot}`" for robot in RIVAL_ARMS)]


def _times(view: View, kind: str) -> str:
    def show(cell: dict[str, Any]) -> str:
        return f"{microseconds(cell['mean_us'])} ({microseconds(cell['p99_us'])})"

    note = (
        f"Of each call the least time of {PASSES} passes, where the first takes less "
        f"than {SHORT_S:g} s."
    )
    return table(_header("solver"), _cells(view, kind, show)) + "\n\n" + note


def _rights(view: View, kind: str) -> str:
    def show(cell: dict[str, Any]) -> str:
        right = _share(cell)
        false = cell["false_claims"]
        return right + (f" ({false} false)" if false else "")

    note = "(n false): answers claimed that are none."
    return table(_header("solver"), _cells(view, kind, show)) + "\n\n" + note


def _share(cell: dict[str, Any]) -> str:
    """Right answers in percent; of a solver that gives none, that it does."""
    if not cell["claimed"]:
        return "returns nothing"
    return percent(cell["right"], cell["count"])


def _rights_and_times(view: View, kind: str) -> str:
    def show(cell: dict[str, Any]) -> str:
        right = _share(cell)
        false = f" ({cell['false_claims']} false)" if cell["false_claims"] else ""
        return f"{right}{false}; {microseconds(cell['mean_us'])}"

    return table(_header("right answers in %; mean in µs"), _cells(view, kind, show))


def factors(view: View) -> dict[tuple[str, str], float]:
    """How many times each rival's mean is IKSel's, by robot and solver."""
    result = {}
    for robot in RIVAL_ARMS:
        ours = view.get(rival_cell(robot, OURS, "uniform", view.size))
        for name in RIVALS:
            theirs = view.get(rival_cell(robot, name, "uniform", view.size))
            if ours and theirs and not name.startswith(OURS):
                result[robot, name] = theirs["mean_us"] / ours["mean_us"]
    return result


def _verdicts(view: View) -> list[str]:
    by_rival = factors(view)
    numerical = {key: f for key, f in by_rival.items() if key[1] not in ANALYTIC}
    lines = []
    if numerical:
        (robot, name), least = min(numerical.items(), key=lambda item: item[1])
        below = sorted(key for key, f in numerical.items() if f < TIMES_FASTER)
        lines.append(
            f"Against numerical rivals IKSel is at least {least:.1f} times faster in "
            f"the mean ({name} on `{robot}` comes closest), on these robots and "
            f"targets; {TIMES_FASTER:.0f} times was the aim"
            + (
                ", missed against "
                + ", ".join(
                    f"{name} on `{robot}` ({numerical[robot, name]:.1f})"
                    for robot, name in below
                )
                if below
                else ", and holds everywhere"
            )
            + "."
        )
    for name in ANALYTIC:
        found = {robot: f for (robot, n), f in by_rival.items() if n == name}
        for robot, factor in found.items():
            ours = view.get(rival_cell(robot, OURS, "uniform", view.size))
            theirs = view.get(rival_cell(robot, name, "uniform", view.size))
            if ours is None or theirs is None or theirs["right"] == 0:
                continue
            word = "below" if factor > 1.0 else "above"
            lines.append(
                f"{OURS} on `{robot}`, one answer at a time from Python: "
                f"{microseconds(ours['mean_us'])} µs, {word} {name}'s "
                f"{microseconds(theirs['mean_us'])} µs for all branches; all with all "
                "are compared under *Every answer*."
            )
    return lines


def _enough(view: View, kind: str) -> str:
    worst, where, part, whole, counts = 100.0, "", 0, 1, []
    for robot in RIVAL_ARMS:
        cell = view.get(rival_cell(robot, OURS, kind, view.size))
        if cell is not None:
            value = 100.0 * cell["right"] / cell["count"]
            counts.append(cell["count"])
            if value <= worst:
                worst, where = value, robot
                part, whole = cell["right"], cell["count"]
    if not where:
        return ""
    proven = 100.0 * at_least(part, whole)
    word = (
        "holds"
        if proven >= ENOUGH_PERCENT
        else "is not refuted, but so few targets cannot prove it"
        if worst >= ENOUGH_PERCENT
        else "is missed"
    )
    return (
        f"IKSel's least of {len(counts)} robots with {max(counts):,} targets each, "
        f"seed {SEED}, is {worst:.3f} % of {whole:,} (`{where}`), "
        f"{share_text(part, whole)}: the aim of {ENOUGH_PERCENT} % {word}."
    )


def _unreachable_claims(view: View) -> str:
    claims = []
    for name in RIVALS:
        found = [
            view.get(rival_cell(robot, name, "unreachable", view.size))
            for robot in RIVAL_ARMS
        ]
        total = sum(cell["claimed"] for cell in found if cell is not None)
        if total:
            claims.append(f"{name} ({total})")
    targets = "Targets are farther from the first joint than the arm is long. "
    if not claims:
        return targets + "No solver claimed an answer."
    return targets + f"Answers claimed all the same: {', '.join(claims)}."


def _settings(view: View) -> str:
    rows = []
    for name, rival in RIVALS.items():
        version = view.report["versions"].get(name)
        if version is None:
            version = f"skipped: {view.report['missing'][name]}"
        rows.append([name, version, rival.measured, rival.settings])
    lines = [text_table(["solver", "version", "timed", "settings"], rows)]
    refused = sorted(
        {
            f"{name} on `{robot}`: {why}"
            for name in RIVALS
            for robot in RIVAL_ARMS
            if (why := view.why_not(rival_cell(robot, name, "uniform", view.size)))
            and why != "not measured"
        }
    )
    if refused:
        lines += ["", "Refused:", "", *(f"- {line}" for line in refused)]
    return "\n".join(lines)
