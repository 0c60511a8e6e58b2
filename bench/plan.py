# SPDX-License-Identifier: BSD-3-Clause
"""What a report measures: jobs of cells.

Times are taken with nothing else running, so timed jobs go one after another. A job is
one process.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from bench.analytic.plan import analytic_jobs
from bench.learned.plan import learned_jobs
from bench.paper.choices import choice_jobs
from bench.paper.plan import paper_jobs
from bench.paper.seeding import seeding_jobs
from bench.plans.no import no_jobs
from bench.plans.requests import request_jobs
from bench.plans.rivals import rival_jobs
from bench.plans.robots import robots_jobs
from bench.plans.shared import target_cell
from bench.random_builds import random_jobs
from bench.size import Job
from bench.store import key_of
from bench.tails.plan import tail_jobs

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Sequence

    from bench.size import Size
    from bench.store import Settings

SECTIONS: dict[str, Callable[[Size], list[Job]]] = {
    "paper": paper_jobs,
    "text": choice_jobs,
    "learned": learned_jobs,
    "seeds": seeding_jobs,
    "rivals": rival_jobs,
    "no": no_jobs,
    "analytic": analytic_jobs,
    "random": random_jobs,
    "tails": tail_jobs,
    "robots": robots_jobs,
    "requests": request_jobs,
}
"""The jobs of each, by what --only takes."""


def plan(
    size: Size,
    robots: Collection[str] | None = None,
    only: Collection[str] | None = None,
    rivals: Collection[str] | None = None,
) -> list[Job]:
    """All jobs of a report; see `chosen`."""
    jobs = [job for jobs_of in SECTIONS.values() for job in jobs_of(size)]
    return chosen(jobs, robots, only, rivals)


def chosen(
    jobs: Sequence[Job],
    robots: Collection[str] | None = None,
    only: Collection[str] | None = None,
    rivals: Collection[str] | None = None,
) -> list[Job]:
    """Jobs with those of their cells that are wanted, each cell once, in their order.

    Those without times come first, and before them those that make the targets. What
    two sections show is measured for the first of them.

    Args:
        jobs: Of any sections.
        robots: Keep only these robots; None: all.
        only: Keep only these sections and solvers; None: all.
        rivals: The solvers that can be had; None: all.
    """
    seen: set[str] = set()
    kept = []
    for job in jobs:
        cells = {
            key_of(cell): cell
            for cell in job.cells
            if (robots is None or cell["robot"] in robots)
            and (only is None or job.section in only or cell.get("rival") in only)
            and (rivals is None or cell.get("rival") in {None, *rivals})
        }
        new = [cell for key, cell in cells.items() if key not in seen]
        seen |= cells.keys()
        if new:
            kept.append(replace(job, cells=new))
    return sorted([*_target_jobs(kept), *kept], key=lambda job: job.timed)


def _target_jobs(jobs: list[Job]) -> list[Job]:
    """One job per robot for the targets that other jobs read."""
    wanted: dict[str, list[Settings]] = {}
    for job in jobs:
        for cell in job.cells:
            if "kind" in cell:
                made = target_cell(
                    cell["robot"], cell["kind"], cell["count"], cell["seed"]
                )
                cells = wanted.setdefault(cell["robot"], [])
                if made not in cells:
                    cells.append(made)
    return [
        Job(f"targets, {robot}", "targets", cells, timed=False)
        for robot, cells in wanted.items()
    ]
