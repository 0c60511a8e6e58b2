# SPDX-License-Identifier: BSD-3-Clause
"""Solvers that enumerate: how they are given an arm, judged and told of."""

from __future__ import annotations

import itertools
import subprocess
import time

import numpy as np
import pytest

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench import command, plan, report_command, run
from bench.analytic import cells, counted
from bench.analytic.plan import (
    COUNTED,
    KINDS,
    NUMBERS,
    analytic_jobs,
    arms,
    asked_cell,
    counted_arms,
    counted_cell,
    job_name,
)
from bench.arms import BENCH_ARMS, load_arm
from bench.markdown import NONE
from bench.rivals import ENUMERATORS
from bench.rivals.base import UnsupportedError
from bench.rivals.crx import _controller, _ours
from bench.rivals.dh import dh_table
from bench.rivals.enumerator import WAYS, Enumerator, Request, fit_frames
from bench.rivals.opw import opw_form
from bench.sections import analytic
from bench.sections import counted as section
from bench.settings import targets_of
from bench.size import FULL, QUICK, Job
from bench.store import Store
from bench.timing import time_calls
from bench.view import View

import iksel

SEED = 7
SIX = ["cvr038", "ur3", "irb120", "xarm6", "gen3_6dof", "crx10ia"]
TAKEN = {
    "ikdh": "irb120",
    "EAIK": "irb120",
    "IK-Geo": "irb120",
    "py-ikgeo": "irb120",
    "opw": "irb120",
    "crx": "crx10ia",
    "IKFast": "pr2_right_arm",
    "frankik, defaults": "panda",
}
"""An arm that a solver takes; else the Panda, or irb120."""


def turn(axis, angle):
    """Rotation about x (0) or z (2) as a pose."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    pose = np.eye(4)
    pose[i, i] = pose[j, j] = np.cos(angle)
    pose[j, i] = np.sin(angle)
    pose[i, j] = -pose[j, i]
    return pose


def shift(axis, length):
    pose = np.eye(4)
    pose[axis, 3] = length
    return pose


class TestDescriptions:
    """An arm in other people's parameters is still that arm."""

    @pytest.mark.parametrize("name", SIX)
    def test_dh(self, name):
        arm = load_arm(name)
        table = dh_table(arm)

        def fk(q):
            pose = np.eye(4)
            for i, value in enumerate(q):
                pose = pose @ turn(2, table.theta[i] + value) @ shift(2, table.d[i])
                pose = pose @ shift(0, table.a[i]) @ turn(0, table.alpha[i])
            return pose

        frames = fit_frames(arm, fk)
        q = arm.robot.random_configurations(1, SEED)
        pose = arm.chain.fk(q)[0]
        # Axes that are parallel but for rounding put frames far away.
        assert np.abs(frames.target(pose) - fk(q[0])).max() < 1e-9

    @pytest.mark.parametrize("name", ["irb120", "vs060"])
    def test_opw(self, name):
        arm = load_arm(name)
        form = opw_form(arm)
        length = form.lengths

        def fk(q):
            q1, q2, q3, q4, q5, q6 = form.signs * q + form.offsets
            elbow = turn(2, q1) @ shift(0, length["a1"]) @ shift(1, length["b"])
            elbow = elbow @ about_y(q2) @ shift(2, length["c2"]) @ about_y(q3)
            wrist = elbow @ shift(0, length["a2"]) @ shift(2, length["c3"])
            return wrist @ turn(2, q4) @ about_y(q5) @ turn(2, q6)

        def about_y(angle):
            return turn(2, np.pi / 2) @ turn(0, angle) @ turn(2, -np.pi / 2)

        fit_frames(arm, fk)

    @pytest.mark.parametrize(
        ("name", "why"),
        [
            ("ur3", "do not meet"),
            ("cvr038", "do not meet"),
            ("panda", "6 revolute joints only"),
        ],
    )
    def test_opw_refuses(self, name, why):
        with pytest.raises(UnsupportedError, match=why):
            opw_form(load_arm(name))

    def test_another_arm_does_not_fit(self):
        arm, other = load_arm("ur3"), load_arm("ur5")
        with pytest.raises(UnsupportedError, match="no such arm"):
            fit_frames(arm, lambda q: other.chain.fk(q[None])[0])

    def test_base_and_tool_are_found(self):
        arm = load_arm("panda")
        base, tool = turn(0, 1.0) @ shift(1, 0.3), shift(2, -0.2) @ turn(2, 2.0)
        frames = fit_frames(arm, lambda q: base @ arm.chain.fk(q[None])[0] @ tool)
        assert np.abs(frames.base @ base - np.eye(4)).max() < 1e-12
        assert np.abs(tool @ frames.tool - np.eye(4)).max() < 1e-12

    def test_crx_degrees(self):
        q = np.array([0.1, -0.2, 0.3, -0.4, 0.5, -0.6])
        assert np.abs(_ours(_controller(q)) - q).max() < 1e-15
        assert _controller(q)[2] == pytest.approx(np.degrees(0.5))


