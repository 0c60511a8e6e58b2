# SPDX-License-Identifier: BSD-3-Clause
"""Computing maps: the same bytes by every engine, whatever dies on the way."""

from __future__ import annotations

import contextlib
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from reach_maps import computed

import iksel
from iksel import reach

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench.reach.engines import digests, run_on_cluster
from bench.reach.processes import children

SETTINGS = {
    "spacing": 0.25,
    "orientations": 300,
    "symmetry": False,
    "qualities": ["branches", "manipulability", "q"],
    "chunk_cells": 10_000,
}
CHUNKS = 27


@pytest.fixture(scope="module")
def planned(made):
    return reach.plan(made.robot("ur5e"), **SETTINGS)


@pytest.fixture(scope="module")
def whole(made, tmp_path_factory):
    """A map computed by one worker."""
    path = tmp_path_factory.mktemp("maps") / "whole.zarr"
    return computed(path, made.robot("ur5e"), **SETTINGS)


@pytest.fixture
def copy(whole, tmp_path):
    return Path(shutil.copytree(whole, tmp_path / "copy.zarr"))


def shard(path: Path, name: str = "status", index: int = 0) -> Path:
    store = reach.Store(path)
    places = np.unravel_index(index, store.job.chunk_grid)
    return path.joinpath(name, "c", *map(str, places))


def command(*words: object) -> list[str]:
    return [sys.executable, "-m", "iksel", "reach", *map(str, words)]


def test_the_plan_is_as_planned(planned, whole):
    assert planned.chunks == CHUNKS
    assert reach.status(whole) == reach.Progress(CHUNKS, CHUNKS, planned.size)


def test_two_workers_write_the_same_bytes(planned, whole, tmp_path):
    path = tmp_path / "two.zarr"
    reach.create(planned, path)
    calls = []
    reach.run(path, workers=2, progress=lambda done, total: calls.append((done, total)))
    assert calls == [(n, CHUNKS) for n in range(CHUNKS + 1)]
    assert digests(path) == digests(whole)


def test_workers_that_end_while_others_go_on(made, tmp_path):
    path = tmp_path / "few.zarr"
    plan = reach.plan(made.robot("ur5e"), **SETTINGS | {"chunk_cells": 70_000})
    assert plan.chunks == 4
    reach.create(plan, path)
    assert reach.run(path, workers=3).complete


def test_shares_write_the_same_bytes(planned, whole, tmp_path):
    path = tmp_path / "shares.zarr"
    reach.create(planned, path)
    for i in range(7):
        progress = reach.run(path, workers=1, share=(i, 7))
        assert progress.done == progress.chunks == len(range(i, CHUNKS, 7))
        done = sum(n % 7 <= i for n in range(CHUNKS))
        assert reach.status(path) == reach.Progress(done, CHUNKS, planned.size)
    assert digests(path) == digests(whole)


def test_parts_in_stores_of_their_own_are_merged(planned, whole, tmp_path):
    paths = [tmp_path / f"{i}.zarr" for i in range(3)]
    for i, path in enumerate(paths):
        reach.create(planned, path)
        reach.run(path, workers=1, share=(i, 3))
    target = tmp_path / "all.zarr"
    reach.create(planned, target)
    assert reach.merge(target, paths).complete
    assert digests(target) == digests(whole)


@pytest.mark.slow
def test_a_dask_cluster_writes_the_same_bytes(planned, whole, tmp_path):
    pytest.importorskip("distributed", reason="pip install iksel[reach]")
    path = tmp_path / "dask.zarr"
    reach.create(planned, path)
    assert run_on_cluster(path).complete
    assert digests(path) == digests(whole)


