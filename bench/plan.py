# SPDX-License-Identifier: BSD-3-Clause
"""What a report measures: jobs of cells, in two sizes.

Times are taken with nothing else running, so timed jobs go one after another. A job is
one process.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import iksel
from bench.arms import PAPER_ARMS, RIVAL_ARMS
from bench.cells import CEILING_ATTEMPTS
from bench.rivals import RIVALS

if TYPE_CHECKING:
    from collections.abc import Collection

    from bench.store import Settings

SEED = 1
"""Seed of all targets."""

SECTIONS = ("paper", "rivals", "robots", "requests")
"""What --only takes."""

ABLATION_1_SCALES = ("small", "medium", "large")

SELECTIONS: dict[str, dict[str, Any]] = {
    "Eq. (5), farthest": {},
    "Eq. (5), in order": {"reselection": "next"},
    "Eq. (2), in order": {"ranking": "nearest", "reselection": "next"},
}
"""The three methods of the paper's figures, as changes to the paper preset."""

ROTATION_KEYS = ("rotation_vector", "matrix", "euler", "quaternion")


@dataclass(frozen=True)
class Size:
    """How much is measured."""

    paper: int
    """Targets of the paper's tables."""
    figure: int
    """Targets for the times of the figures."""
    figure_attempts: tuple[int, ...]
    """#ReA that the figures' times are taken at."""
    cvt_scales: tuple[str, ...]
    """Sizes of the databases that are also sampled by CVT."""
    rivals: dict[str, int]
    """Targets per kind for a solver whose share is 1."""
    robots: int
    """Targets for the table of all robots."""
    batch: int
    """Poses in a batch."""
    artefact: int
    """Queries looked at for singular samples."""
    share: float = 10.0
    """Largest share that a solver may have."""
    requests: int = 10_000
    """Targets of the requests."""
    restarts: int = 1_000
    """Targets that are restarted a thousand times each."""


FULL = Size(
    paper=10_000,
    figure=2_000,
    figure_attempts=tuple(range(1, 21)),
    cvt_scales=("small", "medium"),
    rivals={
        "uniform": 2_000,
        "near_limits": 1_000,
        "near_singular": 1_000,
        "lines": 1_000,
        "any_rotation": 100,
        "unreachable": 100,
    },
    robots=100_000,
    batch=10_000,
    artefact=1_000,
)

QUICK = Size(
    paper=1_000,
    figure=200,
    figure_attempts=(1, 5, 20),
    cvt_scales=(),
    rivals={
        "uniform": 100,
        "near_limits": 40,
        "near_singular": 40,
        "lines": 40,
        "any_rotation": 5,
        "unreachable": 5,
    },
    robots=2_000,
    batch=2_000,
    artefact=200,
    requests=500,
    restarts=50,
)


@dataclass(frozen=True)
class Job:
    """Cells measured by one process."""

    name: str
    section: str
    cells: list[Settings]
    timed: bool = True


def plan(
    size: Size,
    robots: Collection[str] | None,
    only: Collection[str] | None,
    rivals: Collection[str] = tuple(RIVALS),
) -> list[Job]:
    """All jobs of a report, those without times first.

    Args:
        size: How much.
        robots: Keep only these robots; None: all.
        only: Keep only these sections and solvers; None: all.
        rivals: The solvers that can be had.
    """
    jobs = [
        *_paper_jobs(size),
        *_rival_jobs(size),
        _robots_job(size),
        *_request_jobs(size),
    ]
    jobs = [_kept(job, robots, only, rivals) for job in jobs]
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
    "seeds": 5e-3,
    "near_branches": 1e-3,
    "near_moves": 1e-3,
    "all_branches": 1e-3,
    "restarts": 2e-2,
    "path": 1e-2,
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


def paper_cell(
    robot: str, size: Size, overrides: dict[str, Any], count: int | None = None
) -> Settings:
    """The paper preset with some options changed, by iksel.evaluate."""
    return {
        "cell": "evaluate",
        "robot": robot,
        "preset": "paper",
        "overrides": overrides,
        "count": size.paper if count is None else count,
        "seed": SEED,
    }


def attempts_cell(robot: str, size: Size, overrides: dict[str, Any]) -> Settings:
    """Success after each number of attempts."""
    return {**paper_cell(robot, size, overrides), "cell": "attempts"}


