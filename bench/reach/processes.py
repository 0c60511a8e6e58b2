# SPDX-License-Identifier: BSD-3-Clause
"""Runs of their own processes: time, memory and children."""

from __future__ import annotations

import contextlib
import os
import resource
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import TYPE_CHECKING

from iksel import reach

if TYPE_CHECKING:
    from collections.abc import Iterator


def timed_run(plan: reach.Plan, path: Path, workers: int) -> tuple[float, float]:
    """Seconds and largest resident memory [MiB] of all processes of a run."""
    reach.create(plan, path)
    words = [sys.executable, "-m", "iksel", "reach", "run", str(path)]
    start = time.perf_counter()
    process = subprocess.Popen([*words, "--workers", str(workers)])
    with memory_of(process.pid) as largest:
        code = process.wait()
    elapsed = time.perf_counter() - start
    if code != 0:
        raise SystemExit(f"iksel reach run ended with {code}")
    return elapsed, largest[0] / 2**20


@contextlib.contextmanager
def memory_of(pid: int) -> Iterator[list[float]]:
    """The largest sum of the resident memory of a process and its children [byte]."""
    largest, ended = [0.0], threading.Event()

    def watch() -> None:
        while not ended.wait(0.1):
            largest[0] = max(
                largest[0], sum(map(resident_memory, [pid, *children(pid)]))
            )

    thread = threading.Thread(target=watch)
    thread.start()
    try:
        yield largest
    finally:
        ended.set()
        thread.join()


def resident_memory(pid: int) -> float:
    """Resident memory of a process [byte]; 0 if it has ended."""
    try:
        pages = Path(f"/proc/{pid}/statm").read_text(encoding="ascii").split()[1]
    except OSError:
        return 0.0
    return float(pages) * os.sysconf("SC_PAGE_SIZE")


def processor_time(who: int) -> float:
    """Seconds of processor time, of all cores and in the kernel too."""
    usage = resource.getrusage(who)
    return usage.ru_utime + usage.ru_stime


def children(pid: int) -> list[int]:
    """Processes that a process has started."""
    try:
        text = Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="ascii")
    except OSError:
        return []
    return [int(word) for word in text.split()]
