# SPDX-License-Identifier: BSD-3-Clause
"""Answers say what they are: as truth values, as text, as tables and to mypy."""

from __future__ import annotations

import html.parser
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest

import iksel

ENUMS = [
    thing
    for thing in vars(iksel).values()
    if isinstance(thing, type) and hasattr(thing, "__members__")
]


@pytest.fixture(scope="module")
def solver(made) -> iksel.Solver:
    return made.solver("ur3")


@pytest.fixture(scope="module")
def poses(solver) -> np.ndarray:
    """Three that are solved and one out of reach."""
    poses = solver.robot.fk(solver.robot.random_configurations(4, 11))
    poses[3, :3, 3] = 50.0
    return poses


# Truth


def test_answers_are_true_when_they_are_answers(solver, poses) -> None:
    for pose, good in zip(poses, (True, True, True, False), strict=True):
        for answer in (
            solver.solve(pose),
            solver.solve(pose, near=np.zeros(6)),
            solver.solve_batch(pose[None])[0],
            solver.solve_all(pose),
            solver.solve_path(pose[None]),
        ):
            assert bool(answer) is answer.success is good
        assert bool(solver.diagnose(pose)) is good
        tracked = solver.tracker(np.zeros(6)).track(pose, dt=100.0)
        assert bool(tracked) is tracked.success is good


def test_a_step_that_was_too_fast_is_no_success(solver, poses) -> None:
    tracked = solver.tracker(np.zeros(6)).track(poses[0], dt=1e-6)
    assert tracked.status is iksel.Status.too_fast
    assert not tracked


@pytest.mark.parametrize("count", [0, 1, 4])
def test_the_truth_of_a_batch_is_ambiguous(solver, poses, count: int) -> None:
    batch = solver.solve_batch(poses[:count])
    with pytest.raises(iksel.InvalidArgumentError, match=r"success\.all\(\)") as error:
        bool(batch)
    assert f"{count} answers" in str(error.value)


# Text


def test_a_result_shows_its_joints_and_errors(solver, poses) -> None:
    result = solver.solve(poses[0])
    text = str(result)
    shown = text[text.index("[") + 1 : text.index("]")].split(", ")
    np.testing.assert_allclose(np.array(shown, dtype=float), result.q, rtol=1e-4)
    assert text.startswith("Result(solved, q=[")
    assert f"position_error={result.position_error:.3g}" in text
    assert f"rotation_error={result.rotation_error:.3g}" in text
    assert len(text) < 200
    assert str(solver.solve(poses[3])).startswith(
        "Result(out_of_reach, proven: reach, attempts=0"
    )


def test_other_answers_show_theirs(solver, poses) -> None:
    found = solver.solve_all(poses[0])
    assert f"Solutions(solved, {len(found)} solutions, best q=[" in repr(found)
    assert repr(solver.solve_all(poses[3])) == (
        "Solutions(out_of_reach, proven: reach, 0 solutions)"
    )
    assert repr(solver.solve_batch(poses)) == "BatchResult(3 of 4 solved)"


@pytest.mark.parametrize("enum", ENUMS, ids=lambda enum: enum.__name__)
def test_members_of_enums_are_written_by_name(enum) -> None:
    assert len(enum) > 0
    for member in enum:
        assert str(member) == f"{member}" == member.name
        assert f"{member:>20}" == member.name.rjust(20)
        assert member.name in repr(member)


def test_all_bound_enums_are_tried() -> None:
    assert {"Status", "Proof", "Cause", "ObjectiveKind"} <= {
        enum.__name__ for enum in ENUMS
    }


# Tables


