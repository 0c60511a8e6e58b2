# SPDX-License-Identifier: BSD-3-Clause
"""Laws of the seed makers and of IK-Geo's search. No times."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench import check, plan, targets
from bench.arms import load_arm
from bench.ikgeo import cells as ikgeo_cells
from bench.ikgeo.search import Search
from bench.ikgeo.subproblems import subproblem_1, subproblem_3, subproblem_4, turned
from bench.markdown import NONE
from bench.paper import published, seeding
from bench.rivals import ikgeo as package
from bench.rivals.base import UnsupportedError
from bench.sections import ikgeo as ikgeo_section
from bench.sections import seed_makers as makers_section
from bench.seed_makers import MAKERS, first_attempt, from_seeds, paper_solver
from bench.size import QUICK
from bench.view import View

import iksel

SEED = 11
CASES = 200
COUNT = 40
GRID = np.linspace(-np.pi, np.pi, 40_001)
ARMS = ("cvr038", "cvrb1213", "ur3_wrs")


@pytest.fixture(params=[SEED], ids="seed {}".format)
def random(request):
    return np.random.default_rng(request.param)


def unit(random, count=CASES):
    k = random.normal(size=(count, 3))
    return k / np.linalg.norm(k, axis=1, keepdims=True)


def around(k, p):
    """R(k, t) p for all angles of the grid, by a matrix exponential's closed form."""
    cross = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    turns = np.eye(3) + np.sin(GRID)[:, None, None] * cross
    turns = turns + (1 - np.cos(GRID))[:, None, None] * (cross @ cross)
    return turns @ p


class TestSubproblems:
    def test_1(self, random):
        """No angle of a fine grid is better, and a solvable one is solved."""
        k, p1, noise = unit(random), random.normal(size=(CASES, 3)), unit(random)
        truth = random.uniform(-np.pi, np.pi, CASES)
        exact = np.arange(CASES) % 2 == 0
        p2 = turned(k, truth, p1) + np.where(exact[:, None], 0.0, 0.3 * noise)
        angle, least_squares = subproblem_1(p1, p2, k)
        error = np.linalg.norm(turned(k, angle, p1) - p2, axis=1)
        assert np.array_equal(~least_squares, exact)
        assert error[exact].max() < 1e-12
        for i in range(CASES):
            brute = np.linalg.norm(around(k[i], p1[i]) - p2[i], axis=1).min()
            assert error[i] <= brute + 1e-12

    @pytest.mark.parametrize("number", [3, 4])
    def test_3_and_4(self, random, number):
        """As many angles as a fine grid sees changes of sign, or its least error."""
        k, p, other = unit(random), random.normal(size=(CASES, 3)), unit(random)
        if number == 3:
            d = random.uniform(0.0, 4.0, CASES)
            found, least_squares = subproblem_3(p, other, k, d)
        else:
            d = random.uniform(-2.0, 2.0, CASES)
            found, least_squares = subproblem_4(other, p, k, d)

        def value(moved, i):
            if number == 3:
                return np.linalg.norm(moved - other[i], axis=-1) - d[i]
            return moved @ other[i] - d[i]

        counts = []
        for i in range(CASES):
            brute = value(around(k[i], p[i]), i)
            signs = np.count_nonzero(np.diff(np.sign(brute)))
            error = [value(turned(k[i], angle, p[i]), i) for angle in found[:, i]]
            assert (signs == 0) == least_squares[i]
            assert np.abs(error).max() <= np.abs(brute).min() + 1e-9
            if signs:
                gap = (found[0, i] - found[1, i] + np.pi) % (2 * np.pi) - np.pi
                assert np.abs(error).max() < 1e-12
                assert abs(gap) > 1e-6
            counts.append(signs)
        assert set(counts) == {0, 2}


