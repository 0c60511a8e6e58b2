# SPDX-License-Identifier: BSD-3-Clause
"""Many poses on the command line: files of every format, and stdin and stdout."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from answer_files import FEW, read
from command_line import Run, assert_good

import iksel
from iksel.cli import _poses

COUNT = 40


INPUTS = ["matrix.csv", "euler.csv", "quaternion.csv", "numbers.txt"]


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
    ros = quaternion[:, [0, 1, 2, 4, 5, 6, 3]]
    write("ros.txt", rows(ros, " "))
    np.save(folder / "ros.npy", ros)
    times = [f"{0.01 * i}" for i in range(COUNT)]
    names = "time,x,y,z,qx,qy,qz,qw,name"
    cells = zip(times, rows(ros), strict=True)
    write("times.csv", [names, *(f"{t},{row},pick {t}" for t, row in cells)])
    write("lists.jsonl", [json.dumps(pose) for pose in targets.tolist()])
    poses = ({"pose": pose, "name": "x"} for pose in targets.tolist())
    write("objects.jsonl", [json.dumps(pose) for pose in poses])
    np.save(folder / "matrix.npy", targets)
    np.save(folder / "flat.npy", flat)
    np.save(folder / "quaternion.npy", quaternion)
    return folder


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
    assert proofs == ["answer"] * COUNT
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


def test_quaternions_with_the_scalar_last(
    run: Run, folder: Path, tmp_path: Path, targets
) -> None:
    """As ROS prints them, with --order xyzw; columns of that name need no flag."""
    words = ["solve", "ur3", *FEW, "--poses"]

    def answers(name: str, *more: str) -> np.ndarray:
        path = tmp_path / f"{name}-{len(more)}.csv"
        assert_good(run(*words, folder / name, "-o", path, *more))
        return read(path)[2]

    first = answers("quaternion.csv")
    order = ("--order", "xyzw")
    for name in ("ros.txt", "ros.npy", "times.csv", "quaternion.csv"):
        np.testing.assert_allclose(answers(name, *order), first, atol=1e-9)
    np.testing.assert_allclose(answers("times.csv"), first, atol=1e-9)
    position, (w, *xyz) = targets[0, :3, 3], iksel.quaternion_from_pose(targets[0])
    pose = [repr(float(x)) for x in (*position, *xyz, w)]
    told = run("solve", "ur3", *FEW, "--json", *order, "--pose", *pose).json()
    np.testing.assert_allclose(told["target"], targets[0], atol=1e-12)
    tool = run("fk", "ur3", *"000000", "--json", *order, "--tcp", *"0001000").json()
    turned = iksel.pose_from_quaternion([0, 0, 0], [1, 0, 0, 0], "xyzw")
    plain = iksel.load_robot("ur3").fk(np.zeros(6))
    np.testing.assert_allclose(tool["pose"], plain @ turned, atol=1e-12)


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


def test_a_file_may_be_answered_in_its_place(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "poses.csv"
    path.write_text("0.2 0.15 0.3 0 3.1416 0\n", "utf-8")
    assert_good(run("solve", "ur3", "--poses", path, "-o", path, *FEW))
    assert read(path)[0] == ["solved"]
