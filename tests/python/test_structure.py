# SPDX-License-Identifier: BSD-3-Clause
"""What follows from how a robot's axes lie, and failures that are proven by it."""

from __future__ import annotations

import numpy as np
import pytest

import iksel

SEED = 19
COUNT = 100

none = iksel.Proof.none
reach = iksel.Proof.reach
closed_form = iksel.Proof.closed_form
answer = iksel.Proof.answer


def turned_at_random(robot: iksel.Robot) -> np.ndarray:
    """Positions that are reached, each with some rotation or other."""
    poses = robot.fk(robot.random_configurations(COUNT, SEED))
    rng = np.random.default_rng(SEED)
    for pose in poses:
        rotation, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        pose[:3, :3] = rotation * np.linalg.det(rotation)
    return poses


@pytest.fixture(scope="module")
def solver(made) -> iksel.Solver:
    return made.solver("ur3")


@pytest.fixture(scope="module")
def poses(solver) -> np.ndarray:
    """Some with solutions, some without, and at the end some out of reach."""
    poses = turned_at_random(solver.robot)
    poses[-10:, :3, 3] += 5.0
    return poses


# Structure


@pytest.mark.parametrize("name", ["ur3", "irb120", "vs060"])
def test_arms_in_closed_form(made, name: str) -> None:
    structure = made.robot(name).structure
    assert structure.kind is iksel.StructureKind.closed_form
    assert "axes" in structure.description
    assert structure.description.endswith("solved in closed form")


@pytest.mark.parametrize(("name", "joint"), [("panda", 7), ("iiwa14", 1), ("xarm7", 7)])
def test_arms_of_which_a_joint_is_swept(made, name: str, joint: int) -> None:
    structure = made.robot(name).structure
    assert structure.kind is iksel.StructureKind.swept
    assert f"angle of joint {joint}, which is swept" in structure.description


def six_axes(seed: int) -> iksel.Robot:
    """Six joints whose axes lie anyhow."""
    rng = np.random.default_rng(seed)
    joints = []
    for i in range(6):
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        numbers = [
            " ".join(map(repr, v.tolist())) for v in (rng.uniform(0.1, 0.3, 3), axis)
        ]
        joints.append(
            f'<link name="link{i + 1}"/><joint name="joint{i + 1}" type="revolute">'
            f'<parent link="link{i}"/><child link="link{i + 1}"/>'
            f'<origin xyz="{numbers[0]}"/><axis xyz="{numbers[1]}"/>'
            '<limit lower="-3" upper="3" effort="1" velocity="1"/></joint>'
        )
    text = f'<robot name="any"><link name="link0"/>{"".join(joints)}</robot>'
    return iksel.load_robot(text)


@pytest.mark.parametrize("seed", range(3))
def test_axes_that_lie_anyhow_are_swept(seed: int) -> None:
    robot = six_axes(seed)
    assert robot.structure.kind is iksel.StructureKind.swept
    assert "axes that lie anyhow" in robot.structure.description
    solver = iksel.Solver(robot)
    reached = robot.random_configurations(COUNT, SEED)
    concluded = 0
    for q, pose in zip(reached, robot.fk(reached), strict=True):
        found = solver.solve_all(pose)
        concluded += found.proof is iksel.Proof.sweep
        assert min(np.abs(other.q - q).max() for other in found) < 0.02, f"seed {SEED}"
    assert concluded >= 0.9 * COUNT, f"seed {SEED}"
    missed = [
        result for result in map(solver.solve, turned_at_random(robot)) if not result
    ]
    swept = [result.proof is iksel.Proof.sweep for result in missed]
    assert len(swept) > 0
    assert sum(swept) >= 0.8 * len(swept), f"seed {SEED}"
    assert not any(
        result.proven for result in missed if result.proof is iksel.Proof.sweep
    )


@pytest.mark.parametrize("name", ["irb14050", "baxter_right"])
def test_arms_that_are_searched(made, name: str) -> None:
    structure = made.robot(name).structure
    assert structure.kind is iksel.StructureKind.searched
    assert structure.description.endswith("solved by search")


def test_a_structure_shows_its_kind_and_description(made) -> None:
    structure = made.robot("ur3").structure
    assert repr(structure) == f"Structure(closed_form: {structure.description})"
    with pytest.raises(AttributeError):
        structure.kind = iksel.StructureKind.searched


