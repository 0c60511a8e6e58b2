# SPDX-License-Identifier: BSD-3-Clause
"""Many poses on the command line: wrong rows, wrong files, full disks."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from answer_files import FEW, read
from command_line import Output, Run, assert_bad


@pytest.fixture(scope="module")
def targets(made) -> np.ndarray:
    robot = made.robot("ur3")
    return robot.fk(robot.random_configurations(40, seed=3))


@pytest.fixture(scope="module")
def poses_file(tmp_path_factory, targets) -> Path:
    path = tmp_path_factory.mktemp("poses") / "poses.npy"
    np.save(path, targets)
    return path


MIXED = """\
0.2 0.15 0.3 0 3.1416 0
9 0 0 0 0 0
0.2 0.15 nan 0 3.1416 0
0.2 0.15 0.3 1 1 0 0
1 2 3
x 0 0 0 0 0
[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0]]
{"pose": [0.2, 0.15, null, 0, 3.1416, 0]}
{"matrix": []}
{"pose": "somewhere"}
{"pose": [true, 0, 0, 0, 0, 0]}
{broken
{"pose": [0.2, 0.15, 0.3, 0, 3.1416, 0]}
"""


@pytest.mark.parametrize("form", ["csv", "jsonl", "npy"])
def test_rows_that_are_no_poses_have_their_status(
    run: Run, tmp_path: Path, form: str
) -> None:
    source, path = tmp_path / "mixed", tmp_path / f"answers.{form}"
    source.write_text(MIXED, "utf-8")
    output = run("solve", "ur3", "--poses", source, "-o", path, "--json", *FEW)
    assert output.code == 1
    assert output.err.startswith(f"iksel: warning: {source}, line 3: ")
    assert output.err.count("\n") == 1
    assert output.json() == {
        "file": str(path),
        "poses": 13,
        "solved": 2,
        "statuses": {"solved": 2, "out_of_reach": 1, "invalid_pose": 10},
    }
    statuses, proofs, q, errors = read(path)
    assert statuses == ["solved", "out_of_reach", *["invalid_pose"] * 10, "solved"]
    assert proofs == ["answer", "reach", *["none"] * 10, "answer"]
    assert np.isnan(q[1:-1]).all()
    assert np.isnan(errors[1:-1]).all()
    np.testing.assert_array_equal(q[0], q[-1])


def test_rows_of_an_array_that_are_no_poses(run: Run, tmp_path: Path, targets) -> None:
    poses = targets.copy()
    poses[3, 0, 0] = np.nan
    poses[5] = 0
    source, path = tmp_path / "poses.npy", tmp_path / "answers.npy"
    np.save(source, poses)
    output = run("solve", "ur3", "--poses", source, "-o", path, *FEW)
    assert output.code == 1
    assert "poses.npy, row 3: pose: not finite: nan" in output.err
    assert list(np.flatnonzero(np.load(path)["status"] == 7)) == [3, 5]


BAD = [
    ("--poses absent", "absent: No such file"),
    ("--poses .", r"\.: .*directory"),
    ("--poses /dev/null", "/dev/null: no poses in it"),
    ("--poses /dev/zero", "/dev/zero: .*line 1.*longer"),
    (
        "--poses names",
        "names, line 1: x y z roll .* or .* qw qx .* are not among the columns a, b",
    ),
    ("--poses two", "two, line 1: the columns .* hold more than one pose"),
    ("--poses twice", "twice, line 1: the columns .* hold more than one pose"),
    ("--poses short --on-invalid raise", "short, line 2: expected 7 columns.*got 6"),
    (
        "--poses wide --on-invalid raise",
        "wide, line 1: .*got 8; .*a first line of names",
    ),
    ("--poses header", "header: no poses in it"),
    ("--poses bytes", "bytes: line 2: .*utf-8"),
    ("--poses shape.npy", r"shape\.npy: expected an array of shape .*got \(3, 5\)"),
    ("--poses text.npy", r"text\.npy: expected numbers, got an array of <U1"),
    ("--poses objects.npy", r"objects\.npy: no array: .*objects"),
    ("--poses cut.npy", r"cut\.npy: no array: "),
    ("--poses empty.npy", r"empty\.npy: no poses in it"),
    ("--poses good -o a.txt", r"a\.txt: its end says no format.*\.csv.*\.jsonl.*\.npy"),
    ("--poses good -o absent/a.csv", "'absent/a.csv' cannot be written: No such file"),
    ("--poses good -o . --format csv", r"'\.' cannot be written: Is a directory"),
    ("--poses good --format xml", "--format.*'xml'.*csv.*jsonl.*npy"),
    ("--poses good --all", "--all: is for one pose"),
    ("--poses good --diagnose", "--diagnose: is for one pose"),
    ("--poses good --json", "--json: .*-o FILE.*--format jsonl"),
    ("--poses good --threads -1", "threads"),
    ("--poses good --chunk 0", "--chunk: 0 is less than 1"),
    ("--poses good --near 1", "--near: expected 6 numbers"),
    ("--poses good --pose 1 2 3 4 5 6", "not allowed with"),
    ("--poses mixed --on-invalid raise", "mixed, line 2: .*expected 6.*got 3"),
    ("--poses mixed --on-invalid raise -o a.csv", "mixed, line 2: "),
    ("--pose 1 2 3 4 5 6 -o a.csv", "--output: needs --poses FILE"),
    ("--pose 1 2 3 4 5 6 --threads 2", "--threads: needs --poses FILE"),
    ("--pose 1 2 3 4 5 6 --chunk 2", "--chunk: needs --poses FILE"),
    ("--pose 1 2 3 4 5 6 --on-invalid raise", "--on-invalid: needs --poses"),
]


@pytest.mark.parametrize(("words", "culprit"), BAD)
def test_bad_files_are_one_line(
    run: Run,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    words: str,
    culprit: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    good = "0.2 0.15 0.3 0 3.1416 0\n"
    files = {"good": good, "mixed": good + "1 2 3\n", "names": "a,b\n" + good}
    files |= {"header": "x,y,z,roll,pitch,yaw\n"}
    files |= {"two": "x,y,z,roll,pitch,yaw,qw,qx,qy,qz\n"}
    files |= {"twice": "x,y,z,roll,pitch,yaw,x\n"}
    files |= {"short": "time x y z roll pitch yaw\n" + good}
    files |= {"wide": "0.01 0.2 0.15 0.3 0 0 1 0\n"}
    for name, text in files.items():
        Path(name).write_text(text, "utf-8")
    Path("bytes").write_bytes(good.encode() + b"\xff\n")
    np.save("shape.npy", np.zeros((3, 5)))
    np.save("text.npy", np.full((3, 4, 4), "a"))
    np.save("objects.npy", np.full((3, 4, 4), None), allow_pickle=True)
    np.save("empty.npy", np.zeros((0, 4, 4)))
    Path("cut.npy").write_bytes(Path("shape.npy").read_bytes()[:-9])
    before = sorted(tmp_path.iterdir())
    assert_bad(run(f"solve ur3 {words} --samples 500"), culprit)
    assert sorted(tmp_path.iterdir()) == before


def test_an_old_file_stays_when_all_fails(run: Run, tmp_path: Path) -> None:
    source, path = tmp_path / "poses", tmp_path / "answers.csv"
    source.write_text("0.2 0.15 0.3 0 3.1416 0\n1 2 3\n", "utf-8")
    path.write_text("old", "utf-8")
    words = ["--poses", source, "-o", path, *FEW]
    assert run("solve", "ur3", *words, "--on-invalid", "raise").code == 2
    assert path.read_text("utf-8") == "old"
    assert run("solve", "ur3", *words).code == 1
    assert path.read_text("utf-8").startswith("status,proof,")
    assert sorted(tmp_path.iterdir()) == [path, source]


def test_a_reader_that_goes_away_is_no_error(poses_file: Path) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    command = [sys.executable, "-m", "iksel", "solve", "ur3", *FEW]
    process = subprocess.Popen(
        [*command, "--poses", str(poses_file)],
        stdout=writing,
        stderr=subprocess.PIPE,
        text=True,
    )
    os.close(writing)
    _, err = process.communicate()
    assert (process.returncode, err) == (141, "")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_a_full_disk_is_one_line(poses_file: Path) -> None:
    command = [sys.executable, "-m", "iksel", "solve", "ur3", *FEW]
    words = ["--poses", poses_file, "-o", "/dev/full", "--format", "csv"]
    done = subprocess.run(
        [*command, *words], capture_output=True, text=True, check=False
    )
    output = Output(done.returncode, done.stdout, done.stderr)
    assert_bad(output, "'/dev/full' cannot be written: No space")
