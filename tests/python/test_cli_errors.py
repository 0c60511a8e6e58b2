# SPDX-License-Identifier: BSD-3-Clause
"""The command line when something is wrong: one line on stderr and a status."""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from command_line import Output, Run, assert_bad

import iksel
from iksel import cli

POSE = "0.2 0.15 0.3 0 3.1416 0"
FEW = ["--samples", "500"]

BAD = [
    ("", "COMMAND"),
    ("sovle ur3", "sovle.*robots.*info.*solve.*build.*; did you mean solve?"),
    ("jacobi ur3", "'jacobi'.*; did you mean jacobian?"),
    ("solve ur3 --objective limit", "'limit'.*; did you mean limits?"),
    ("solve ur3 --order xyz", "'xyz'.*; did you mean xyzw?"),
    ("--frobnicate", "COMMAND|frobnicate"),
    ("robots ur3", "unrecognized arguments: ur3"),
    ("info", "ROBOT"),
    ("info ur33", "no built-in robot 'ur33'; did you mean ur3.*panda.*MJCF file"),
    ("info absent.urdf", r"absent\.urdf"),
    ("info ./absent", "'absent'"),
    ("info arm.urdf.xacro", r"'arm\.urdf\.xacro': No such file"),
    ("info ur3 --tip hand", "'hand'.*tool0"),
    ("info ur3 --base hand", "'hand'.*base_link"),
    ("info ur3 --tip base_link", "base_link"),
    ("info ur3 --tcp 1 2 3", "--tcp: expected 6 numbers.*got 3"),
    ("info ur3 --tcp 0 0 0 1 1 1 1", "--tcp: quaternion: expected norm 1"),
    ("info ur3 --tcp a", "--tcp: not all numbers in 'a'"),
    ("info ur3 --lock elbow", "--lock: expected JOINT=VALUE, got 'elbow'"),
    ("info ur3 --lock =1", "--lock: expected JOINT=VALUE, got '=1'"),
    ("info ur3 --lock elbow_joint=", "--lock: expected JOINT=VALUE"),
    ("info ur3 --lock elbow_joint=x", "--lock elbow_joint=x: not all numbers"),
    ("info ur3 --lock elbow_joint=nan", "elbow_joint"),
    ("info ur3 --lock elbow=1", "'elbow'.*elbow_joint"),
    ("info ur3 --jso", "--jso"),
    ("solve ur3", "--pose.*--from-q"),
    ("solve ur3 --pose", "--pose"),
    (f"solve ur3 --pose {POSE} --from-q 0 0 0 0 0 0", "not allowed with"),
    ("solve ur3 --pose 1 2 3 4 5", "--pose: expected 6 numbers.*7.*16.*got 5"),
    ("solve ur3 --pose 0,2 0,1 0,3 0 3,1 0", "got 10; decimals take a point"),
    ("solve ur3 --pose 1 2 3 4 5 x", "--pose: not all numbers in '1 2 3 4 5 x'"),
    ("solve ur3 --pose 1 2 3 4 5 nan", "--pose: rpy: not finite: nan"),
    ("solve ur3 --pose -inf 2 3 4 5 6", "--pose: position: not finite: -inf"),
    ("solve ur3 --pose 0 0 0 1 0 0 1", "--pose: quaternion: .*1.414"),
    ("solve ur3 --pose" + " 1" * 16, "--pose: pose: not rigid"),
    ("solve ur3 --from-q 1 2 3", "--from-q: expected 6 numbers.*elbow_joint.*got 3"),
    ("solve ur3 --from-q 1 2 3 4 5 inf", "q"),
    (f"solve ur3 --pose {POSE} --seed-q 1", "--seed-q: expected 6 numbers.*got 1"),
    (f"solve ur3 --pose {POSE} --no-database-seeds", "nothing to try.*--seed-q"),
    (f"solve ur3 --pose {POSE} --preset fast", "fast.*default.*paper"),
    (f"solve ur3 --pose {POSE} --iteration newton", "newton.*dls.*pinv.*cwln.*lm"),
    (f"solve ur3 --pose {POSE} --sampling sobol", "sobol.*grid.*cvt.*random"),
    (f"solve ur3 --pose {POSE} --max-attempts many", "--max-attempts.*'many'"),
    (f"solve ur3 --pose {POSE} --max-attempts 0", "max_attempts"),
    (f"solve ur3 --pose {POSE} --max-attempts {10**30}", "max_attempts"),
    (f"solve ur3 --pose {POSE} --position-tolerance -1", "position_tolerance"),
    (f"solve ur3 --pose {POSE} --position-tolerance nan", "position_tolerance"),
    (f"solve ur3 --pose {POSE} --solver-seed -1", "seed"),
    (f"solve ur3 --pose {POSE} --samples -1", "samples"),
    (f"solve ur3 --pose {POSE} --database absent.iksel", r"absent\.iksel"),
    (f"solve ur3 --pose {POSE} --mmap", "--database"),
    (
        f"solve ur3 --pose {POSE} --database x --samples 9 --scale small",
        "--samples, --scale: cannot be used with --database",
    ),
    (
        "build ur3 -o x --scale large --samples 9",
        "--samples 9: cannot be used with --scale large",
    ),
    (f"solve ur3 --pose {POSE} --near 1 2", "--near: expected 6 numbers.*got 2"),
    (f"solve ur3 --pose {POSE} --near" + " nan" * 6, "near"),
    ("path ur3", "FILE"),
    ("path ur3 absent.txt", r"absent\.txt: .*No such file"),
    ("path ur3 .", "'?.'?: .*directory"),
    ("path ur3 /dev/null", "/dev/null: no poses"),
    ("path ur3 /dev/null --dt x", "--dt"),
    ("build ur3", "-o/--output"),
    ("build ur3 -o absent/file --samples 50", "absent/file.*No such file"),
    ("build ur3 -o . --samples 50", "database '.'"),
    ("build ur3 -o x --max-attempts 3", "unrecognized arguments"),
    ("build ur3 -o x --rotation-weight=-1", "rotation_weight"),
    ("evaluate ur3 --targets 0", "--targets: 0 is less than 1"),
    ("evaluate ur3 --targets 1.5", "--targets"),
    ("evaluate ur3 --seed -1", "--seed: -1 is not between 0 and"),
    (f"evaluate ur3 --seed {2**64}", "--seed"),
]


