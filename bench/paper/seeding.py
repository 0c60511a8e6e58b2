# SPDX-License-Identifier: BSD-3-Clause
"""What is measured of IK-Geo and of all that makes seeds, on the same targets."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from bench.arms import PAPER_ARMS
from bench.learned.plan import learned_cell, our_jobs
from bench.seed_makers import MAKERS, Learned
from bench.size import SEED, Job, Size

if TYPE_CHECKING:
    from bench.ikgeo.search import Between
    from bench.store import Settings

TARGETS = 2_000
"""At most."""

IK_GEO_ARMS = ("cvr038", "cvrb1213")
"""What the paper used IK-Geo on."""

SEARCHING = ("two_parallel", "two_intersecting", "gen_six_dof")
FAMILIES = {
    "cvr038": SEARCHING,
    "cvrb1213": SEARCHING,
    "ur3_wrs": ("three_parallel_two_intersecting",),
}
"""The families of the package that fit the arms, by their names in it."""

SEARCHES: dict[str, tuple[int, Between]] = {
    "36 values of q4, interpolated; joints 1 to 3 of the lower": (36, "lower end"),
    "36 values, interpolated; joints 1 to 3 anew": (36, "interpolated"),
    "360 values, bisected": (360, "bisected"),
}
"""Rows: values of q4, and what becomes of a change of sign between two."""
PAPERS_SEARCH, ANEW = tuple(SEARCHES)[:2]
"""The row that is compared with the published one, and the one beside it."""


def seeding_cell(cell: str, robot: str, size: Size) -> Settings:
    """A kind of cell on a robot's targets."""
    return {
        "cell": cell,
        "robot": robot,
        "kind": "uniform",
        "count": min(size.paper, TARGETS),
        "seed": SEED,
    }


def search_cell(robot: str, name: str, size: Size) -> Settings:
    """One of SEARCHES."""
    values, between = SEARCHES[name]
    cell = seeding_cell("ikgeo_search", robot, size)
    return {**cell, "values": values, "between": between}


def package_cell(robot: str, family: str, size: Size) -> Settings:
    """The package from PyPI by one of its families."""
    cell = seeding_cell("ikgeo_package", robot, size)
    return {**cell, "rival": "IK-Geo", "family": family}


def enumeration_cell(robot: str, size: Size) -> Settings:
    """All solutions by IKSel."""
    return seeding_cell("ikgeo_enumeration", robot, size)


def maker_cell(robot: str, name: str, size: Size) -> Settings:
    """One of MAKERS."""
    maker = MAKERS[name]
    if isinstance(maker, Learned):
        return learned_cell(robot, maker.model, size)
    return {**seeding_cell("first_attempt", robot, size), "maker": name}


def seeding_jobs(size: Size) -> list[Job]:
    """IK-Geo, and all makers."""
    search = [
        search_cell(robot, name, size) for robot in IK_GEO_ARMS for name in SEARCHES
    ]
    search += [enumeration_cell(robot, size) for robot in IK_GEO_ARMS]
    package = [
        package_cell(robot, family, size)
        for robot, families in FAMILIES.items()
        for family in families
    ]
    makers = [
        Job(
            f"seeds, {name}",
            "seeds",
            [maker_cell(robot, name, size) for robot in PAPER_ARMS],
        )
        for name, maker in MAKERS.items()
        if not isinstance(maker, Learned)
    ]
    return [
        Job("IK-Geo, search", "seeds", search),
        Job("IK-Geo, package", "seeds", package),
        *makers,
        *(replace(job, section="seeds") for job in our_jobs(size)),
    ]
