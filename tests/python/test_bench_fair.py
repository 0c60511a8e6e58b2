# SPDX-License-Identifier: BSD-3-Clause
"""Laws of what makes the report fair: bounds, claims, provenance. No times."""

from __future__ import annotations

import importlib.util
import math
import subprocess
from dataclasses import replace
from pathlib import Path
from threading import Event

import numpy as np
import pytest

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench import (
    bounds,
    cells,
    command,
    machine,
    plots,
    provenance,
    report,
    report_command,
    run,
)
from bench.arms import load_arm
from bench.paper import choices, claims, published, seeds_shown
from bench.paper import plan as paper_plan
from bench.paper.bounds import margin
from bench.paper.paired import paired, rotation_vectors
from bench.plans import rivals
from bench.plans.shared import at_level
from bench.rivals import RIVALS
from bench.rivals.base import Run, least_run
from bench.sections import choices as choices_section
from bench.sections import cut_offs, fastest, target_counts
from bench.sections import rivals as rivals_section
from bench.settings import targets_of
from bench.size import QUICK, Job
from bench.store import Store
from bench.timing import summary
from bench.view import View

import iksel

SEED = 5
ROOT = Path(__file__).resolve().parents[2]

spec = importlib.util.spec_from_file_location("readme", ROOT / "scripts" / "readme.py")
readme = importlib.util.module_from_spec(spec)
spec.loader.exec_module(readme)


def report_of(cells):
    """A report of pairs of settings and results."""
    return {
        "cells": [{"settings": s, "result": r} for s, r in cells],
        "size": vars(QUICK),
        "missing": {},
        "versions": {},
    }


class TestBounds:
    @pytest.mark.parametrize("part", [0, 1, 7, 90, 99, 100])
    def test_as_likely_as_said(self, part):
        """At the bound as many successes, or more, come up in 5 %: summed by hand."""
        share = bounds.at_least(part, 100)
        more = sum(
            math.comb(100, k) * share**k * (1 - share) ** (100 - k)
            for k in range(part, 101)
        )
        assert more == pytest.approx(0.05 if part else 1.0, abs=1e-9)

    def test_rule_of_three(self):
        for count in (100, 10_000, 1_000_000):
            assert bounds.at_least(count, count) == pytest.approx(0.05 ** (1 / count))
            assert 1 - bounds.at_least(count, count) < 3 / count

    def test_a_difference_covers_the_truth(self):
        """Of 2,000 draws about 95 % of the intervals have the true difference."""
        random = np.random.default_rng(SEED)
        count, rates = 1_000, (0.05, 0.02, 0.93)
        won, lost, _ = random.multinomial(count, rates, 2_000).T
        covered = [
            abs(100 * (w - x) / count - 3.0) <= bounds.paired_points(w, x, count)
            for w, x in zip(won, lost, strict=True)
        ]
        assert np.mean(covered) == pytest.approx(0.95, abs=0.02)

    def test_verdicts(self):
        assert bounds.verdict(1.0, 0.9) == "holds"
        assert bounds.verdict(1.0, 1.1) == "undecided"
        assert bounds.verdict(-1.0, 0.9) == "does not hold"
        assert bounds.paired_points(0, 0, 1_000) > 0


