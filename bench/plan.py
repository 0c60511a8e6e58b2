# SPDX-License-Identifier: BSD-3-Clause
"""What a report measures: jobs of cells.

Times are taken with nothing else running, so timed jobs go one after another. A job is
one process.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import iksel
from bench.analytic.plan import analytic_jobs
from bench.arms import RIVAL_ARMS
from bench.learned.plan import learned_jobs
from bench.paper.choices import choice_jobs
from bench.paper.plan import paper_jobs
from bench.paper.seeding import seeding_jobs
from bench.random_builds import random_jobs
from bench.rivals import ENUMERATORS, RIVALS
from bench.size import SEED, Job, Size
from bench.tails.plan import tail_jobs

if TYPE_CHECKING:
    from collections.abc import Collection

    from bench.store import Settings

SECTIONS = (
    "paper",
    "text",
    "learned",
    "seeds",
    "rivals",
    "no",
    "analytic",
    "random",
    "tails",
    "robots",
    "requests",
)
"""What --only takes."""


def plan(
    size: Size,
    robots: Collection[str] | None,
    only: Collection[str] | None,
    rivals: Collection[str] = (*RIVALS, *ENUMERATORS),
) -> list[Job]:
    """All jobs of a report, those without times first.

    Args:
        size: How much.
        robots: Keep only these robots; None: all.
        only: Keep only these sections and solvers; None: all.
        rivals: The solvers that can be had.
    """
    jobs = [
        *paper_jobs(size),
        *choice_jobs(size),
        *learned_jobs(size),
        *seeding_jobs(size),
        *_rival_jobs(size),
        *no_jobs(size),
        *analytic_jobs(size),
        *random_jobs(size),
        *tail_jobs(size),
        *_robots_jobs(size),
        *_request_jobs(size),
    ]
    return _ordered([_kept(job, robots, only, rivals) for job in jobs])


def no_plan(
    size: Size, robots: Collection[str], rivals: Collection[str] = tuple(RIVALS)
) -> list[Job]:
    """The jobs of the section "no" alone, on any robots."""
    jobs = no_jobs(size, robots)
    return _ordered([_kept(job, None, None, rivals) for job in jobs])


def learned_plan(
    size: Size, robots: Collection[str] | None, models: Collection[str]
) -> list[Job]:
    """The jobs of the section "learned" alone."""
    jobs = [_kept(job, robots, None, ()) for job in learned_jobs(size)]
    kept = [
        replace(job, cells=[cell for cell in job.cells if cell["model"] in models])
        for job in jobs
    ]
    return _ordered(kept)


def analytic_plan(
    size: Size, robots: Collection[str], rivals: Collection[str]
) -> list[Job]:
    """The jobs of the section "analytic" alone, on any robots."""
    jobs = analytic_jobs(size, robots)
    return _ordered([_kept(job, None, None, rivals) for job in jobs])


def _ordered(jobs: list[Job]) -> list[Job]:
    """Those with cells, and before them those that make their targets."""
    jobs = [*_target_jobs(jobs), *(job for job in jobs if job.cells)]
    return sorted(jobs, key=lambda job: job.timed)


def _kept(
    job: Job,
    robots: Collection[str] | None,
    only: Collection[str] | None,
    rivals: Collection[str],
) -> Job:
    """The job with the cells that were asked for."""
    cells = [
        cell
        for cell in job.cells
        if (robots is None or cell["robot"] in robots)
        and (only is None or job.section in only or cell.get("rival") in only)
        and ("rival" not in cell or cell["rival"] in rivals)
    ]
    return replace(job, cells=cells)


SECONDS_PER_TARGET = {
    "evaluate": 2e-4,
    "attempts": 1e-4,
    "rival": 2e-3,
    "targets": 1e-4,
    "batch": 1e-5,
    "artefact": 1e-2,
    "ikgeo_search": 5e-3,
    "ikgeo_package": 1e-2,
    "ikgeo_enumeration": 1e-4,
    "first_attempt": 1e-3,
    "learned": 5e-3,
    "newer": 1e-2,
    "paired": 2e-4,
    "seeds_shown": 1e-3,
    "tree_file": 1e-4,
    "no": 1e-3,
    "asked": 3e-3,
    "near_branches": 1e-3,
    "near_moves": 1e-3,
    "all_branches": 1e-3,
    "restarts": 2e-2,
    "path": 1e-2,
    "random_arms": 0.1,
    "tail_calls": 6e-6,
    "tail_beside": 1e-2,
    "tail_threads": 3e-5,
    "tail_fresh": 0.5,
    "whole_body": 1e-3,
}

PATH_WAYPOINTS = 1_000
"""About how many a path has."""


def seconds(cell: Settings) -> float:
    """About how long a cell takes, for the progress bar."""
    database = {"medium": 1.0, "small": 0.3, "large": 5.0}
    overrides = cell.get("overrides", {})
    fixed = database[overrides.get("database.scale", "medium")]
    if overrides.get("database.sampling") == "cvt":
        fixed *= 3.0
    per_target: float = SECONDS_PER_TARGET[cell["cell"]]
    return 0.2 + fixed / 5.0 + float(cell.get("count", PATH_WAYPOINTS)) * per_target


def rival_count(size: Size, name: str, kind: str) -> int:
    """Targets of a kind for a solver."""
    share = min(RIVALS[name].share, size.share)
    return max(1, round(size.rivals[kind] * share))


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


def target_cell(robot: str, kind: str, count: int, seed: int = SEED) -> Settings:
    """Targets, made once for all solvers with that count."""
    return {
        "cell": "targets",
        "robot": robot,
        "kind": kind,
        "count": count,
        "seed": seed,
    }


def rival_cell(robot: str, name: str, kind: str, size: Size) -> Settings:
    """One solver on one kind of targets."""
    count = rival_count(size, name, kind)
    return {**target_cell(robot, kind, count), "cell": "rival", "rival": name}


def batch_cell(robot: str, name: str, threads: int, size: Size) -> Settings:
    """Many poses in one call."""
    cell = target_cell(robot, "uniform", size.batch)
    return {**cell, "cell": "batch", "rival": name, "threads": threads}


def every_cell(robot: str, size: Size) -> Settings:
    """All branches of many poses, pose by pose: beside EAIK's batches."""
    return {**batch_cell(robot, "IKSel", 1, size), "every": True}