def test_what_is_there_is_kept_and_what_is_missing_computed(copy, whole):
    times = {f: (copy / f).stat().st_mtime_ns for f in digests(copy)}
    reach.Store(copy, writable=True).forget(5)
    assert reach.status(copy).done == CHUNKS - 1
    reach.run(copy, workers=1)
    assert digests(copy) == digests(whole)
    changed = {f for f, then in times.items() if (copy / f).stat().st_mtime_ns != then}
    assert len(changed) == 6  # five arrays and the receipt
    assert all(
        f.split("/")[0] in {*SETTINGS["qualities"], "status", "proof", "receipt"}
        for f in changed
    )


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="needs /proc")
def test_killed_workers_and_a_killed_scheduler_leave_no_trace(planned, whole, tmp_path):
    path = tmp_path / "killed.zarr"
    reach.create(planned, path)
    run = subprocess.Popen(command("run", path, "--workers", 2), start_new_session=True)
    deadline = time.monotonic() + 120
    try:
        for n in range(3):
            while reach.status(path).done <= 2 * n or not children(run.pid):
                assert run.poll() is None, "it ended before it was killed"
                assert time.monotonic() < deadline
                time.sleep(0.02)
            with contextlib.suppress(ProcessLookupError):
                os.kill(children(run.pid)[0], signal.SIGKILL)
        before = reach.status(path).done
        while reach.status(path).done == before:
            assert run.poll() is None, "it gave up"
            assert time.monotonic() < deadline
            time.sleep(0.02)
        workers = children(run.pid)
    finally:
        run.kill()
        run.wait()
    # Workers without a scheduler end by themselves.
    while any(Path(f"/proc/{pid}").exists() and alive(pid) for pid in workers):
        assert time.monotonic() < deadline
        time.sleep(0.05)
    done = reach.status(path).done
    assert 0 < done < CHUNKS
    # What has a receipt is whole.
    store = reach.Store(path)
    assert not list(store.damaged(np.flatnonzero(store.done()).tolist()))
    assert reach.run(path, workers=2).complete
    assert digests(path) == digests(whole)


def alive(pid: int) -> bool:
    try:
        state = Path(f"/proc/{pid}/stat").read_text(encoding="ascii")
    except OSError:
        return False
    return state.rsplit(")", 1)[1].split()[0] != "Z"


def test_a_chunk_that_kills_its_worker_ends_the_run(
    planned, tmp_path, monkeypatch, capfd
):
    path = tmp_path / "deadly.zarr"
    reach.create(planned, path)
    site = tmp_path / "site"
    site.mkdir()
    (site / "sitecustomize.py").write_text(
        "import os, sys\nif 'iksel.reach._worker' in sys.orig_argv: os._exit(9)\n"
    )
    monkeypatch.syspath_prepend(site)
    with pytest.raises(reach.WorkerError, match=r"chunk [01]: 3 workers .* status 9"):
        reach.run(path, workers=2)
    assert reach.status(path).done == 0


