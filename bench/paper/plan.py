# SPDX-License-Identifier: BSD-3-Clause
"""What is measured of the paper's tables and figures."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from bench.arms import PAPER_ARMS
from bench.cells import CEILING_ATTEMPTS
from bench.size import SEED, Job, Size

if TYPE_CHECKING:
    from bench.store import Settings

ABLATION_1_SCALES = ("small", "medium", "large")

SELECTIONS: dict[str, dict[str, Any]] = {
    "Eq. (5), farthest": {},
    "Eq. (5), in order": {"reselection": "next"},
    "Eq. (2), in order": {"ranking": "nearest", "reselection": "next"},
}
"""The three methods of the paper's figures, as changes to the paper preset."""

ROTATION_KEYS = (
    "rotation_vector",
    "matrix",
    "euler",
    "quaternion",
    "dual_quaternion",
)


def preset_cell(
    robot: str, overrides: dict[str, Any], count: int, cell: str = "evaluate"
) -> Settings:
    """The paper preset with some options changed, by default by iksel.evaluate."""
    return {
        "cell": cell,
        "robot": robot,
        "preset": "paper",
        "overrides": overrides,
        "count": count,
        "seed": SEED,
    }


def paper_cell(robot: str, size: Size, overrides: dict[str, Any]) -> Settings:
    """A row of the paper's tables; of those in STAGED the time of each stage too."""
    cell = preset_cell(robot, overrides, size.paper)
    return {**cell, "stages": True} if overrides in STAGED else cell