class TestSearch:
    @pytest.mark.parametrize("name", ARMS)
    def test_bisected_candidates_are_solutions(self, name):
        arm = load_arm(name)
        goals = targets.make_targets(arm, "uniform", COUNT, SEED)
        search = Search(arm, 360, "bisected")
        solved = 0
        for pose, witness in zip(goals.poses, goals.witnesses, strict=True):
            q = search(pose)
            poses = np.broadcast_to(pose, (len(q), 4, 4))
            assert check.right(arm.chain, poses, q).all()
            gap = (q - witness + np.pi) % (2 * np.pi) - np.pi
            solved += bool((np.abs(gap).max(axis=1) < 1e-6).any())
        # A pair of zeros between two values of q4 is missed.
        assert solved >= COUNT - 2

    @pytest.mark.parametrize("between", ["lower end", "interpolated"])
    def test_interpolated_candidates_are_near_solutions(self, between):
        arm = load_arm("cvr038")
        goals = targets.make_targets(arm, "uniform", COUNT, SEED)
        coarse, fine = (Search(arm, values, between) for values in (36, 720))
        median = []
        for search in (coarse, fine):
            found = [search(pose) for pose in goals.poses]
            owner = np.repeat(np.arange(COUNT), [len(q) for q in found])
            q = np.concatenate(found)
            assert arm.chain.within_limits(q).all()
            position, _ = check.errors(arm.chain, goals.poses[owner], q)
            median.append(np.median(position))
        # Of first order in the distance of the values if joints are held, else second.
        order = np.log(median[0] / median[1]) / np.log(719 / 35)
        assert order == pytest.approx(1.0 if between == "lower end" else 2.0, abs=0.3)

    def test_other_axes_are_refused(self):
        with pytest.raises(UnsupportedError, match="axes 2 and 3 parallel"):
            Search(load_arm("xarm6"), 36, "bisected")
        with pytest.raises(UnsupportedError, match="6 revolute joints"):
            Search(load_arm("irb14050"), 36, "bisected")


class TestMakers:
    def test_a_solution_is_a_good_first_seed(self):
        arm = load_arm("cvr038")
        goals = targets.make_targets(arm, "uniform", COUNT, SEED)
        seeds = [q[None] for q in goals.witnesses]
        seeds[3] = np.empty((0, 6))
        seeds[4] = np.tile(goals.witnesses[4], (5, 1))
        done = from_seeds(paper_solver(arm, 1), arm, goals.poses, seeds)
        assert done.right.sum() == COUNT - 1
        assert not done.right[3]
        assert done.attempts.tolist() == [i != 3 for i in range(COUNT)]
        assert done.iterations.max() == 0

    def test_the_next_seed_follows_a_failed_one(self):
        """As often as all of them, each by itself, and never with more attempts."""
        arm = load_arm("cvr038")
        goals = targets.make_targets(arm, "uniform", COUNT, SEED)
        seeds = arm.robot.random_configurations(8 * COUNT, SEED + 1)
        seeds = seeds.reshape(COUNT, 8, 6)
        together = from_seeds(paper_solver(arm, 8), arm, goals.poses, list(seeds))
        once = paper_solver(arm, 1)
        single = [
            from_seeds(once, arm, goals.poses, list(seeds[:, [i]])).right
            for i in range(8)
        ]
        assert 0 < together.right.sum() < COUNT
        assert np.array_equal(together.right, np.any(single, axis=0))
        assert (together.attempts[~together.right] == 8).all()

    @pytest.mark.parametrize("name", ["random", "IK-Geo, 36 values of q4"])
    def test_asked_outside_the_solver(self, name):
        arm = load_arm("cvr038")
        goals = targets.make_targets(arm, "uniform", COUNT, SEED)
        cell = first_attempt(arm, goals, {"maker": name})
        assert cell["count"] == COUNT
        assert 0 < cell["iterations"] <= 8
        assert cell["right"] <= COUNT - cell["without_seed"]

    def test_asked_inside_it(self):
        """The nearest sample by Eq. (2), as by the database itself."""
        arm = load_arm("ur3_wrs")
        goals = targets.make_targets(arm, "uniform", COUNT, SEED)
        name = "paper's database, nearest, Eq. (2)"
        cell = first_attempt(arm, goals, {"maker": name})
        solver = paper_solver(arm, 1)
        base = solver.database
        seeds = [base.q(int(base.nearest(pose, 1)[0]))[None] for pose in goals.poses]
        again = from_seeds(solver, arm, goals.poses, seeds)
        assert cell["right"] == again.right.sum()
        assert cell["iterations"] == pytest.approx(again.iterations.mean())
        assert cell["samples"] == len(base)

    def test_makers_that_cannot_be_had_say_so(self):
        with pytest.raises(UnsupportedError):
            MAKERS["IK-Geo, 36 values of q4"].make(load_arm("irb14050"))


