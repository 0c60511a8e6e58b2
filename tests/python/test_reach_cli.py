# SPDX-License-Identifier: BSD-3-Clause
"""iksel reach on the command line."""

from __future__ import annotations

import re
import subprocess
import sys

import numpy as np
import pytest
import reach_maps  # noqa: F401 (skips without the extra)
from command_line import assert_bad, assert_good

import iksel
from iksel import cli, reach

PLAN = "reach plan ur5e --spacing 0.3 --orientations 72 -o {}"


@pytest.fixture
def planned(run, tmp_path):
    path = tmp_path / "a.zarr"
    assert_good(run(PLAN.format(path)))
    return path


def test_a_map_from_its_plan_to_its_pictures(run, planned, tmp_path):
    assert_good(run("reach", "status", planned), 1)
    output = run("reach", "status", planned, "--json")
    assert output.code == 1
    assert output.json() == {
        "done": 0,
        "chunks": 1,
        "cells": 4 * 7 * 12,
        "complete": False,
    }
    assert_good(run("reach", "run", planned))
    assert_good(run("reach", "status", planned))
    for name, flags in {"a.png": [], "a.svg": ["--slice", "y=0.1"]}.items():
        assert_good(run("reach", "view", planned, "-o", tmp_path / name, *flags))
        assert (tmp_path / name).stat().st_size > 5000
    for name, flags in {"a.h5": [], "a.npy": ["--array", "status"]}.items():
        assert_good(run("reach", "export", planned, "-o", tmp_path / name, *flags))
    assert np.load(tmp_path / "a.npy").shape == (4, 7, 12)
    output = assert_good(run("reach", "compare", planned, planned, "--json")).json()
    assert output["overlap"] == 1
    assert output["both"] > 0


def examples() -> list[str]:
    """Those of the help texts, with less to compute."""
    lines = [*cli.reach.EXAMPLES.splitlines(), *cli.dataset.EXAMPLES.splitlines()]
    found = [line.strip() for line in lines if line.startswith("  iksel ")]
    changes = {
        r"^iksel ": "",
        r"--spacing 0.05 --orientations 1000": "--spacing 0.3 --orientations 72",
        r"\$SLURM_ARRAY_TASK_ID": "0",
        r"--samples \d+": "--samples 20",
        r"(dataset .*)-o ur5e.zarr": r"\1-o samples.zarr",
    }
    for pattern, text in changes.items():
        found = [re.sub(pattern, text, line) for line in found]
    return found


def test_examples_work(run, planned, monkeypatch):
    monkeypatch.chdir(planned.parent)
    for name in ("part0", "part1"):
        assert_good(run(PLAN.format(f"{name}.zarr")))
    plan = "reach plan panda --spacing 0.6 --orientations 12 -o panda.zarr"
    assert_good(run(plan))
    assert_good(run("reach run panda.zarr"))
    tried = [
        line for line in examples() if "--dask" not in line and "--browser" not in line
    ]
    assert len(tried) == 12
    for line in tried:
        assert_good(run(line))


def test_flags_of_a_plan_arrive_in_it(run, tmp_path):
    path = tmp_path / "b.zarr"
    flags = (
        "--no-symmetry --quality branches --quality q --chunk-cells 500 --tcp 0 0 .1"
    )
    flags += " 0 0 0 --position-tolerance 1e-5 --box 0 0 0 0.6 0.6 0.3 --angle 0.6"
    output = assert_good(
        run(f"reach plan ur5e --spacing 0.3 {flags} -o {path} --json")
    ).json()
    plan = reach.Store(path).job
    assert output["id"] == plan.id
    assert output["cells"] == plan.size == 2 * 2 * 1 * 48 * 11
    assert output["left_out"] == []
    assert plan.qualities == ("branches", "q")
    assert plan.options == iksel.SolverOptions(position_tolerance=1e-5)
    assert plan.robot().tcp[2, 3] == 0.1
    expected = reach.plan(
        iksel.load_robot("ur5e", tcp=iksel.pose_from_euler([0, 0, 0.1], [0, 0, 0])),
        spacing=0.3,
        angle=0.6,
        box=[[0, 0, 0], [0.6, 0.6, 0.3]],
        qualities=["q", "branches"],
        symmetry=False,
        options=iksel.SolverOptions(position_tolerance=1e-5),
        chunk_cells=500,
    )
    assert expected.id == plan.id


def test_shares_and_merging(run, tmp_path):
    paths = [tmp_path / f"{i}.zarr" for i in range(3)]
    for i, path in enumerate(paths):
        assert_good(run(PLAN.format(path) + " --chunk-cells 3000 --no-symmetry"))
        if i:
            line = f"reach run {path} --workers 1 --chunks {i - 1}/2"
            assert_good(run(line))
    output = run("reach", "merge", *paths, "--json")
    assert assert_good(output).json()["complete"]


@pytest.mark.parametrize(
    ("line", "culprit"),
    [
        ("run missing.zarr", "missing.zarr.*no map"),
        ("run {} --chunks 2/2", "--chunks.*I is 0"),
        ("run {} --chunks two", "--chunks.*no I/N"),
        ("run {} --workers 0", "--workers"),
        ("run {} --workers 1 --dask tcp://a:1", "--dask"),
        ("view {} -o a.png", "1 of 1 chunks are missing.*iksel reach run"),
        ("view {} -o a.png --slice w=1", "--slice.*AXIS=NUMBER"),
        ("plan ur5e -o {} --spacing 0.2", "another plan"),
        ("plan ur5e -o b.zarr --spacing 0", "spacing: 0.0"),
        ("plan panda -o b.zarr --quality branches", "redundant"),
        ("plan ur5e -o b.zarr --database a.iksel", "--database"),
        ("merge {} missing.zarr", "missing.zarr"),
        ("", "reach_command|COMMAND|required"),
    ],
)
def test_bad_input_is_one_line(run, planned, monkeypatch, line, culprit):
    monkeypatch.chdir(planned.parent)
    assert_bad(run("reach " + line.format(planned)), culprit)


def test_nothing_of_the_extra_is_imported_before_it_is_used():
    program = (
        "import sys, iksel, iksel.reach, iksel.cli\n"
        "print(*sorted({m.partition('.')[0] for m in sys.modules} & set(sys.argv)))"
    )
    extra = ["zarr", "dask", "distributed", "xarray", "h5py", "pyarrow", "matplotlib"]
    ended = subprocess.run(
        [sys.executable, "-c", program, *extra],
        capture_output=True,
        text=True,
        check=True,
    )
    assert ended.stdout.split() == []


@pytest.mark.parametrize("module", ["zarr", "matplotlib", "h5py"])
def test_a_missing_package_is_named_with_what_installs_it(
    run, planned, monkeypatch, module
):
    assert_good(run("reach", "run", planned))
    monkeypatch.setitem(sys.modules, module, None)
    line = {
        "zarr": f"reach status {planned}",
        "matplotlib": f"reach view {planned} -o {planned}.png",
        "h5py": f"reach export {planned} -o {planned}.h5",
    }[module]
    assert_bad(run(line), rf"needs {module}.*iksel\[reach\].*Python 3.11")
