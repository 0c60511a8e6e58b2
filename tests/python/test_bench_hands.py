# SPDX-License-Identifier: BSD-3-Clause
"""What both hands are asked for beside the first answer, and its judges."""

from __future__ import annotations

import numpy as np
import pytest

import iksel

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench import command
from bench.branches import SAME_MOVE
from bench.chain import chain_from_urdf
from bench.moves import APART
from bench.robot_data import robots_folder
from bench.tips import changed
from bench.whole_body import carried
from bench.whole_body.brute import Brute
from bench.whole_body.free import both, load_meshes
from bench.whole_body.nearest import nearest
from bench.whole_body.pairs import random_pair
from bench.whole_body.robots import load_body

SEED = 3


@pytest.fixture(scope="module")
def pandas():
    return load_body("two_pandas")


class TestBruteForce:
    def test_finds_what_is_known(self, pandas):
        """A configuration at the target is an answer; the least move is no longer."""
        brute = Brute(pandas)
        q = pandas.random_configurations(5, SEED)
        near = changed(pandas.robot, q, 0.1, SEED)
        for poses, here, there in zip(pandas.fk(q), near, q, strict=True):
            least = brute.least_move(poses, here, SEED)
            assert 0 < least <= np.linalg.norm(here - there)

    def test_is_beside_no_shorter_move(self, pandas):
        """Answers drawn at random, slid, are not nearer than before they were."""
        brute = Brute(pandas)
        poses = pandas.fk(pandas.random_configurations(1, SEED))[0]
        near = pandas.random_configurations(1, SEED + 1)[0]
        found = np.array(iksel.Solver(pandas.robot).solve_all(poses, 20).q)
        slid = brute.slid(poses, near, found)
        assert pandas.right(np.repeat(poses[None], len(slid), axis=0), slid).all()
        before, after = (np.linalg.norm(some - near, axis=1) for some in (found, slid))
        assert np.all(after <= before + 1e-6)
        # What is locally least stays so.
        again = np.linalg.norm(brute.slid(poses, near, slid) - near, axis=1)
        assert np.median(after - again) < 1e-3

    def test_finds_nothing_where_nothing_is(self, pandas):
        poses = pandas.fk(pandas.random_configurations(1, SEED))[0]
        poses[0, 0, 3] += 9.0
        near = pandas.random_configurations(1, SEED)[0]
        assert Brute(pandas).least_move(poses, near, SEED) == np.inf

    def test_near_beside_it(self, pandas):
        row = nearest(pandas, "beside", 4, SEED)
        assert (row["cases"], row["none"], row["wrong"], row["longer"]) == (4, 0, 0, 0)