BESIDE_LEVEL = "avx2"
"""The SIMD level of the rows beside those of AVX-512: what most processors have."""


def other_level() -> str | None:
    """BESIDE_LEVEL where the rows are of AVX-512."""
    return BESIDE_LEVEL if iksel.simd_level() == "avx512" else None


def at_level(cell: Settings, level: str) -> Settings:
    """A cell of IKSel's, measured in a process whose SIMD level is another."""
    return {**cell, "simd": level}


BATCHES = (("ur3_wrs", "EAIK"), *((robot, "IKSel") for robot in RIVAL_ARMS))
"""Robots and solvers of the batches."""

BATCH_THREADS = (1, 2)


def _rival_jobs(size: Size) -> list[Job]:
    jobs = [
        Job(
            name,
            "rivals",
            [
                rival_cell(robot, name, kind, size)
                for robot in RIVAL_ARMS
                for kind in size.rivals
            ],
        )
        for name in RIVALS
    ]
    batches = [
        batch_cell(robot, name, threads, size)
        for robot, name in BATCHES
        for threads in BATCH_THREADS
    ]
    batches.append(every_cell(BATCHES[0][0], size))
    jobs.append(Job("batches", "rivals", batches))
    if level := other_level():
        cells = [
            at_level(rival_cell(robot, "IKSel", kind, size), level)
            for robot in RIVAL_ARMS
            for kind in size.rivals
        ]
        jobs.append(Job(f"IKSel, {level}", "rivals", cells))
    return jobs


NO_KINDS = ("uniform", "any_rotation")
"""Targets that all have an answer, and targets of which many have none."""
BRANCH_RIVAL = "EAIK"
BRANCH_ARMS = ("ur3", "ur3_wrs", "ur10e", "irb120", "vs060")
"""Robots whose branches an analytic solver knows."""
NO_ARMS = (
    *BRANCH_ARMS,
    *("cvr038", "cvrb1213", "gen3_6dof", "xarm6"),
    *("panda", "iiwa14", "xarm7", "pr2_right_arm"),
    *("irb14050", "synthetic10"),
)
"""Of every structure some: closed form; two axes that are parallel or meet; closed form
when one of seven joints is held; none of these."""
NO_RIVALS = (
    "IKSel",
    BRANCH_RIVAL,
    "Robotics Toolbox",
    "OptIK",
    "TRAC-IK (pytracik)",
    "Pinocchio, Python loop",
    "Pinocchio, C++ loop",
    "KDL LMA",
    "KDL NR_JL",
)
MANY = 10.0
"""Share of a solver that is fast enough for all targets of the noes."""