class Table(html.parser.HTMLParser):
    """The cells of a page, and a check that every tag is closed."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.cells: list[str] = []
        self.rows = 0
        self.feed(page)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs) -> None:
        assert tag in {"table", "caption", "thead", "tbody", "tr", "th", "td"}
        self.open.append(tag)
        self.rows += tag == "tr"
        if tag in {"th", "td", "caption"}:
            self.cells.append("")

    def handle_endtag(self, tag) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data) -> None:
        if self.open and self.open[-1] in {"th", "td", "caption"}:
            self.cells[-1] += data


def test_tables_of_robots(made) -> None:
    robot = made.robot("panda")
    table = Table(robot._repr_html_())
    assert table.rows == 1 + robot.dof
    for name, lower in zip(robot.joint_names, robot.lower, strict=True):
        assert name in table.cells
        assert f"{lower:.5g}" in table.cells


def test_tables_are_escaped(made) -> None:
    urdf = made.robot("ur3").urdf
    joint = made.robot("ur3").joint_names[0]
    evil = "&lt;b&gt;&amp;&quot;"
    robot = iksel.Robot.from_urdf(
        urdf.replace(f'"{joint}"', f'"{evil}"'), base_link="base_link", tip_link="tool0"
    )
    assert robot.joint_names[0] == '<b>&"'
    assert '<b>&"' in Table(robot._repr_html_()).cells


def test_tables_of_answers(solver, poses) -> None:
    result = solver.solve(poses[0])
    table = Table(result._repr_html_())
    assert "solved" in table.cells
    assert f"{result.position_error:.3g}" in table.cells
    failed = Table(solver.solve(poses[3])._repr_html_()).cells
    assert "out_of_reach" in failed
    assert failed[failed.index("proof") + 1] == "reach"
    found = solver.solve_all(poses[0])
    assert Table(found._repr_html_()).rows == 1 + len(found)
    for q in found.q:
        assert f"{q[0]:.5g}" in Table(found._repr_html_()).cells
    batch = solver.solve_batch(poses)
    table = Table(batch._repr_html_())
    assert table.rows == 1 + len(batch)
    assert table.cells.count("solved") == 3
    assert table.cells.count("reach") == 1
    assert "3 of 4 solved" in table.cells


def test_tables_stay_small(solver, poses) -> None:
    batch = solver.solve_batch(np.tile(poses, (250, 1, 1)))
    table = Table(batch._repr_html_())
    assert table.rows < 30
    assert any("980 more" in cell for cell in table.cells)


# Rows


def test_rows_of_a_batch_are_a_batch(solver, poses) -> None:
    batch = solver.solve_batch(np.concatenate([poses, poses]), near=np.zeros(6))
    mask = np.arange(8) % 3 == 0
    for index in (
        slice(1, 3), slice(None, None, -2), slice(5, 2), slice(None), mask, ~mask,
        [3, 1, -1], np.array([7, 7], dtype=np.uint8), [], np.array([], int),
        np.zeros(8, dtype=bool), mask.tolist(),
    ):  # fmt: skip
        part = batch[index]
        assert type(part) is iksel.BatchResult
        rows = np.arange(8)[index]
        assert [repr(row) for row in part] == [repr(batch[int(i)]) for i in rows]
        assert part.solved == batch.success[rows].sum()
        for name in (
            "q",
            "success",
            "status",
            "proof",
            "position_error",
            "attempts",
            "move",
        ):
            one, other = getattr(part, name), getattr(batch, name)
            np.testing.assert_array_equal(one, other[rows], err_msg=name)
            assert not np.shares_memory(one, other)


@pytest.mark.parametrize(
    "index", ["0", 1.5, None, (0, 1), [0.5], np.zeros((2, 2), dtype=int), True, ...]
)
def test_other_indices_are_refused(solver, poses, index: object) -> None:
    with pytest.raises(iksel.InvalidArgumentError, match="^i: expected an int"):
        solver.solve_batch(poses)[index]


@pytest.mark.parametrize("index", [[4], [True], np.array([-5])])
def test_rows_beyond_the_batch_are_refused(solver, poses, index: object) -> None:
    with pytest.raises(IndexError):
        solver.solve_batch(poses)[index]


# Types


def mypy(program: str, folder: Path) -> str:
    file = folder / "program.py"
    file.write_text(textwrap.dedent(program), encoding="utf-8")
    source = Path(iksel.__file__).parents[1]
    stubs = folder / "stubs"
    if (
        not stubs.exists()
    ):  # which mypy finds beside a package only where that is installed
        stubs.mkdir()
        (stubs / "iksel").symlink_to(source / "iksel")
        (stubs / "iksel_cpp").symlink_to(source / "iksel_cpp-stubs")
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(folder), file],
        capture_output=True,
        text=True,
        check=False,
        cwd=folder,
        env={"MYPYPATH": str(stubs)},
    )
    assert done.stderr == ""
    return done.stdout


@pytest.mark.slow
def test_mypy_knows_that_a_success_has_joint_values(tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    head = """
        import numpy as np
        from numpy.typing import NDArray
        import iksel

        def move(q: NDArray[np.float64]) -> None: ...

        def follow(solver: iksel.Solver, pose: NDArray[np.float64]) -> None:
            result: iksel.Result = solver.solve(pose)
    """
    right = """
            if result.success:
                move(result.q)
            if result:
                move(result.q)
            if result.q is not None:
                move(result.q)
            assert isinstance(result, iksel.Result)
            for row in solver.solve_batch(pose[None]):
                if not row:
                    continue
                move(row.q)
            if step := solver.tracker(np.zeros(6)).track(pose, 0.1):
                move(step.q)
    """
    assert mypy(head + right, tmp_path).startswith("Success")
    for wrong in ("move(result.q)", "move(result.q) if not result else None"):
        output = mypy(head + f"\n            {wrong}\n", tmp_path)
        assert "[arg-type]" in output, output