class TestChoices:
    def test_one_setting_beside_another(self):
        """Targets that only one solves add up, and the same setting has none."""
        size = QUICK.__class__(**{**vars(QUICK), "paper": 200})
        few = {"max_iterations": 4}
        cell = paired(choices.paired_cell("cvr038", size, {}, few))
        assert cell["solved"] - cell["against_solved"] == cell["won"] - cell["lost"]
        assert cell["won"] > 0
        same = paired(choices.paired_cell("cvr038", size, few, few))
        assert (same["won"], same["lost"]) == (0, 0)
        assert same["solved"] == cell["against_solved"]

    def test_rotation_vectors(self):
        random = np.random.default_rng(SEED)
        axis = random.normal(size=(50, 3))
        axis /= np.linalg.norm(axis, axis=1, keepdims=True)
        angle = random.uniform(0.0, np.pi, 50)
        angle[:5] = [0.0, 1e-8, np.pi, np.pi, np.pi]
        cross = np.cross(np.eye(3)[None], axis[:, None])
        turns = np.eye(3) + np.sin(angle)[:, None, None] * cross
        turns = turns + (1 - np.cos(angle))[:, None, None] * (cross @ cross)
        found = rotation_vectors(turns)
        expected = angle[:, None] * axis
        # Either of the two vectors of a half turn.
        either = np.minimum(
            np.abs(found - expected).max(axis=1), np.abs(found + expected).max(axis=1)
        )
        half = angle > np.pi - 1e-6
        assert np.abs(found - expected)[~half].max() < 1e-7
        assert either.max() < 1e-7

    def test_rows_say_what_holds(self):
        """Re-selection among 10 solves more, among 200 less; of UR3 it is not known."""
        cells = []
        (choice,) = [c for c in choices.CHOICES if "best 20" in c.says]
        for robot in published.ROBOTS:
            for label, other in choice.others.items():
                won, lost = {"10": (100, 140), "200": (90, 10)}.get(label, (9, 9))
                if robot == "ur3_wrs":
                    won, lost = 10, 10
                result = {"count": 1_000, "solved": 870, "won": won, "lost": lost}
                result["against_solved"] = 870 - won + lost
                settings = choices.paired_cell(robot, QUICK, choice.chosen, other)
                cells.append((settings, result))
        text = choices_section.text(View(report_of(cells)))
        rows = {
            line.split("|")[1].strip(): line
            for line in text.splitlines()
            if "|" in line
        }
        assert "87.00 (87.59)" in rows[f"**{choice.says}**: {choice.chosen_label}"]
        assert rows["10"].endswith("| does not hold on C0, C1, IRB; undecided on UR3 |")
        assert rows["200"].endswith("| holds on C0, C1, IRB; undecided on UR3 |")
        assert rows["50"].endswith("| undecided |")

    def test_times_have_their_stages(self):
        """Large is slower than medium by its query, as the row says."""
        claim = choices.TIMES[0]
        (medium,) = claim.slower.values()
        cells = []
        for robot in published.ROBOTS:
            for overrides, query in ((claim.faster[1], 30.0), (medium, 20.0)):
                result = {"mean_us": 80.0 + query, "std_us": 50.0, "targets": 10_000}
                result |= {"query_us": query, "rank_us": 40.0, "iterate_us": 40.0}
                settings = paper_plan.paper_cell(robot, QUICK, overrides)
                assert settings["stages"]
                cells.append((settings, {**result, "reselect_us": 0.0}))
        text = choices_section.text(View(report_of(cells)))
        (row,) = [x for x in text.splitlines() if x.startswith("| medium less large")]
        assert "\N{MINUS SIGN}10.0 ± 1.4: query \N{MINUS SIGN}10.0, rank +0.0" in row
        assert row.endswith("| does not hold |")

    def test_every_choice_is_another_setting(self):
        for robot in ("cvr038", "irb14050"):
            for cell in choices.choice_cells(robot, QUICK):
                assert cell["overrides"] != cell["against"]
        assert choices_section.text(View(report_of([]))) == ""

    def test_margins_of_drawn_rows(self):
        """A difference of two rates has the interval that its variance gives."""
        rows = {"worse": 70.0, "better": 73.0}

        def look(label, i):
            del i
            return claims.Row(rows[label], 1.0, 0.5, 2.0, 1_000)

        claim = claims.Claim("", "points", lambda f: f.gain("worse", "better"))
        found = margin(claim, look, 0)
        wide = 1.96 * 100 * np.sqrt((0.7 * 0.3 + 0.73 * 0.27) / 1_000)
        assert found.value == pytest.approx(3.0)
        assert found.high - found.low == pytest.approx(2 * wide, rel=0.2)


