# SPDX-License-Identifier: BSD-3-Clause
"""IK-Geo beside the paper's numbers, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench.arms import PAPER_ARMS
from bench.bounds import rate_points
from bench.ikgeo.cells import LIMIT_S
from bench.markdown import NONE, percent, signed, table
from bench.paper import published, seeding

if TYPE_CHECKING:
    from bench.store import Settings
    from bench.view import View

POINTS = 2.0
"""By which the rows may differ from the published ones."""

HEADER = [
    "targets",
    "candidates a target",
    "direct %",
    "position error, mm",
    "rotation error, °",
    "ms",
    "as seed %",
    "ms with it",
    "right to 1e-5, %",
]


PACKAGE_HEADER = [
    "poses begun",
    "nothing returned",
    "panicked inside",
    "only least-squares branches",
    "direct %",
    "right to 1e-5, %",
    "as seed %",
    "ms",
]


def text(view: View) -> str:
    """The whole section."""
    tables = [_table(view, robot) for robot in seeding.IK_GEO_ARMS]
    if not any(tables):
        return ""
    most = seeding.seeding_cell("", "", view.size)["count"]
    conditions = (
        f"Up to {most:,} targets per robot, uniform in the limits, seed 1; none is "
        f"begun after {LIMIT_S:g} s. *Direct*: some candidate lies inside the "
        "limits, as the paper counts. Errors are of all candidates: mean, standard "
        "deviation, least, quartiles 1 and 3, most. *As seed*: the paper's iteration "
        "from the candidates, one after another until one arrives, at the paper's "
        "tolerances, in the order of Eq. (5). On C1, whose joint 4 has one and a half "
        "turns, candidates come with their whole turns. The search is numpy, one pose "
        "a call (`bench/ikgeo`, written from the subproblems as published); the "
        "package is Rust, the iteration and `solve_all` are C++; failures are in every "
        "mean."
    )
    parts = [
        "## IK-Geo",
        conditions,
        *tables,
        _verdict(view),
        _interpolation(view),
        _extra_time(view),
        _package(view),
    ]
    return "\n\n".join(part for part in parts if part)


def _table(view: View, robot: str) -> str:
    size = view.size
    rows: list[tuple[str, Settings]] = [
        (name, seeding.search_cell(robot, name, size)) for name in seeding.SEARCHES
    ]
    rows.append(("IKSel, `solve_all`", seeding.enumeration_cell(robot, size)))
    measured = [
        [name, *_columns(cell)]
        for name, settings in rows
        if (cell := view.get(settings)) is not None
    ]
    if not measured:
        return ""
    header = [PAPER_ARMS[robot], *HEADER]
    return table(header, [["published", *_published(robot)], *measured])


def _published(robot: str) -> list[str]:
    direct, seeded = (published.IK_GEO[how][robot] for how in ("direct", "as seed"))
    errors = published.IK_GEO_ERRORS[robot]
    return [
        NONE,
        NONE,
        f"{direct[0]:.2f}",
        *(_listed(errors[name]) for name in ("position_mm", "rotation_deg")),
        f"{direct[1]:.2f}",
        f"{seeded[0]:.2f}",
        f"{seeded[1]:.2f}",
        NONE,
    ]


def _columns(cell: dict[str, Any]) -> list[str]:
    seeded = "seeded" in cell
    spreads = [cell[name] for name in ("position_mm", "rotation_deg")]
    return [
        f"{cell['count']:,}",
        f"{cell['candidates'] / cell['count']:.2f}",
        percent(cell["direct"], cell["count"]),
        *(NONE if each is None else _listed(each.values()) for each in spreads),
        _ms(cell["mean_us"]),
        percent(cell["seeded"], cell["count"]) if seeded else NONE,
        _ms(cell["seeded_mean_us"]) if seeded else NONE,
        percent(cell["right"], cell["count"]),
    ]


def _listed(values: Any) -> str:
    return " / ".join(f"{value:.2f}" for value in values)


def _ms(mean_us: float) -> str:
    return f"{mean_us / 1e3:.3g}"


def _papers(view: View, robot: str) -> dict[str, Any] | None:
    return view.get(seeding.search_cell(robot, seeding.PAPERS_SEARCH, view.size))


def _verdict(view: View) -> str:
    """How far the paper's search is from the published rates."""
    found, least, most = [], [], []
    for robot in seeding.IK_GEO_ARMS:
        cell = _papers(view, robot)
        if cell is None:
            continue
        for how, name in (("direct", "direct"), ("as seed", "seeded")):
            ours = 100.0 * cell[name] / cell["count"]
            difference = ours - published.IK_GEO[how][robot][0]
            bound = rate_points(ours, cell["count"])
            found.append(
                f"{PAPER_ARMS[robot]} {how} {signed(difference)} ± {bound:.2f}"
            )
            least.append(abs(difference) - bound)
            most.append(abs(difference) + bound)
    if not found:
        return ""
    word = (
        "holds"
        if max(most) <= POINTS
        else "missed"
        if max(least) > POINTS
        else "undecided: the bounds cross it"
    )
    return (
        f"The first of these rows against the published rates, in points: "
        f"{', '.join(found)} (within {POINTS:g} points aimed at: {word})."
    )


