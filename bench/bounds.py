# SPDX-License-Identifier: BSD-3-Clause
"""How far from the truth a counted share or a mean may be: bounds at 95 %."""

from __future__ import annotations

import math

import numpy as np

CONFIDENCE = 0.95
TWO_SIDED = 1.959964
"""Deviations of a normal variable that it exceeds, to either side, in 5 %."""
BISECTIONS = 60


def at_least(part: int, whole: int) -> float:
    """The share that is exceeded at 95 %, by Clopper and Pearson, one-sided.

    Of all of n it is 0.05^(1/n), by the rule of three about 1 - 3/n.
    """
    if part <= 0:
        return 0.0
    # The share at which as few failures, or fewer, come up in 5 %.
    low, high = 0.0, 1.0
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if _at_most(whole - part, whole, middle) > 1.0 - CONFIDENCE:
            low = middle
        else:
            high = middle
    return 1.0 - 0.5 * (low + high)


def _at_most(failures: int, count: int, rate: float) -> float:
    """How likely so many failures of a binomial variable are, or fewer."""
    if rate <= 0.0:
        return 1.0
    if rate >= 1.0:
        return float(failures >= count)
    k = np.arange(failures + 1)
    # log C(n, k) as sums, k from 0 on.
    ways = np.concatenate([[0.0], np.cumsum(np.log((count - k[:-1]) / (k[:-1] + 1.0)))])
    terms = ways + k * math.log(rate) + (count - k) * math.log1p(-rate)
    most = terms.max()
    return float(np.exp(most) * np.exp(terms - most).sum())


def paired_points(won: int, lost: int, count: int) -> float:
    """Half a confidence interval of the difference of two rates on the same targets.

    Args:
        won: Targets that only the one solves.
        lost: Targets that only the other solves.
        count: All targets.
    """
    # One that was not met could have been: 0 of n is no certainty.
    differing = max(won + lost, 1)
    variance = differing - (won - lost) ** 2 / count
    return float(100.0 * TWO_SIDED * np.sqrt(max(variance, 0.0)) / count)


def rate_points(percent: float, count: int) -> float:
    """Half a confidence interval of a rate [points]."""
    share = min(max(percent / 100.0, 1.0 / count), 1.0 - 1.0 / count)
    return float(100.0 * TWO_SIDED * np.sqrt(share * (1.0 - share) / count))


def mean_bound(std: float, count: int) -> float:
    """Half a confidence interval of a mean, in the unit of the deviation."""
    return TWO_SIDED * std / math.sqrt(count)


def share_text(part: int, whole: int) -> str:
    """What a count proves of a share."""
    return f"at least {100.0 * at_least(part, whole):.3f} % at 95 %"


def verdict(value: float, bound: float) -> str:
    """Whether a margin is above 0, as far as its bound can tell."""
    if value - bound > 0.0:
        return "holds"
    return "does not hold" if value + bound <= 0.0 else "undecided"