class TestFair:
    def test_a_solver_that_gives_nothing(self):
        """Not 0 %: of IK-Geo that says what the package does."""
        times = {"mean_us": 1.0, "p99_us": 1.0}
        cells = []
        for name, claimed in (("IK-Geo", 0), ("KDL LMA", 50)):
            settings = rivals.rival_cell("cvr038", name, "uniform", QUICK)
            result = {"count": 100, "right": 0, "claimed": claimed, "false_claims": 0}
            cells.append((settings, result | times))
        every = report_of(cells)
        every["versions"] = dict.fromkeys(RIVALS, "1")
        text = rivals_section.text(View(every))
        assert "| IK-Geo | returns nothing |" in text
        assert "| KDL LMA | 0.00 |" in text

    def test_counts_under_a_table(self):
        cells = []
        for name, count in (("IKSel", 900), ("KDL LMA", 90), ("OptIK", 90)):
            settings = rivals.rival_cell("cvr038", name, "lines", QUICK)
            cells.append((settings, {"count": count}))
        settings = rivals.rival_cell("panda", "OptIK", "lines", QUICK)
        told = target_counts.text(
            View(report_of([*cells, (settings, {"count": 90})])), "lines"
        )
        assert told == "Targets per robot, seed 1: 90 (IKSel: 900)."
        assert target_counts.text(View(report_of([])), "lines") == ""

    def test_the_least_cut_off(self):
        """Of 1,000 calls of 1 to 1,000 us it is 999; without that many, none."""
        times = np.arange(1.0, 1_001.0) * 1e3
        cell = {"count": 1_000, "right": 1_000}
        cell["right_quantiles_us"] = summary(times)["quantiles_us"]
        assert cut_offs.enough(cell) == "999"
        assert cut_offs.enough(cell | {"right": 998}).startswith("never (99.80")

    @pytest.mark.parametrize("threads", rivals.BATCH_THREADS)
    def test_all_branches_beside_all(self, threads):
        """The batch of all branches has those of solve_all, and no fewer."""
        size = replace(QUICK, batch=20)
        settings = rivals.every_cell("ur3_wrs", threads, size)
        cell = cells.batch(settings)
        solver = iksel.Solver(load_arm("ur3_wrs").robot)
        poses = targets_of(settings).poses
        assert cell["branches"] == sum(len(solver.solve_all(pose)) for pose in poses)
        assert cell["right"] == 20

    @pytest.mark.parametrize("threads", [1, 2, 3, 7])
    def test_parts_on_threads_keep_their_order(self, threads):
        numbers = list(range(10))
        assert cells.each(lambda i: i + 1, numbers, threads) == [i + 1 for i in numbers]

    @pytest.mark.parametrize(("first_ns", "passes"), [(5, 3), (int(1e9), 1)])
    def test_what_is_soon_through_has_the_least_of_its_passes(self, first_ns, passes):
        """As of the others, so that one interruption is not in a mean."""
        asked = []

        class Twice:
            def run(self, targets):
                asked.append(targets)
                slow = [3, first_ns][len(asked) == 1]
                return Run(np.array([slow, 7]), [[len(asked)], []])

        run_ = least_run(Twice(), "targets")
        assert len(asked) == passes
        assert list(run_.times_ns) == ([3, 7] if passes > 1 else [first_ns, 7])
        assert run_.answers == [[1], []]

    def test_another_level_has_a_process_of_its_own(self, tmp_path):
        seen = []

        def fake(_, *, env, **__):
            seen.append(env.get("IKSEL_SIMD"))
            return subprocess.Popen(["true"], stdin=subprocess.PIPE, text=True)

        cell = rivals.rival_cell("ur3_wrs", "IKSel", "uniform", QUICK)
        store = Store(tmp_path, "a")
        with pytest.MonkeyPatch.context() as patch:
            patch.delenv("IKSEL_SIMD", raising=False)
            patch.setattr(run, "Popen", fake)
            for some in (cell, at_level(cell, "avx2")):
                run.run_job(Job("x", "rivals", [some]), store, tmp_path, Event())
        assert seen == [None, "avx2"]


