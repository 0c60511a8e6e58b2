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

from bench.machine import ROOT
from bench.plan import seconds

if TYPE_CHECKING:
    from pathlib import Path

    from typing_extensions import Self

    from bench.size import Job
    from bench.store import Settings, Store

BAR_WIDTH = 24
LIMIT_S = 900.0
"""A worker that takes longer is ended [s], unless its cells say "hang_s"."""


class Bar:
    """One line on stderr: how far, how long, what now."""

    def __init__(self, cells: list[Settings], store: Store, stream: TextIO) -> None:
        """A bar over cells, of which the store has some already."""
        self._missing = [cell for cell in cells if not store.has(cell)]
        self._total = max(sum(map(seconds, self._missing)), 1e-9)
        self._store = store
        self._stream = stream
        self._begin = time.monotonic()
        self._what = ""
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)

    def __enter__(self) -> Self:
        """Begin to watch the store."""
        self._thread.start()
        return self

    def __exit__(self, *exception: object) -> None:
        """Draw the bar for the last time."""
        self._end.set()
        self._thread.join()
        self._draw()
        if self._stream.isatty():
            self._stream.write("\n")

    def say(self, what: str) -> None:
        """What is being measured now."""
        self._what = what

    def _watch(self) -> None:
        while not self._end.wait(1.0 if self._stream.isatty() else 15.0):
            self._draw()

    def _draw(self) -> None:
        left = [cell for cell in self._missing if not self._store.has(cell)]
        part = 1.0 - sum(map(seconds, left)) / self._total
        bar = "#" * int(part * BAR_WIDTH)
        passed = time.monotonic() - self._begin
        line = f"[{bar:<{BAR_WIDTH}}] {part:4.0%} {passed:5.0f} s  {self._what}"
        before, after = ("\r\033[K", "") if self._stream.isatty() else ("", "\n")
        self._stream.write(f"{before}{line[:100]}{after}")
        self._stream.flush()


def run_jobs(jobs: list[Job], store: Store, folder: Path) -> dict[str, str]:
    """Measure every cell that the store does not have.

    Jobs without times run on all cores at once, the others alone, one by one.

    Returns:
        Why cells failed, by their job and robot; all others are in the store.
    """
    failures: dict[str, str] = {}
    cells = [cell for job in jobs for cell in job.cells]
    with Bar(cells, store, sys.stderr) as bar:
        stop = threading.Event()

        def work(job: Job) -> None:
            bar.say(job.name)
            failures.update(run_job(job, store, folder, stop))

        pool = ThreadPoolExecutor(os.cpu_count() or 1)
        try:
            for future in [pool.submit(work, job) for job in jobs if not job.timed]:
                future.result()
            for job in jobs:
                if job.timed:
                    work(job)
        finally:
            # Ctrl-C ends the workers; no others are to be started for what they left.
            stop.set()
            pool.shutdown(cancel_futures=True)
    return failures


def run_job(
    job: Job, store: Store, folder: Path, stop: threading.Event
) -> dict[str, str]:
    """Measure a job in processes of its own; why cells failed.

    A cell that ends its process is left out, and another process does the rest.
    """
    log = folder / "logs" / (job.name.replace(" ", "-").replace("/", "-") + ".txt")
    log.parent.mkdir(parents=True, exist_ok=True)
    failures: dict[str, str] = {}
    left = [cell for cell in job.cells if not store.has(cell)]
    while left and not stop.is_set():
        reason = _run_worker(left, store, log)
        missing = [cell for cell in left if not store.has(cell)]
        if missing:
            culprit, *missing = missing
            kind = culprit.get("kind", culprit["cell"])
            failures[f"{job.name}, {culprit['robot']}, {kind}"] = reason
        left = missing
    return failures


def _run_worker(cells: list[Settings], store: Store, log: Path) -> str:
    """Feed one worker; why it failed, or ""."""
    task = {
        "folder": str(store.folder),
        "fingerprint": store.fingerprint,
        "versions": store.versions,
        "cells": cells,
    }
    paths = [str(ROOT), os.environ.get("PYTHONPATH", "")]
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join(path for path in paths if path),
        # One thread for each solver: no BLAS or OpenMP pool beside it.
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "RUST_BACKTRACE": "0",
    }
    # The cells of a job are all of one level.
    if level := cells[0].get("simd"):
        environment["IKSEL_SIMD"] = level
    limit_s = max(cell.get("hang_s", LIMIT_S) for cell in cells)
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
                timeout=limit_s,
                cwd=ROOT,
            )
        except subprocess.TimeoutExpired:
            return f"ended after {limit_s:.0f} s"
    tail = log.read_text(encoding="utf-8", errors="replace").strip().splitlines()
    return f"exit status {done.returncode}: {tail[-1] if tail else 'no output'}"