def curve_cell(
    robot: str, size: Size, sampling: dict[str, Any], selection: str
) -> Settings:
    """Success over #ReA 1 to 20."""
    changes = {**sampling, **SELECTIONS[selection], "max_attempts": 21}
    return attempts_cell(robot, size, changes)


def ceiling_cell(robot: str, size: Size, sampling: dict[str, Any]) -> Settings:
    """Success after 100 attempts."""
    many = {"max_attempts": CEILING_ATTEMPTS, "candidates": CEILING_ATTEMPTS}
    return attempts_cell(robot, size, {**sampling, **many})


def sampling_of(name: str, scale: str = "medium") -> dict[str, Any]:
    """Overrides for a grid or CVT of a scale; the preset's own are left out."""
    changes: dict[str, Any] = {}
    if name == "cvt":
        changes = {"database.sampling": "cvt", "database.samples": 0}
    if scale != "medium":
        changes["database.scale"] = scale
    return changes


def ablation_2(scheme: str) -> dict[str, Any]:
    """Overrides of a row of Table II; a note after the name is another reading."""
    name, _, note = scheme.partition(", ")
    changes: dict[str, Any] = {} if name == "dls" else {"iteration": name}
    return {**changes, **ABLATION_2_NOTES.get(note, {})}


ABLATION_2_NOTES: dict[str, dict[str, Any]] = {
    "6 steps": {"max_iterations": 6},
    "growth stop on": {"growth_stop": "on"},
}

ABLATION_2_ROWS = (
    "dls",
    "pinv",
    "pinv_rr",
    "pinv_rr, 6 steps",
    "cwln",
    "cwpi",
    "cwpi, growth stop on",
)

ABLATION_3_ROWS: dict[str, dict[str, Any]] = {
    "Eq. (2)": {"ranking": "nearest", "reselection": "next"},
    "Eq. (2), farthest": {"ranking": "nearest"},
    "Eq. (5)": {},
    "#ReA 3": {"max_attempts": 4},
    "#ReA 5": {"max_attempts": 6},
    "#ReA 10": {"max_attempts": 11},
    "#ReA 20": {"max_attempts": 21},
}


def figure_cell(robot: str, size: Size, selection: str, rea: int) -> Settings:
    """Mean and deviation of the time at one #ReA."""
    changes = {**SELECTIONS[selection], "max_attempts": rea + 1}
    return paper_cell(robot, size, changes, size.figure)


def artefact_cell(robot: str, size: Size, overrides: dict[str, Any]) -> Settings:
    """Singular samples that rank first."""
    return {**paper_cell(robot, size, overrides, size.artefact), "cell": "artefact"}


def artefact_rows(size: Size) -> dict[str, dict[str, Any]]:
    """Overrides of the databases that are searched for singular samples."""
    rows = {f"grid, {scale}": sampling_of("grid", scale) for scale in ABLATION_1_SCALES}
    for scale in dict.fromkeys(("small", *size.cvt_scales)):
        rows[f"cvt, {scale}"] = sampling_of("cvt", scale)
    even = {"database.sampling": "low_discrepancy", "database.samples": 0}
    return {**rows, "low_discrepancy, medium": even}


def seeds_cell(robot: str, size: Size) -> Settings:
    """IK-Geo's solutions as seeds of the paper's iteration."""
    count = min(size.paper, 2_000)
    cell = paper_cell(robot, size, {}, count)
    return {**cell, "cell": "seeds", "rival": "IK-Geo", "kind": "uniform"}


