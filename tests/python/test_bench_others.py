# SPDX-License-Identifier: BSD-3-Clause
"""Other processes beside a report: waited for, and told of."""

from __future__ import annotations

import subprocess
import sys
import time

import pytest

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench import machine, others, report, run
from bench.size import FULL, QUICK, Job
from bench.store import Store

pytestmark = pytest.mark.skipif(
    not others.STAT.exists(), reason="only Linux says what all processes take"
)
SPIN = "import time\nend = time.monotonic() + {}\nwhile time.monotonic() < end: pass"


def test_what_works_is_seen():
    """A process that is not waited for is another one."""
    watched = others.Others(0.0)
    with (
        subprocess.Popen([sys.executable, "-c", SPIN.format(1.0)]),
        watched.beside("a job"),
    ):
        time.sleep(0.8)
    facts = watched.facts()
    assert facts["job"] == "a job"
    # A shared machine may give it little.
    assert facts["mean"] == facts["most"] > 0.1


def test_what_a_job_takes_is_not_others(monkeypatch):
    """Where nothing else runs, others take nothing."""
    monkeypatch.setattr(others, "busy_s", others.own_s)
    watched = others.Others(0.0)
    begin = others.own_s()
    with watched.beside("a job"):
        subprocess.run([sys.executable, "-c", SPIN.format(0.5)], check=True)
    assert others.own_s() - begin > 0.05
    _, taken, seconds = watched._taken[0]
    assert seconds > 0.5
    assert taken < 0.02


@pytest.mark.parametrize(("busy", "patience_s"), [(1.9, 3.0), (0.1, 3.0), (1.9, 0.0)])
def test_waits_while_others_work_and_patience_lasts(monkeypatch, busy, patience_s):
    now = [0.0]
    monkeypatch.setattr(others.time, "monotonic", lambda: now[0])
    monkeypatch.setattr(others.time, "sleep", lambda s: now.__setitem__(0, now[0] + s))
    monkeypatch.setattr(others, "busy_s", lambda: busy * now[0])
    watched = others.Others(patience_s)
    watched.wait()
    expected = {1.9: patience_s, 0.1: others.LOOK_S}[busy]
    assert expected <= now[0] <= expected + others.LOOK_S + others.PAUSE_S
    # What was spent is spent.
    begin = now[0]
    watched.wait()
    assert now[0] - begin <= others.LOOK_S + others.PAUSE_S


def test_a_report_waits_before_what_it_measures_only(monkeypatch, tmp_path):
    said = []

    class Watched(others.Others):
        def wait(self):
            said.append("waits")

    def worker(left, store, log):
        del log
        said.append(len(left))
        for cell in left:
            store.save(cell, {"made": "now"})
        return ""

    monkeypatch.setattr(run, "_run_worker", worker)
    store = Store(tmp_path / "cells", "a")
    cells = [{"cell": "evaluate", "robot": "ur3", "count": n} for n in (1, 2, 3)]
    jobs = [
        Job("free", "paper", cells[:1], timed=False),
        Job("new", "paper", cells[1:]),
        Job("there", "paper", cells[1:2]),
    ]
    run.run_jobs(jobs, store, tmp_path, Watched(1.0))
    assert said == [1, "waits", 2]


def test_the_report_says_it():
    facts = {"mean": 0.03, "most": 0.9, "job": "IKSel", "waited_s": 12}
    told = machine.others_text({"others": facts})
    assert "took 0.03 cores in the mean, 0.9 at most (IKSel); it had waited" in told
    assert machine.others_text({}) == machine.others_text({"others": {}}) == ""
    assert FULL.patience_s > QUICK.patience_s == 0.0
    made_on = dict.fromkeys(
        ("iksel", "simd", "commit", "python", "numpy", "cpu", "system"), "x"
    ) | {"cores": 2, "others": facts}
    part = {"machine": made_on, "command": "it", "seconds": 1}
    assert told in report._made(part)
