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


def newer_cells(robot: str, size: Size) -> list[Settings]:
    """The paper's setting, the authors' newer one, that without its pull, in numpy."""
    paper = paper_cell(robot, size, {})
    newer = {**paper, "preset": "paper2026"}
    free = {**newer, "overrides": {"null_space_gain": 0.0}}
    return [paper, newer, free, {**newer, "cell": "newer", "count": size.figure}]


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

KINEMATICS_ROWS: dict[str, dict[str, Any]] = {
    "KDL": {},
    "kernel": {"kinematics": "kernel"},
}
"""What computes forward kinematics and Jacobians: as in the paper KDL, or IKSel."""


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
        for sampling in ("grid", "cvt"):
            scales = ABLATION_1_SCALES if sampling == "grid" else size.cvt_scales
            cells = _table_cells(robot, size, sampling, scales)
            curves = [cell for cell in cells if cell["cell"] == "attempts"]
            timed = [cell for cell in cells if cell["cell"] != "attempts"]
            name = f"paper, {short}, {sampling}"
            if sampling == "grid":
                others = (UNSORTED, UNSORTED_STOPPED, KINEMATICS_ROWS["kernel"])
                timed += [paper_cell(robot, size, row) for row in others]
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
    # The paper's own row is one of the tables'.
    newer = [replace(job, cells=job.cells[1:]) for job in newer_jobs(size)]
    return [*jobs, *newer]


def _table_cells(
    robot: str, size: Size, sampling: str, scales: tuple[str, ...]
) -> list[Settings]:
    """The cells of the three ablations with one sampling, each once."""
    cells = [paper_cell(robot, size, sampling_of(sampling, scale)) for scale in scales]
    if "medium" in scales:
        base = sampling_of(sampling)
        rows = [*ABLATION_2_ROWS.values(), *ABLATION_3_ROWS.values()]
        cells += [paper_cell(robot, size, {**base, **row}) for row in rows]
        cells += [curve_cell(robot, size, base, name) for name in SELECTIONS]
        cells.append(ceiling_cell(robot, size, base))
        cwln = {**base, **ABLATION_2_ROWS["cwln"]}
        cells.append(attempts_cell(robot, size, cwln))
    # One option changed from the preset may be none: rows of two tables are one cell.
    return [cell for i, cell in enumerate(cells) if cell not in cells[:i]]
