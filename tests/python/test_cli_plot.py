# SPDX-License-Identifier: BSD-3-Clause
"""iksel plot: the pictures, and the numbers that they show."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
import pytest
from command_line import Run, assert_bad, assert_good

import iksel
from iksel import cli
from iksel.cli import _plots
from iksel.cli._angles import Angles

pytest.importorskip("matplotlib")

FEW = ["--configurations", "2000"]
STARTS = {"png": b"\x89PNG\r\n", "svg": b"<?xml", "pdf": b"%PDF"}


@pytest.fixture(scope="module")
def line(made) -> np.ndarray:
    """Poses on a straight line, of which the last cannot be reached by a UR3."""
    pose = made.robot("ur3").fk([0.3, -1.2, 1.4, -0.6, 1.2, 0.2])
    poses = np.repeat(pose[None], 6, axis=0)
    poses[:, 0, 3] += 0.02 * np.arange(6)
    poses[-1, 0, 3] += 1
    return poses


@pytest.fixture
def path(line, tmp_path: Path) -> Path:
    np.save(tmp_path / "line.npy", line)
    return tmp_path / "line.npy"


@pytest.mark.parametrize("form", list(STARTS))
@pytest.mark.parametrize("picture", ["workspace", "manipulability", "branches"])
def test_pictures_are_drawn_the_same_each_time(
    run: Run, tmp_path: Path, path: Path, picture: str, form: str
) -> None:
    words = ["--poses", path] if picture == "branches" else FEW
    contents = []
    for name in ("a", "b"):
        file = tmp_path / f"{name}.{form}"
        answer = assert_good(run("plot", "ur3", picture, "-o", file, *words, "--json"))
        assert answer.json()["picture"] == picture
        contents.append(file.read_bytes())
    assert contents[0].startswith(STARTS[form])
    assert contents[0] == contents[1]
    assert len(list(tmp_path.iterdir())) == 3


def test_text_says_what_is_drawn(run: Run, tmp_path: Path, path: Path) -> None:
    words = ["plot", "ur3", "branches", "--poses", path, "-o", tmp_path / "a.png"]
    text = assert_good(run(*words)).out
    assert "waypoints         6\n" in text
    assert "without solution  1\n" in text
    workspace = assert_good(run("plot", "ur3", "-o", tmp_path / "a.png", *FEW)).out
    assert "picture         workspace\n" in workspace


def test_branches_are_all_solutions(made, line) -> None:
    robot, solver = made.robot("ur3"), made.solver("ur3")
    branches = _plots.find_branches(solver, line)
    assert branches.status.tolist() == [0] * 5 + [int(iksel.Status.out_of_reach)]
    assert branches.path.first_unreachable == 5
    errors = iksel.pose_error(line[branches.waypoint], robot.fk(branches.q))
    assert max(np.max(e) for e in errors) <= 1e-6 + 1e-12
    for index, pose in enumerate(line[:5]):
        found = solver.solve_all(pose)
        np.testing.assert_array_equal(branches.q[branches.waypoint == index], found.q)


@pytest.mark.parametrize("joint", range(6))
def test_whole_turns_are_those_inside_the_limits(made, line, joint: int) -> None:
    robot, solver = made.robot("ur3"), made.solver("ur3")
    branches = _plots.find_branches(solver, line[:1])
    _, values = _plots.whole_turns(robot, joint, branches)
    copies = solver.solve_all(line[0], 4096, whole_turns=True).q[:, joint]
    assert len(copies) < 4096
    expected = np.unique(np.round(copies, 4))
    np.testing.assert_allclose(np.unique(np.round(values, 4)), expected, atol=2e-4)


def test_joints_without_limits_and_slides_have_no_whole_turns() -> None:
    robot = iksel.load_robot("gen3_6dof")
    assert np.isinf(robot.upper[0])
    pose = robot.fk([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    solver = iksel.Solver(robot, iksel.SolverOptions(database={"samples": 500}))
    branches = _plots.find_branches(solver, pose[None])
    _, values = _plots.whole_turns(robot, 0, branches)
    np.testing.assert_array_equal(values, branches.q[:, 0])


def test_largest_in_cells_is_that_of_a_loop() -> None:
    random = np.random.default_rng(5)
    across, along, values = random.uniform(size=(3, 300))
    edges = [np.linspace(0, 1, 9), np.linspace(0, 1, 7)]
    found = _plots.largest_in_cells(across, along, values, edges)
    assert found.shape == (8, 6)
    for i, j in np.ndindex(found.shape):
        inside = (across >= edges[0][i]) & (across < edges[0][i + 1])
        inside &= (along >= edges[1][j]) & (along < edges[1][j + 1])
        if inside.any():
            assert found[i, j] == values[inside].max()
        else:
            assert np.isnan(found[i, j])


def test_every_configuration_is_in_the_picture(made) -> None:
    robot = made.robot("panda")
    q = robot.random_configurations(2000, seed=1)
    figure = _plots.workspace_figure(robot, q)
    side, above = [axes for axes in figure.axes if axes.get_title()]
    position = robot.fk(q)[:, :3, 3]
    for axes, columns in ((side, [0, 2]), (above, [0, 1])):
        (mesh,) = axes.collections
        corners = mesh.get_coordinates()
        for axis, column in enumerate(columns):
            assert corners[..., axis].min() <= position[:, column].min()
            assert corners[..., axis].max() >= position[:, column].max()
        assert np.nanmax(mesh.get_array()) == 1


def test_branches_have_limits_and_units(made, line) -> None:
    robot = made.robot("ur3")
    branches = _plots.find_branches(made.solver("ur3"), line)
    for degrees, unit, scale in ((False, "rad", 1), (True, "deg", 180 / np.pi)):
        angles = Angles(argparse.Namespace(degrees=degrees))
        figure = _plots.branches_figure(robot, branches, angles)
        assert len(figure.axes) == 6
        for joint, axes in enumerate(figure.axes):
            assert axes.get_ylabel() == f"{robot.joint_names[joint]}\n[{unit}]"
            lower, upper, dots, way = (np.asarray(x.get_ydata()) for x in axes.lines)
            assert lower[0] == pytest.approx(robot.lower[joint] * scale)
            assert upper[0] == pytest.approx(robot.upper[joint] * scale)
            np.testing.assert_allclose(way, branches.path.q[:, joint] * scale)
            near = np.abs(dots[:, None] - way).min(axis=0)
            assert near.max() < 1e-4 * scale  # the path goes through the solutions


BAD = [
    ("ur3", "-o/--output"),
    ("ur3 -o a.txt", r"'a\.txt': a picture's name ends in one of \.png, \.svg, \.pdf"),
    ("ur3 -o absent/a.png", "'absent/a.png' cannot be written: No such file"),
    ("ur3 volume -o a.png", "'volume'.*workspace.*manipulability.*branches"),
    ("ur3 branches -o a.png", "branches: needs a path, --poses FILE"),
    ("ur3 branches -o a.png --poses absent", "absent: No such file"),
    ("ur3 branches -o a.png --poses x --seed 1", "--seed: .*'branches' does not read"),
    ("ur3 -o a.png --poses x", "--poses: the picture 'workspace' does not read it"),
    ("ur3 -o a.png --configurations 0", "--configurations: 0 is less than 1"),
    ("ur33 -o a.png", "no built-in robot 'ur33'"),
]


@pytest.mark.parametrize(("words", "culprit"), BAD)
def test_bad_input_is_one_line(
    run: Run,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    words: str,
    culprit: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    few = "" if "branches" in words or "--conf" in words else " --configurations 50"
    assert_bad(run(f"plot {words}{few}"), culprit)
    assert list(tmp_path.iterdir()) == []


def test_a_missing_matplotlib_is_named_with_what_installs_it(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    words = ["plot", "ur3", "-o", tmp_path / "a.png", *FEW]
    assert_bad(run(*words), r"iksel plot needs matplotlib.*pip install 'iksel\[plot\]'")
    assert list(tmp_path.iterdir()) == []


def test_a_picture_that_cannot_be_drawn_leaves_the_old(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise MemoryError

    file = tmp_path / "a.png"
    file.write_bytes(b"old")
    monkeypatch.setattr(cli.plot.plots, "workspace_figure", fail)
    assert_bad(run("plot", "ur3", "-o", file, *FEW), "memory")
    assert file.read_bytes() == b"old"
