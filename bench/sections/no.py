# SPDX-License-Identifier: BSD-3-Clause
"""Poses without an answer, all answers and the nearest, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench.check import POSITION_TOLERANCE, ROTATION_TOLERANCE
from bench.machine import load_text
from bench.markdown import (
    NONE,
    bullets,
    listed,
    mean_median,
    microseconds,
    percent,
    table,
)
from bench.plans import no as plan
from bench.rivals import RIVALS, timed_in_cpp
from bench.sections import branches, cut_offs
from bench.sections.branches import KIND_WORDS

if TYPE_CHECKING:
    from collections.abc import Callable

    from bench.view import View

OURS = "IKSel"
UNREACHED = plan.NO_KINDS[1]


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
        *branches.parts(view),
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
    notes = (
        (
            f"Targets: reachable positions with rotations at random, {size.no:,} per "
            f"robot ({size.no_slow:,}, the first of them, for {listed(slow)}), and as "
            f"many that can all be reached; seed {size.no_seed}."
        ),
        (
            "Default options, tolerances of 1e-6 m and 1e-6 rad, one thread, one "
            "process per solver; of each call the least time of three where that does "
            "not take long. Calls are from Python, those of "
            f"{listed(timed_in_cpp(plan.NO_RIVALS))} in C++."
        ),
        (
            f"A rival's answer is right within {POSITION_TOLERANCE:g} m, "
            f"{ROTATION_TOLERANCE:g} rad and the limits; branches of analytic solvers "
            "that lie outside the limits are left out after the clock has stopped."
        ),
        _machine(view),
    )
    return bullets(notes)


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
    return f"{about}: {'; '.join(found) or 'none'}.\n\n{tried_proofs(view)}"


def tried_proofs(view: View) -> str:
    """How many of IKSel's proofs other solvers' answers could have refuted."""
    cells = {
        name: [
            cell
            for robot in view.robots("no")
            for kind in plan.NO_KINDS
            if (cell := view.get(plan.no_cell(robot, name, kind, view.size)))
        ]
        for name in plan.NO_RIVALS
    }
    proofs = sum(cell["proofs"] for cell in cells.pop(OURS))
    counts = {name: sum(cell["proofs"] for cell in of) for name, of in cells.items()}
    refuted = sum(cell["disproved"] for of in cells.values() for cell in of)
    tried = "; ".join(f"{name} {count:,}" for name, count in counts.items() if count)
    return (
        f"IKSel gave {proofs:,} proofs that there is no answer. Other solvers were "
        f"asked for an answer where it did: {tried or 'none'}. Proofs that their "
        f"answers refute: {refuted}."
    )


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
            counts = ("yes", "proven", "proven_unasked", "swept", "searched")
            rows.append(
                [
                    f"`{robot}`, {KIND_WORDS[kind]}",
                    cell["structure"].replace("_", " "),
                    *(f"{cell[what]:,}" for what in counts),
                    f"{cell['most_iterations']:,}",
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
        "of these unasked",
        "by sweep",
        "searched",
        "most steps",
        "mean no in units",
        "with prove=True",
        "unit, µs",
    ]
    notes = (
        (
            "Counts are with `prove=True`: *proven* is certain, *by sweep* and "
            "*searched* are not. *Unasked*: proven without `prove=True`, too; the "
            "others are then by sweep."
        ),
        "A unit is one KDL FK + Jacobian, the least of 20 means in the same run.",
    )
    return table(header, rows) + "\n\n" + bullets(notes)