class TestNear:
    @pytest.mark.parametrize(
        ("case", "turn"),
        [(23, -1.0702), (47, -0.8783), (243, -0.6265), (251, 0.0714), (301, 1.145)],
    )
    def test_is_no_farther_than_both_arms_behind_the_joint(self, pandas, case, turn):
        """Answers of both arms that exist together for a short way of the joint."""
        count = 302
        poses = pandas.fk(pandas.random_configurations(count, 0))[case]
        near = pandas.random_configurations(count, APART)[case]
        move = [turn - near[pandas.robot.shared_joints[0]]]
        for i, tip in enumerate(pandas.robot.tip_links):
            base = chain_from_urdf(pandas.urdf, "base", "turn_link", np.eye(4))
            arm = iksel.Robot.from_urdf(
                pandas.urdf.encode(), base_link="turn_link", tip_link=tip
            )
            behind = np.linalg.inv(base.fk(np.array([[turn]]))[0]) @ poses[i]
            own = near[np.setdiff1d(pandas.columns[i], pandas.robot.shared_joints)]
            result = iksel.Solver(arm).solve(behind, near=own)
            assert result.success
            move.append(result.move)
        result = iksel.Solver(pandas.robot).solve(poses, near=near)
        assert result.move <= np.linalg.norm(move) + 1e-6

    @pytest.mark.parametrize("pair", [*range(6), 30])
    def test_of_several_shared_joints_is_no_farther_than_what_is_known(self, pair):
        """Both arms have answers behind few of their values."""
        body = random_pair(pair, shared=3)
        solver, known = iksel.Solver(body.robot), body.random_configurations(10, pair)
        starts = changed(body.robot, known, 0.3, pair)
        for poses, near, q in zip(body.fk(known), starts, known, strict=True):
            move = solver.solve(poses, near=near).move
            assert move <= np.linalg.norm(q - near) + SAME_MOVE

    @pytest.mark.parametrize("pair", [8, 31, 32, 46])
    def test_a_posture_is_where_the_search_begins(self, pair):
        body = random_pair(pair, shared=3)
        solver, known = iksel.Solver(body.robot), body.random_configurations(5, pair)
        starts = changed(body.robot, known, 0.05, pair)
        for poses, posture, q in zip(body.fk(known), starts, known, strict=True):
            result = solver.solve(
                poses, objective=iksel.Objective.near_posture(posture)
            )
            move = np.linalg.norm(result.q - posture)
            assert move <= np.linalg.norm(q - posture) + SAME_MOVE

    @pytest.mark.parametrize("shared", [1, 3])
    @pytest.mark.parametrize("pair", [4, 8, 14, 33])
    def test_where_a_filter_refuses_the_nearest_others_are_found(self, pair, shared):
        body = random_pair(pair, shared)
        solver, known = iksel.Solver(body.robot), body.random_configurations(5, pair)
        starts = body.random_configurations(5, pair + 1)
        for poses, near, q in zip(body.fk(known), starts, known, strict=True):

            def keeps(candidates, least=q[-1] - 0.05):
                return candidates[:, -1] >= least

            result = solver.solve(poses, near=near, filter=keeps)
            assert result.success
            assert keeps(result.q[None]).all()


class TestCarried:
    def test_hands_stay_where_they_hold_the_box(self, pandas):
        row = carried.carried(pandas, 4, SEED)
        assert row["wrong"] == 0
        assert row["ended"] < row["paths"] == 4
        assert max(row["apart"]) <= 1e-6
        assert not row["lost"]

    def test_paths_begin_and_end_at_the_grasp(self, pandas):
        hands = pandas.fk(pandas.random_configurations(1, SEED))[0]
        path = carried.box_path(hands)
        between = np.linalg.inv(hands[0]) @ hands[1]
        np.testing.assert_allclose(path[[0, -1], 0], hands[[0, 0]], atol=1e-12)
        assert np.array_equal(path[:, 1], np.repeat(between[None], len(path), axis=0))
        raised = path[len(path) // 2, 0, :3, 3] - hands[0, :3, 3]
        assert raised == pytest.approx([carried.SIDEWAYS, 0, carried.UP], rel=1e-3)

    def test_what_comes_apart_is_told(self, pandas):
        q = pandas.random_configurations(1, SEED)
        left, right = pandas.fk(q)[0]
        between = np.linalg.inv(left) @ right
        assert max(carried.apart(pandas, q, between)) < 1e-12
        q[0, pandas.columns[1][-1]] += 0.01
        assert carried.apart(pandas, q, between)[1] == pytest.approx(0.01)


class TestFree:
    def test_what_an_arm_may_touch_both_may(self):
        text = both('<robot><disable_collisions link1="a" link2="b"/></robot>')
        for side in ("l_", "r_"):
            assert f'link1="{side}a" link2="{side}b"' in text
        assert text.count("disable_collisions") == 2

    def test_names_of_files_stay(self):
        if not robots_folder().is_dir():
            pytest.skip("example-robot-data is not installed")
        robot = load_meshes("two_pandas")
        assert 'filename="package://example-robot-data' in robot.urdf
        assert robot.body.robot.tip_links == ["l_panda_link8", "r_panda_link8"]


class TestCommand:
    def test_prints_tables(self, capsys):
        words = ["hands", "two_pandas", "--near", "2", "--free", "0", "--paths", "1"]
        assert command.main(words) == 0
        told = capsys.readouterr().out
        assert "| two_pandas, beside | 2 | 0 | 0 | 0 |" in told
        assert "A box carried along 200 waypoints" in told

    def test_unknown_robots_are_named(self):
        with pytest.raises(SystemExit, match="no nobody; has two_pandas"):
            command.main(["hands", "nobody"])
