# SPDX-License-Identifier: BSD-3-Clause
"""What README.md shows of the report: two tables, and what is in them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bench.analytic.plan import KINDS
from bench.arms import RIVAL_ARMS
from bench.check import POSITION_TOLERANCE, ROTATION_TOLERANCE
from bench.markdown import NONE, bullets, microseconds, percent, table
from bench.plans import no as plan
from bench.plans.rivals import rival_cell
from bench.random_builds import RESTARTS
from bench.sections import fastest, random_builds
from bench.sections.cut_offs import ENOUGH
from bench.sections.no import tried_proofs
from bench.sections.rivals import OURS, TIMES
from bench.size import SEED

if TYPE_CHECKING:
    from bench.sections.fastest import Result
    from bench.view import View

REACHED, TURNED = KINDS


def results(view: View) -> str:
    """The default preset beside its rivals."""
    rows = [
        _row(view, robot, ours)
        for robot in RIVAL_ARMS
        if (ours := view.get(rival_cell(robot, OURS, "uniform", view.size)))
    ]
    if not rows:
        return "Not measured: `python -m bench report --only rivals`."
    header = [
        "robot",
        "solved",
        "mean",
        "p99",
        "next fastest numerical solver",
        "fastest that enumerates",
        "a no",
        "others' no",
    ]
    plot = "![Share of targets solved over time](bench/plots/success_over_time.svg)"
    return "\n\n".join([plot, table(header, rows), bullets(_conditions(view))])


def _row(view: View, robot: str, ours: Result) -> list[str]:
    """One robot, and who is next."""
    others_no = fastest.enumerators_no(fastest.asked(view, robot, TURNED))
    return [
        f"`{robot}`",
        f"{percent(ours['right'], ours['count'], 3)} %",
        f"{microseconds(ours['mean_us'])} µs",
        f"{microseconds(ours['p99_us'])} µs",
        fastest.next_numerical(view, robot, ours["mean_us"]),
        fastest.enumerating(fastest.asked(view, robot, REACHED)),
        _our_no(view.get(_no_cell(view, robot))),
        f"{others_no}; {fastest.cut_off(view, robot)}",
    ]


def _no_cell(view: View, robot: str) -> Result:
    return plan.no_cell(robot, OURS, TURNED, view.size)


def _our_no(cell: Result | None) -> str:
    """What it costs, and how many are certain, without and with prove=True."""
    if cell is None or cell["no_us"] is None:
        return "not measured"
    noes = cell["proven"] + cell["swept"] + cell["searched"]
    text = f"{microseconds(cell['no_us'][0])} µs"
    if not cell["proven"]:
        return f"{text}, none proven"
    share = percent(cell["proven"], noes, 1)
    if cell["proven_unasked"] == cell["proven"]:
        return f"{text}, {share} % proven"
    unasked = cell["proven_unasked"]
    sure = f"{percent(unasked, noes, 1)} % proven" if unasked else "none proven"
    proof = microseconds(cell["proven_us"][0])
    return f"{text}, {sure}; `prove=True`: {proof} µs, {share} % proven"


def machine(view: View, section: str) -> str:
    """What a section was measured on, of which commit, and by which command."""
    part = view.report.get("parts", {}).get(section, view.report)
    facts = part["machine"]
    load = f", load average {facts['load']:g}" if "load" in facts else ""
    return (
        f"{facts['cpu']} ({facts['cores']} cores{load}), SIMD level {facts['simd']}, "
        f"commit {facts['commit']}, by `{part['command']}`."
    )


def _conditions(view: View) -> list[str]:
    count = max(
        cell["count"]
        for robot in RIVAL_ARMS
        if (cell := view.get(rival_cell(robot, OURS, "uniform", view.size)))
    )
    others = sorted(
        {
            cell["count"]
            for robot in RIVAL_ARMS
            for cell in fastest.numerical(view, robot).values()
        }
    )
    fewer = " to ".join(f"{n:,}" for n in dict.fromkeys([*others[:1], *others[-1:]]))
    size = view.size
    return [
        (
            f"Targets: {count:,} per robot (other solvers {fewer}), uniform in the "
            f"joint limits, seed {SEED}, so that all can be reached; one pose at a "
            f"time. {TIMES}"
        ),
        (
            f"*Solved*: an answer within {POSITION_TOLERANCE:g} m and "
            f"{ROTATION_TOLERANCE:g} rad by forward kinematics that is not IKSel's, "
            "and inside the limits. In brackets the other solver's share."
        ),
        (
            "*Fastest that enumerates*: of the solvers that know all solutions the "
            f"fastest that misses none of up to {size.analytic:,} such targets: mean "
            "for one answer, or for all where it gives only all. In brackets IKSel's "
            "mean for the same in the same section of the report, of each call the "
            "least of three."
        ),
        (
            f"*A no*: mean time of `solve` where it finds no answer, of {size.no:,} "
            "reachable positions with rotations at random. What is *proven* is certain "
            "(IKSel's own proofs); any other no is a search that found nothing."
        ),
        (
            "*Others' no*: the fastest solver that enumerates and misses at most "
            f"{100 * fastest.FEW_MISSED:g} % of the targets with an answer, of up to "
            f"{size.analytic:,} such poses; and the least cut-off with which a "
            f"numerical solver still solves {100 * ENOUGH:g} % of the reachable "
            "targets, which proves nothing."
        ),
        machine(view, "rivals"),
    ]


def noes(view: View) -> str:
    """What poses without an answer cost on each robot."""
    rows = [
        [f"`{robot}`", *_no_columns(view, robot, ours)]
        for robot in view.robots("no")
        if (ours := view.get(_no_cell(view, robot)))
    ]
    if not rows:
        return "Not measured: `python -m bench report --only no`."
    header = [
        *("robot", "structure", "solved", "no: proven", "by sweep", "searched"),
        *("yes", "no", "no, `prove=True`", "an enumerator's no"),
        *("`solve_all`", "`near`", "KDL"),
    ]
    return table(header, rows) + "\n\n" + bullets(_no_conditions(view))


def _no_columns(view: View, robot: str, ours: Result) -> list[str]:
    unasked = ours["proven_unasked"]
    proven = f"{ours['proven']:,}"
    if unasked < ours["proven"]:
        proven += f" ({unasked:,} unasked)"
    rest = (
        view.get(plan.branch_cell(cell, robot, TURNED, view.size))
        for cell in ("all_branches", "near_branches")
    )
    return [
        ours["structure"].replace("_", " "),
        f"{ours['yes']:,}",
        proven,
        *(f"{ours[what]:,}" for what in ("swept", "searched")),
        *(_two_times(ours[what]) for what in ("yes_us", "no_us", "proven_us")),
        fastest.enumerators_no(fastest.asked(view, robot, TURNED)),
        *(NONE if cell is None else microseconds(cell["mean_us"]) for cell in rest),
        microseconds(ours["unit_us"]),
    ]


def _two_times(times: list[float] | None) -> str:
    """Mean and median."""
    return NONE if times is None else ", ".join(map(microseconds, times))


def _no_conditions(view: View) -> list[str]:
    size = view.size
    reachable = [
        cell
        for robot in view.robots("no")
        if (cell := view.get(plan.no_cell(robot, OURS, REACHED, size)))
    ]
    solved, count = (sum(cell[what] for cell in reachable) for what in ("yes", "count"))
    return [
        (
            f"Targets: {size.no:,} per robot, seed {size.no_seed}; tolerances of 1e-6 "
            "m and 1e-6 rad, one thread, from Python; of each call the least time of "
            "three where that does not take long. `solve_all` and `near` over all "
            "targets, or a tenth of them where there is no closed form."
        ),
        (
            "*Proven*: IKSel says that there is certainly no answer, asked with "
            "`prove=True`; in brackets how many of them it proves *unasked*, where "
            "that is fewer. *By sweep*: one joint was swept over its range; "
            "*searched*: seeds were tried. Neither is certain."
        ),
        "*An enumerator's no* is as in the table above.",
        (
            f"Of {count:,} targets that can be reached, uniform in the limits of these "
            f"{len(reachable)} robots, seed {size.no_seed}, {solved:,} were solved."
        ),
        tried_proofs(view),
        *_random_arms(view),
        machine(view, "no"),
    ]


def _random_arms(view: View) -> list[str]:
    """The same on arms that no constant was chosen by."""
    cells = random_builds.found(view).values()
    if not cells:
        return []
    total = {what: sum(cell[what] for cell in cells) for what in random_builds.SUMMED}
    return [
        (
            f"Arms drawn at random: {total['arms']:,} of {len(cells)} builds, seeds "
            f"from {view.size.random_seed:,}, by which no constant was chosen. Of "
            f"{total['targets']:,} targets that can be reached {total['lost']:,} were "
            f"not solved, and {total['false']:,} answers were false."
        ),
        (
            f"Of these arms' {total['noes']:,} noes {total['proven']:,} were proven, "
            f"{total['swept']:,} swept, and {random_builds.unsure(total):,} neither. "
            f"{total['tried_proofs']:,} of the proofs were tried, by IKSel's own "
            f"iteration from {RESTARTS} random seeds each: {total['refuted']:,} "
            "refuted."
        ),
        (
            f"Of {total['moves']:,} moves with `near` {total['longer']:,} were longer "
            "than brute force's, which is IKSel's own: all of `solve_all`, "
            "`self_motion` from end to end, or restarts. `python -m bench random` "
            "prints these build by build."
        ),
    ]
