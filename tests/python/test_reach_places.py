# SPDX-License-Identifier: BSD-3-Clause
"""Maps at URLs of fsspec, shares that read no more than their own, other machines."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from command_line import Run, assert_bad, assert_good
from reach_maps import computed

import iksel
from iksel import reach
from iksel.reach import _job, _store

fsspec = pytest.importorskip("fsspec", reason="pip install iksel[reach]")

SETTINGS = {"spacing": 0.4, "orientations": 50, "symmetry": False, "chunk_cells": 900}


@pytest.fixture(scope="module")
def planned(made):
    return reach.plan(made.robot("ur5e"), **SETTINGS)


@pytest.fixture(scope="module")
def whole(made, tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("maps") / "whole.zarr"
    return computed(path, made.robot("ur5e"), **SETTINGS)


@pytest.fixture(params=["memory", "local"])
def url(request, tmp_path, monkeypatch) -> str:
    """Of an empty place, which fsspec makes; other processes see the second alone."""
    if request.param == "memory":
        return f"memory://{tmp_path.name}/map.zarr"
    for scheme in ("local", "file"):
        monkeypatch.setitem(fsspec.config.conf, scheme, {"auto_mkdir": True})
    monkeypatch.setenv("FSSPEC_LOCAL_AUTO_MKDIR", "true")
    return f"local://{tmp_path}/deep/map.zarr"


def test_a_map_at_a_url_is_that_of_a_folder(planned, whole, url: str) -> None:
    reach.create(planned, url)
    reach.create(planned, url)  # the same again
    workers = 1 if url.startswith("memory") else 2
    assert reach.run(url, workers=workers, share=(0, 2)).complete
    assert not reach.status(url).complete
    assert reach.run(url, workers=workers).complete
    there, here = reach.open(url), reach.open(whole)
    for name in here.names:
        np.testing.assert_array_equal(there.array(name), here.array(name))
    store = reach.Store(url, writable=True)
    store.forget(1)
    assert reach.status(url).done == planned.chunks - 1
    assert reach.merge(url, [whole]).complete
    files, root = fsspec.core.url_to_fs(url)
    shard = next(f for f in files.find(f"{root}/status/c") if "/c/" in f)
    files.pipe_file(shard, files.cat_file(shard)[:-3])
    with pytest.raises(reach.ChunkDamagedError):
        reach.run(url, workers=1)
    assert reach.run(url, workers=1, repair=True).complete


def test_what_is_at_a_url_already(planned, made, url: str) -> None:
    with pytest.raises(reach.MapIoError, match="is no map: it has no zarr.json"):
        reach.open(url)
    files, root = fsspec.core.url_to_fs(url)
    files.makedirs(root, exist_ok=True)
    files.pipe_file(f"{root}/other", b"")
    with pytest.raises(reach.MapIoError, match="there already, and is no map"):
        reach.create(planned, url)
    files.rm(root, recursive=True)
    reach.create(planned, url)
    other = reach.plan(made.robot("ur5e"), **SETTINGS | {"orientations": 60})
    with pytest.raises(reach.PlanMismatchError, match="with another plan"):
        reach.create(other, url)


def test_urls_that_lead_nowhere(planned, tmp_path: Path) -> None:
    for path in ("nowhere://map.zarr", f"nowhere://{tmp_path}"):
        with pytest.raises(reach.MapIoError, match=r"nowhere://.* cannot be opened"):
            reach.create(planned, path)
    reach.create(planned, f"file://{tmp_path}/map.zarr")
    assert reach.status(tmp_path / "map.zarr").done == 0


def test_the_command_line_takes_urls(run: Run, url: str) -> None:
    words = ["--spacing", "0.5", "--orientations", "30", "-o", url]
    assert_good(run("reach", "plan", "ur5e", *words))
    assert_good(run("reach", "run", url, "--workers", "1"))
    text = assert_good(run("reach", "status", url)).out
    assert f"store   {url}" in text
    assert_bad(run("reach", "status", "nowhere://x"), "cannot be opened")


def test_a_share_reads_its_own_receipts_only(whole, tmp_path: Path) -> None:
    """What other shares have, or are at, is nothing to it."""
    path = Path(shutil.copytree(whole, tmp_path / "map.zarr"))
    store = reach.Store(path)
    chunks = store.job.chunks
    assert chunks > 8
    for index in range(chunks):
        if index % 4 != 1:
            receipt = path / _store.RECEIPTS / "c" / str(index) / "0"
            receipt.write_bytes(bytes(range(32)))  # of another plan
    own = range(1, chunks, 4)
    store = reach.Store(path, writable=True)
    store.forget(5)
    progress = reach.run(path, workers=1, share=(1, 4))
    assert progress.complete
    assert progress.chunks == len(own)
    parts = [store.job.block(i) for i in own]
    cells = sum(np.prod([s.stop - s.start for s in part]) for part in parts)
    assert progress.cells == cells
    assert reach.run(path, workers=1, share=(chunks + 3, 2 * chunks)).chunks == 0
    with pytest.raises(reach.PlanMismatchError, match="belongs to the plan 00010203"):
        reach.status(path)


def test_a_plan_is_of_one_instruction_set(planned, tmp_path, monkeypatch) -> None:
    level = iksel.simd_level()
    assert planned.to_dict()["simd"] == level
    path = tmp_path / "map.zarr"
    reach.create(planned, path)
    monkeypatch.setattr(_job, "simd_level", lambda: "neon")
    with pytest.raises(
        reach.PlanMismatchError, match=f"for {level}, .* neon.*IKSEL_SIMD={level}"
    ):
        reach.run(path, workers=1)
    assert reach.status(path).done == 0
    assert reach.open(path, partial=True).solver.robot.dof == 6
