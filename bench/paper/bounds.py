# SPDX-License-Identifier: BSD-3-Clause
"""How certain a margin made of rows is: the rows drawn again within their errors."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from bench.bounds import CONFIDENCE
from bench.paper.claims import Figures

if TYPE_CHECKING:
    from collections.abc import Callable

    from bench.paper.claims import Claim, Row

DRAWS = 200
SEED = 1


@dataclass(frozen=True)
class Margin:
    """By how much a claim holds, and the 95 % interval around that."""

    value: float
    low: float
    high: float


def margin(claim: Claim, look: Callable[[str, int], Row], i: int) -> Margin:
    """A claim's margin on robot i, by rows drawn around those that were measured.

    Each rate and mean is drawn for itself, normal with its standard error; targets that
    rows have in common make true intervals narrower. Longest times are taken as they
    are: a maximum has no such error.
    """
    random = np.random.default_rng(SEED)

    def again() -> float:
        drawn: dict[tuple[str, int], Row] = {}

        def shaken(label: str, robot: int) -> Row:
            if (label, robot) not in drawn:
                drawn[label, robot] = _drawn(look(label, robot), random)
            return drawn[label, robot]

        return claim.margin(Figures(shaken, i))

    value = claim.margin(Figures(look, i))
    outside = 0.5 * (1.0 - CONFIDENCE)
    low, high = np.quantile([again() for _ in range(DRAWS)], [outside, 1.0 - outside])
    # A least of several is lower in the mean of draws than it is: never past the value.
    return Margin(value, min(value, float(low)), max(value, float(high)))


def _drawn(row: Row, random: np.random.Generator) -> Row:
    share = min(max(row.success / 100.0, 1.0 / row.count), 1.0 - 1.0 / row.count)
    rate = 100.0 * math.sqrt(share * (1.0 - share) / row.count)
    return replace(
        row,
        success=row.success + rate * random.normal(),
        mean=row.mean + row.std / math.sqrt(row.count) * random.normal(),
    )
