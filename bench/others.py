# SPDX-License-Identifier: BSD-3-Clause
"""What other processes take of the machine while a report is measured."""

from __future__ import annotations

import contextlib
import os
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator

LOOK_S = 0.1
"""Time over which the machine is looked at [s]."""
LITTLE = 0.25
"""Cores that others may take without being waited for."""
PAUSE_S = 1.0
"""Until the machine is looked at again [s]."""
STAT = Path("/proc/stat")
IDLE = (3, 4)
"""Places of the times that nothing ran, in its first line."""
GUEST = 8
"""From there on times that are in others already."""


def busy_s() -> float | None:
    """Time that all cores have worked since the start [s], also for other machines."""
    try:
        line = STAT.read_text(encoding="utf-8").splitlines()[0]
    except OSError:
        return None
    ticks = [int(word) for word in line.split()[1:]][:GUEST]
    worked = sum(ticks) - sum(ticks[place] for place in IDLE)
    return worked / float(os.sysconf("SC_CLK_TCK"))


def own_s() -> float:
    """The same of this process and of those that it has waited for [s]."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


class Others:
    """Waits until others are through, and keeps what they took all the same."""

    def __init__(self, patience_s: float) -> None:
        """`patience_s`: time that it waits, all jobs together [s]."""
        self._left = patience_s
        self._waited = 0.0
        self._taken: list[tuple[str, float, float]] = []

    def wait(self) -> None:
        """Until others take little; no longer than there is patience."""
        begin = time.monotonic()
        while self._left > time.monotonic() - begin and _cores(LOOK_S) > LITTLE:
            time.sleep(PAUSE_S)
        waited = time.monotonic() - begin
        self._left -= waited
        self._waited += waited

    @contextlib.contextmanager
    def beside(self, job: str) -> Iterator[None]:
        """Keep what others take while a job is measured."""
        begin, busy, own = time.monotonic(), busy_s(), own_s()
        try:
            yield
        finally:
            end = busy_s()
            if busy is not None and end is not None:
                taken = max(0.0, end - busy - (own_s() - own))
                self._taken.append((job, taken, time.monotonic() - begin))

    def facts(self) -> dict[str, Any]:
        """Cores in the mean and at most, by which job, and the time waited [s]."""
        jobs = [each for each in self._taken if each[2] > LOOK_S]
        if not jobs:
            return {}
        name, taken, seconds = max(jobs, key=lambda each: each[1] / each[2])
        mean = sum(each[1] for each in jobs) / sum(each[2] for each in jobs)
        return {
            "mean": round(mean, 2),
            "most": round(taken / seconds, 2),
            "job": name,
            "waited_s": round(self._waited),
        }


def _cores(seconds: float) -> float:
    """How many work while this process sleeps for so long; 0 if nobody knows."""
    before = busy_s()
    time.sleep(seconds)
    after = busy_s()
    return 0.0 if before is None or after is None else (after - before) / seconds
