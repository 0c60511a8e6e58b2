# SPDX-License-Identifier: BSD-3-Clause
"""What the paper's text says of its choices: which settings stand for each."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from bench.arms import PAPER_ARMS
from bench.paper.plan import (
    ABLATION_1_SCALES,
    ABLATION_2_ROWS,
    ABLATION_3_ROWS,
    STAGED,
    paper_cell,
    preset_cell,
    sampling_of,
)
from bench.size import Job, Size

if TYPE_CHECKING:
    from bench.store import Settings

Overrides = dict[str, Any]

FREE = 1e6
"""A clamp that no error reaches [m, rad]."""
RADII = (0.25, 0.5, 1.0)
"""Roots of the threshold of Eq. (3) that are tried."""


@dataclass(frozen=True)
class Choice:
    """A sentence, and settings beside those that it is about."""

    says: str
    """The sentence, in short."""
    others: dict[str, Overrides]
    """What the paper did not choose, by labels."""
    chosen: Overrides = field(default_factory=dict)
    """What it did, by changes to the preset."""
    chosen_label: str = "the preset"
    wanted: str = "more"
    """"more": the choice solves more than each other; "no less": none solves more;
    "published": with it the published rates come out."""


CHOICES = (
    Choice(
        "no scaling coefficient is needed",
        {"errors shortened to 0.1 m and 0.1π rad (the preset)": {}},
        {"position_clamp": FREE, "rotation_clamp": FREE},
        "without",
        "no less",
    ),
    Choice(
        "7 iterations an attempt",
        {f"{steps} steps": {"max_iterations": steps} for steps in (5, 6, 8, 10, 20)},
        {"max_iterations": 7},
        "7 steps (the reference code's max_n_iter = 7 allows 8)",
        "published",
    ),
    Choice(
        "a threshold δ on the distance, Eq. (3), helps",
        {"no threshold (the preset)": {}},
        {"neighbour_radius": 0.5},
        "distance at most 0.5 (δ = 0.25)",
    ),
    Choice(
        "re-selection among the best 20 solves more than among others",
        {str(best): {"candidates": best} for best in (5, 10, 50, 200)},
        chosen_label="best 20",
    ),
    Choice(
        "DLS gives up when the errors grow, at no loss",
        {"goes on": {"growth_stop": "off"}},
        {"growth_stop": "on"},
        "gives up",
        "no less",
    ),
    Choice(
        "the 200 nearest are ranked",
        {str(k): {"neighbours": k} for k in (20, 50, 100)},
        chosen_label="k = 200",
    ),
    Choice(
        "singular values cut off improve robustness",
        {
            f"{cutoff:g} of the largest": {
                "database.pinv_cutoff": cutoff,
                "pinv_cutoff": cutoff,
            }
            for cutoff in (1e-12, 1e-8, 1e-3, 1e-2)
        },
        chosen_label="1e-4 of the largest",
    ),
)

DISTANCES: dict[str, Overrides] = {
    f"at most {radius:g}": {"neighbour_radius": radius} for radius in RADII
}
"""Thresholds of Eq. (3) beside each other."""


@dataclass(frozen=True)
class Slower:
    """A row that the text has take less time than others."""

    says: str
    faster: tuple[str, Overrides]
    slower: dict[str, Overrides]


TIMES = (
    Slower(
        "a large database takes less time than a medium one",
        ("large", sampling_of("grid", "large")),
        {"medium": {}},
    ),
    Slower(
        "DLS is the fastest scheme",
        ("dls", ABLATION_2_ROWS["dls"]),
        {name: ABLATION_2_ROWS[name] for name in ("pinv", "pinv_rr", "cwln", "cwpi")},
    ),
    Slower(
        "Eq. (5) takes less time than Eq. (2)",
        ("Eq. (5)", ABLATION_3_ROWS["Eq. (5)"]),
        {"Eq. (2)": ABLATION_3_ROWS["Eq. (2)"]},
    ),
)


def paired_cell(
    robot: str, size: Size, ours: Overrides, against: Overrides
) -> Settings:
    """Two settings on the same targets."""
    return {**preset_cell(robot, ours, size.paper, "paired"), "against": against}


def tree_cell(robot: str, scale: str, size: Size) -> Settings:
    """The pickled tree of a database's keys."""
    return preset_cell(robot, sampling_of("grid", scale), size.paper, "tree_file")


def shown_cell(size: Size) -> Settings:
    """The figures 1 to 3, of C0."""
    return preset_cell("cvr038", {}, size.figure, "seeds_shown")


def choice_cells(robot: str, size: Size) -> list[Settings]:
    """All cells of CHOICES on a robot."""
    cells = [
        paired_cell(robot, size, choice.chosen, other)
        for choice in CHOICES
        for other in choice.others.values()
    ]
    cells += [paired_cell(robot, size, radius, {}) for radius in DISTANCES.values()]
    return [cell for i, cell in enumerate(cells) if cell not in cells[:i]]


def choice_jobs(size: Size) -> list[Job]:
    """Success with no regard to time, then times alone."""
    jobs = [Job("text, figures 1 to 3", "text", [shown_cell(size)], timed=False)]
    for robot, short in PAPER_ARMS.items():
        name = f"text, {short}"
        cells = choice_cells(robot, size)
        cells += [tree_cell(robot, scale, size) for scale in ABLATION_1_SCALES]
        timed = [paper_cell(robot, size, overrides) for overrides in STAGED]
        jobs.append(Job(f"{name}, choices", "text", cells, timed=False))
        jobs.append(Job(f"{name}, stages", "text", timed))
    return jobs
