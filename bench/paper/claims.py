# SPDX-License-Identifier: BSD-3-Clause
"""What the paper's text says of its tables, as margins that its rows have."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from bench.paper import plan as paper_plan
from bench.paper import published

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

C0, C1, UR3, IRB = range(4)
ALL = (C0, C1, UR3, IRB)

SCHEMES = ("dls", "pinv", "pinv_rr", "cwln", "cwpi")
REA = ("Eq. (5)", "#ReA 3", "#ReA 5", "#ReA 10", "#ReA 20")
SCALES = ("small", "medium", "large")

OVERRIDES: dict[str, dict[str, Any]] = {
    **{scale: paper_plan.sampling_of("grid", scale) for scale in SCALES},
    **paper_plan.ABLATION_2_ROWS,
    **paper_plan.ABLATION_3_ROWS,
    "TRAC-IK": paper_plan.UNSORTED,
    "beside TRAC-IK": paper_plan.BESIDE_UNSORTED,
}
PUBLISHED = {
    **published.ABLATION_1,
    **published.ABLATION_2,
    **published.ABLATION_3,
    "TRAC-IK": published.TRAC_IK,
    "beside TRAC-IK": published.BESIDE_TRAC_IK,
}


class AbsentError(LookupError):
    """A figure that was not measured, or not published."""


@dataclass(frozen=True)
class Row:
    """One robot's figures in a row, ours or published."""

    success: float
    """Percent."""
    mean: float
    std: float
    most: float
    """Times, in one unit for all rows."""
    count: int
    """Targets."""


def published_row(label: str, i: int) -> Row:
    """A row of the paper for robot i."""
    row = PUBLISHED[label]
    times = row.times[i]
    return Row(row.success[i], times.mean, times.std, times.most, published.TARGETS)


class Figures:
    """The rows for one robot, and what claims are made of."""

    def __init__(self, look: Callable[[str, int], Row], i: int) -> None:
        """Robot i of the tables."""
        self._look = look
        self._i = i

    def rate(self, label: str) -> float:
        """Success in percent."""
        return self._look(label, self._i).success

    def mean(self, label: str) -> float:
        """Mean time."""
        return self._look(label, self._i).mean

    def most(self, label: str) -> float:
        """Longest time."""
        return self._look(label, self._i).most

    def rates(self, labels: Sequence[str]) -> list[float]:
        """Success of some rows in percent."""
        return [self.rate(label) for label in labels]

    def gain(self, worse: str, better: str) -> float:
        """Points of success."""
        return self.rate(better) - self.rate(worse)

    def on(self, i: int) -> Figures:
        """Those of another robot."""
        return Figures(self._look, i)

    def gain_beyond(self, others: Sequence[int], worse: str, better: str) -> float:
        """How far the gain is above those of other robots."""
        most = max(self.on(i).gain(worse, better) for i in others)
        return self.gain(worse, better) - most


def _without(*names: str) -> list[str]:
    return [scheme for scheme in SCHEMES if scheme not in names]


def longer(time: float, other: float) -> float:
    """By how much `other` is longer, in percent."""
    return 100.0 * (other / time - 1.0)


def spread(values: Sequence[float]) -> float:
    """From the least to the largest."""
    return max(values) - min(values)


@dataclass(frozen=True)
class Claim:
    """Something that the text says, as a margin for each robot: it holds above 0."""

    text: str
    unit: str
    margin: Callable[[Figures], float]
    robots: tuple[int, ...] = ALL


CLAIMS = (
    Claim(
        "I: a larger database solves more",
        "points",
        lambda f: float(np.diff(f.rates(SCALES)).min()),
    ),
    Claim(
        "I: from small to large, C1 and UR3 gain more than C0 and IRB",
        "points",
        lambda f: f.gain_beyond((C0, IRB), "small", "large"),
        (C1, UR3),
    ),
    Claim(
        "I: medium takes longer than small",
        "%",
        lambda f: longer(f.mean("small"), f.mean("medium")),
    ),
    Claim(
        "I: large takes less time than medium",
        "%",
        lambda f: longer(f.mean("large"), f.mean("medium")),
    ),
    Claim(
        "II: CWLN solves most",
        "points",
        lambda f: f.rate("cwln") - max(f.rates(_without("cwln"))),
    ),
    Claim(
        "II: CWLN and CWPI solve more than the others",
        "points",
        lambda f: (
            min(f.rates(("cwln", "cwpi"))) - max(f.rates(_without("cwln", "cwpi")))
        ),
    ),
    Claim(
        "II: PINV_RR solves least",
        "points",
        lambda f: min(f.rates(_without("pinv_rr"))) - f.rate("pinv_rr"),
    ),
    Claim(
        "II: without PINV_RR the schemes lie within 5 points",
        "points",
        lambda f: 5.0 - spread(f.rates(_without("pinv_rr"))),
    ),
    Claim(
        "II: DLS is the fastest",
        "%",
        lambda f: longer(f.mean("dls"), min(map(f.mean, _without("dls")))),
    ),
    Claim(
        "II: CWLN and CWPI take longer than the others",
        "%",
        lambda f: longer(
            max(map(f.mean, _without("cwln", "cwpi"))),
            min(map(f.mean, ("cwln", "cwpi"))),
        ),
    ),
    Claim(
        "II: the longest time is CWLN's or CWPI's",
        "%",
        lambda f: longer(
            max(map(f.most, _without("cwln", "cwpi"))),
            max(map(f.most, ("cwln", "cwpi"))),
        ),
    ),
    Claim(
        "II: PINV_RR's longest time is above those of DLS and PINV on C1 and UR3",
        "%",
        lambda f: longer(max(map(f.most, ("dls", "pinv"))), f.most("pinv_rr")),
        (C1, UR3),
    ),
    Claim(
        "III: Eq. (5) gains at least 10 points on Eq. (2)",
        "points",
        lambda f: f.gain("Eq. (2)", "Eq. (5)") - 10.0,
    ),
    Claim(
        "III: that gain is largest on C0",
        "points",
        lambda f: f.gain_beyond((C1, UR3, IRB), "Eq. (2)", "Eq. (5)"),
        (C0,),
    ),
    Claim(
        "III: Eq. (5) takes less time than Eq. (2)",
        "%",
        lambda f: longer(f.mean("Eq. (5)"), f.mean("Eq. (2)")),
    ),
    Claim(
        "III: success rises with #ReA",
        "points",
        lambda f: float(np.diff(f.rates(REA)).min()),
    ),
    Claim(
        "III: time rises with #ReA",
        "%",
        lambda f: min(longer(f.mean(a), f.mean(b)) for a, b in itertools.pairwise(REA)),
    ),
)
"""Of the tables I to III."""