class TestPackage:
    def test_what_it_did_is_counted(self, monkeypatch):
        """A package that finds, finds nothing, gives only least squares, panics."""
        arm = load_arm("cvr038")
        goals = targets.make_targets(arm, "uniform", 8, SEED)
        kinds = iter([*range(4), *range(4)] * 2)

        class Fake:
            def __init__(self, arm, family):
                assert family == "two_parallel"
                self.rows = iter([*goals.witnesses, *goals.witnesses])

            prepare = staticmethod(lambda pose, start: (pose,))
            answers = package.IkGeo.answers

            def call(self, pose):
                q = next(self.rows).tolist()
                return [[(q, False)], [], [(q, True)], package.PANIC][next(kinds)]

        monkeypatch.setattr(ikgeo_cells, "IkGeo", Fake)
        cell = ikgeo_cells.packaged(arm, goals, {"family": "two_parallel"})
        counts = [cell[w] for w in ("count", "empty", "least_squares", "panics")]
        assert counts == [8, 2, 2, 2]
        assert cell["right"] == cell["seeded"] == cell["direct"] == 2

    def test_panics_are_told_from_errors(self):
        panic = type("PanicException", (BaseException,), {})

        def fails(error):
            made = package.IkGeo.__new__(package.IkGeo)

            def get_ik(*arguments):
                raise error

            made._get_ik = get_ik
            return made

        assert fails(panic()).call(1) is package.PANIC
        with pytest.raises(ValueError, match="other"):
            fails(ValueError("other")).call(1)


class TestText:
    def view(self):
        """Small cells of one robot each, as a report has them."""
        size = QUICK
        arm = load_arm("cvr038")
        goals = targets.make_targets(arm, "uniform", COUNT, SEED)
        wanted = [
            (seeding.search_cell("cvr038", name, size), ikgeo_cells.searched)
            for name in seeding.SEARCHES
        ]
        wanted.append(
            (seeding.enumeration_cell("cvr038", size), ikgeo_cells.enumerated)
        )
        wanted += [
            (seeding.maker_cell("cvr038", name, size), first_attempt)
            for name in MAKERS
            if MAKERS[name].language != "JAX"
        ]
        cells = [
            {"settings": settings, "result": measure(arm, goals, settings)}
            for settings, measure in wanted
        ]
        return View({"size": vars(size), "cells": cells, "missing": {}})

    def test_from_cells(self):
        view = self.view()
        told = ikgeo_section.text(view)
        assert f"| published | {NONE} | {NONE} | 94.06 |" in told
        assert "| IKSel, `solve_all` |" in told
        assert "| C1, `two_parallel` |" in told
        told = makers_section.text(view)
        assert "Over C0, a first attempt arrives from" in told
        assert f"| C0, MDN | JAX | {NONE} |" in told
        assert "not measured" in told

    @pytest.mark.parametrize(
        ("off", "count", "word"),
        [(0.5, 10_000, "holds"), (1.7, 2_000, "undecided"), (4.0, 2_000, "missed")],
    )
    def test_a_difference_whose_bound_crosses_the_aim(
        self, monkeypatch, off, count, word
    ):
        """Is neither held nor missed."""

        def cell(_, robot):
            rates = published.IK_GEO
            direct, seeded = (rates[how][robot][0] - off for how in rates)
            return {
                "count": count,
                "direct": count * direct / 100,
                "seeded": count * seeded / 100,
            }

        monkeypatch.setattr(ikgeo_section, "_papers", cell)
        assert f"aimed at: {word}" in ikgeo_section._verdict(self.view())

    def test_nothing_measured(self):
        view = View({"size": vars(QUICK), "cells": [], "missing": {}})
        assert ikgeo_section.text(view) == makers_section.text(view) == ""

    def test_planned(self):
        jobs = plan.plan(QUICK, None, ["seeds"])
        planned = [cell for job in jobs for cell in job.cells]
        for name in MAKERS:
            assert seeding.maker_cell("cvr038", name, QUICK) in planned
        jobs = plan.plan(QUICK, None, ["seeds"], ["IKSel"])
        assert not any("ikgeo_package" in str(job.cells) for job in jobs)


def test_ikgeo_and_solve_all_agree():
    """Every bisected candidate is one of solve_all's solutions."""
    arm = load_arm("cvrb1213")
    search = Search(arm, 360, "bisected")
    solver = iksel.Solver(arm.robot)
    goals = targets.make_targets(arm, "uniform", COUNT, SEED)
    for pose in goals.poses:
        every = np.array(solver.solve_all(pose).q)
        for q in search(pose):
            gap = (every - q + np.pi) % (2 * np.pi) - np.pi
            assert np.abs(gap).max(axis=1).min() < 1e-3