@pytest.mark.parametrize(("words", "culprit"), BAD)
def test_bad_input_is_one_line(
    run: Run,
    words: str,
    culprit: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert_bad(run(words), culprit)
    assert list(tmp_path.iterdir()) == []


def test_bad_files_are_one_line(run: Run, tmp_path: Path) -> None:
    broken = tmp_path / "broken.urdf"
    broken.write_text("<robot", encoding="utf-8")
    assert_bad(run("info", broken), "URDF does not parse")
    database = tmp_path / "other.iksel"
    run("build", "panda", "-o", database, *FEW)
    words = ["solve", "ur3", "--pose", *POSE.split(), "--database", database]
    assert_bad(run(*words), "another chain")
    database.write_bytes(database.read_bytes()[:-1])
    assert_bad(run(*words), r"other\.iksel.*truncated")
    database.write_bytes(b"")
    assert_bad(run(*words), r"other\.iksel.*truncated")


def test_bad_paths_are_one_line(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "poses"
    path.write_text(f"# a comment\n{POSE}\n1 2 3\n", encoding="utf-8")
    assert_bad(run("path", "ur3", path), "poses, line 3: expected 6 numbers.*got 3")
    path.write_text(f"{POSE}\n1 2 x\n", encoding="utf-8")
    assert_bad(run("path", "ur3", path), "poses, line 2: not all numbers")
    path.write_bytes(b"\xff\xfe")
    assert_bad(run("path", "ur3", path), "poses: .*utf-8")
    path.write_text(POSE, encoding="utf-8")
    assert_bad(run("path", "ur3", path, "--start", "1"), "--start: expected 6 numbers")
    assert_bad(run("path", "ur3", path, "--dt", "-1"), "dt: -1")
    assert_bad(run("path", "ur3", path, "--dt", "nan"), "dt: nan")


def test_line_breaks_in_names_stay_inside_the_line(run: Run) -> None:
    assert_bad(run("info", "a\nb"), "robot")
    assert_bad(run("info", "ur3", "--tip", "a\nb"), "link")


def test_no_memory_is_one_line(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(_: object) -> int:
        raise MemoryError

    monkeypatch.setattr(cli.robots, "run", fail)
    assert_bad(run("robots"), "memory")


def test_interruption_is_quiet(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(_: object) -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr(cli.robots, "run", interrupt)
    assert run("robots") == Output(130, "", "")


def start(*words: str, **settings: Any) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "iksel", *words],
        stderr=subprocess.PIPE,
        text=True,
        **settings,
    )


def test_module_is_the_command_line() -> None:
    process = start("robots", "--json", stdout=subprocess.PIPE)
    out, err = process.communicate()
    assert (process.returncode, err) == (0, "")
    assert len(json.loads(out)["robots"]) == len(iksel.robot_names())
    process = start("info", "nobody", stdout=subprocess.PIPE)
    out, err = process.communicate()
    assert_bad(Output(process.returncode, out, err), "nobody")


def test_arguments_that_are_no_text_are_an_error(run: Run) -> None:
    assert_bad(run("info", "ur3", "--base", "\udcff"), r"'\\udcff': not in UTF-8")


def test_a_reader_that_goes_away_is_no_error() -> None:
    reading, writing = os.pipe()
    os.close(reading)
    process = start("robots", "--json", stdout=writing)
    os.close(writing)
    _, err = process.communicate()
    assert err == ""
    assert process.returncode == 141


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_output_that_cannot_be_written_is_an_error() -> None:
    with Path("/dev/full").open("w", encoding="utf-8") as full:
        process = start("robots", stdout=full)
        _, err = process.communicate()
    assert_bad(Output(process.returncode, "", err), "cannot write the output: .*space")


@pytest.mark.parametrize(
    ("words", "culprit"),
    [
        ("solve ur3 --poses - <&-", "no poses"),
        ("robots >&-", "cannot write the output: stdout is closed"),
        ("info nope 2>&-", ""),
        ("info nope 2>/dev/full", ""),
    ],
)
def test_streams_that_are_closed_or_full_are_an_error(words: str, culprit: str) -> None:
    done = subprocess.run(
        ["sh", "-c", f"{shlex.quote(sys.executable)} -m iksel {words}"],
        capture_output=True,
        text=True,
        check=False,
    )
    # 120 is Python's own, where the rest of stderr cannot be written at its end.
    assert done.returncode in ({2, 120} if words.endswith("/dev/full") else {2})
    if culprit:
        assert_bad(Output(done.returncode, done.stdout, done.stderr), culprit)


def test_signs_that_stdout_has_not_are_left_out() -> None:
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    process = start("robots", stdout=subprocess.PIPE, env=environment)
    out, err = process.communicate()
    assert (process.returncode, err) == (0, "")
    assert "?360" in out
