# SPDX-License-Identifier: BSD-3-Clause
"""Both hands of robots with a torso: how solvers are given them, judged and told of."""

from __future__ import annotations

import numpy as np
import pytest

import iksel

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench import cells, command, report_command
from bench.chain import WIDE
from bench.report import installed_rivals
from bench.rivals.base import UnsupportedError
from bench.robot_data import VARIABLE
from bench.whole_body import command as whole_body
from bench.whole_body import table
from bench.whole_body.cells import judged, measured
from bench.whole_body.robots import ROBOTS, body_of, file_key, load_body
from bench.whole_body.solvers import SOLVERS, Loop

COUNT = 30
SEED = 7
LOOPS = [name for name in SOLVERS if name != table.OURS]
FREE_JOINT = """<robot name="fork"><link name="base"/><link name="l"/><link name="r"/>
<link name="mid"/>
<joint name="turn" type="continuous"><parent link="base"/><child link="mid"/>
  <axis xyz="0 0 1"/></joint>
<joint name="z" type="revolute"><parent link="mid"/><child link="l"/>
  <limit lower="-1" upper="2" effort="1" velocity="1"/>
  <safety_controller k_velocity="1" soft_lower_limit="0" soft_upper_limit="0"/></joint>
<joint name="a" type="prismatic"><parent link="mid"/><child link="r"/>
  <limit lower="0" upper="0.5" effort="1" velocity="1"/></joint></robot>"""


@pytest.fixture(params=ROBOTS)
def body(request):
    try:
        return load_body(request.param)
    except UnsupportedError as reason:
        pytest.skip(str(reason))


@pytest.fixture(scope="module")
def pandas():
    return load_body("two_pandas")


def settings_of(name, count, robot="two_pandas"):
    return {
        "cell": "whole_body",
        "robot": robot,
        "file": file_key(robot),
        "rival": name,
        "count": count,
        "seed": SEED,
        "limit_s": 10.0,
    }


class TestRobots:
    def test_the_judge_agrees_with_the_robot(self, body):
        q = body.random_configurations(COUNT, SEED)
        assert np.abs(body.fk(q) - body.robot.fk(q)).max() < 1e-12
        assert body.shared

    def test_all_solved(self, body):
        poses = body.fk(body.random_configurations(COUNT, SEED))
        result = iksel.Solver(body.robot).solve_batch(poses)
        assert result.solved == COUNT
        assert body.right(poses, result.q).all()

    def test_loops_are_given_the_same_robot(self, body):
        """The chains alone, read by IKSel again."""
        robot = iksel.Robot.from_urdf(body.urdf, tip_links=body.robot.tip_links)
        assert robot.joint_names == body.robot.joint_names
        q = body.random_configurations(COUNT, SEED)
        assert np.abs(robot.fk(q) - body.fk(q)).max() < 1e-12
        free = np.isinf(body.robot.upper)
        assert np.all(robot.upper[~free] == body.robot.upper[~free])
        assert np.all(robot.lower[~free] == body.robot.lower[~free])
        assert robot.upper[free] == pytest.approx(WIDE)

    def test_free_joints_and_soft_limits(self):
        fork = body_of("fork", FREE_JOINT, "base", ("l", "r"))
        assert fork.shared == ["turn"]
        assert "safety_controller" not in fork.urdf
        assert "continuous" not in fork.urdf
        lower, upper = fork.search_limits()
        order = [fork.robot.joint_names.index(joint) for joint in ("turn", "z", "a")]
        assert lower[order] == pytest.approx([-np.pi, -1.0, 0.0])
        assert upper[order] == pytest.approx([np.pi, 2.0, 0.5])

    def test_no_package(self, monkeypatch, tmp_path):
        load_body.cache_clear()
        monkeypatch.setenv(VARIABLE, str(tmp_path / "none"))
        result = cells.whole_body(settings_of("IKSel", 1, "talos"))
        assert "example-robot-data is not installed" in result["unsupported"]
        assert file_key("talos") == ""
        monkeypatch.setenv(VARIABLE, str(tmp_path))
        result = cells.whole_body(settings_of("IKSel", 1, "talos"))
        assert "is not in this example-robot-data" in result["unsupported"]
        load_body.cache_clear()