def test_a_joint_less_is_another_structure(made) -> None:
    wrist = made.robot("ur3").joint_names[-1]
    locked = iksel.load_robot("ur3", locked_joints={wrist: 0.0})
    assert locked.structure.kind is iksel.StructureKind.closed_form
    assert "only 5 joints" in locked.structure.description


# Proofs


def test_beyond_reach_is_proven_for_every_arm(made) -> None:
    for name in ("ur3", "panda"):
        pose = np.eye(4)
        pose[0, 3] = 9.0
        solver = made.solver(name)
        for found in (solver.solve(pose), solver.solve_all(pose)):
            assert found.status is iksel.Status.out_of_reach
            assert found.proof is reach
            assert found.proven is True


def test_failures_of_closed_forms_are_proven(solver, poses) -> None:
    seen = set()
    for pose in poses:
        result = solver.solve(pose)
        seen.add((result.success, result.proof))
        assert result.proven is (result.proof not in {none, answer})
        assert not (result.success and result.proven)
        found = solver.solve_all(pose)
        assert found.success is result.success
        if result.proven:
            assert (len(found), found.proof) == (0, result.proof)
    expected = {(True, answer), (False, closed_form), (False, reach)}
    assert expected <= seen, f"seed {SEED}"


def test_nothing_is_found_where_there_is_none(made, solver, poses) -> None:
    searching = made.solver("ur3", "paper")
    assert searching.solve(poses[-1]).proof is reach
    for pose in poses:
        if solver.solve(pose).proof is closed_form:
            other = searching.solve(pose)
            assert not other, f"seed {SEED}"
            assert not other.proven


@pytest.mark.parametrize("name", ["ur3", "irb120", "vs060", "cvr038", "panda"])
def test_what_has_a_solution_is_never_proven_to_have_none(made, name: str) -> None:
    robot = made.robot(name)
    poses = robot.fk(robot.random_configurations(COUNT, SEED))
    batch = made.solver(name).solve_batch(poses)
    assert (batch.proof == answer).all(), f"seed {SEED}"
    for pose in poses[:10]:
        assert not made.solver(name).solve(pose, near=robot.lower.clip(-1)).proven


def test_all_solutions_are_all_that_there_are(solver, poses) -> None:
    complete = [found for found in map(solver.solve_all, poses) if found.success]
    assert complete
    assert all(found.proof in {answer, closed_form} for found in complete)
    assert any(found.proven for found in complete)


def test_a_search_proves_nothing(made) -> None:
    robot = made.robot("irb14050")
    batch = made.solver("irb14050").solve_batch(turned_at_random(robot))
    missed = batch[~batch.success]
    assert len(missed) > 0
    assert set(missed.proof.tolist()) <= {none, reach}
    assert "proven" not in repr(missed[missed.proof == none][0])


# Batches


@pytest.mark.parametrize("near", [None, np.zeros(6)])
def test_the_proofs_of_a_batch_are_those_of_its_rows(solver, poses, near) -> None:
    broken = np.concatenate([poses, np.zeros((1, 4, 4))])
    batch = solver.solve_batch(broken, near=near)
    assert (batch.proof.dtype, batch.proof.shape) == ("uint8", (COUNT + 1,))
    proofs = [solver.solve(pose, near=near).proof for pose in poses]
    assert batch.proof.tolist() == [*proofs, none]
    assert [row.proof for row in batch] == [*proofs, none]
    assert (batch.proof[-11:-1] == reach).all()
    assert (batch.proof == closed_form).any()


# Text


def test_answers_say_that_they_are_proven(solver, poses) -> None:
    batch = solver.solve_batch(poses)
    i = int(np.flatnonzero(batch.proof == closed_form)[0])
    result, found = solver.solve(poses[i]), solver.solve_all(poses[i])
    start = f"{result.status}, proven: closed_form, "
    assert repr(result).startswith(f"Result({start}attempts=")
    assert repr(found) == f"Solutions({start}0 solutions)"
    assert repr(batch[i]) == repr(result)
    assert "<td>closed_form</td>" in result._repr_html_()
    assert "proven: closed_form" in found._repr_html_()
    cells = batch[i : i + 1]._repr_html_()
    assert "<th>proof</th>" in cells
    assert "<td>closed_form</td>" in cells


def test_successes_say_nothing_of_proofs(solver, poses) -> None:
    batch = solver.solve_batch(poses)
    result = batch[int(np.flatnonzero(batch.success)[0])]
    assert "prove" not in repr(result)
    assert "proof" not in result._repr_html_()
