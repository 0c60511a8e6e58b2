# SPDX-License-Identifier: BSD-3-Clause
"""Arms drawn at random as text, and the command for it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from bench import random_arms
from bench.arguments import add_count, add_kept, add_names, add_seed
from bench.markdown import NONE, bullets, microseconds, percent, table
from bench.moves import LONGER
from bench.random_builds import RESTARTS, random_cell, random_jobs
from bench.size import FULL, QUICK
from bench.view import View, tell_section

if TYPE_CHECKING:
    import argparse
    from collections.abc import Collection

    from bench.size import Job, Size
    from bench.view import Report

SUMMED = (
    *("arms", "targets", "lost", "false", "noes", "proven", "swept"),
    *("tried", "found", "tried_proofs", "refuted", "moves", "longer"),
)
HEADER = (
    *("build", "arms", "targets", "lost", "false", "no: all", "proven %", "by sweep %"),
    *("neither %", "noes tried: answered", "proofs tried: refuted", "yes µs", "no µs"),
    *("`near`: moves", "longer"),
)


def text(view: View) -> str:
    """The whole section; empty where there are no results."""
    cells = found(view)
    if not cells:
        return ""
    rows = [[f"`{build}`", *_columns(cell)] for build, cell in cells.items()]
    total: dict[str, Any] = {
        what: sum(cell[what] for cell in cells.values()) for what in SUMMED
    }
    rows.append(["all", *_columns({**total, "yes_us": None, "no_us": None})])
    parts = [
        "## Arms drawn at random",
        _conditions(view),
        table(HEADER, rows),
        *_culprits(cells),
    ]
    return "\n\n".join(parts)


def found(view: View) -> dict[str, dict[str, Any]]:
    """The results by build."""
    cells = {
        build: view.get(random_cell(build, view.size)) for build in random_arms.BUILDS
    }
    return {build: cell for build, cell in cells.items() if cell is not None}


def _conditions(view: View) -> str:
    size = view.size
    return bullets(
        (
            (
                f"Arms: up to {size.random_arms} of each build "
                f"(`bench/random_arms.py`), seeds from {size.random_seed:,}, by which "
                f"no constant was chosen; none is begun after {size.random_s:g} s of a "
                "build."
            ),
            (
                f"Targets: of each arm {size.random_targets:,} poses of configurations "
                f"uniform inside the limits in a batch and {size.random_asked:,} "
                "others one by one, which can all be reached; and "
                f"{size.random_asked:,} reachable positions with rotations at random, "
                "which give the noes."
            ),
            (
                "Default options, tolerances of 1e-6 m and 1e-6 rad, one thread, from "
                "Python. Answers are judged by bench's own forward kinematics, not by "
                "IKSel's."
            ),
            (
                "*yes*: mean time of the reachable that are solved, *no* of the random "
                "rotations that are not, over all arms, the least of three of each."
            ),
            (
                "*Proven*, *by sweep*, *neither*: what IKSel says of its noes. Only "
                "what is proven is certain."
            ),
            (
                f"*Tried*: up to {size.random_brute} noes of each arm are asked again, "
                f"of IKSel's own iteration from {RESTARTS} random seeds; no other "
                "solver is asked. *Proofs tried* are those of them that are proven. "
                "*Refuted*: proven noes that have an answer, by these restarts or "
                "because the target can be reached."
            ),
            (
                f"*Moves*: {size.random_brute} of each arm from any configuration, "
                "held against brute force made of IKSel's own calls: the configuration "
                "that the pose is of, all of `solve_all`, and `self_motion` from end "
                "to end, or, where the solutions are no curve, the restarts. *longer*: "
                f"by more than {LONGER:g} rad (of a slide m)."
            ),
            "Made by itself: `python -m bench random`.",
        )
    )


def _columns(cell: dict[str, Any]) -> list[str]:
    noes = cell["noes"]
    sure = (cell["proven"], cell["swept"])
    return [
        *(f"{cell[what]:,}" for what in ("arms", "targets", "lost", "false", "noes")),
        *(percent(count, noes, 1) if noes else NONE for count in (*sure, unsure(cell))),
        f"{cell['tried']:,}: {cell['found']:,}",
        f"{cell['tried_proofs']:,}: {cell['refuted']:,}",
        microseconds(cell["yes_us"]),
        microseconds(cell["no_us"]),
        f"{cell['moves']:,}",
        f"{cell['longer']:,}",
    ]


def unsure(cell: dict[str, Any]) -> int:
    """Noes that are neither proven nor swept."""
    return int(cell["noes"] - cell["proven"] - cell["swept"])


def _culprits(cells: dict[str, dict[str, Any]]) -> list[str]:
    """The arms where a count is not 0, to look at them again."""
    lines = [
        f"- `{build}`, {what}: "
        + ", ".join(f"{count} on seed {seed}" for seed, count in seeds)
        for build, cell in cells.items()
        for what, seeds in cell["culprits"].items()
    ]
    return ["\n".join(["Where:", "", *lines])] if lines else []


def wrong(view: View) -> list[str]:
    """What must never be: answers and proofs that are wrong."""
    return [
        f"{build}: {cell[what]} {words}"
        for build, cell in found(view).items()
        for what, words in (("false", "false answers"), ("refuted", "refuted proofs"))
        if cell[what]
    ]


def add(commands: Any) -> None:
    """The command `random`."""
    command = commands.add_parser(
        "random",
        help="success, noes, proofs and moves on arms drawn at random, printed",
        description="The report's section on random arms of each build. Results are "
        "kept as the report's are.",
    )
    add_names(command, "builds", random_arms.BUILDS)
    add_kept(command, "fewer arms and targets")
    add_count(command, "--arms", None, "arms of each build")
    add_count(command, "--targets", None, "targets of each arm, in a batch")
    command.add_argument(
        "--seconds",
        type=float,
        metavar="S",
        help="begin no further arm of a build after this time",
    )
    add_seed(command, FULL.random_seed)


def jobs_of(
    options: argparse.Namespace,
    installed: Collection[str],  # noqa: ARG001
) -> tuple[list[Job], Size]:
    """What is to be measured, and how much."""
    size = QUICK if options.quick else FULL
    size = replace(
        size,
        random_arms=options.arms or size.random_arms,
        random_targets=options.targets or size.random_targets,
        random_s=options.seconds or size.random_s,
        random_seed=options.seed,
    )
    return random_jobs(size, options.builds), size


def tell(report: Report) -> int:
    """Print the section; the exit status is 1 if IKSel is wrong or something failed."""
    view = View(report)
    failed = bool(report["failures"])
    return tell_section(text(view), wrong=wrong(view), failed=failed)
