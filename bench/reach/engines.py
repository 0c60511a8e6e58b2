# SPDX-License-Identifier: BSD-3-Clause
"""Whether every engine writes the same bytes, whatever befalls it."""

from __future__ import annotations

import hashlib
import os
import shutil
import signal
import subprocess
import sys
import time
from typing import TYPE_CHECKING

import numpy as np

from bench.reach.plans import small_plan
from bench.reach.processes import children
from iksel import reach
from iksel.reach._errors import need

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

KILLS = 3


def digests(path: Path) -> dict[str, str]:
    """A hash of every file of a store."""
    return {
        str(file.relative_to(path)): hashlib.sha256(file.read_bytes()).hexdigest()
        for file in path.rglob("*")
        if file.is_file() and file.suffix != ".partial"
    }


def reference(plan: reach.Plan, folder: Path) -> dict[str, str]:
    """Hashes of the plan's store as one process writes it."""
    path = folder / "reference.zarr"
    reach.create(plan, path)
    reach.run(path, workers=1)
    return digests(path)


def run_on_cluster(path: Path) -> reach.Progress:
    """Compute a map by a Dask cluster of two workers on this machine."""
    distributed = need("distributed")
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        return reach.run(path, client=client)


def show_engines(folder: Path) -> None:
    """The part `engines`."""
    plan = small_plan()
    expected = reference(plan, folder)
    engines: dict[str, Callable[[Path], object]] = {
        "two processes": lambda path: reach.run(path, workers=2),
        "shares i/7": lambda path: [
            reach.run(path, workers=1, share=(i, 7)) for i in range(7)
        ],
    }
    for name, run in engines.items():
        path = folder / f"{name.replace('/', '_')}.zarr"
        reach.create(plan, path)
        run(path)
        print(f"{name:<16} the same bytes: {digests(path) == expected}")
    path = folder / "dask.zarr"
    reach.create(plan, path)
    run_on_cluster(path)
    print(f"{'Dask, 2 x 1':<16} the same bytes: {digests(path) == expected}")
    print(f"{len(expected)} files, {plan.size:,} cells, {plan.chunks} chunks")


def show_killed(folder: Path) -> None:
    """The part `killed`."""
    plan = small_plan()
    expected = reference(plan, folder)
    path = folder / "killed.zarr"
    reach.create(plan, path)
    words = [sys.executable, "-m", "iksel", "reach", "run", str(path), "--workers", "2"]
    process = subprocess.Popen(words)
    for n in range(KILLS):
        while reach.status(path).done <= 3 * n or not children(process.pid):
            if process.poll() is not None:
                raise SystemExit("the run ended before it was killed")
            time.sleep(0.02)
        victim = children(process.pid)[0]
        os.kill(victim, signal.SIGKILL)
        print(f"killed worker {victim} after {reach.status(path).done} chunks")
    before = reach.status(path).done
    while reach.status(path).done == before and process.poll() is None:
        time.sleep(0.02)
    process.kill()
    process.wait()
    store = reach.Store(path)
    done = np.flatnonzero(store.done())
    damaged = len(list(store.damaged(done.tolist())))
    print(
        f"killed the scheduler after {len(done)} of {plan.chunks}, damaged: {damaged}"
    )
    reach.run(path, workers=2)
    print(f"run again: the same bytes: {digests(path) == expected}")


def show_full(folder: Path) -> None:
    """The part `full`; needs root, for a tmpfs."""
    plan = small_plan()
    expected = reference(plan, folder)
    place = folder / "small"
    place.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=600k", "tmpfs", str(place)]
    subprocess.run(mount, check=True)
    try:
        path = place / "map.zarr"
        reach.create(plan, path)
        try:
            reach.run(path, workers=2)
        except reach.MapIoError as error:
            print(f"MapIoError: {error}")
        found = reach.open(path, partial=True)
        known = found.array("status") != reach.UNKNOWN
        print(f"{reach.status(path).done} chunks done, {known.sum():,} cells known")
        shutil.copytree(path, folder / "rescued.zarr")
    finally:
        subprocess.run(["umount", str(place)], check=True)
    reach.run(folder / "rescued.zarr", workers=2)
    same = digests(folder / "rescued.zarr") == expected
    print(f"run again elsewhere: the same bytes: {same}")
