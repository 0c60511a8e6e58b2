# SPDX-License-Identifier: BSD-3-Clause
"""The report's section on arms drawn at random. No times."""

from __future__ import annotations

import numpy as np
import pytest

import iksel

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench import command, random_builds, report_command
from bench.random_arms import BUILDS, random_arm
from bench.random_builds import BAD, measured, random_cell, random_jobs, shortest_known
from bench.sections import random_builds as section
from bench.size import FULL, QUICK
from bench.view import View

SMALL = {"count": 2, "targets": 50, "asked": 20, "brute": 1, "limit_s": 60.0}


@pytest.mark.parametrize("build", BUILDS)
def test_a_build_is_counted(build):
    cell = measured(random_cell(build, QUICK) | SMALL)
    assert cell["arms"] == 2
    assert cell["targets"] == 2 * (50 + 20)
    assert cell["yes"] == 2 * 20
    assert cell["proven"] + cell["swept"] <= cell["noes"]
    assert cell["tried"] <= cell["moves"] == 2
    assert [cell[what] for what in BAD] == [0] * len(BAD), cell["culprits"]
    assert (cell["no_us"] is None) == (cell["noes"] == 0)


def test_time_ends_a_build():
    cell = measured(random_cell("srs", QUICK) | SMALL | {"limit_s": 0.0})
    assert cell["arms"] == 1


def test_what_is_wrong_is_counted(monkeypatch):
    """The answers of another arm, and a no wherever that has none."""
    other = iksel.Solver(random_arm("spherical_wrist", 1).robot)
    monkeypatch.setattr(random_builds.iksel, "Solver", lambda *_: other)
    cell = measured(random_cell("three_parallel", QUICK) | SMALL | {"brute": 0})
    assert cell["lost"] > 0
    assert cell["false"] > 0
    assert cell["refuted"] > 0
    assert {what for what, _ in cell["culprits"].items()} >= {"lost", "false"}


@pytest.mark.parametrize("build", ["srs", "three_parallel", "right_angles_7"])
def test_brute_force_knows_where_the_pose_is_from(build):
    arm = random_arm(build, 5)
    q = arm.robot.random_configurations(1, 3)[0]
    pose = arm.robot.fk(q)
    solver = iksel.Solver(arm.robot)
    assert shortest_known(arm, solver, (q, pose), q, 1) == pytest.approx(0, abs=0.02)
    start = arm.robot.random_configurations(1, 4)[0]
    least = shortest_known(arm, solver, (q, pose), start, 1)
    assert least <= np.linalg.norm(q - start) + 1e-9


def test_the_command_prints_the_section(capsys, monkeypatch, tmp_path):
    monkeypatch.setattr(report_command, "WORK", tmp_path)
    words = ["random", "srs", "--quick", "--arms", "1", "--targets", "50"]
    assert command.main(words) == 0
    told = capsys.readouterr().out
    assert "Arms: up to 1 of each build" in told
    assert "| `srs` | 1 | 90 | 0 | 0 |" in told


def test_every_build_is_planned():
    (job,) = random_jobs(FULL)
    assert [cell["robot"] for cell in job.cells] == list(BUILDS)
    assert {cell["count"] for cell in job.cells} == {100}


def test_what_is_wrong_is_told():
    sums = dict.fromkeys(section.SUMMED, 0) | {"lost": 1, "false": 2, "refuted": 3}
    culprits = {"lost": [[20_001, 1]]}
    result = {**sums, "yes_us": 1.0, "no_us": None, "culprits": culprits}
    cells = [{"settings": random_cell("srs", QUICK), "result": result}]
    view = View({"size": vars(QUICK), "cells": cells})
    assert section.wrong(view) == ["srs: 2 false answers", "srs: 3 refuted proofs"]
    assert "- `srs`, lost: 1 on seed 20001" in section.text(view)
    assert section.text(View({"size": vars(QUICK), "cells": []})) == ""
