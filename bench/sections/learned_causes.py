# SPDX-License-Identifier: BSD-3-Clause
"""Learned models by the paper's labels and inputs, and what these explain, as text."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from bench.arms import PAPER_ARMS
from bench.bounds import mean_bound, rate_points
from bench.learned.plan import BETWEEN, CURVE, MANY, OURS, PAPERS, Recipe
from bench.markdown import NONE, table
from bench.sections.learned_rows import BESIDE_PUBLISHED

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from bench.sections.learned_rows import Row

NEAR_POINTS = 3.0
"""Success that differs by no more is taken for the published."""
NEAR_RATIO = 1.5
"""Errors that are no more times as large are, too."""


def text(rows: Sequence[Row]) -> str:
    """Rows by all recipes, and the causes of differences from the published."""
    compared = [row for row in rows if row.robot in _tried(rows)]
    parts = [_causes(rows)]
    if compared:
        parts = [_introduction(rows), _recipes(compared), _reached(rows), *parts]
    return "\n\n".join(part for part in parts if part)


def _tried(rows: Sequence[Row]) -> set[str]:
    """Robots with models of other recipes than ours."""
    return {row.robot for row in rows if row.recipe != OURS}


def _introduction(rows: Sequence[Row]) -> str:
    many = {
        row.robot: row.cell["configurations"]
        for row in rows
        if "configurations" in row.cell
    }
    counts = ", ".join(
        f"of {PAPER_ARMS[robot]} {value:.1f}" for robot, value in many.items()
    )
    count = min(row.cell["count"] for row in rows if row.recipe != OURS)
    return (
        "Learned as the paper has it: the label is the configuration that the pose was "
        "drawn by, so any that reaches it, and the model sees a quaternion. The same "
        f"networks, training and judge; these rows have the first {count:,} of the "
        "targets. So many configurations reach a pose inside the limits, in the mean "
        f"and whole turns of a joint counted: {counts}. *Last half*: what that half of "
        "training brought to the success of the best of 32 (of an MDN: its one "
        "output) on the curve's poses; above its bound, training was too short."
    )


def _reached(rows: Sequence[Row]) -> str:
    """Which of the published success the paper's recipe comes to here."""
    near: list[str] = []
    far: list[str] = []
    for row in rows:
        for seed, published in (
            ("first", row.published.first),
            ("best", row.published.best),
        ):
            if row.recipe == PAPERS and published is not None:
                close = abs(row.rate(seed) - published) <= NEAR_POINTS
                (near if close else far).append(f"{row.title}, {seed}")
    return (
        f"By the paper's recipe and in these minutes within {NEAR_POINTS:g} points of "
        "the published: "
        f"{'; '.join(near) or 'none'}. Not: {'; '.join(far) or 'none'}."
    )


def _recipes(rows: Sequence[Row]) -> str:
    lines = [
        [
            row.title,
            row.learned,
            f"{row.cell['minutes']:.1f}",
            row.late_gain_text(),
            *row.beside_published(),
        ]
        for row in rows
    ]
    header = ["success %", "label, rotation as", "minutes", "last half"]
    return table([*header, *BESIDE_PUBLISHED], lines)


@dataclass(frozen=True)
class Figure:
    """A figure with half its 95 % interval."""

    value: float
    bound: float

    def beyond(self, other: Figure) -> bool:
        """Whether the two differ by more than chance."""
        return abs(self.value - other.value) > math.hypot(self.bound, other.bound)