class Half(Enumerator):
    """Knows every other target, and says nonsense of each fourth."""

    name = "half"
    distribution = "numpy"
    settings = "none"

    def ways(self, arm):
        goals = targets_of(asked_cell(arm.name, "half", KINDS[0], QUICK))
        by_pose = {pose.tobytes(): i for i, pose in enumerate(goals.poses)}

        def prepare(pose, near):
            return pose, near

        def call(pose, near):
            i = by_pose.get(pose.tobytes(), 0)
            q = goals.witnesses[i]
            return [q, q] if i % 2 else [q + 0.1] if i % 4 else []

        return {way: Request(prepare, call, list) for way in WAYS}


class TestCells:
    @pytest.mark.parametrize("name", ["ur3", "panda", "crx10ia"])
    def test_iksel_misses_nothing(self, name):
        arm = load_arm(name)
        for kind in KINDS:
            settings = asked_cell(name, "IKSel", kind, QUICK)
            cell = cells.asked(arm, targets_of(settings), settings)
            ways = analytic._ways(cell)
            assert all(w["wrong"] == w["missed"] == 0 for w in ways.values())
            assert set(ways) == ({"no"} if kind == KINDS[1] else set(WAYS))
        assert cell["noes"] + cell["missed"] + cell["only"] <= cell["count"]

    def test_missed_and_wrong_are_counted(self, monkeypatch):
        monkeypatch.setitem(cells.ENUMERATORS, "half", Half)
        arm = load_arm("ur3")
        settings = asked_cell("ur3", "half", KINDS[0], QUICK)
        cell = cells.asked(arm, targets_of(settings), settings)
        for way in WAYS:
            counts = [cell[way][what] for what in ("count", "missed", "wrong")]
            assert counts == [20, 10, 5]
        # The same branch twice is one, and fewer than all.
        assert cell["every"]["branches"] == 10
        assert cell["every"]["lacks"] == 20

    def test_limits_are_not_everyones_business(self, monkeypatch):
        class Outside(Half):
            keeps_limits = False

            def ways(self, arm):
                requests = super().ways(arm)
                del requests["one"]
                every = requests["every"]

                def call(pose, near):
                    return [q + 4 * np.pi for q in every.call(pose, near)]

                return {"every": Request(every.prepare, call, list)}

        monkeypatch.setitem(cells.ENUMERATORS, "half", Outside)
        settings = asked_cell("ur3", "half", KINDS[0], QUICK)
        cell = cells.asked(load_arm("ur3"), targets_of(settings), settings)
        assert set(cell) == {"every"}
        # Two whole turns away from a branch is that branch.
        assert (cell["every"]["missed"], cell["every"]["wrong"]) == (10, 5)

    @pytest.mark.parametrize("name", [n for n in ENUMERATORS if n != "IKSel"])
    @pytest.mark.filterwarnings("ignore")
    def test_installed_solvers_answer(self, name):
        """Those that are there, on an arm that they take."""
        try:
            ENUMERATORS[name].version()
        except UnsupportedError as reason:
            pytest.skip(str(reason))
        arm = load_arm(TAKEN.get(name, "panda"))
        settings = asked_cell(arm.name, name, KINDS[0], QUICK) | {"count": 5}
        cell = cells.asked(arm, targets_of(settings), settings)
        defaults = name == "frankik, defaults"
        for figures in cell.values():
            assert figures["count"] >= 1
            assert figures["wrong"] == 0
            assert figures["missed"] == 0 or defaults


