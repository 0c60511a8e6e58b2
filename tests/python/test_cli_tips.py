# SPDX-License-Identifier: BSD-3-Clause
"""Robots with several tips on the command line: a --tip, and a pose, for each."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import numpy as np
import pytest
from command_line import assert_bad, assert_good
from trees import two_arms_on_torso

import iksel

SEED = 6
TIPS = ["l_tool0", "r_tool0"]
FLAGS = ["--tip", TIPS[0], "--tip", TIPS[1]]
COUNT = 6


@pytest.fixture(scope="module")
def urdf(tmp_path_factory, made) -> Path:
    path = tmp_path_factory.mktemp("torso") / "torso.urdf"
    path.write_text(two_arms_on_torso(made.robot("ur5e")))
    return path


@pytest.fixture(scope="module")
def robot(urdf) -> iksel.Robot:
    return iksel.load_robot(urdf, tip_links=TIPS)


@pytest.fixture(scope="module")
def targets(robot) -> np.ndarray:
    """Both hands go up from where they are at some configuration."""
    poses = np.stack([robot.fk(robot.random_configurations(1, SEED)[0])] * COUNT)
    poses[:, :, 2, 3] += np.linspace(0, 0.03, COUNT)[:, None]
    return poses


@pytest.fixture
def ask(run, urdf):
    """Run a command on the robot, with both tips."""
    return lambda command, *words: run(command, urdf, *words, *FLAGS)


def lines(rows) -> str:
    return "".join(" ".join(map(repr, map(float, row))) + "\n" for row in rows)


def files(targets) -> dict[str, str | np.ndarray]:
    """The same poses in every form."""
    position = targets[..., :3, 3]
    euler = np.concatenate([position, iksel.euler_from_pose(targets)], axis=-1)
    turned = np.concatenate([position, iksel.quaternion_from_pose(targets)], axis=-1)
    fields = ["x", "y", "z", "qw", "qx", "qy", "qz"]
    names = ["time", *(f"{tip}.{field}" for tip in TIPS[::-1] for field in fields)]
    timed = [[7.5, *row[::-1].ravel()] for row in turned]
    texts = [",".join(names), *(",".join(map(repr, map(float, row))) for row in timed)]
    return {
        "euler.txt": lines(euler.reshape(COUNT, -1)),
        "quaternion.txt": lines(turned.reshape(COUNT, -1)),
        "matrix.txt": lines(targets.reshape(COUNT, -1)),
        "named.csv": "\n".join(texts) + "\n",
        "lists.jsonl": "".join(json.dumps(row) + "\n" for row in targets.tolist()),
        "keys.jsonl": "".join(
            json.dumps({"pose": row, "time": 0}) + "\n" for row in targets.tolist()
        ),
        "matrix.npy": targets,
        "euler.npy": euler.reshape(COUNT, -1),
    }


@pytest.fixture(scope="module")
def folder(urdf, targets) -> Path:
    for name, content in files(targets).items():
        if isinstance(content, str):
            (urdf.parent / name).write_text(content, "utf-8")
        else:
            np.save(urdf.parent / name, content)
    return urdf.parent


FORMS = [
    "euler.txt",
    "quaternion.txt",
    "matrix.txt",
    "named.csv",
    "lists.jsonl",
    "keys.jsonl",
    "matrix.npy",
    "euler.npy",
]


@pytest.mark.parametrize("form", FORMS)
def test_a_path_of_both_hands(ask, folder, robot, targets, form) -> None:
    found = assert_good(ask("path", folder / form, "--json")).json()
    assert found["status"] == "solved"
    np.testing.assert_allclose(robot.fk(found["q"]), targets, atol=5e-6)
    path = iksel.Solver(robot).solve_path(targets)
    np.testing.assert_allclose(found["q"], path.q, atol=1e-4)


def test_a_path_begins_and_ends_somewhere(ask, folder, robot, targets) -> None:
    q = robot.random_configurations(1, SEED)[0]
    words = ["path", folder / "matrix.txt", "--start", *map(repr, q.tolist())]
    text = assert_good(ask(*words)).out
    assert "torso, base -> l_tool0, r_tool0" in text
    assert "6\n" in text
    slow = assert_good(ask(*words, "--dt", "10", "--json")).json()
    assert np.abs(np.diff([q.tolist(), *slow["q"]], axis=0)).max() < 0.1
    far = targets.copy()
    far[3:, 1, 0, 3] += 9
    np.save(folder / "far.npy", far)
    output = ask("path", folder / "far.npy", "--json")
    assert output.code == 1
    assert output.json()["first_unreachable"] == 3


@pytest.mark.parametrize("form", ["named.csv", "matrix.npy"])
def test_a_file_of_targets(ask, folder, robot, targets, form) -> None:
    text = assert_good(ask("solve", "--poses", folder / form)).out
    rows = list(csv.DictReader(io.StringIO(text)))
    q = [[float(row[name]) for name in robot.joint_names] for row in rows]
    np.testing.assert_allclose(robot.fk(q), targets, atol=5e-6)


def test_a_row_that_is_no_pose_has_a_status(ask, folder, targets) -> None:
    rows = files(targets)["matrix.txt"].splitlines()
    rows[1] = rows[1].rpartition(" ")[0]
    rows[3] = rows[3].replace(rows[3].split()[0], "7", 1)
    (folder / "holes.txt").write_text("\n".join(rows), "utf-8")
    words = ["solve", "--poses", folder / "holes.txt", "--format", "jsonl"]
    output = ask(*words)
    assert output.code == 1
    statuses = [json.loads(line)["status"] for line in output.out.splitlines()]
    bad = [status == "invalid_pose" for status in statuses]
    assert bad == [False, True, False, True, False, False]
    assert "line 2: expected a pose for each of l_tool0, r_tool0, in" in output.err
    assert "one of 12, 14, 32 numbers; got 31" in output.err
    raised = ask(*words, "--on-invalid", "raise")
    assert_bad(raised, r"line 2: expected a pose for each of l_tool0, r_tool0")


def test_what_is_wrong_in_a_file_is_named(ask, folder, targets) -> None:
    names = "l_tool0.x,l_tool0.y,l_tool0.z,l_tool0.roll,l_tool0.pitch,l_tool0.yaw"
    for name, text, message in (
        ("one.txt", "1 0 0 0 0 0\n", "line 1: expected a pose for each of l_tool0, r_"),
        (
            "left.csv",
            f"{names}\n1,2,3,4,5,6\n",
            r"a point \(l_tool0.x\) are not among",
        ),
        ("bare.csv", "x,y,z,roll,pitch,yaw\n", "behind its tip's link and a point"),
        ("off.txt", " ".join(["0"] * 32), "line 1, l_tool0: "),
    ):
        (folder / name).write_text(text, "utf-8")
        assert_bad(ask("path", folder / name), message)
    np.save(folder / "one.npy", targets[:, 0])
    shapes = r"shape \(N, 2, 4, 4\), \(N, 12\), \(N, 14\) or \(N, 32\), got \(6, 4, 4\)"
    assert_bad(ask("path", folder / "one.npy"), shapes)


def test_millimetres_are_suspected_of_any_tip(ask, folder, targets) -> None:
    poses = targets.copy()
    poses[:, 1, :3, 3] *= 1000
    np.save(folder / "mm.npy", poses)
    output = ask("path", folder / "mm.npy")
    assert "looks like millimetres" in output.err


def test_the_jacobian_has_the_rows_of_each_tip(ask, robot) -> None:
    q = robot.random_configurations(1, SEED)[0]
    words = ["jacobian", *map(repr, q.tolist())]
    found = assert_good(ask(*words, "--json")).json()
    np.testing.assert_allclose(found["jacobian"], robot.jacobian(q), atol=1e-12)
    assert found["rows"][0] == "vx l_tool0"
    assert found["rows"][11] == "wz r_tool0"
    text = assert_good(ask(*words)).out
    assert sum("r_tool0" in line for line in text.splitlines()) == 7


@pytest.mark.parametrize("picture", ["workspace", "manipulability", "branches"])
def test_pictures(ask, folder, picture) -> None:
    pytest.importorskip("matplotlib", reason="pip install iksel[plot]")
    file = folder / f"{picture}.png"
    of = ["--configurations", "500"]
    if picture == "branches":
        of = ["--poses", folder / "matrix.npy"]
    found = ask("plot", picture, "-o", file, *of, "--json")
    facts = assert_good(found).json()
    assert file.stat().st_size > 5_000
    if picture == "branches":
        assert facts["without_solution"] == 0
        assert facts["solutions"] > COUNT


def test_what_is_of_one_tip_is_refused_in_words(ask, run, urdf, folder, robot) -> None:
    reach = pytest.importorskip("iksel.reach")
    both = "l_tool0, r_tool0"
    assert_bad(ask("evaluate"), f"2 tips .*{both}")
    assert_bad(ask("build", "-o", folder / "db"), f"2 tips .*{both}")
    of_one = f"robot: maps and data sets are of one tip, and this has {both}"
    words = ["-o", folder / "m.zarr"]
    assert_bad(run("reach", "plan", urdf, *FLAGS, *words), of_one)
    assert_bad(ask("dataset", "--samples", "9", *words), of_one)
    for symmetry in (True, False):
        with pytest.raises(iksel.InvalidArgumentError, match=of_one):
            reach.plan(robot, symmetry=symmetry)


def test_a_tip_and_a_pose_each(ask, robot) -> None:
    def answer(*line: str) -> dict:
        return assert_good(ask(*line, "--json")).json()

    q = [0.1, 0.2, 0.3, -1.2, 1.4, -1.8, -1.6, 0.2, -0.3, -1.9, -1.4, -1.3, 1.6, 0]
    there = answer("fk", *map(str, q))
    assert np.shape(there["pose"]) == (2, 4, 4)
    assert there["tip_links"] == ["l_tool0", "r_tool0"]
    poses = []
    for position, rpy in zip(there["position"], there["rpy"], strict=True):
        poses += ["--pose", *map(str, [*position, *rpy])]
    solved = answer("solve", *poses)
    np.testing.assert_allclose(robot.fk(solved["q"]), there["pose"], atol=1e-5)
    assert len(answer("solve", *poses, "--all")["q"]) > 8
    info = answer("info")
    assert info["shared_joints"] == ["lift", "turn"]
    assert [each["tip_link"] for each in info["chains"]] == ["l_tool0", "r_tool0"]
    assert "target of r_tool0" in assert_good(ask("solve", *poses)).out
    for line, words in (
        (poses[:7], "--pose: given 1 times; expected once for each of"),
        ([*poses, "--tcp", "none"], "--tcp: given 1 times"),
    ):
        assert_bad(ask("solve", *line), words)