@dataclass(frozen=True)
class Difference:
    """A figure that is not the published one, and the same by other recipes."""

    title: str
    published: float
    ours: Figure
    others: dict[Recipe, Figure]
    ratio: bool
    """Whether it is near by a ratio, as errors are, or by points."""
    minutes: float = 0.0
    """Of training by the paper's recipe."""
    early: Figure | None = None
    """Ours after as many minutes as the paper's recipe had, where that is known."""

    def near(self, value: float) -> bool:
        """Whether it is the published one, as far as that is asked."""
        if self.ratio:
            return 1.0 / NEAR_RATIO <= value / self.published <= NEAR_RATIO
        return abs(value - self.published) <= NEAR_POINTS

    def cause(self) -> str:
        """As far as the experiments show it."""
        papers = self.others.get(PAPERS)
        if papers is None:
            return "not known: not trained by the paper's recipe"
        wanted = self.published - self.ours.value
        moved = papers.value - self.ours.value
        if not papers.beyond(self.ours) or moved * wanted < 0.0:
            return f"not known: labels and inputs bring it no nearer {self._in()}"
        if self.early is not None and not self._beside_early(papers, moved):
            return "undecided: labels and inputs, or that they had fewer minutes"
        which = self._which()
        if self.near(papers.value):
            return which
        if abs(moved) > abs(wanted):
            rest = f"why it is not as far with the authors' ({self.published:.2f})"
            beyond = f"which move it that way and beyond {self._in()}"
            return f"{which}, {beyond}; {rest} is not known{self._more(papers)}"
        return f"{which} for {abs(moved):.1f} of {abs(wanted):.1f}; the rest not known"

    def _more(self, papers: Figure) -> str:
        """What more Gaussians than the paper's recipe has here do, where tried."""
        many = self.others.get(MANY)
        if many is None:
            return ""
        gaussians = f"{MANY.gaussians} Gaussians in the place of {PAPERS.gaussians}"
        back = (many.value - papers.value) * (self.published - papers.value) > 0.0
        if not (many.beyond(papers) and back):
            return f", nor is it {gaussians} ({many.value:.2f})"
        return f" but for a part: {gaussians} bring it to {many.value:.2f}"

    def _in(self) -> str:
        return f"in {self.minutes:.1f} minutes"

    def _beside_early(self, papers: Figure, moved: float) -> bool:
        """Whether it moves as well from ours after as many minutes."""
        assert self.early is not None
        way = (papers.value - self.early.value) * moved
        return papers.beyond(self.early) and way > 0.0

    def _which(self) -> str:
        """Which of the two choices moves it, where that was tried."""
        alone = [self.others.get(recipe) for recipe in BETWEEN]
        if None in alone:
            return "labels and inputs together"
        wanted = self.published - self.ours.value
        moves = [
            figure.beyond(self.ours) and (figure.value - self.ours.value) * wanted > 0.0
            for figure in alone
            if figure is not None
        ]
        names = ("the labels", "the quaternions")
        moving = [name for name, moves_it in zip(names, moves, strict=True) if moves_it]
        return " and ".join(moving) if moving else "only both together"


def _causes(rows: Sequence[Row]) -> str:
    lines = [
        [
            found.title,
            f"{found.published:.2f}",
            *map(_shown, _columns(found)),
            found.cause(),
        ]
        for found in _differences(rows)
    ]
    if not lines:
        return ""
    header = [
        "what differs",
        "published",
        "ours",
        "ours after its minutes",
        "paper's recipe",
        "its labels alone",
        "its quaternions alone",
        "cause",
    ]
    return "\n\n".join([CAUSES, table(header, lines)])


CAUSES = (
    f"Where ours is more than {NEAR_POINTS:g} points of success from the published, or "
    f"has mean errors more than {NEAR_RATIO:g} times as large, and what of that the "
    "paper's labels and inputs explain: they are named as the cause where they change "
    "the figure by more than chance (95 %) towards the published one, from ours and "
    "from ours after as many minutes (the curve's nearest point, on its poses; errors "
    "are not in the curves). The authors' networks, data and minutes are not public, "
    "so what remains is not known."
)


def _columns(found: Difference) -> list[Figure | None]:
    others = [found.others.get(recipe) for recipe in (PAPERS, *BETWEEN)]
    return [found.ours, found.early, *others]


def _shown(figure: Figure | None) -> str:
    return NONE if figure is None else f"{figure.value:.2f} ± {figure.bound:.2f}"


def _differences(rows: Sequence[Row]) -> Iterator[Difference]:
    for ours in rows:
        if ours.recipe != OURS:
            continue
        same = [r for r in rows if (r.model, r.robot) == (ours.model, ours.robot)]
        others = {row.recipe: row for row in same if row.recipe != OURS}
        for name, published in (
            ("first as seed, %", ours.published.first),
            ("best of 32 as seed, %", ours.published.best),
            ("position error, mm", ours.published.position_mm),
            ("rotation error, °", ours.published.rotation_deg),
        ):
            if published is None or _figure(ours, name) is None:
                continue
            found = Difference(
                f"{ours.title}: {name}",
                published,
                _figure(ours, name),
                {recipe: _figure(row, name) for recipe, row in others.items()},
                ratio="error" in name,
                minutes=others[PAPERS].cell["minutes"] if PAPERS in others else 0.0,
                early=_early(ours, others.get(PAPERS), name),
            )
            larger = found.ours.value > published
            if not found.near(found.ours.value) and (larger or not found.ratio):
                yield found


def _early(ours: Row, papers: Row | None, name: str) -> Figure | None:
    """Ours on the curve's poses when it had the minutes of the paper's recipe."""
    if papers is None or "error" in name:
        return None
    rate = ours.after(name.split(maxsplit=1)[0], papers.cell["minutes"])
    return Figure(rate, rate_points(rate, CURVE))


def _figure(row: Row, name: str) -> Figure:
    count = row.cell["count"]
    if "error" in name:
        unit = "position_mm" if "position" in name else "rotation_deg"
        figures = row.cell[unit]
        return Figure(figures["mean"], mean_bound(figures["deviation"], count))
    rate = row.rate(name.split(maxsplit=1)[0])
    return Figure(rate, rate_points(rate, count))
