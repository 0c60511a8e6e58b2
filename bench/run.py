# SPDX-License-Identifier: BSD-3-Clause
"""Runs the jobs of a plan in worker processes."""

from __future__ import annotations

import json
import os
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from subprocess import PIPE, STDOUT, Popen, TimeoutExpired
from typing import TYPE_CHECKING

from bench.machine import ROOT
from bench.progress import Bar

if TYPE_CHECKING:
    from pathlib import Path

    from bench.others import Others
    from bench.size import Job
    from bench.store import Settings, Store

LIMIT_S = 900.0
"""A worker that takes longer for a cell is ended [s], unless its cells say "hang_s"."""


def run_jobs(
    jobs: list[Job], store: Store, folder: Path, others: Others | None = None
) -> dict[str, str]:
    """Measure every cell that the store does not have.

    Jobs without times run on all cores at once, the others alone, one by one, with
    `others` when other processes are through.

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
                if not job.timed:
                    continue
                if others is None or all(map(store.has, job.cells)):
                    work(job)
                    continue
                others.wait()
                with others.beside(job.name):
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
    with (
        log.open("w", encoding="utf-8") as output,
        Popen(
            [sys.executable, "-m", "bench.worker"],
            stdin=PIPE,
            stdout=output,
            stderr=STDOUT,
            text=True,
            env=environment,
            cwd=ROOT,
        ) as worker,
    ):
        if not _ends(worker, json.dumps(task), cells, store, limit_s):
            return f"ended after {limit_s:.0f} s"
    tail = log.read_text(encoding="utf-8", errors="replace").strip().splitlines()
    return f"exit status {worker.returncode}: {tail[-1] if tail else 'no output'}"


def _ends(
    worker: Popen[str],
    task: str,
    cells: list[Settings],
    store: Store,
    limit_s: float,
) -> bool:
    """Whether a worker ends by itself; one that saves nothing for so long is killed."""
    given: str | None = task
    saved = -1
    try:
        while sum(map(store.has, cells)) > saved:
            saved = sum(map(store.has, cells))
            try:
                worker.communicate(given, timeout=limit_s)
            except TimeoutExpired:
                given = None
            else:
                return True
    finally:
        # Also where Ctrl-C ends the wait.
        worker.kill()
    return False
