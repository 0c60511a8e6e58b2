# SPDX-License-Identifier: BSD-3-Clause
"""What means hide: causes of slow calls, other work, first calls. No times."""

from __future__ import annotations

import threading
import time

import numpy as np
import pytest

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench import cold, command, report_command
from bench.cells import CELLS
from bench.sections import slowest as slowest_section
from bench.sections import tails as section
from bench.size import FULL, QUICK
from bench.tails import beside, fresh, slowest
from bench.tails.plan import (
    KINDS,
    TEN,
    beside_cell,
    calls_cell,
    fresh_cell,
    tail_jobs,
    threads_cell,
)
from bench.view import View

import iksel

QUANTILES = ("median_us", "p99_us", "p999_us", "max_us")
WHY = {
    "stages": {"query_us": 1.0, "rank_us": 0.0, "iterate_us": 3.0, "reselect_us": 0.0},
    "around": {"count": 20, "answers": 7, "median_us": 2.5},
}
"""What tells why a call is slow."""


@pytest.mark.parametrize("kind", KINDS)
def test_least_times_are_not_longer(kind, monkeypatch):
    monkeypatch.setattr(slowest, "CHUNK", 100)
    cell = slowest.calls(calls_cell("ur3", kind, QUICK) | {"count": 250})
    assert cell["again"] >= 3 * slowest.LEAST
    for times in (cell["came"], cell["least"]):
        values = [times[of] for of in QUANTILES]
        assert values == sorted(values)
    assert cell["least"]["max_us"] <= cell["came"]["max_us"]
    assert cell["slowest"][0]["us"] == cell["came"]["max_us"]
    assert cell["edges"]["looked"] == slowest.EDGES
    assert 0 <= cell["edges"]["others"] <= slowest.EDGES
    assert len(cell["slowest"]) == len(cell["slowest_again"]) == slowest.SHOWN


def test_the_machine_and_the_target_are_told_apart(monkeypatch):
    """One call is slow once, another one each time."""
    monkeypatch.setattr(slowest, "AGAIN", 2)
    hard, unlucky = 7, 11
    state = {"poses": None, "slept": False}
    make, solver_of = slowest.make_targets, slowest.iksel.Solver

    def targets(*arguments):
        made = make(*arguments)
        state["poses"] = made.poses
        return made

    class Odd:
        def __init__(self, robot):
            self.solver = solver_of(robot)

        def solve(self, pose):
            number = int(np.argmax((state["poses"] == pose).all(axis=(1, 2))))
            if number == unlucky and not state["slept"]:
                state["slept"] = True
                time.sleep(0.2)
            elif number == hard:
                time.sleep(0.1)
            return self.solver.solve(pose)

    monkeypatch.setattr(slowest, "make_targets", targets)
    monkeypatch.setattr(slowest.iksel, "Solver", Odd)
    monkeypatch.setattr(slowest, "_stages", lambda *_: [0.0, 0.0, 0.0])
    monkeypatch.setattr(slowest, "explained", lambda *_: WHY)
    # The first calls warm up; the one that is slow once is not among those.
    monkeypatch.setattr("bench.timing.WARM_UP", 2)
    cell = slowest.calls(calls_cell("ur3", KINDS[0], QUICK) | {"count": 40})
    first, second = cell["slowest"][:2]
    assert (first["where"][1], second["where"][1]) == (unlucky, hard)
    assert slowest_section.cause(first) == "by the machine"
    assert "by the target, 75 % of it in iterations" in slowest_section.cause(second)
    assert cell["slowest_again"][0]["where"][1] == hard


def test_poses_around_are_that_far():
    pose = iksel.load_robot("ur3").fk(np.linspace(0.1, 0.6, 6))
    around = slowest.poses_around(pose, 3)
    assert len({each.tobytes() for each in around}) == slowest.AROUND
    shifts = np.linalg.norm(around[:, :3, 3] - pose[:3, 3], axis=1)
    assert np.abs(shifts - slowest.AROUND_M).max() < 1e-12
    turns = around[:, :3, :3] @ pose[:3, :3].T
    angles = np.arccos(np.clip((np.trace(turns, axis1=1, axis2=2) - 1) / 2, -1, 1))
    assert np.abs(angles - slowest.AROUND_RAD).max() < 1e-7


def test_an_edge_has_answers_on_one_side():
    """Between well inside and far beyond there is one, where a line leaves it."""
    robot = iksel.load_robot("ur3")
    solver = iksel.Solver(robot)
    inside = robot.fk([0.3, -1.2, 1.4, 0.5, 1.1, 0.2])
    beyond = inside.copy()
    beyond[0, 3] += 1.0
    last, first = inside.copy(), beyond.copy()
    for _ in range(20):
        middle = (last + first) / 2.0
        last, first = (middle, first) if solver.solve(middle) else (last, middle)
    assert slowest.is_at_edge(solver, last)
    assert not slowest.is_at_edge(solver, inside)
    assert not slowest.is_at_edge(solver, beyond)