class TestJudge:
    def test_missed_and_wrong_are_counted(self, pandas):
        q = pandas.random_configurations(6, SEED)
        poses = pandas.fk(q)
        outside = q[3].copy()
        outside[-1] += 2 * np.pi
        one_hand = q[4].copy()
        one_hand[pandas.columns[1][-1]] += 2e-6
        answers = [q[0], None, q[2] + 1e-3, outside, one_hand, q[5]]
        figures = judged(pandas, poses, answers)
        assert figures == {
            "count": 6,
            "missed": 4,
            "missed_targets": [1, 2, 3, 4],
            "wrong": 3,
        }

    def test_no_answers(self, pandas):
        poses = pandas.fk(pandas.random_configurations(2, SEED))
        figures = judged(pandas, poses, [None, None])
        assert (figures["missed"], figures["wrong"]) == (2, 0)

    def test_iksel_misses_nothing(self):
        result = measured(settings_of("IKSel", COUNT))
        assert (result["count"], result["missed"], result["wrong"]) == (COUNT, 0, 0)
        assert (result["dof"], result["shared"]) == (15, ["turn"])


class Still(Loop):
    """Goes nowhere; its joints are the other way round."""

    def make(self, body):
        return list(body.robot.joint_names)[::-1]

    def prepare(self, poses):
        return poses

    def descend(self, target, q):
        del target
        return q


class TestLoops:
    def test_no_start_is_an_answer(self, pandas):
        """Starts and targets are drawn apart, whatever the seed."""
        loop = Still(pandas)
        starts = np.array([loop.answer(loop.call(None)) for _ in range(COUNT)])
        lower, upper = pandas.search_limits()
        assert ((starts >= lower) & (starts <= upper)).all()
        for seed in range(5):
            q = pandas.random_configurations(COUNT, seed)
            assert np.abs(q[:, None] - starts[None]).max(axis=2).min() > 1e-2

    @pytest.mark.parametrize("name", LOOPS)
    @pytest.mark.filterwarnings("ignore")
    def test_installed_loops_answer(self, name):
        if name not in installed_rivals():
            pytest.skip(f"{name} is not installed")
        pytest.importorskip("daqp")
        result = measured(settings_of(name, 3))
        assert (result["missed"], result["wrong"]) == (0, 0)


class TestCommand:
    def test_prints_one_table(self, capsys, monkeypatch, tmp_path):
        monkeypatch.setattr(report_command, "WORK", tmp_path)
        words = ["whole_body", "two_pandas", "--targets", "20", "--solvers", "IKSel"]
        assert command.main(words) == 0
        told = capsys.readouterr().out
        assert "| `two_pandas`, IKSel | 15 (1) | 20 | 0 | 100.0 | 0 |" in told
        assert "SIMD level" in told
        assert "seed 1." in told
        assert "- `two_pandas`: `turn`" in told

    def test_unknown_robots_are_named(self):
        with pytest.raises(SystemExit, match="no nobody; has two_pandas"):
            command.main(["whole_body", "nobody"])

    def test_every_robot_and_solver_is_planned(self):
        options = command.parser().parse_args(["whole_body"])
        jobs, _ = whole_body.jobs_of(options, SOLVERS)
        assert len({job.name for job in jobs}) == len(ROBOTS) * len(SOLVERS)
        counts = {job.cells[0]["robot"]: job.cells[0]["count"] for job in jobs}
        assert counts["two_pandas"] == counts["pr2"] == 100_000
        assert counts["talos"] == 10_000

    def test_what_ends_or_is_absent_is_a_row(self, capsys):
        figures = {"dof": 15, "shared": ["turn"], "count": 2_000, "missed": 1}
        figures |= {"mean_us": 2.0, "median_us": 1.5, "p99_us": 120.0}
        figures |= {"missed_targets": [17], "wrong": 1}
        absent = {"unsupported": "example-robot-data is not installed"}
        report = {
            "machine": {"simd": "avx2", "cpu": "a cpu", "cores": 2},
            "versions": {"IKSel": "1"},
            "missing": {"mink": "mink is not installed (pip install mink)"},
            "failures": {"pink on talos, talos, whole_body": "exit status -6: abort"},
            "cells": [
                {"settings": settings_of("IKSel", 2_000), "result": figures},
                {"settings": settings_of("IKSel", 9, "talos"), "result": absent},
                {"settings": settings_of("pink", 9, "talos"), "result": absent},
            ],
        }
        assert whole_body.tell(report) == 1
        told = capsys.readouterr().out
        row = "| `two_pandas`, IKSel | 15 (1) | 2,000 | 1 | 99.950 | 1 | 2.00 |"
        assert row in told
        assert "| `talos`, IKSel | example-robot-data is not installed |" in told
        assert "| pink on talos | ended: exit status -6 |" in told
        assert "| all, mink | not installed |" in told
        assert "- `two_pandas`: 17" in told
        assert "begun after 10 s" in told
        assert "WRONG: two_pandas: 1 wrong" in told