class Sampled(Enumerator):
    """Every other sample is an answer, of which half are the same."""

    name = "sampled"
    distribution = "numpy"
    settings = "none"
    of_samples = True

    def ways(self, arm):
        del arm
        return {}

    def so_many(self, arm, number):
        solver = iksel.Solver(arm.robot)

        def call(pose):
            found = list(solver.solve_all(pose, max=max(1, number // 4)).q)
            return [*found, *found]

        return Request(lambda pose, near: (pose,), call, list)


class TestCounted:
    @pytest.mark.parametrize("name", counted_arms())
    def test_iksel_has_so_many(self, name):
        settings = counted_cell(name, "IKSel", QUICK)
        cell = counted.counted(load_arm(name), targets_of(settings), settings)
        for number in NUMBERS:
            figures = cell[str(number)]
            assert figures["taken"] == number
            assert figures["wrong"] == figures["missed"] == 0
            assert figures["answers"] <= number * figures["count"]
            assert figures["fewer"] <= 0.3 * figures["count"]

    def test_samples_are_as_many_as_are_needed(self, monkeypatch):
        """Each answer counts once, however often it is given."""
        monkeypatch.setitem(counted.ENUMERATORS, "sampled", Sampled)
        settings = counted_cell("panda", "sampled", QUICK) | {"count": 4}
        cell = counted.counted(load_arm("panda"), targets_of(settings), settings)
        for number in NUMBERS:
            figures = cell[str(number)]
            assert figures["taken"] == 4 * number
            assert figures["answers"] == number * figures["count"]

    def test_what_has_no_number_says_so(self):
        arm = load_arm("irb120")
        with pytest.raises(UnsupportedError, match="cannot give 16"):
            Half(arm).so_many(arm, 16)

    def test_the_verdict_is_of_the_figures(self):
        def cell(name, *means, missed=0):
            settings = counted_cell("panda", name, QUICK)
            result = {"structure": "swept"}
            for number, mean in zip(NUMBERS, means, strict=True):
                result[str(number)] = {
                    "taken": 2 * number,
                    "count": 10,
                    "us": [mean, 0.5 * mean],
                    "answers": 10 * number - missed,
                    "fewer": missed,
                    "missed": missed,
                    "wrong": 0,
                }
            return {"settings": settings, "result": result}

        cells_ = [cell("IKSel", 30.0, 125.0), cell("frankik", 45.0, 50.0, missed=5)]
        view = View({"size": vars(QUICK), "cells": cells_})
        text = section.text(view)
        assert (
            "16 answers in at most 40 µs in the mean were aimed at; within on " in text
        )
        assert "within on `panda` (30.0).\n" in text
        assert "above on `panda` (125, 1.25 times; swept)." in text
        assert "| 10 | 45.0 (22.5) | 15.5 (32) | 2.90 | 5, 5 |" in text
        ahead = "- `panda`, 64: frankik 0.40 of IKSel's mean, 0.40 of its median; fewer"
        assert ahead in text
        assert "`panda`, 16: frankik" not in text
        assert section.wrong(view) == []
        assert section.wrong(
            View({**view.report, "cells": [cell("IKSel", 1, 1, missed=1)]})
        )
        assert section.text(View({**view.report, "cells": []})) == ""


class TestLess:
    """Where a solver takes less, by mean or by median, and of all branches by each."""

    OURS = {"us": [10.0, 10.0], "branches": 640, "count": 10}  # noqa: RUF012

    def test_more_answers_in_more_time_are_less_each(self):
        theirs = {"us": [15.0, 15.0], "branches": 1_280, "count": 10}
        told = analytic._less(theirs, self.OURS)
        assert told == "0.75 of IKSel's mean (branches 128.0 to 64.0)"

    def test_fewer_answers_in_less_time_are_not(self):
        theirs = {"us": [6.0, 6.0], "branches": 320, "count": 10}
        assert analytic._less(theirs, self.OURS) == ""

    def test_a_median_of_another_order_is_told(self):
        theirs = {"us": [20.0, 1.0], "missed": 3}
        told = analytic._less(theirs, {"us": [10.0, 10.0]})
        assert told == "2.00 of IKSel's mean, 0.10 of its median (3 missed)"
        assert analytic._less(theirs, {"us": None}) == ""
        assert analytic._less(theirs, {"us": [30.0, 0.5]}).startswith("0.67 of IKSel's")


class TestCommand:
    def test_prints_one_table(self, capsys, monkeypatch, tmp_path):
        monkeypatch.setattr(report_command, "WORK", tmp_path)
        words = ["analytic", "ur3", "--quick", "--solvers", "IKSel"]
        assert command.main(words) == 0
        told = capsys.readouterr().out
        assert "Up to 20 targets per arm" in told
        assert "SIMD level" in told
        assert "| `ur3`, IKSel | 20 |" in told

    def test_every_arm_and_solver_is_planned(self):
        jobs = analytic_jobs(FULL)
        assert len({job.name for job in jobs}) == len(jobs)
        asked = {"asked": set(), "counted": set()}
        for job in jobs:
            for cell in job.cells:
                asked[cell["cell"]].add((cell["rival"], cell["robot"]))
        assert asked["asked"] == set(itertools.product(ENUMERATORS, arms()))
        assert asked["counted"] == set(itertools.product(COUNTED, counted_arms()))
        assert set(BENCH_ARMS) <= set(arms())

    def test_what_ends_or_is_absent_is_a_row(self):
        def cell(name, result):
            settings = asked_cell("ur3", name, KINDS[0], QUICK)
            return {"settings": settings, "result": result}

        figures = {"count": 20, "us": [2.0, 1.5], "missed": 0, "wrong": 0}
        refused = "6R only; ur3 is none"
        ended = f"{job_name('ikdh')}, ur3, {KINDS[0]}"
        view = View(
            {
                "size": vars(QUICK),
                "machine": {"simd": "avx2", "cpu": "a cpu", "cores": 2},
                "versions": {},
                "missing": {"frankik": "frankik is not installed"},
                "failures": {ended: "exit status -6: abort"},
                "cells": [
                    cell("IKSel", {"one": figures | {"missed": 3}}),
                    cell("opw", {"unsupported": refused}),
                    cell("ssik", {"one": figures | {"us": [1.0, 0.9], "missed": 2}}),
                ],
            }
        )
        text = analytic.text(view)
        assert "| `ur3`, IKSel | 20 | 2.00 (1.50) |" in text
        ended = " | ".join(["exit status -6", *[NONE] * 7])
        assert f"| `ur3`, ikdh | ended: {ended} |" in text
        assert "| all, frankik | not installed |" in text
        assert "- opw: `ur3`: 6R only; it is none" in text
        assert "one 3 of 20" in text
        assert "- `ur3`, one: ssik 0.50 of IKSel's mean (2 missed)\n" in text
        assert analytic.wrong(view) == ["ur3, uniform, one: 3 missed"]

    @pytest.mark.parametrize(("noes", "shown"), [(3, " of 3"), (20, "")])
    def test_a_mean_of_few_noes_says_so(self, noes, shown):
        told = analytic._no({"us": [2.0, 1.5], "noes": noes})
        assert told == "2.00 (1.50)" + shown

    def test_what_hangs_is_ended(self, monkeypatch, tmp_path):
        """Each cell has its own time, and after one that hangs the next is tried."""
        cells_ = [
            {**asked_cell(robot, "ikdh", kind, QUICK), "hang_s": 5.0}
            for robot in ("ur3", "panda")
            for kind in KINDS
        ]
        store = Store(tmp_path / "cells", "a")
        waits = []

        class Hangs:
            """Saves the first two cells, one in each wait, and no other."""

            def __init__(self, *_, **__):
                pass

            def __enter__(self):
                return self

            def __exit__(self, *_):
                pass

            def communicate(self, _, timeout):
                if len(waits) < 2:
                    store.save(cells_[len(waits)], {"made": "now"})
                waits.append(timeout)
                raise subprocess.TimeoutExpired("worker", timeout)

            def kill(self):
                pass

        monkeypatch.setattr(run, "Popen", Hangs)
        failures = run.run_jobs([Job("it", "analytic", cells_)], store, tmp_path)
        assert waits == [5.0] * 4
        assert failures == {f"it, panda, {kind}": "ended after 5 s" for kind in KINDS}


def test_warming_up_does_not_take_long():
    calls = []

    def slow(_):
        calls.append(time.perf_counter())
        time.sleep(0.02)

    times, _ = time_calls(slow, [(i,) for i in range(100)], 0.05)
    assert len(times) < 10
    assert len(calls) - len(times) <= 2


@pytest.mark.parametrize("name", ["pink", "mink"])
@pytest.mark.filterwarnings("ignore")
def test_loops_take_joints_without_limits(name):
    """Each answer is one, also by turns beyond where joints start."""
    try:
        ENUMERATORS[name].version()
    except UnsupportedError as reason:
        pytest.skip(str(reason))
    arm = load_arm("gen3_6dof")
    assert np.isinf(arm.chain.upper).any()
    settings = asked_cell(arm.name, name, KINDS[0], QUICK) | {"count": 10}
    settings["limit_s"] = 2.0
    cell = cells.asked(arm, targets_of(settings), settings)
    assert set(cell) == {"one", "nearest"}
    for figures in cell.values():
        assert figures["count"] == 10
        assert figures["wrong"] == figures["missed"] == 0


def test_what_ssik_builds_is_no_part_of_a_report(monkeypatch):
    """It is built before the clock of a report begins, once for each arm."""
    built = []
    monkeypatch.setattr(
        report_command.ssik, "build", lambda arm: built.append(arm.name)
    )
    jobs = plan.plan(QUICK, ["ur3", "panda"], ["analytic"], ["ssik"])
    report_command.build(jobs)
    assert built == sorted({"ur3", "panda"})
