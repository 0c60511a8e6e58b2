# SPDX-License-Identifier: BSD-3-Clause
"""IKSel beside solvers that enumerate, as text: one table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench.analytic.plan import KINDS, asked_cell, job_name
from bench.branches import NOISE, SAME_MOVE
from bench.check import POSITION_TOLERANCE, ROTATION_TOLERANCE
from bench.machine import load_text
from bench.markdown import NONE, mean_median, table, text_table
from bench.rivals import ENUMERATORS
from bench.rivals.enumerator import WAYS
from bench.sections import counted

if TYPE_CHECKING:
    from bench.view import View

OURS = "IKSel"
REACHED, TURNED = KINDS
WORDS = {"one": "one", "every": "all", "nearest": "nearest", "no": "no"}

FEW = 20
"""Noes below this are counted in the table."""

HEADER = [
    "arm, solver",
    "targets",
    "one, µs",
    "all, µs",
    "branches",
    "nearest, µs",
    "no, µs",
    "missed",
    "wrong",
]


def text(view: View) -> str:
    """The whole section."""
    if not view.has_any("asked"):
        return ""
    parts = [
        "## One answer, all branches, the nearest, a no: beside solvers that enumerate",
        _conditions(view),
        table(HEADER, _rows(view)),
        NOTES,
        _ahead(view),
        counted.text(view),
        _refused(view),
        _settings(view),
    ]
    return "\n\n".join(part for part in parts if part)


NOTES = (
    "Mean (median) of each call in µs. *One*: any answer, where a solver can be asked "
    "for one; *as all* where it only knows all. *All*: of six joints each branch once, "
    "of seven as many samples of the self-motion as a solver takes. *Branches*: how "
    "many are right, in the mean; of six joints (lacks n, has n more): targets for "
    "which IKSel's `solve_all` has a branch that the solver has not, and the other way "
    f"round. *Nearest* to a solution with normal noise of {NOISE} rad on every joint; "
    f"(n longer): moves longer by {SAME_MOVE:g} rad than IKSel's. *No*: of the turned "
    "targets those for which neither IKSel nor the solver has an answer. *Missed*: "
    "targets without a right answer though there is one, by what was asked, among the "
    "turned ones where IKSel has one. *Wrong*: answers off the target, or outside the "
    "limits of a solver that is given them. A solver without limits has its branches "
    "outside of them left out after the clock has stopped. pink and mink do not "
    "enumerate: they are the loops that people write."
)


def wrong(view: View) -> list[str]:
    """What must never be: an answer of IKSel's that is wrong or missed."""
    lines = []
    for robot in view.robots("asked"):
        for kind in KINDS:
            cell = view.get(asked_cell(robot, OURS, kind, view.size))
            if cell is None:
                continue
            lines += [
                f"{robot}, {kind}, {WORDS[way]}: {figures[what]} {what}"
                for way, figures in _ways(cell).items()
                for what in ("wrong", "missed")
                if figures[what]
            ]
    return lines + counted.wrong(view)


def _ways(cell: dict[str, Any]) -> dict[str, Any]:
    """Figures by way; of turned targets there is only the no."""
    return {"no": cell} if "noes" in cell else cell


def _conditions(view: View) -> str:
    size = view.size
    facts = view.machine("analytic")
    return (
        f"Up to {size.analytic:,} targets per arm that can be reached, uniform in the "
        "limits, and as many whose rotations are turned at random; seed "
        f"{size.no_seed}; no call is begun after {size.analytic_s:g} s, so that slow "
        "solvers get the first of them only. An answer is right within "
        f"{POSITION_TOLERANCE:g} m and {ROTATION_TOLERANCE:g} rad by bench's own "
        "forward kinematics, and inside the limits. One thread; each call from Python; "
        "a process for each solver; ways to ask in turns, of each call the "
        f"least time of three. SIMD level {facts['simd']} (IKSel's), {facts['cpu']}, "
        f"{facts['cores']} cores{load_text(facts)}."
    )


def _rows(view: View) -> list[list[str]]:
    rows = []
    for robot in view.robots("asked"):
        for name in ENUMERATORS:
            cells = [
                view.get(asked_cell(robot, name, kind, view.size)) for kind in KINDS
            ]
            failure = _failure(view, robot, name)
            if any(cells) or failure:
                row = _row(cells[0] or {}, cells[1] or {}, failure)
                rows.append([f"`{robot}`, {name}", *row])
    absent = [
        [f"all, {name}", "not installed", *[NONE] * (len(HEADER) - 2)]
        for name in ENUMERATORS
        if name in view.report["missing"]
    ]
    return rows + absent


def _failure(view: View, robot: str, name: str) -> str:
    """What ended a solver's process, in short."""
    for kind in KINDS:
        reason = view.report["failures"].get(f"{job_name(name)}, {robot}, {kind}")
        if reason:
            return str(reason).split(":", maxsplit=1)[0]
    return ""