def newer_cells(robot: str, size: Size) -> list[Settings]:
    """The paper's setting, the authors' newer one, that without its pull, in numpy."""
    paper = paper_cell(robot, size, {})
    newer = {**preset_cell(robot, {}, size.paper), "preset": "paper2026"}
    free = {**newer, "overrides": {"null_space_gain": 0.0}}
    numpy = {**newer, "cell": "newer", "count": size.paper // 10}
    return [paper, newer, free, numpy]


def attempts_cell(robot: str, size: Size, overrides: dict[str, Any]) -> Settings:
    """Success after each number of attempts."""
    return preset_cell(robot, overrides, size.paper, "attempts")


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


ABLATION_2_ROWS: dict[str, dict[str, Any]] = {
    "dls": {},
    "dls, damping 1e-4": {"damping": 1e-4},
    "pinv": {"iteration": "pinv"},
    "pinv_rr": {"iteration": "pinv_rr", "max_iterations": 7},
    "pinv_rr, 6 steps": {"iteration": "pinv_rr", "max_iterations": 6},
    "pinv_rr, 8 steps": {"iteration": "pinv_rr"},
    "pinv_rr, no growth stop": {
        "iteration": "pinv_rr",
        "max_iterations": 7,
        "growth_stop": "off",
    },
    "cwln": {"iteration": "cwln"},
    "cwpi": {"iteration": "cwpi", "growth_stop": "on"},
    "cwpi, no growth stop": {"iteration": "cwpi"},
    "cwpi, neither stop": {"iteration": "cwpi", "min_step": 0.0},
}
"""Rows of Table II, as its reference implementation reads; after a comma another
reading. The text says of cwpi that the growth stop is off."""

BESIDE_UNSORTED = ABLATION_2_ROWS["cwpi, neither stop"]
"""The row beside the one that is called TRAC-IK."""

UNSORTED = {
    "ranking": "nearest",
    "reselection": "none",
    "max_attempts": 1,
    **BESIDE_UNSORTED,
}
"""The baseline whose numbers the authors' log has where the paper has TRAC-IK's."""

UNSORTED_STOPPED = {**UNSORTED, "min_step": 1e-6}
"""The same with the small-step stop."""

ABLATION_3_ROWS: dict[str, dict[str, Any]] = {
    "Eq. (2)": {"ranking": "nearest", "reselection": "next"},
    "Eq. (2), farthest": {"ranking": "nearest"},
    "Eq. (5)": {},
    "#ReA 3": {"max_attempts": 4},
    "#ReA 5": {"max_attempts": 6},
    "#ReA 10": {"max_attempts": 11},
    "#ReA 20": {"max_attempts": 21},
}

STAGED = (
    sampling_of("grid", "large"),
    *(ABLATION_2_ROWS[name] for name in ("dls", "pinv", "pinv_rr", "cwln", "cwpi")),
    ABLATION_3_ROWS["Eq. (2)"],
)
"""Rows whose times the text compares; the first scheme is the preset's."""

KINEMATICS_ROWS: dict[str, dict[str, Any]] = {
    "KDL": {},
    "kernel": {"kinematics": "kernel"},
}
"""What computes forward kinematics and Jacobians: as in the paper KDL, or IKSel."""


OTHER_ROWS = (UNSORTED, UNSORTED_STOPPED, KINEMATICS_ROWS["kernel"])
"""What stands beside the tables."""


def table_rows(sampling: str, scales: tuple[str, ...]) -> dict[str, dict[str, Any]]:
    """The rows of the three ablations with one sampling, by table and label."""
    rows = {f"I {scale}": sampling_of(sampling, scale) for scale in scales}
    if "medium" in scales:
        base = sampling_of(sampling)
        for number, of_table in (("II", ABLATION_2_ROWS), ("III", ABLATION_3_ROWS)):
            rows |= {f"{number} {name}": base | row for name, row in of_table.items()}
    return rows


def figure_cell(robot: str, size: Size, selection: str, rea: int) -> Settings:
    """Mean and deviation of the time at one #ReA."""
    changes = {**SELECTIONS[selection], "max_attempts": rea + 1}
    return preset_cell(robot, changes, size.figure)


def artefact_cell(robot: str, size: Size, overrides: dict[str, Any]) -> Settings:
    """Singular samples that rank first."""
    return preset_cell(robot, overrides, size.artefact, "artefact")


def artefact_rows(size: Size) -> dict[str, dict[str, Any]]:
    """Overrides of the databases that are searched for singular samples."""
    rows = {f"grid, {scale}": sampling_of("grid", scale) for scale in ABLATION_1_SCALES}
    for scale in dict.fromkeys(("small", *size.cvt_scales)):
        rows[f"cvt, {scale}"] = sampling_of("cvt", scale)
    even = {"database.sampling": "low_discrepancy", "database.samples": 0}
    return {**rows, "low_discrepancy, medium": even}


def newer_jobs(size: Size) -> list[Job]:
    """The cells of the authors' newer selection, each robot's a job."""
    return [
        Job(f"paper, {short}, newer selection", "paper", newer_cells(robot, size))
        for robot, short in PAPER_ARMS.items()
    ]


def paper_jobs(size: Size) -> list[Job]:
    """All jobs of the paper."""
    jobs = []
    for robot, short in PAPER_ARMS.items():
        name = f"paper, {short}"
        success = _success_cells(robot, size)
        rows = [*table_rows("grid", ABLATION_1_SCALES).values(), *OTHER_ROWS]
        tables = [paper_cell(robot, size, row) for row in rows]
        figures = [
            figure_cell(robot, size, selection, rea)
            for selection in SELECTIONS
            for rea in size.figure_attempts
        ]
        jobs += [
            Job(f"{name}, success", "paper", success, timed=False),
            Job(f"{name}, tables", "paper", tables),
            Job(f"{name}, figures", "paper", figures),
        ]
    artefacts = artefact_rows(size).values()
    artefact = [artefact_cell("ur3_wrs", size, row) for row in artefacts]
    jobs.append(Job("paper, grid artefact", "paper", artefact, timed=False))
    # The paper's own row is one of the tables'.
    newer = [replace(job, cells=job.cells[1:]) for job in newer_jobs(size)]
    return [*jobs, *newer]


def _success_cells(robot: str, size: Size) -> list[Settings]:
    """All that is told of without times."""
    cells = []
    for sampling, scales in (("grid", ABLATION_1_SCALES), ("cvt", size.cvt_scales)):
        if "medium" in scales:
            base = sampling_of(sampling)
            cells += [curve_cell(robot, size, base, name) for name in SELECTIONS]
            cells.append(ceiling_cell(robot, size, base))
    cells.append(attempts_cell(robot, size, ABLATION_2_ROWS["cwln"]))
    rows = table_rows("cvt", size.cvt_scales).values()
    cells += [attempts_cell(robot, size, row) for row in rows]
    keys = [{"database.rotation_key": key} for key in ROTATION_KEYS]
    return cells + [attempts_cell(robot, size, key) for key in keys]