def no_cell(robot: str, name: str, kind: str, size: Size) -> Settings:
    """One solver's yes and no to targets of a kind."""
    count = size.no if RIVALS[name].share >= MANY else size.no_slow
    cell = target_cell(robot, kind, count, size.no_seed)
    return {**cell, "cell": "no", "rival": name}


def branch_cell(cell: str, robot: str, kind: str, size: Size) -> Settings:
    """All branches or the nearest, beside a solver that knows them if there is one."""
    known = robot in BRANCH_ARMS
    count = size.no if known else max(1, size.no // 10)
    settings = {**target_cell(robot, kind, count, size.no_seed), "cell": cell}
    return {**settings, "beside": BRANCH_RIVAL} if known else settings


def no_jobs(size: Size, arms: Collection[str] = NO_ARMS) -> list[Job]:
    """Each solver's yes and no; all branches, and the nearest."""
    answered = {
        name: [no_cell(robot, name, kind, size) for robot in arms for kind in NO_KINDS]
        for name in NO_RIVALS
    }
    branches = {
        title: [
            branch_cell(cell, robot, kind, size) for robot in arms for kind in NO_KINDS
        ]
        for title, cell in (("all", "all_branches"), ("nearest", "near_branches"))
    }
    return [
        Job(f"no, {name}", "no", cells) for name, cells in (answered | branches).items()
    ]


def all_robots() -> list[str]:
    """The built-in robots that have at least 6 joints."""
    return [name for name in iksel.robot_names() if iksel.robot_info(name).dof >= 6]


def robot_cell(robot: str, size: Size) -> Settings:
    """The default preset by iksel.evaluate, with the time of each stage."""
    return {
        "cell": "evaluate",
        "robot": robot,
        "preset": "default",
        "overrides": {},
        "count": size.robots,
        "seed": SEED,
        "stages": True,
    }


def _robots_jobs(size: Size) -> list[Job]:
    cells = [robot_cell(robot, size) for robot in all_robots()]
    jobs = [Job("every robot", "robots", cells)]
    if level := other_level():
        others = [at_level(cell, level) for cell in cells]
        jobs.append(Job(f"every robot, {level}", "robots", others))
    return jobs


RESTART_ARMS = ("cvr038", "cvrb1213")
"""Robots whose branches none of them knows."""
MOVE_ARMS = ("panda", "iiwa14")
MOVE_RIVALS: dict[str, dict[str, Any]] = {
    "Robotics Toolbox": {"rival": "Robotics Toolbox"},
    "OptIK": {"rival": "OptIK"},
    "OptIK, quality": {"rival": "OptIK", "quality": True},
}
"""Solvers that start where they are told, as settings."""
PATHS = (
    ("panda", "line"),
    ("ur3", "flip"),
    ("ur3", "flip_beside"),
    ("ur3", "flip_free"),
)


def request_cell(cell: str, robot: str, count: int) -> Settings:
    """One request on one robot."""
    return {**target_cell(robot, "uniform", count), "cell": cell}


def moves_cell(robot: str, name: str, size: Size) -> Settings:
    """Our moves beside those of a solver, of which each call takes up to 0.1 s."""
    return {
        **request_cell("near_moves", robot, max(1, size.requests // 10)),
        **MOVE_RIVALS[name],
    }


def path_cell(robot: str, name: str) -> Settings:
    """One path of bench.requests."""
    return {"cell": "path", "robot": robot, "path": name}


def _request_jobs(size: Size) -> list[Job]:
    counts = [request_cell("restarts", robot, size.restarts) for robot in RESTART_ARMS]
    paths = [path_cell(robot, name) for robot, name in PATHS]
    moves = [
        Job(
            f"near, {name}",
            "requests",
            [moves_cell(robot, name, size) for robot in MOVE_ARMS],
        )
        for name in MOVE_RIVALS
    ]
    return [
        *moves,
        Job("restarts", "requests", counts),
        Job("paths", "requests", paths),
    ]
