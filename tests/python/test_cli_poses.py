# SPDX-License-Identifier: BSD-3-Clause
"""Many poses on the command line: files of every format, and stdin and stdout."""

from __future__ import annotations

import csv
import io
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from command_line import Output, Run, assert_bad, assert_good

import iksel
from iksel.cli import _poses

FEW = ["--samples", "500"]
COUNT = 40
INPUTS = ["matrix.csv", "euler.csv", "quaternion.csv", "numbers.txt"]
INPUTS += ["lists.jsonl", "objects.jsonl", "matrix.npy", "flat.npy", "quaternion.npy"]


@pytest.fixture(scope="module")
def targets(made) -> np.ndarray:
    robot = made.robot("ur3")
    return robot.fk(robot.random_configurations(COUNT, seed=3))


@pytest.fixture(scope="module")
def folder(tmp_path_factory, targets) -> Path:
    """The same poses in a file of every form."""
    folder = tmp_path_factory.mktemp("poses")
    position = targets[:, :3, 3]
    euler = np.hstack([position, iksel.euler_from_pose(targets)])
    quaternion = np.hstack([position, iksel.quaternion_from_pose(targets)])
    flat = targets.reshape(-1, 16)

    def write(name: str, lines) -> None:
        (folder / name).write_text("".join(f"{line}\n" for line in lines), "utf-8")

    def rows(array, separator: str = ",") -> list[str]:
        return [separator.join(map(repr, row)) for row in array.tolist()]

    write("matrix.csv", rows(flat))
    write("euler.csv", ["x,y,z,roll,pitch,yaw", *rows(euler)])
    order = [5, 3, 4, 6, 0, 1, 2]
    names = np.array(["x", "y", "z", "qw", "qx", "qy", "qz"])[order]
    write("quaternion.csv", [",".join(names), *rows(quaternion[:, order])])
    write("numbers.txt", ["# a comment", "", *rows(flat, "  ")])
    write("lists.jsonl", [json.dumps(pose) for pose in targets.tolist()])
    poses = ({"pose": pose, "name": "x"} for pose in targets.tolist())
    write("objects.jsonl", [json.dumps(pose) for pose in poses])
    np.save(folder / "matrix.npy", targets)
    np.save(folder / "flat.npy", flat)
    np.save(folder / "quaternion.npy", quaternion)
    return folder


def read(path: Path) -> tuple[list[str], list[str], np.ndarray, np.ndarray]:
    """Statuses, proofs, joint values and errors of a file of answers, NaN for none."""

    def numbers(rows) -> np.ndarray:
        values = [[np.nan if x in (None, "") else float(x) for x in r] for r in rows]
        return np.array(values)

    if path.suffix == ".npy":
        array = np.load(path)
        statuses = [iksel.Status(x).name for x in array["status"]]
        proofs = [iksel.Proof(x).name for x in array["proof"]]
        errors = np.stack([array["position_error"], array["rotation_error"]], axis=1)
        return statuses, proofs, array["q"], errors
    text = path.read_text("utf-8")
    if path.suffix == ".csv":
        _, *rows = csv.reader(io.StringIO(text))
        q = numbers(row[2:-2] for row in rows)
        errors = numbers(row[-2:] for row in rows)
        return [r[0] for r in rows], [r[1] for r in rows], q, errors
    objects = [json.loads(line) for line in text.splitlines()]
    q = numbers(o["q"] or [None] * 6 for o in objects)
    errors = numbers((o["position_error"], o["rotation_error"]) for o in objects)
    return [o["status"] for o in objects], [o["proof"] for o in objects], q, errors


def assert_same(path: Path, other: Path) -> None:
    for one, two in zip(read(path), read(other), strict=True):
        np.testing.assert_array_equal(one, two)


@pytest.mark.parametrize("form", ["csv", "jsonl", "npy"])
@pytest.mark.parametrize("name", INPUTS)
def test_fk_of_every_answer_is_its_pose(
    run: Run, made, folder: Path, targets, tmp_path: Path, *, name: str, form: str
) -> None:
    answers = tmp_path / f"answers.{form}"
    words = ["--poses", folder / name, "-o", answers, *FEW]
    summary = assert_good(run("solve", "ur3", *words)).out
    assert f"solved  {COUNT}" in summary
    statuses, proofs, q, errors = read(answers)
    assert statuses == ["solved"] * COUNT
    assert proofs == ["none"] * COUNT
    robot = made.robot("ur3")
    assert robot.within_limits(q).all()
    measured = np.stack(iksel.pose_error(targets, robot.fk(q)), axis=1)
    assert measured.max() <= 1e-6 + 1e-12
    np.testing.assert_allclose(errors, measured, rtol=0, atol=1e-9)