@pytest.mark.parametrize("change", ["flip", "cut", "empty", "remove", "other chunk's"])
def test_a_damaged_chunk_is_refused_by_name_and_repaired(copy, whole, change):
    file = shard(copy, "status", 3)
    content = file.read_bytes()
    if change == "flip":
        middle = len(content) // 3
        content = (
            content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :]
        )
    elif change == "other chunk's":
        content = shard(copy, "status", 4).read_bytes()
    else:
        content = {"cut": content[: len(content) // 2], "empty": b"", "remove": None}[
            change
        ]
    if content is None:
        file.unlink()
    else:
        file.write_bytes(content)
    with pytest.raises(reach.ChunkDamagedError, match="chunk 3 .*status/c/0/1/0"):
        reach.run(copy, workers=1)
    with pytest.raises(reach.ChunkDamagedError, match="chunk 3 "):
        reach.open(copy).array("proof")
    reach.run(copy, workers=1, repair=True)
    assert digests(copy) == digests(whole)


def test_a_chunk_of_another_plan_is_refused_by_name(made, copy, tmp_path):
    other = computed(
        tmp_path / "other.zarr",
        made.robot("ur5e"),
        **SETTINGS | {"options": iksel.SolverOptions(seed=1)},
    )
    shutil.copy(shard(other, "status", 2), shard(copy, "status", 2))
    # Its numbers may be the same, its receipt is not.
    shutil.copy(other / "receipt/c/2/0", copy / "receipt/c/2/0")
    for call in (reach.run, reach.open, reach.status):
        with pytest.raises(reach.PlanMismatchError, match="chunk 2 .* belongs to"):
            call(copy)
    fresh = tmp_path / "fresh.zarr"
    reach.create(reach.plan(made.robot("ur5e"), **SETTINGS), fresh)
    with pytest.raises(reach.PlanMismatchError, match="has another plan"):
        reach.merge(fresh, [other])


def test_another_plan_does_not_overwrite_a_map(made, copy):
    same = reach.plan(made.robot("ur5e"), **SETTINGS)
    assert reach.create(same, copy).done().all()
    with pytest.raises(reach.PlanMismatchError, match="another plan"):
        reach.create(reach.plan(made.robot("ur5e"), spacing=0.3), copy)


def test_a_changed_plan_is_refused(copy):
    file = copy / "zarr.json"
    text = file.read_text()
    assert '"version": "' in text
    file.write_text(text.replace('"spacing": 0.25', '"spacing": 0.26'))
    with pytest.raises(reach.PlanMismatchError, match="the plan was changed"):
        reach.open(copy)


def test_another_version_does_not_go_on(copy, monkeypatch):
    reach.Store(copy, writable=True).forget(0)
    monkeypatch.setattr("iksel.reach._job.__version__", "99.0")
    with pytest.raises(reach.PlanMismatchError, match=r"made by iksel .*, this is 99"):
        reach.run(copy)
    assert reach.open(copy, partial=True).array("status").any()


def test_what_is_no_map_is_refused(tmp_path):
    with pytest.raises(reach.MapIoError, match="no map"):
        reach.open(tmp_path)
    with pytest.raises(reach.MapIoError, match="no map"):
        reach.run(tmp_path / "missing.zarr")
    (tmp_path / "zarr.json").write_text('{"zarr_format": 3, "node_type": "group"}')
    with pytest.raises(reach.PlanMismatchError, match="no map of iksel"):
        reach.open(tmp_path)
    (tmp_path / "zarr.json").write_text("{")
    with pytest.raises(reach.MapIoError, match="cannot be read"):
        reach.open(tmp_path)


def test_a_map_of_which_chunks_are_missing(copy):
    reach.Store(copy, writable=True).forget(7)
    with pytest.raises(reach.IncompleteMapError, match="1 of 27 chunks are missing"):
        reach.open(copy)
    half = reach.open(copy, partial=True)
    block = half.plan.block(7)
    assert (half.array("status")[block] == reach.UNKNOWN).all()
    assert np.isnan(half.fraction[block[:3]]).all()
    assert np.isnan(half.fraction).sum() == np.prod(
        [b.stop - b.start for b in block[:3]]
    )


@pytest.mark.parametrize("workers", [1, 2])
def test_a_full_disk_is_an_error_and_the_map_still_opens(
    planned, whole, tmp_path, workers
):
    """Files of more than 2 KiB cannot be written, which fails as a full disk does."""
    path = tmp_path / "full.zarr"
    reach.create(planned, path)
    line = shlex.join(command("run", path, "--workers", workers))
    ended = subprocess.run(
        ["bash", "-c", f"ulimit -f 2; exec {line}"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.returncode == 2
    assert ended.stderr.count("\n") == 1
    assert "File too large" in ended.stderr
    assert re.search(f"chunk [01] of '{path}'", ended.stderr)
    assert reach.status(path).done == 0
    assert (reach.open(path, partial=True).array("status") == reach.UNKNOWN).all()
    reach.run(path, workers=2)
    assert digests(path) == digests(whole)


def test_workers_and_shares_out_of_range(copy):
    with pytest.raises(iksel.InvalidArgumentError, match="workers"):
        reach.run(copy, workers=0)
    for share in ((-1, 2), (2, 2), (0, 0)):
        with pytest.raises(iksel.InvalidArgumentError, match="share"):
            reach.run(copy, share=share)
