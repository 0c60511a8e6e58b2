# SPDX-License-Identifier: BSD-3-Clause
"""Poses without an answer, all answers and the nearest, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench import branches
from bench.check import POSITION_TOLERANCE, ROTATION_TOLERANCE
from bench.machine import load_text
from bench.markdown import NONE, mean_median, microseconds, percent, table
from bench.plans import no as plan
from bench.rivals import RIVALS
from bench.sections import cut_offs

if TYPE_CHECKING:
    from collections.abc import Callable

    from bench.view import View

OURS = "IKSel"
UNREACHED = plan.NO_KINDS[1]
KIND_WORDS = {"uniform": "reachable", UNREACHED: "random rotations"}
TIMES_OF_RIVAL = 1.0
"""Times of the analytic solver's mean that all solutions may take."""
NEAR_US = 10.0
"""Mean that the nearest answer may take in closed form [us]."""


def text(view: View) -> str:
    """The whole section."""
    if not view.has_any("no"):
        return ""
    parts = [
        "## No answer, every answer, the nearest",
        _conditions(view),
        "### Random rotations: mean (median) of a no, or of giving up, in µs",
        _by_solver(view, lambda cell: mean_median(cell["no_us"])),
        cut_offs.text(view),
        "### The same targets: mean (median) of a yes in µs",
        _by_solver(view, lambda cell: mean_median(cell["yes_us"])),
        "### The same targets: answered rightly, in percent",
        _by_solver(view, _rightly),
        RIGHTLY,
        _found_by_others(view),
        "### How certain IKSel's no is",
        _certain(view),
        "### Every answer, and the nearest: mean µs",
        _branches(view),
        *_verdicts(view),
    ]
    return "\n\n".join(part for part in parts if part)


RIGHTLY = (
    "(n missed): no answer, where IKSel has one that is right. (n false): answers "
    "claimed that are none. A no without either is counted as right: that there is "
    "no answer is certain where IKSel's is proven."
)


def wrong(view: View) -> list[str]:
    """What must never be: answers and proofs of IKSel's that are wrong."""
    lines = []
    for robot in view.robots("no"):
        for kind in plan.NO_KINDS:
            for name in plan.NO_RIVALS:
                cell = view.get(plan.no_cell(robot, name, kind, view.size))
                if cell and cell["disproved"]:
                    lines.append(f"{robot}, {kind}: {cell['disproved']} proofs")
                if cell and name == OURS and cell["false"]:
                    lines.append(f"{robot}, {kind}: {cell['false']} answers")
            for request in ("all_branches", "near_branches"):
                cell = view.get(plan.branch_cell(request, robot, kind, view.size))
                if cell and cell["wrong"]:
                    lines.append(f"{robot}, {kind}, {request}: {cell['wrong']} answers")
    return lines


def _conditions(view: View) -> str:
    size = view.size
    slow = [name for name in plan.NO_RIVALS if RIVALS[name].share < plan.MANY]
    return (
        f"Reachable positions with rotations at random, {size.no:,} per robot "
        f"({size.no_slow:,} for {', '.join(slow)}), and as many that can all be "
        f"reached; seed {size.no_seed}, default options, tolerances of 1e-6 m and 1e-6 "
        "rad, one thread, each call from Python (KDL's from C++), one process per "
        "solver, of each call the least time of three where that does not take long. A "
        "rival's answer is right within "
        f"{POSITION_TOLERANCE:g} m, {ROTATION_TOLERANCE:g} rad and the limits; "
        "branches of analytic solvers that lie outside the limits are left out after "
        f"the clock has stopped. {_machine(view)}"
    )


def _machine(view: View) -> str:
    facts = view.machine("no")
    return (
        f"SIMD level {facts['simd']}, {facts['cpu']}, {facts['cores']} cores"
        f"{load_text(facts)}."
    )


def _rightly(cell: dict[str, Any]) -> str:
    notes = [f"{cell[what]} {what}" for what in ("missed", "false") if cell[what]]
    good = cell["count"] - cell["missed"] - cell["false"]
    return percent(good, cell["count"]) + (f" ({', '.join(notes)})" if notes else "")


def _by_solver(view: View, show: Callable[[dict[str, Any]], str]) -> str:
    """Robots down, solvers across: those that were measured on any."""
    robots = view.robots("no")
    cells = {
        name: [view.get(plan.no_cell(r, name, UNREACHED, view.size)) for r in robots]
        for name in plan.NO_RIVALS
    }
    columns = {name: found for name, found in cells.items() if any(found)}
    rows = [
        [f"`{robot}`", *(NONE if cell is None else show(cell) for cell in row)]
        for robot, *row in zip(robots, *columns.values(), strict=True)
    ]
    return table(["robot", *columns], rows)


def _found_by_others(view: View) -> str:
    """Answers where IKSel has none."""
    found = [
        f"{name} on `{robot}`, {KIND_WORDS[kind]}: {cell['only']} of {cell['count']:,}"
        for robot in view.robots("no")
        for kind in plan.NO_KINDS
        for name in plan.NO_RIVALS
        if (cell := view.get(plan.no_cell(robot, name, kind, view.size)))
        if cell["only"]
    ]
    counts = [
        cell["count"]
        for robot in view.robots("no")
        for kind in plan.NO_KINDS
        if (cell := view.get(plan.no_cell(robot, OURS, kind, view.size)))
    ]
    about = (
        f"Answers within 1e-6 m and 1e-6 rad where IKSel has none, of {sum(counts):,} "
        f"targets of both kinds on {len(view.robots('no'))} robots, seed "
        f"{view.size.no_seed} (slow solvers: the first of them)"
    )
    return f"{about}: {'; '.join(found) or 'none'}."


