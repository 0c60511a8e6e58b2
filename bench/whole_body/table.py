# SPDX-License-Identifier: BSD-3-Clause
"""Both hands at once, as text: one table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench.machine import load_text
from bench.markdown import NONE, microseconds, percent, table
from bench.whole_body.robots import TOLERANCE
from bench.whole_body.solvers import CLOSE, SOLVERS, STARTS, STEPS

if TYPE_CHECKING:
    from bench.store import Settings
    from bench.view import Report

OURS = "IKSel"

HEADER = [
    "robot, solver",
    "joints (shared)",
    "targets",
    "missed",
    "solved, %",
    "wrong",
    "mean, µs",
    "median, µs",
    "99 %, µs",
]


def job_name(robot: str, name: str) -> str:
    """How progress and failures call a job."""
    return f"{name} on {robot}"


def text(report: Report) -> str:
    """All of it."""
    parts = [
        "## Both hands of robots with a torso: beside loops that people write",
        _conditions(report),
        table(HEADER, _rows(report)),
        NOTES,
        _shared(report),
        _missed(report),
        _settings(report),
    ]
    return "\n\n".join(part for part in parts if part)


NOTES = (
    "*Missed*: targets without a right answer. *Wrong*: answers among these that are "
    "off a target or outside the limits. Times are of all calls, misses included. "
    "IKSel is given no start, the loops start at random: at most "
    f"{STARTS} times {STEPS} steps, each until no component of an error is above "
    f"{CLOSE:g} m or rad."
)


def wrong(report: Report) -> list[str]:
    """What must never be: an answer of IKSel's that is wrong."""
    return [
        f"{settings['robot']}: {result['wrong']} wrong"
        for settings, result in _cells(report)
        if settings["rival"] == OURS and result.get("wrong")
    ]


def _cells(report: Report) -> list[tuple[Settings, dict[str, Any]]]:
    return [(cell["settings"], cell["result"]) for cell in report["cells"]]


def _conditions(report: Report) -> str:
    facts = report["machine"]
    settings = [settings for settings, _ in _cells(report)]
    seeds = ", ".join(str(s) for s in dict.fromkeys(s["seed"] for s in settings))
    limits = {s["limit_s"] for s in settings if s["rival"] != OURS}
    limit = " or ".join(f"{limit_s:g}" for limit_s in sorted(limits))
    cut = (
        f"; no call of a loop is begun after {limit} s, so that loops get the first of "
        "them only"
    )
    return (
        "Goals of six degrees of freedom on both hands, fixed base; targets are the "
        "poses of random configurations inside the limits, so all can be reached; seed "
        f"{seeds}{cut if limit else ''}. An answer is right if both hands are within "
        f"{TOLERANCE:g} m and {TOLERANCE:g} rad by bench's own forward kinematics and "
        "all joints inside their limits; the solvers' own tolerances are the same. One "
        "thread; each call from Python; a process for each solver and robot. SIMD "
        f"level {facts['simd']} (IKSel's), {facts['cpu']}, {facts['cores']} "
        f"cores{load_text(facts)}."
    )


def _rows(report: Report) -> list[list[str]]:
    empty = [NONE] * (len(HEADER) - 2)
    rows = []
    for settings, result in _cells(report):
        start = f"`{settings['robot']}`, {settings['rival']}"
        if "unsupported" in result:
            rows.append([start, result["unsupported"], *empty])
        else:
            rows.append([start, *_row(result)])
    rows += [
        [key.split(",", maxsplit=1)[0], f"ended: {reason.split(':')[0]}", *empty]
        for key, reason in report["failures"].items()
    ]
    rows += [
        [f"all, {name}", "not installed", *empty]
        for name in SOLVERS
        if name in report["missing"]
    ]
    return rows


def _row(result: dict[str, Any]) -> list[str]:
    count, missed = result["count"], result["missed"]
    return [
        f"{result['dof']} ({len(result['shared'])})",
        f"{count:,}",
        f"{missed:,}",
        percent(count - missed, count, 3 if count > 1_000 else 1),
        f"{result['wrong']:,}",
        *(microseconds(result[name]) for name in ("mean_us", "median_us", "p99_us")),
    ]


def _shared(report: Report) -> str:
    """Each robot's shared joints."""
    shared = {
        settings["robot"]: ", ".join(f"`{joint}`" for joint in result["shared"])
        for settings, result in _cells(report)
        if "shared" in result
    }
    return "\n".join(
        ["Joints that both hands share:", ""]
        + [f"- `{robot}`: {joints}" for robot, joints in shared.items()]
    )


def _missed(report: Report) -> str:
    """The first targets that IKSel missed, to look at them again."""
    lines = [
        f"- `{settings['robot']}`: {', '.join(map(str, result['missed_targets']))}"
        for settings, result in _cells(report)
        if settings["rival"] == OURS and result.get("missed")
    ]
    return "\n".join(["Targets that IKSel missed, the first of them:", "", *lines]) * (
        len(lines) > 0
    )


def _settings(report: Report) -> str:
    lines = ["| solver | version | settings |", "|---|---|---|"]
    for name, solver in SOLVERS.items():
        version = report["versions"].get(name)
        if version is None:
            version = report["missing"].get(name, "not asked")
        lines.append(f"| {name} | {version} | {solver.settings} |")
    return "\n".join(lines)
