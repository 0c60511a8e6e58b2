# SPDX-License-Identifier: BSD-3-Clause
"""Runs the jobs of a plan in worker processes, with a progress bar."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, TextIO

from bench.machine import ROOT, fingerprint

if TYPE_CHECKING:
    from pathlib import Path

    from bench.plan import Job
    from bench.store import Store

BAR_WIDTH = 24
LIMIT_S = 900.0
"""A worker that takes longer is ended."""


class Bar:
    """One line on stderr: how far, how long, what now."""

    def __init__(self, total: float, stream: TextIO = sys.stderr) -> None:
        """A bar that is full at `total`."""
        self._total = max(total, 1e-9)
        self._done = 0.0
        self._begin = time.monotonic()
        self._stream = stream
        self._lock = threading.Lock()

    def begin(self, what: str) -> None:
        """Say what comes next."""
        with self._lock:
            self._draw(what)

    def advance(self, part: float, what: str) -> None:
        """So much is done."""
        with self._lock:
            self._done += part
            self._draw(what)

    def _draw(self, what: str) -> None:
        part = min(self._done / self._total, 1.0)
        bar = "#" * int(part * BAR_WIDTH)
        passed = time.monotonic() - self._begin
        line = f"[{bar:<{BAR_WIDTH}}] {part:4.0%} {passed:5.0f} s  {what}"
        if self._stream.isatty():
            self._stream.write(f"\r\033[K{line[:110]}")
        else:
            self._stream.write(line + "\n")
        self._stream.flush()


def run_jobs(jobs: list[Job], store: Store, folder: Path) -> dict[str, str]:
    """Measure every cell that the store does not have.

    Jobs without times run on all cores at once, the others alone, one by one.

    Returns:
        Why jobs failed, by their names; what they had done by then is kept.
    """
    missing = [
        job for job in jobs if not all(store.has(settings) for settings in job.cells)
    ]
    bar = Bar(sum(job.seconds for job in missing))
    failures: dict[str, str] = {}

    def work(job: Job) -> None:
        bar.begin(job.name)
        reason = run_job(job, store, folder)
        if reason:
            failures[job.name] = reason
        bar.advance(job.seconds, job.name)

    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        list(pool.map(work, [job for job in missing if not job.timed]))
    for job in missing:
        if job.timed:
            work(job)
    if missing and sys.stderr.isatty():
        sys.stderr.write("\n")
    return failures


def run_job(job: Job, store: Store, folder: Path) -> str:
    """Measure a job in a process of its own; why it failed, or ""."""
    task = {
        "folder": str(store.folder),
        "fingerprint": fingerprint(),
        "cells": [cell for cell in job.cells if not store.has(cell)],
    }
    log = folder / "logs" / (job.name.replace(" ", "-").replace("/", "-") + ".txt")
    log.parent.mkdir(parents=True, exist_ok=True)
    paths = [str(ROOT), os.environ.get("PYTHONPATH", "")]
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join(path for path in paths if path),
        # One thread for each solver: no BLAS or OpenMP pool beside it.
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "RUST_BACKTRACE": "0",
    }
    with log.open("w", encoding="utf-8") as output:
        try:
            done = subprocess.run(
                [sys.executable, "-m", "bench.worker"],
                input=json.dumps(task),
                text=True,
                check=False,
                stdout=output,
                stderr=subprocess.STDOUT,
                env=environment,
                timeout=LIMIT_S,
                cwd=ROOT,
            )
        except subprocess.TimeoutExpired:
            return f"ended after {LIMIT_S:.0f} s"
    if done.returncode == 0:
        return ""
    tail = log.read_text(encoding="utf-8", errors="replace").strip().splitlines()
    return f"exit status {done.returncode}: {tail[-1] if tail else 'no output'}"