class TestReadme:
    @staticmethod
    def figures(mean, missed=0, wrong=0):
        us = [mean, mean]
        return {"us": us, "missed": missed, "wrong": wrong, "count": 1_000}

    def test_the_fastest_that_misses_none(self):
        """Faster ones that miss some are not shown, unless there is no other."""
        assert fastest.enumerating({}) == "not measured"
        assert fastest.enumerating({"IKSel": {}}) == "none of those asked"
        found = {
            "IKSel": {"one": self.figures(1.0), "every": self.figures(3.0)},
            "pink": {"one": self.figures(0.5)},
            "frankik": {"one": self.figures(2.0, 1_000)},
            "frankik, defaults": {"one": self.figures(2.5, 3)},
            "opw": {"one": self.figures(2.6, wrong=1)},
        }
        told = fastest.enumerating(found)
        assert told == "opw 2.60 µs (IKSel 1.00, 1 of 1,000 wrong)"
        found["ssik"] = {"one": self.figures(130.0), "every": self.figures(90.0)}
        assert fastest.enumerating(found) == "ssik 130 µs (IKSel 1.00)"
        # All is held against all.
        found["EAIK"] = {"every": self.figures(4.5)}
        assert fastest.enumerating(found) == "EAIK 4.50 µs for all (IKSel 3.00)"

    def test_a_no_of_one_that_looks(self):
        def cell(mean, missed):
            us = [mean, mean]
            return {"us": us, "missed": missed, "count": 1_000, "noes": 600}

        assert fastest.enumerators_no({}) == "not measured"
        found = {"IKSel": cell(0.1, 0), "ikdh": cell(9.0, 0), "py-ikgeo": cell(1.0, 5)}
        assert fastest.enumerators_no(found) == "ikdh 9.00 µs"
        found["frankik"] = cell(3.75, 4)
        assert fastest.enumerators_no(found) == "frankik 3.75 µs (misses 4 of 400)"

    @pytest.mark.parametrize(
        ("unasked", "proven", "told"),
        [
            (0, 0, "4.00 µs, none proven"),
            (8, 8, "4.00 µs, 80.0 % proven"),
            (0, 8, "4.00 µs, none proven; `prove=True`: 20.0 µs, 80.0 % proven"),
        ],
    )
    def test_our_no_says_what_is_certain(self, unasked, proven, told):
        cell = {"proven": proven, "swept": 2, "searched": 8 - proven}
        cell |= {"proven_unasked": unasked, "no_us": [4.0, 4.0]}
        assert readme.section._our_no(cell | {"proven_us": [20.0, 20.0]}) == told

    def test_it_is_of_the_report(self, capsys):
        """Or, where sources have changed since, says so and goes on."""
        readme.main(["--check"])
        assert capsys.readouterr().err.count("figures left as they are") <= 1

    @pytest.fixture
    def copy(self, tmp_path_factory, monkeypatch, checkout):
        """Of README.md in a folder of its own, with what it is made of."""
        checkout[1]()
        folder = tmp_path_factory.mktemp("copy")
        for path in ("python/examples", "cpp/examples", "cpp/robots"):
            (folder / path).parent.mkdir(exist_ok=True)
            (folder / path).symlink_to(ROOT / path)
        text = (ROOT / "README.md").read_text(encoding="utf-8")
        broken = text.replace("import sys", "import nothing", 1)
        (folder / "README.md").write_text(broken, encoding="utf-8")
        monkeypatch.setattr(readme, "ROOT", folder)
        monkeypatch.setattr(readme, "View", lambda report: report)
        shown = dict.fromkeys(readme.FIGURES, lambda _: "new figures")
        monkeypatch.setattr(readme, "FIGURES", shown)
        return folder / "README.md"

    @pytest.mark.parametrize("check", [False, True])
    @pytest.mark.parametrize(
        "made_at",
        [
            ("HEAD", ""),
            ("0123456789", "not in this repository"),
            ("unknown", "unknown commit"),
            ("HEAD+", "differs from its commit"),
        ],
    )
    def test_what_is_rendered(self, copy, monkeypatch, capsys, check, made_at):
        """Figures of a fresh report alone; --check writes nothing at all.

        A report that later commits have left behind is no error of --check, one that
        never was of a commit is.
        """
        commit, why = made_at
        made = {"machine": {"commit": commit}}
        monkeypatch.setattr(readme, "load_report", lambda _: made)
        broken = copy.read_text(encoding="utf-8")
        arguments = ["--check"] if check else []
        ended = ""
        try:
            readme.main(arguments)
        except SystemExit as reason:
            ended = str(reason)
        after = copy.read_text(encoding="utf-8")
        if check:
            assert after == broken
            fit = why in {"", "not in this repository"}
            assert ("stale block" if fit else why) in ended
            return
        assert after.count("new figures") == (0 if why else len(readme.FIGURES))
        assert why in capsys.readouterr().err
        assert ended == ("1" if why else "")
        # What sources give is made anew in any case.
        assert "import nothing" not in after
        if why == "not in this repository":
            readme.main(["--check"])


@pytest.fixture
def checkout(tmp_path, monkeypatch):
    """A repository of one C++ file, one text that no figure needs, and a commit."""
    (tmp_path / "cpp").mkdir()
    (tmp_path / "cpp" / "a.cpp").write_text("1")
    (tmp_path / "notes.md").write_text("1")

    def commit():
        for words in (["init", "-q"], ["add", "-A"], ["commit", "-qm", "x"]):
            who = ["-c", "user.name=a", "-c", "user.email=a@b"]
            subprocess.run(["git", "-C", str(tmp_path), *who, *words], check=True)
        return machine.commit()

    monkeypatch.setattr(machine, "ROOT", tmp_path)
    return tmp_path, commit


