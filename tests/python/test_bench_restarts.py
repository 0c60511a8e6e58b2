# SPDX-License-Identifier: BSD-3-Clause
"""Branches beside those of random restarts: sets, not their sizes."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench import restarts as cell_module
from bench.arms import load_arm
from bench.plans.requests import request_cell
from bench.sections import requests as section
from bench.settings import targets_of
from bench.size import QUICK
from bench.view import View

import iksel

COUNT = 4
SOLVER = iksel.Solver


class Odd:
    """solve_all without a branch of target 0, one of 1 twice, nonsense of 2."""

    def __init__(self, robot):
        self._solver = SOLVER(robot)
        self.robot = robot
        self.poses = targets_of(request_cell("restarts", robot.name, COUNT)).poses

    def solve(self, *arguments, **words):
        return self._solver.solve(*arguments, **words)

    def solve_all(self, pose):
        q = np.array(self._solver.solve_all(pose).q)
        number = int(np.argmax((self.poses == pose).all(axis=(1, 2))))
        other = {0: q[1:], 1: np.vstack([q, q[:1]]), 2: np.vstack([q, q[:1] + 0.1])}
        return SimpleNamespace(q=other.get(number, q))


def measured(monkeypatch, few):
    monkeypatch.setattr(cell_module, "RESTARTS", few)
    monkeypatch.setattr(cell_module, "MORE_RESTARTS", 2_000)
    settings = request_cell("restarts", "ur3", COUNT)
    return cell_module.restarts(load_arm("ur3"), targets_of(settings), settings)


def test_what_is_lacking_double_or_wrong_is_counted(monkeypatch):
    monkeypatch.setattr(cell_module.iksel, "Solver", Odd)
    cell = measured(monkeypatch, 2_000)
    assert cell["missed"] == [0]
    assert (cell["lacking"], cell["more"], cell["wrong"]) == (1, 0, 2)


def test_more_than_the_restarts_is_no_failure(monkeypatch):
    """From one seed each few branches are known; from many the others, too."""
    cell = measured(monkeypatch, 1)
    assert (cell["lacking"], cell["wrong"]) == (0, 0)
    assert cell["more"] == COUNT
    assert cell["added"] >= COUNT
    again = cell["again"]
    assert again == {"poses": COUNT, "branches": cell["added"], "found": cell["added"]}


def test_the_rate_is_of_poses_that_lack_none():
    counts = {"count": 1_000, "lacking": 0, "more": 206, "added": 210, "wrong": 0}
    again = {"poses": 50, "branches": 52, "found": 51}
    result = counts | {"branches": 6_043, "mean_us": 9.0, "missed": [], "again": again}
    settings = request_cell("restarts", "cvrb1213", QUICK.restarts)
    view = View(
        {"size": vars(QUICK), "cells": [{"settings": settings, "result": result}]}
    )
    text = section.text(view)
    assert "is lacking in 100.00 % (at least 99.701 % at 95 %; 99.5 % aimed" in text
    assert "210 more branches in 206 poses (of 52 of these 20,000 restarts" in text