def test_all_formats_hold_the_same(run: Run, folder: Path, tmp_path: Path) -> None:
    def answer(source: str, form: str) -> Path:
        path = tmp_path / f"{source}.{form}"
        words = ["--poses", folder / source, "-o", path, *FEW]
        assert_good(run("solve", "ur3", *words))
        return path

    first = answer("matrix.csv", "csv")
    for form in ("jsonl", "npy"):
        assert_same(answer("matrix.csv", form), first)
    for source in ("numbers.txt", "lists.jsonl", "objects.jsonl", "matrix.npy"):
        assert answer(source, "csv").read_bytes() == first.read_bytes()
    assert answer("flat.npy", "csv").read_bytes() == first.read_bytes()
    quaternions = answer("quaternion.csv", "csv").read_bytes()
    assert answer("quaternion.npy", "csv").read_bytes() == quaternions


def test_answers_are_those_of_solve_batch(
    run: Run, made, folder: Path, targets, tmp_path: Path
) -> None:
    robot = made.robot("ur3")
    options = iksel.SolverOptions(database={"samples": 500})
    near = [0.0, -1.0, 1.0, 0.0, 1.0, 0.0]
    batch = iksel.Solver(robot, options).solve_batch(targets, near=near)
    path = tmp_path / "answers.npy"
    words = ["--poses", folder / "matrix.npy", "-o", path, *FEW, "--near", *near]
    assert_good(run("solve", "ur3", *words))
    np.testing.assert_array_equal(np.load(path)["q"], batch.q)


def test_chunks_and_threads_change_nothing(
    run: Run, folder: Path, tmp_path: Path
) -> None:
    whole, parts = tmp_path / "whole.jsonl", tmp_path / "parts.jsonl"
    words = ["solve", "ur3", "--poses", folder / "matrix.csv", *FEW, "-o"]
    assert_good(run(*words, whole, "--threads", "2"))
    assert_good(run(*words, parts, "--threads", "1", "--chunk", "7"))
    assert whole.read_bytes() == parts.read_bytes()


def pipe(source: Path, *words: object) -> subprocess.CompletedProcess[bytes]:
    command = [sys.executable, "-m", "iksel", "solve", "ur3", "--poses", "-", *FEW]
    with source.open("rb") as file:
        return subprocess.run(
            [*command, *map(str, words)], stdin=file, capture_output=True, check=False
        )


@pytest.mark.parametrize(
    ("source", "form"),
    [("matrix.csv", "csv"), ("lists.jsonl", "jsonl"), ("matrix.npy", "npy")],
)
def test_stdin_and_stdout_are_files(
    run: Run, folder: Path, tmp_path: Path, source: str, form: str
) -> None:
    path = tmp_path / f"answers.{form}"
    words = ["--poses", folder / source, "-o", path, *FEW]
    assert_good(run("solve", "ur3", *words))
    done = pipe(folder / source, "--format", form)
    assert (done.returncode, done.stderr) == (0, b"")
    assert done.stdout == path.read_bytes()