def _row(reached: dict[str, Any], turned: dict[str, Any], failure: str) -> list[str]:
    counts = sorted({figures["count"] for figures in reached.values()})
    targets = " to ".join(
        f"{count:,}" for count in dict.fromkeys([*counts[:1], *counts[-1:]])
    )
    one, every, nearest = (reached.get(way) for way in WAYS)
    as_all = "as all" if every else NONE
    ways = {**reached, **({"no": turned} if turned else {})}
    return [
        f"ended: {failure}" if failure else targets,
        as_all if one is None else mean_median(one["us"]),
        NONE if every is None else mean_median(every["us"]),
        NONE if every is None else _branches(every),
        NONE
        if nearest is None
        else mean_median(nearest["us"]) + _noted(nearest, "longer"),
        _no(turned) if turned else NONE,
        _counted(ways, "missed"),
        _counted(ways, "wrong"),
    ]


def _no(turned: dict[str, Any]) -> str:
    """With how many it is the mean of, where these are few."""
    few = 0 < turned["noes"] < FEW
    return mean_median(turned["us"]) + (f" of {turned['noes']}" if few else "")


def _noted(figures: dict[str, Any], what: str) -> str:
    return f" ({figures[what]:,} {what})" if figures.get(what) else ""


def _branches(every: dict[str, Any]) -> str:
    notes = []
    if every.get("lacks"):
        notes.append(f"lacks {every['lacks']:,}")
    if every.get("has_more"):
        notes.append(f"has {every['has_more']:,} more")
    mean = f"{every['branches'] / max(every['count'], 1):.1f}"
    return mean + (f" ({', '.join(notes)})" if notes else "")


def _counted(ways: dict[str, Any], what: str) -> str:
    """How many of each way; 0 if there are none at all."""
    if not ways:
        return NONE
    parts = [
        f"{WORDS[way]} {figures[what]:,} of {figures['count']:,}"
        for way, figures in ways.items()
        if figures[what]
    ]
    if what == "wrong":
        # Of many branches a target: the count of targets would say nothing.
        parts = [part.split(" of ", maxsplit=1)[0] for part in parts]
    return "; ".join(parts) or "0"


def _ahead(view: View) -> str:
    """Where a solver takes less than IKSel, by mean or by median."""
    lines = []
    for robot in view.robots("asked"):
        ours = _asked(view, robot, OURS)
        for name in ENUMERATORS:
            if name == OURS:
                continue
            for way, theirs in _asked(view, robot, name).items():
                told = _less(theirs, ours.get(way, {}))
                if told:
                    lines.append(f"- `{robot}`, {WORDS[way]}: {name} {told}")
    if not lines:
        return "IKSel's means and medians are the least of each arm."
    title = (
        "Where IKSel's mean or median is not the least of an arm; of *all* these are "
        "of the time a right answer, as solvers give different numbers of them:"
    )
    return "\n".join([title, "", *lines])


def _less(theirs: dict[str, Any], ours: dict[str, Any]) -> str:
    """How much less a solver takes, and what it leaves out; "" if it takes more.

    The median is told where its order is not the mean's.
    """
    if not theirs["us"] or not ours.get("us"):
        return ""
    if not theirs.get("branches", 1) or not ours.get("branches", 1):
        return ""
    share = _answers(ours) / _answers(theirs)
    mean, median = (
        share * their / our for their, our in zip(theirs["us"], ours["us"], strict=True)
    )
    if min(mean, median) >= 1.0:
        return ""
    told = f"{mean:.2f} of IKSel's mean"
    if (mean < 1.0) != (median < 1.0):
        told += f", {median:.2f} of its median"
    notes = [f"{theirs[k]:,} {k}" for k in ("missed", "longer") if theirs.get(k)]
    if "branches" in theirs:
        notes.append(f"branches {_branches(theirs)} to {_branches(ours)}")
    return told + (f" ({', '.join(notes)})" if notes else "")


def _answers(figures: dict[str, Any]) -> float:
    """Right answers a call where all are asked for; else one, whatever it is."""
    if "branches" not in figures:
        return 1.0
    return float(figures["branches"]) / float(figures["count"])


def _asked(view: View, robot: str, name: str) -> dict[str, Any]:
    """Figures of an arm and a solver by way."""
    ways: dict[str, Any] = {}
    for kind in KINDS:
        ways |= _ways(view.get(asked_cell(robot, name, kind, view.size)) or {})
    return ways


def _refused(view: View) -> str:
    """Who cannot be had for which arm, by reasons without the arm's name."""
    arms: dict[tuple[str, str], list[str]] = {}
    for name in ENUMERATORS:
        for robot in view.robots("asked"):
            why = view.why_not(asked_cell(robot, name, REACHED, view.size))
            if why and why != "not measured":
                reason = why.replace(robot, "it")
                arms.setdefault((name, reason), []).append(f"`{robot}`")
    lines = [
        f"- {name}: {', '.join(robots)}: {reason}"
        for (name, reason), robots in arms.items()
    ]
    return "\n".join(["Refused:", "", *lines]) if lines else ""


def _settings(view: View) -> str:
    rows = []
    for name, rival in ENUMERATORS.items():
        version = view.report["versions"].get(name)
        if version is None:
            version = view.report["missing"].get(name, "not asked")
        rows.append([name, version, rival.settings])
    return text_table(["solver", "version", "settings"], rows)