@pytest.mark.parametrize(
    ("stretch", "answers"), [(0.0, slowest.AROUND), (1.0, 0)], ids=["inside", "beyond"]
)
def test_what_lies_around_is_asked(stretch, answers):
    """Around a pose well inside all are reached; 1 m beyond the arm none."""
    robot = iksel.load_robot("ur3")
    pose = robot.fk([0.3, -1.2, 1.4, 0.5, 1.1, 0.2])
    pose[0, 3] += stretch
    told = slowest.explained(iksel.Solver(robot), pose, 1)
    assert told["around"]["answers"] == answers
    assert told["around"]["median_us"] > 0
    # What is out of reach is said before any stage begins.
    assert (sum(told["stages"].values()) > 0) == (answers > 0)


def test_the_headline_names_the_worst():
    """Of each kind p99.9 and the slowest, as they came and by the target."""

    def call(us, again_us, number):
        facts = {"answer": False, "proof": "none", "attempts": 4, "iterations": 9}
        return WHY | facts | {"us": us, "again_us": again_us, "where": [1, number]}

    def cell(robot, came, least):
        times = dict.fromkeys(("mean_us", "median_us", "p99_us"), 1.0)
        return {
            "settings": calls_cell(robot, KINDS[1], QUICK),
            "result": {
                "came": times | {"p999_us": came / 10, "max_us": came},
                "least": times | {"p999_us": least / 10, "max_us": least},
                "again": 20,
                "by_machine": 1,
                "slowest": [call(came, least, 1)],
                "slowest_again": [call(least, least, 2)],
                "edges": {"looked": 50, "slow": 40, "others": 1},
                "stages": [0.1, 0.2, 0.3],
            },
        }

    cells = [cell("ur3", 800.0, 30.0), cell("panda", 700.0, 600.0)]
    text = slowest_section.headline(View({"size": vars(QUICK), "cells": cells}))
    assert "p99.9 is at most 80.0 µs (`ur3`), of the targets alone 60.0" in text
    assert "slowest call took 800 µs (`ur3`, by the machine)" in text
    assert "slowest by its target 600 µs (`panda`, 75 % of it in iterations" in text
    assert "at the edge of what has answers (7 of 20 poses around have)" in text
    assert "Of the 100 targets that are the slowest by themselves 80 % lie" in text
    assert "reachable" not in text
    assert slowest_section.headline(View({"size": vars(QUICK), "cells": []})) == ""


def test_other_work_comes_before_each_call_and_is_not_timed():
    order = []
    times = cold.times_after(
        order.append, [1, 2], lambda: (order.append(0), time.sleep(0.05))
    )
    assert order == [0, 1, 0, 2]
    assert len(times) == 2
    assert times.max() < 0.05e9


def test_beside_and_threads_have_all_conditions(monkeypatch):
    monkeypatch.setattr(beside, "TOUCHED_MB", 1)
    cell = beside_cell("ur3", QUICK)
    assert len(cell["others"]) == 9
    assert cell["robot"] not in cell["others"]
    assert set(beside.beside(cell)) == set(beside.CONDITIONS)
    before = threading.active_count()
    row = beside.threads(threads_cell("ur3", QUICK))
    assert threading.active_count() == before
    assert set(row) == set(beside.THREADS)
    assert row["alone"]["others"] == 0
    assert row["single"]["others"] > 0


def test_a_new_process_measures_itself():
    row = fresh.fresh(fresh_cell("ur3") | {"count": 1})
    assert row["import_ms"] > 0
    assert row["solver_ms"] > 0
    assert row["first_us"] > 0
    assert row["database_mb"] > 0
    assert row["process_mb"] >= row["solver_mb"] >= 0


def test_the_command_prints_the_section(capsys, monkeypatch, tmp_path):
    monkeypatch.setattr(report_command, "WORK", tmp_path)
    assert command.main(["tails", "ur3", "--quick", "--calls", "200"]) == 0
    told = capsys.readouterr().out
    assert "| `ur3`, reachable, 200 |" in told
    assert "| `ur3`, random rotations, 500 |" in told
    assert told.count("\n| `ur3` |") == 3
    for title in ("slowest calls", "caches", "busy thread", "first answer"):
        assert title in told


def test_every_robot_is_planned():
    jobs = tail_jobs(FULL)
    cells = [cell for job in jobs for cell in job.cells]
    assert {cell["cell"] for cell in cells} <= set(CELLS)
    assert max(cell["count"] for cell in cells) == 1_000_000
    assert {c["robot"] for c in cells if c["cell"] == "tail_fresh"} >= set(TEN)
    assert section.text(View({"size": vars(QUICK), "cells": []})) == ""