def test_a_live_stdin_is_answered_row_by_row(folder: Path) -> None:
    lines = (folder / "lists.jsonl").read_text("utf-8").splitlines()[:5]
    words = ["--poses", "-", "--format", "jsonl", "--chunk", "1", *FEW]
    process = subprocess.Popen(
        [sys.executable, "-m", "iksel", "solve", "ur3", *words],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    for line in lines:
        process.stdin.write(line + "\n")
        process.stdin.flush()
        assert json.loads(process.stdout.readline())["status"] == "solved"
    assert process.communicate()[0] == ""
    assert process.returncode == 0


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
    assert proofs == ["none", "reach", *["none"] * 11]
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


def test_degrees(run: Run, folder: Path, targets, tmp_path: Path) -> None:
    euler = np.hstack([targets[:, :3, 3], np.degrees(iksel.euler_from_pose(targets))])
    np.save(tmp_path / "degrees.npy", euler)
    for name, source, more in (
        ("a.npy", folder / "euler.csv", []),
        ("b.npy", tmp_path / "degrees.npy", ["--degrees"]),
    ):
        words = ["--poses", source, "-o", tmp_path / name, *FEW, *more]
        assert_good(run("solve", "ur3", *words))
    plain, degrees = (np.load(tmp_path / name)["q"] for name in ("a.npy", "b.npy"))
    np.testing.assert_allclose(degrees, np.degrees(plain), rtol=0, atol=1e-6)
    np.save(tmp_path / "round.npy", [[0.2, 0.15, 0.3, 0, 180, 0]] * 3)
    words = ["--poses", tmp_path / "round.npy", *FEW]
    output = run("solve", "ur3", *words)
    assert output.err.count("\n") == 1
    assert "round.npy, row 0: 0 180 0 look like degrees" in output.err
    assert run("solve", "ur3", *words, "--degrees").err == ""


def test_paths_take_the_same_files(run: Run, tmp_path: Path, made) -> None:
    robot = made.robot("ur3")
    q = np.array([0.1, -1, 1, 0.2, 0.3, -0.4]) + 0.01 * np.arange(5)[:, None]
    poses = robot.fk(q)
    np.save(tmp_path / "path.npy", poses)
    lines = "\n".join(json.dumps({"pose": pose}) for pose in poses.tolist())
    (tmp_path / "path.jsonl").write_text(lines, "utf-8")
    answers = [
        assert_good(run("path", "ur3", tmp_path / name, *FEW, "--json")).json()
        for name in ("path.npy", "path.jsonl")
    ]
    assert answers[0] == answers[1]
    assert len(answers[0]["q"]) == 5


def test_lines_are_not_kept(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Answers to the first rows are written before the last ones are read."""
    held = []
    row = _poses.PoseFile._row

    def watch(self, *arguments):
        held.append(path.stat().st_size if path.exists() else 0)
        return row(self, *arguments)

    source, path = tmp_path / "poses", tmp_path / f".answers.csv.{os.getpid()}.part"
    source.write_text("9 0 0 0 0 0\n" * 20, "utf-8")
    monkeypatch.setattr(_poses.PoseFile, "_row", watch)
    words = ["--poses", source, "-o", tmp_path / "answers.csv", *FEW, "--chunk", "5"]
    assert run("solve", "ur3", *words).code == 1
    sizes = held[::5]
    assert sizes == sorted(set(sizes))


def test_progress_is_shown_on_stderr(run: Run, folder: Path, tmp_path: Path) -> None:
    words = ["solve", "ur3", "--poses", folder / "matrix.csv", *FEW]
    output = run(*words, "-o", tmp_path / "a.csv", "--progress")
    assert "solving [" in output.err
    assert output.err.endswith("100%\n")
    assert run(*words, "--no-progress").err == ""


BAD = [
    ("--poses absent", "absent: No such file"),
    ("--poses .", r"\.: .*directory"),
    ("--poses /dev/null", "/dev/null: no poses in it"),
    ("--poses /dev/zero", "/dev/zero: .*line 1.*longer"),
    (
        "--poses names",
        "names, line 1: the columns a, b are not x y z roll.*qw qx",
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


def test_a_file_may_be_answered_in_its_place(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "poses.csv"
    path.write_text("0.2 0.15 0.3 0 3.1416 0\n", "utf-8")
    assert_good(run("solve", "ur3", "--poses", path, "-o", path, *FEW))
    assert read(path)[0] == ["solved"]


def test_a_reader_that_goes_away_is_no_error(folder: Path) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    command = [sys.executable, "-m", "iksel", "solve", "ur3", *FEW]
    process = subprocess.Popen(
        [*command, "--poses", str(folder / "matrix.csv")],
        stdout=writing,
        stderr=subprocess.PIPE,
        text=True,
    )
    os.close(writing)
    _, err = process.communicate()
    assert (process.returncode, err) == (141, "")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_a_full_disk_is_one_line(folder: Path) -> None:
    command = [sys.executable, "-m", "iksel", "solve", "ur3", *FEW]
    words = ["--poses", folder / "matrix.csv", "-o", "/dev/full", "--format", "csv"]
    done = subprocess.run(
        [*command, *words], capture_output=True, text=True, check=False
    )
    output = Output(done.returncode, done.stdout, done.stderr)
    assert_bad(output, "'/dev/full' cannot be written: No space")