def _paper_jobs(size: Size) -> list[Job]:
    jobs = []
    for robot, short in PAPER_ARMS.items():
        for sampling in ("grid", "cvt"):
            scales = ABLATION_1_SCALES if sampling == "grid" else size.cvt_scales
            cells = _table_cells(robot, size, sampling, scales)
            curves = [cell for cell in cells if cell["cell"] == "attempts"]
            timed = [cell for cell in cells if cell["cell"] != "attempts"]
            name = f"paper, {short}, {sampling}"
            jobs.append(Job(f"{name}, curves", "paper", curves, timed=False))
            jobs.append(Job(name, "paper", timed))
        figure = [
            figure_cell(robot, size, selection, rea)
            for selection in SELECTIONS
            for rea in size.figure_attempts
        ]
        jobs.append(Job(f"paper, {short}, figures", "paper", figure))
        keys = [
            attempts_cell(robot, size, {"database.rotation_key": key})
            for key in ROTATION_KEYS
        ]
        name = f"paper, {short}, rotation keys"
        jobs.append(Job(name, "paper", keys, timed=False))
    rows = artefact_rows(size).values()
    artefact = [artefact_cell("ur3_wrs", size, row) for row in rows]
    jobs.append(Job("paper, grid artefact", "paper", artefact, timed=False))
    seeded = [seeds_cell(robot, size) for robot in ("cvr038", "cvrb1213", "ur3_wrs")]
    jobs.append(Job("paper, IK-Geo as seed", "paper", seeded))
    return jobs


def _table_cells(
    robot: str, size: Size, sampling: str, scales: tuple[str, ...]
) -> list[Settings]:
    """The cells of the three ablations with one sampling, each once."""
    cells = [paper_cell(robot, size, sampling_of(sampling, scale)) for scale in scales]
    if "medium" in scales:
        base = sampling_of(sampling)
        rows = [ablation_2(scheme) for scheme in ABLATION_2_ROWS]
        rows += ABLATION_3_ROWS.values()
        cells += [paper_cell(robot, size, {**base, **row}) for row in rows]
        cells += [curve_cell(robot, size, base, name) for name in SELECTIONS]
        cells.append(ceiling_cell(robot, size, base))
        cwln = {**base, **ablation_2("cwln")}
        cells.append(attempts_cell(robot, size, cwln))
    # One option changed from the preset may be none: rows of two tables are one cell.
    return [cell for i, cell in enumerate(cells) if cell not in cells[:i]]


def _target_jobs(jobs: list[Job]) -> list[Job]:
    """One job per robot for the targets that other jobs read."""
    wanted: dict[str, list[Settings]] = {}
    for job in jobs:
        for cell in job.cells:
            if "kind" in cell:
                made = target_cell(cell["robot"], cell["kind"], cell["count"])
                cells = wanted.setdefault(cell["robot"], [])
                if made not in cells:
                    cells.append(made)
    return [
        Job(f"targets, {robot}", "targets", cells, timed=False)
        for robot, cells in wanted.items()
    ]


def target_cell(robot: str, kind: str, count: int) -> Settings:
    """Targets, made once for all solvers with that count."""
    return {
        "cell": "targets",
        "robot": robot,
        "kind": kind,
        "count": count,
        "seed": SEED,
    }


def rival_cell(robot: str, name: str, kind: str, size: Size) -> Settings:
    """One solver on one kind of targets."""
    count = rival_count(size, name, kind)
    return {**target_cell(robot, kind, count), "cell": "rival", "rival": name}


def batch_cell(robot: str, name: str, threads: int, size: Size) -> Settings:
    """Many poses in one call."""
    cell = target_cell(robot, "uniform", size.batch)
    return {**cell, "cell": "batch", "rival": name, "threads": threads}


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
    return [*jobs, Job("batches", "rivals", batches)]


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


def _robots_job(size: Size) -> Job:
    cells = [robot_cell(robot, size) for robot in all_robots()]
    return Job("every robot", "robots", cells)


BRANCH_ARMS = ("ur3", "ur10e")
"""Robots whose branches an analytic solver knows."""
NEAR_ARM = BRANCH_ARMS[0]
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
BRANCH_RIVAL = "EAIK"


def request_cell(cell: str, robot: str, count: int, rival: str = "") -> Settings:
    """One request on one robot, beside a solver if there is one."""
    settings = {**target_cell(robot, "uniform", count), "cell": cell}
    return {**settings, "rival": rival} if rival else settings


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
    near = request_cell("near_branches", NEAR_ARM, size.requests, BRANCH_RIVAL)
    branches = [
        request_cell("all_branches", robot, size.requests, BRANCH_RIVAL)
        for robot in BRANCH_ARMS
    ]
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
        Job("near, branches", "requests", [near]),
        *moves,
        Job("all solutions", "requests", branches),
        Job("restarts", "requests", counts),
        Job("paths", "requests", paths),
    ]