def _certain(view: View) -> str:
    rows = []
    for robot in view.robots("no"):
        for kind in plan.NO_KINDS:
            cell = view.get(plan.no_cell(robot, OURS, kind, view.size))
            if cell is None:
                continue
            unit = cell["unit_us"]
            no = cell["no_us"]
            proof = cell.get("proven_us")
            counts = ("yes", "proven", "swept", "searched", "most_iterations")
            rows.append(
                [
                    f"`{robot}`, {KIND_WORDS[kind]}",
                    cell["structure"].replace("_", " "),
                    *(f"{cell[what]:,}" for what in counts),
                    NONE if no is None else f"{no[0] / unit:.1f}",
                    NONE if proof is None else f"{proof[0] / unit:.1f}",
                    microseconds(unit),
                ]
            )
    header = [
        "targets",
        "structure",
        "yes",
        "no: proven",
        "by sweep",
        "searched",
        "most steps",
        "mean no in units",
        "with prove=True",
        "unit, µs",
    ]
    note = "A unit is one KDL FK + Jacobian, the least of 20 means in the same run."
    return table(header, rows) + "\n\n" + note


def _branches(view: View) -> str:
    rows = []
    for robot in view.robots("all_branches"):
        for kind in plan.NO_KINDS:
            every, near = (
                view.get(plan.branch_cell(cell, robot, kind, view.size))
                for cell in ("all_branches", "near_branches")
            )
            if every is None or near is None:
                continue
            rows.append(
                [
                    f"`{robot}`, {KIND_WORDS[kind]}, {every['count']:,}",
                    *_every_columns(every),
                    microseconds(near["mean_us"]),
                    _smallest(near),
                ]
            )
    header = [
        "targets",
        f"`solve_all` (p99) beside {plan.BRANCH_RIVAL}",
        "solutions",
        f"{plan.BRANCH_RIVAL}'s set in %",
        "`near`",
        "smallest move in %",
    ]
    note = (
        f"*near* is a solution with normal noise of {branches.NOISE} rad on every "
        "joint where one is known, else any configuration. *Smallest move*: over all "
        f"that `solve_all` and {plan.BRANCH_RIVAL} give, with their whole turns, give "
        f"or take {branches.SAME_MOVE:g} rad. (n fewer): poses where "
        f"{plan.BRANCH_RIVAL} has a branch that is right within 1e-6 m and 1e-6 rad, "
        "and `solve_all` has not; (n more): the other way round. Both called in turns "
        "in one process, three times each, of each call the least time."
    )
    return table(header, rows) + "\n\n" + note


def _every_columns(cell: dict[str, Any]) -> list[str]:
    mean = f"{microseconds(cell['mean_us'])} ({microseconds(cell['p99_us'])})"
    count = f"{cell['branches']:,}"
    if "same" not in cell:
        return [mean, count, NONE]
    notes = [f"{cell[what]} {what}" for what in ("fewer", "more") if cell[what]]
    same = percent(cell["same"], cell["count"])
    return [
        f"{mean}, {microseconds(cell['rival_mean_us'])}",
        count,
        same + (f" ({', '.join(notes)})" if notes else ""),
    ]


def _smallest(cell: dict[str, Any]) -> str:
    if not cell["solvable"]:
        return NONE
    return percent(cell["smallest"], cell["solvable"])


def _verdicts(view: View) -> list[str]:
    """The aims in closed form, each with what it missed by."""
    lines: list[str] = []
    compared: dict[str, int] = {}
    for robot in view.robots("all_branches"):
        for kind in plan.NO_KINDS:
            where = f"`{robot}`, {KIND_WORDS[kind]}"
            every, near = (
                view.get(plan.branch_cell(cell, robot, kind, view.size))
                for cell in ("all_branches", "near_branches")
            )
            if every is None or near is None or "same" not in every:
                continue
            compared[robot] = compared.get(robot, 0) + every["count"]
            times = every["mean_us"] / every["rival_mean_us"]
            if times > TIMES_OF_RIVAL:
                lines.append(
                    f"{where}: `solve_all` {times:.2f} times {plan.BRANCH_RIVAL}"
                )
            if every["fewer"]:
                lines.append(f"{where}: {every['fewer']} sets lack a branch")
            if near["mean_us"] > NEAR_US:
                lines.append(f"{where}: `near` {microseconds(near['mean_us'])} µs")
            if near["smallest"] < near["solvable"]:
                lines.append(
                    f"{where}: {near['solvable'] - near['smallest']} moves not smallest"
                )
    if not compared:
        return []
    aims = (
        f"In closed form the aims are `solve_all` in {plan.BRANCH_RIVAL}'s time and "
        f"with all its branches, and `near` in {NEAR_US:.0f} µs and with the smallest "
        f"move. On {sum(compared.values()):,} targets of "
        f"{', '.join(f'`{robot}`' for robot in compared)}, half of them reachable, "
        f"half with random rotations, seed {view.size.no_seed}"
    )
    return [f"{aims}, {'missed by ' + '; '.join(lines) if lines else 'all hold'}."]
