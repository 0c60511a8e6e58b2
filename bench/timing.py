# SPDX-License-Identifier: BSD-3-Clause
"""The one timing loop, and what is kept of its times."""

from __future__ import annotations

import gc
import time
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import numpy.typing as npt

WARM_UP = 20
"""Calls before the first timed one."""
WARM_PART, WARM_S = 0.2, 0.2
"""Part of the time limit that they may take, and time [s]: of slow calls a few do."""

PASSES = 3
"""Runs of which each call's least time counts."""
SHORT_S = 0.05
"""A solver that is through its targets sooner goes through them again [s]."""

QUANTILES = np.concatenate(
    [np.linspace(0.0, 0.98, 50), [0.99, 0.995, 0.998, 0.999, 0.9995, 0.9999, 1.0]]
)
"""The quantiles of a latency distribution that are kept for the plots."""


def time_calls(
    call: Callable[..., Any], arguments: Sequence[tuple[Any, ...]], limit_s: float
) -> tuple[npt.NDArray[np.int64], list[Any]]:
    """Time a call over many arguments, one after another.

    Args:
        call: What is timed.
        arguments: One tuple for each call.
        limit_s: No call is begun after this time [s]; there may be fewer times then.

    Returns:
        The times [ns] and what was returned. Garbage collection waits meanwhile.
    """
    clock = time.perf_counter_ns
    warm = clock() + int(min(limit_s * WARM_PART, WARM_S) * 1e9)
    for values in arguments[:WARM_UP]:
        call(*values)
        if clock() > warm:
            break
    times = np.zeros(len(arguments), dtype=np.int64)
    returned = []
    end = clock() + int(limit_s * 1e9)
    enabled = gc.isenabled()
    gc.disable()
    try:
        for i, values in enumerate(arguments):
            begin = clock()
            result = call(*values)
            now = clock()
            times[i] = now - begin
            returned.append(result)
            if now > end:
                break
    finally:
        if enabled:
            gc.enable()
    return times[: len(returned)], returned


def least_times(runs: Sequence[npt.NDArray[np.int64]]) -> npt.NDArray[np.int64]:
    """Of each call the least time of some runs: what other work added is left out.

    A run that was cut short ends the others where it ended.
    """
    count = min(map(len, runs))
    return np.asarray(np.min([times[:count] for times in runs], axis=0))


def mean_median(times_ns: npt.NDArray[np.int64]) -> list[float] | None:
    """Both [us]; None of no times."""
    if len(times_ns) == 0:
        return None
    return [float(times_ns.mean()) / 1e3, float(np.median(times_ns)) / 1e3]


def tail(times_ns: npt.NDArray[np.int64]) -> dict[str, float]:
    """Mean, median and what is slowest [us]."""
    us = times_ns / 1e3
    return {
        "mean_us": float(us.mean()),
        "median_us": float(np.median(us)),
        "p99_us": float(np.quantile(us, 0.99)),
        "p999_us": float(np.quantile(us, 0.999)),
        "max_us": float(us.max()),
    }


def summary(times_ns: npt.NDArray[Any]) -> dict[str, Any]:
    """Mean, deviation and quantiles [us], failures included."""
    us = np.asarray(times_ns, dtype=float) / 1e3
    return {
        "mean_us": float(us.mean()),
        "std_us": float(us.std()),
        "min_us": float(us.min()),
        "max_us": float(us.max()),
        "median_us": float(np.median(us)),
        "p99_us": float(np.quantile(us, 0.99)),
        "quantiles_us": np.round(np.quantile(us, QUANTILES), 3).tolist(),
    }