class TestProvenance:
    def test_clean(self, checkout):
        folder, commit = checkout
        facts = {"commit": commit(), "stale": False}
        assert provenance.doubts(facts) == []
        # What no figure needs may change, what figures are made of may not.
        (folder / "notes.md").write_text("2")
        assert provenance.doubts(facts) == []
        (folder / "cpp" / "a.cpp").write_text("2")
        (reason,) = provenance.doubts(facts)
        assert reason.startswith("changed since its commit")
        assert reason.endswith("cpp/a.cpp")

    def test_dirty_trees_are_told(self, checkout):
        folder, commit = checkout
        assert not commit().endswith("+")
        (folder / "cpp" / "new.cpp").write_text("1")
        assert machine.commit().endswith("+")

    @pytest.mark.parametrize(
        ("facts", "reason"),
        [
            ({"commit": "unknown"}, "unknown commit"),
            ({}, "unknown commit"),
            ({"commit": "HEAD+"}, "differs from its commit HEAD"),
            ({"commit": "HEAD", "stale": True}, "older than its sources"),
            ({"commit": "0123456789"}, "not in this repository"),
        ],
    )
    def test_what_is_refused(self, checkout, facts, reason):
        _, commit = checkout
        commit()
        part = {"machine": {"commit": "HEAD"}, "parts": {"no": {"machine": facts}}}
        with pytest.raises(provenance.ProvenanceError, match=f"section no: .*{reason}"):
            provenance.check(part)

    def test_render_writes_nothing(self, tmp_path, capsys):
        made = {"machine": {"commit": "unknown"}, "cells": []}
        report.save_report(made, tmp_path)
        assert command.main(["render", "-o", str(tmp_path)]) == 2
        assert "made at an unknown commit" in capsys.readouterr().err
        assert not (tmp_path / "RESULTS.md").exists()


class TestFigures:
    def test_seeds_as_the_captions_say(self, tmp_path):
        settings = choices.shown_cell(QUICK)
        shown = seeds_shown.measured(settings)
        errors = {name: shown["first"][name]["errors"] for name in ("nearest", "least")}
        # The nearest leads away; the other arrives within four steps.
        assert errors["nearest"][1] > errors["nearest"][0]
        assert errors["nearest"][0] < errors["least"][0] or len(errors["least"]) > 1
        assert len(errors["least"]) <= 5
        assert errors["least"][-1] < 1e-4
        lower, upper = np.array(shown["lower"]), np.array(shown["upper"])
        ends = [np.array(path[-1]) for path in shown["second"]["attempts"]]
        inside = [bool(((q >= lower) & (q <= upper)).all()) for q in ends]
        assert inside == [False, True]
        attempts = shown["third"]["attempts"]
        assert attempts[0] == 0
        assert max(attempts) < 20
        view = View(report_of([(settings, shown)]))
        drawn = plots.draw_all(view, tmp_path) if has_matplotlib() else []
        assert len(drawn) in (0, 3)
        assert "paper_figure_3.svg" in choices_section.text(view)

    def test_outlines_end_at_the_tip(self):
        arm = load_arm("panda")
        q = arm.robot.random_configurations(1, SEED)[0]
        points = np.array(seeds_shown.outline(arm.chain, q))
        assert np.abs(points[-1] - arm.chain.fk(q[None])[0, :3, 3]).max() < 1e-12


def has_matplotlib():
    return importlib.util.find_spec("matplotlib") is not None


class TestCommand:
    def test_prints_the_claims(self, capsys, monkeypatch, tmp_path):
        monkeypatch.setattr(report_command, "WORK", tmp_path)
        for name in ("CHOICES", "TIMES", "ABLATION_1_SCALES"):
            monkeypatch.setattr(choices, name, getattr(choices, name)[:1])
        assert command.main(["text", "cvr038", "--targets", "20"]) == 0
        told = capsys.readouterr().out
        assert "20 targets per robot" in told
        assert "| **no scaling coefficient is needed**: without |" in told
        assert "| medium less large |" in told