def _interpolation(view: View) -> str:
    """Which joints the paper interpolated, by the quartiles of its errors."""
    sentences = []
    for robot in seeding.IK_GEO_ARMS:
        cells = [
            view.get(seeding.search_cell(robot, name, view.size))
            for name in (seeding.PAPERS_SEARCH, seeding.ANEW)
        ]
        spreads = [cell["position_mm"] for cell in cells if cell is not None]
        if len(spreads) < 2 or None in spreads:
            continue
        theirs = published.IK_GEO_ERRORS[robot]["position_mm"]
        held, anew = (f"{each['q1']:.2f} and {each['q3']:.2f}" for each in spreads)
        sentences.append(
            f"{PAPER_ARMS[robot]} {theirs[3]:.2f} and {theirs[4]:.2f} mm published, "
            f"{held} with joints 1 to 3 left as they were at the lower value of q4, "
            f"{anew} with joints 1 to 3 anew for the interpolated q4"
        )
    if not sentences:
        return ""
    return (
        "The paper does not say which joints it interpolates. Quartiles 1 and 3 of the "
        f"position error tell the readings apart: {'; '.join(sentences)}."
    )


def _extra_time(view: View) -> str:
    """Whether the published time of the iteration is that of all candidates."""
    sentences = []
    for robot in seeding.IK_GEO_ARMS:
        cell = _papers(view, robot)
        if cell is None or not cell["candidates"]:
            continue
        direct, seeded = (published.IK_GEO[how][robot][1] for how in published.IK_GEO)
        each = cell["candidates"] / cell["count"]
        extra = seeded - direct
        sentences.append(
            f"{extra:.2f} ms on {PAPER_ARMS[robot]}, which has {each:.2f} candidates a "
            f"target, is {extra / each:.2f} ms for each"
        )
    if not sentences:
        return ""
    return (
        "Nor does it say which candidates it iterates from. What its iteration adds to "
        f"the time would fit all of them: {'; '.join(sentences)}."
    )


def _package(view: View) -> str:
    rows = []
    for robot, families in seeding.FAMILIES.items():
        for family in families:
            settings = seeding.package_cell(robot, family, view.size)
            cell = view.get(settings)
            head = f"{PAPER_ARMS[robot]}, `{family}`"
            if cell is None:
                why = view.report["missing"].get("IK-Geo") or view.why_not(settings)
                rows.append([head, *[NONE] * (len(PACKAGE_HEADER) - 1), why])
                continue
            counts = ("count", "empty", "panics", "least_squares")
            nothing = cell["empty"] + cell["panics"] == cell["count"]
            rates = (
                ["returns nothing"] * 3
                if nothing
                else [
                    percent(cell[name], cell["count"])
                    for name in ("direct", "right", "seeded")
                ]
            )
            figures = [f"{cell[name]:,}" for name in counts]
            rows.append([head, *figures, *rates, _ms(cell["mean_us"])])
    text = (
        "What the package ik-geo from PyPI did, with every one of its families that "
        "fits the arm."
    )
    return "\n\n".join([text, table(["", *PACKAGE_HEADER], rows)])
