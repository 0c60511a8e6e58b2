# SPDX-License-Identifier: BSD-3-Clause
"""Tasks, objectives, diagnoses, derivatives and calibrated arms from Python."""

from __future__ import annotations

import math
import pickle
import re

import iksel_cpp
import numpy as np
import pytest
from command_line import Run, assert_bad, assert_good
from conftest import CASES

import iksel

FACTORIES = [
    iksel.Task.pose(),
    iksel.Task.position_only(),
    iksel.Task.free_spin("x"),
    iksel.Task.upright(),
    iksel.Task.planar(iksel.Axis.y),
    iksel.Task.box([0.01, 0.02, 0.03], [0.1, 0.2, math.inf], frame="base"),
    iksel.Task(position_lower=[0, 0, -0.02], frame="base"),
]


def angle_between(a, b) -> float:
    return math.atan2(np.linalg.norm(np.cross(a, b)), a @ b)


@pytest.mark.parametrize("task", FACTORIES, ids=repr)
def test_tasks_survive_pickling_and_dicts(task: iksel.Task) -> None:
    assert pickle.loads(pickle.dumps(task)) == task
    assert iksel.Task(**task.to_dict()) == task
    options = iksel.SolverOptions(task=task)
    assert options.task == task
    again = pickle.loads(pickle.dumps(options))
    assert again == options
    assert again.task == task
    assert iksel.SolverOptions(**options.to_dict()) == options


def test_tasks_say_what_they_are() -> None:
    assert [task.constrained_axes for task in FACTORIES] == [6, 3, 5, 5, 3, 5, 6]
    assert [task.is_full_pose for task in FACTORIES] == [True, *[False] * 6]
    assert iksel.SolverOptions().task == iksel.Task.pose()
    free = iksel.Task.free_spin()
    assert free.rotation_upper == (0, 0, math.inf)
    assert free != iksel.Task.free_spin("y")
    assert hash(free) == hash(iksel.Task.free_spin("z"))
    with pytest.raises(AttributeError):
        free.frame = "base"


@pytest.mark.parametrize(
    ("make", "match"),
    [
        (lambda: iksel.Task(position_lower=[1, 0, 0]), "position x: 1 .. 0"),
        (lambda: iksel.Task(rotation_upper=[0, 4, 0]), "rotation y: 0 .. 4"),
        (lambda: iksel.Task.box([-1, 0, 0], [0, 0, 0]), "position x"),
        (lambda: iksel.Task.free_spin("w"), "axis: expected one of x, y, z"),
        (lambda: iksel.Task(frame="world"), "frame: expected one of base, tool"),
        (
            lambda: iksel.Task(position_upper=[1, 2]),
            "position_upper: expected 3 numbers",
        ),
        (
            lambda: iksel.Task.box([math.inf] * 3, [math.inf] * 3),
            "all six axes are free",
        ),
    ],
)
def test_bad_tasks_are_refused(make, match: str) -> None:
    with pytest.raises(iksel.InvalidArgumentError, match=match):
        make()


@pytest.mark.parametrize("name", ["ur3", "panda", "xarm5"])
def test_a_task_of_a_call_or_of_the_options(made, name: str) -> None:
    robot = made.robot(name)
    task = iksel.Task.free_spin()
    plain = made.solver(name)
    for_all = iksel.Solver(robot, iksel.SolverOptions(task=task), plain.database)
    targets = robot.fk(robot.random_configurations(CASES, 5))
    batch = for_all.solve_batch(targets)
    assert batch.solved == CASES
    for target, row in zip(targets, batch, strict=True):
        for result in (plain.solve(target, task=task), row):
            assert result.success
            pose = robot.fk(result.q)
            assert np.linalg.norm(pose[:3, 3] - target[:3, 3]) <= 1e-6
            assert angle_between(pose[:3, 2], target[:3, 2]) <= 1e-6


def test_boxes_are_used(made) -> None:
    """Where the exact pose is out of reach, its box is not."""
    solver = made.solver("ur3")
    target = iksel.pose_from_euler([solver.robot.reach, 0, 0.152], [0, 0, 0])
    far = iksel.pose_from_euler([0.45, 0.1, 0.2], [0.3, 0.2, 0.1])
    box = iksel.Task.box([0.2, 0.2, 0.2], [math.pi] * 3, frame="base")
    assert not solver.solve(target).success
    result = solver.solve(target, task=box)
    assert result.success
    off = np.abs(solver.robot.fk(result.q)[:3, 3] - target[:3, 3])
    assert (off <= 0.2 + 1e-9).all()
    assert solver.solve(far, task=iksel.Task.position_only()).success


def test_nearest_and_all_solutions_of_a_task(made) -> None:
    solver = made.solver("ur3")
    robot = solver.robot
    task = iksel.Task.free_spin()
    for q in robot.random_configurations(20, 6):
        target = robot.fk(q)
        near = solver.solve(target, near=q, task=task)
        assert near.move <= solver.solve(target, near=q).move + 1e-6
        found = solver.solve_all(target, 8, task=task)
        assert found.success
        for one in found:
            assert angle_between(robot.fk(one.q)[:3, 2], target[:3, 2]) <= 1e-6


# Objectives


@pytest.mark.parametrize("name", ["ur3", "panda"])
def test_objectives_improve_answers(made, name: str) -> None:
    solver = made.solver(name)
    robot = solver.robot
    posture = robot.random_configurations(1, 9)[0]

    def wish(q):
        return float(np.sum(np.cos(q)))

    def slope(q):
        return -np.sin(q)

    def distance(q):
        return 0.5 * np.sum((q - posture) ** 2)

    def lost_manipulability(q):
        jacobian = robot.jacobian(q)
        return -math.sqrt(np.linalg.det(jacobian @ jacobian.T))

    objectives = [
        (iksel.Objective.near_posture(posture), distance),
        ("manipulability", lost_manipulability),
        (wish, wish),
        (iksel.Objective.custom(wish, slope), wish),
    ]
    for q in robot.random_configurations(max(2, CASES // 20), 10):
        target = robot.fk(q)
        plain = solver.solve(target)
        for objective, cost in objectives:
            result = solver.solve(target, objective=objective)
            assert result.success
            assert np.abs(iksel.pose_error(target, robot.fk(result.q))).max() <= 1e-6
            assert result.cost == pytest.approx(cost(result.q), abs=1e-9)
            assert result.cost <= cost(plain.q) + 1e-6
        assert math.isnan(plain.cost)
        assert solver.solve(target, objective="limits").success


@pytest.mark.parametrize("value", [math.nan, -math.inf])
@pytest.mark.parametrize("name", ["ur3", "panda"])
def test_a_cost_that_is_no_number_is_an_error(made, name, value) -> None:
    solver = made.solver(name)
    targets = solver.robot.fk(solver.robot.random_configurations(20, 1))
    message = r"^objective: the cost is -?(nan|inf) at q = \[.*\+infinity"

    def sometimes(q):
        return value if q[1] > 0 else float(q @ q)

    for objective in (lambda _: value, iksel.Objective.custom(lambda _: value)):
        with pytest.raises(iksel.InvalidArgumentError, match=message):
            solver.solve(targets[0], objective=objective)
    for threads in (1, 2, 5):
        with pytest.raises(iksel.InvalidArgumentError, match=message):
            solver.solve_batch(targets, objective=sometimes, threads=threads)
    gradient = iksel.Objective.custom(lambda q: float(q @ q), lambda q: value * q)
    with pytest.raises(iksel.InvalidArgumentError, match="gradient"):
        made.solver("panda").solve(
            made.robot("panda").fk(np.array([0.1, 0.2, 0.3, -1, 0.5, 1, 0.7])),
            objective=gradient,
        )


@pytest.mark.parametrize("name", ["ur3", "panda"])
def test_an_infinite_cost_refuses(made, name) -> None:
    solver = made.solver(name)
    robot = solver.robot
    asked = solver.solve_batch(
        robot.fk(robot.random_configurations(CASES, 3)),
        objective=lambda q: float(q @ q) if q[0] >= 0 else math.inf,
    )
    refused = asked.status == iksel.Status.rejected
    assert (asked.success | refused).all()
    assert asked.solved > CASES / 2
    assert asked.q[asked.success, 0].min() >= 0
    never = solver.solve(
        robot.fk(robot.random_configurations(1, 3)[0]), objective=lambda _: math.inf
    )
    assert never.status == iksel.Status.rejected
    assert math.isnan(never.cost)


@pytest.mark.parametrize("name", ["ur5e", "irb120"])
def test_the_nearest_spin_leaves_the_last_joint(made, name: str) -> None:
    """The task does not feel its angle, so that each branch has one nearest answer."""
    solver = made.solver(name)
    robot, task = solver.robot, iksel.Task.free_spin("z")
    q, starts = (robot.random_configurations(100, seed=seed) for seed in (1, 2))
    for known, start in zip(q, starts, strict=True):
        pose = robot.fk(known)
        near = solver.solve(pose, task=task, near=start)
        others = solver.solve_all(pose, task=task, near=start, max=256)
        assert near
        assert near.move <= others[0].move + 1e-4  # within the tolerances
        assert near.move <= np.linalg.norm(known - start) + 1e-6
        assert near.q[-1] == pytest.approx(start[-1], abs=1e-9)


def test_what_was_near_is_not_what_is_diagnosed(made) -> None:
    """What a task does not feel stays at `near` for that call only."""
    solver = made.solver("ur5e")
    robot, task = solver.robot, iksel.Task.free_spin("z")
    far = robot.fk(robot.random_configurations(20, seed=3))
    far[:, :3, 3] *= 1.2
    fresh = [iksel.Solver(robot).diagnose(pose, task=task) for pose in far]
    for pose, expected in zip(far, fresh, strict=True):
        solver.solve(pose, task=task, near=robot.upper)
        assert repr(solver.diagnose(pose, task=task)) == repr(expected)


@pytest.mark.parametrize("name", ["panda", "iiwa14", "xarm7", "fr3"])
@pytest.mark.parametrize("objective", ["limits", "manipulability"])
def test_no_solution_of_seven_joints_is_better(made, name: str, objective: str) -> None:
    """Solutions all over the self-motion are looked at, not only where seeds lead."""
    solver = made.solver(name)
    for pose in solver.robot.fk(solver.robot.random_configurations(60, seed=1)):
        best = solver.solve_all(pose, objective=objective)[0].cost
        assert solver.solve(pose, objective=objective).cost <= best + 1e-3 * abs(best)


@pytest.mark.parametrize("name", ["irb14050", "synthetic10", "ur5e"])
@pytest.mark.parametrize("objective", ["limits", "manipulability"])
def test_no_solution_found_at_random_is_better(made, name: str, objective: str) -> None:
    """Where no joint is swept, solve leaves out nothing that solve_all sees."""
    solver = made.solver(name)
    tasks = [iksel.Task.free_spin(), iksel.Task.position_only()]
    if solver.robot.dof > 6:
        tasks.append(iksel.Task.pose())
    seed = 1
    for pose in solver.robot.fk(solver.robot.random_configurations(20, seed)):
        for task in tasks:
            wish = {"objective": objective, "task": task}
            best = solver.solve_all(pose, **wish)[0].cost
            cost = solver.solve(pose, **wish).cost
            assert cost <= best + 1e-6 * abs(best), f"{task}, seed {seed}"


def test_exceptions_of_an_objective_reach_the_caller(made) -> None:
    solver = made.solver("panda")
    target = solver.robot.fk(solver.robot.random_configurations(1, 1)[0])

    def broken(q):
        raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        solver.solve(target, objective=broken)
    with pytest.raises(iksel.InvalidArgumentError, match="cost: expected a number"):
        solver.solve(target, objective=lambda q: "cheap")
    with pytest.raises(iksel.InvalidArgumentError, match="objective: expected"):
        solver.solve(target, objective="beauty")
    with pytest.raises(iksel.InvalidArgumentError, match="objective posture"):
        solver.solve(target, objective=iksel.Objective.near_posture([0, 0]))


# Diagnoses


def test_diagnoses(made) -> None:
    solver = made.solver("ur3")
    robot = solver.robot
    reached = robot.fk([0.3, -1.1, 1.2, 0.4, 0.9, 0.2])

    fine = solver.diagnose(reached)
    assert (fine.cause, fine.q_is_solution) == (iksel.Cause.none, True)

    far = solver.diagnose(iksel.pose_from_euler([2, 0, 0.2], [0, 0, 0]))
    assert far.cause is iksel.Cause.out_of_reach
    # The links of a UR3 add up to about 0.55 m from the shoulder's axis.
    assert 1.3 < far.beyond_reach < 1.6
    assert far.position_error >= far.beyond_reach - 1e-6
    assert math.isnan(far.rotation_gap)
    assert not far.q_is_solution
    assert robot.within_limits(far.q)
    assert "beyond" in far.message
    assert re.fullmatch(r"Diagnosis\(out_of_reach: .*\)", repr(far))

    refused = solver.diagnose(reached, filter=lambda q: np.zeros(len(q), bool))
    assert refused.cause is iksel.Cause.rejected
    assert refused.refused == len(solver.solve_all(reached))

    # Not solved in closed form.
    robot = iksel.load_robot("cvr038")
    reached = robot.fk(robot.random_configurations(1, seed=1)[0])
    hurried = iksel.Solver(robot, iksel.SolverOptions(max_attempts=1, max_iterations=1))
    budget = hurried.diagnose(reached)
    assert budget.cause is iksel.Cause.budget
    assert np.abs(iksel.pose_error(reached, robot.fk(budget.q))).max() <= 1e-6


def test_a_diagnosis_names_the_joint(made) -> None:
    arm = made.robot("cvr038")
    solver = made.solver("cvr038")
    diagnosed = 0
    for q in arm.random_configurations(20, 8):
        q[2] = arm.lower[2] - 0.2
        target = arm.fk(q)
        # Another branch may lie inside the limits.
        if solver.solve(target).success:
            continue
        diagnosed += 1
        diagnosis = solver.diagnose(target)
        assert diagnosis.cause is iksel.Cause.joint_limits
        assert 0 <= diagnosis.joint < arm.dof
        assert 0 < diagnosis.limit_violation <= 0.2 + 1e-5
        assert arm.joint_names[diagnosis.joint] in diagnosis.message
    assert diagnosed > 0


def test_a_proven_no_is_explained_by_its_branches(made) -> None:
    arm = made.robot("irb120")
    solver = made.solver("irb120")
    poses = arm.fk(arm.random_configurations(60, 8))
    poses[:, :3, :3] = poses[::-1, :3, :3].copy()
    causes = set()
    for pose in poses:
        result = solver.solve(pose)
        diagnosis = solver.diagnose(pose)
        assert (diagnosis.proof, diagnosis.proven) == (result.proof, result.proven)
        if diagnosis.proof is not iksel.Proof.closed_form:
            continue
        causes.add(diagnosis.cause)
        assert diagnosis.attempts == 0
        assert diagnosis.message.startswith("certainly no answer: ")
        assert f"'{arm.joint_names[diagnosis.joint]}'" in diagnosis.message
        if diagnosis.cause is iksel.Cause.joint_limits:
            assert np.abs(iksel.pose_error(pose, arm.fk(diagnosis.branch))).max() < 1e-9
            outside = np.maximum(
                arm.lower - diagnosis.branch, diagnosis.branch - arm.upper
            )
            assert outside.argmax() == diagnosis.joint
            assert outside.max() == diagnosis.limit_violation > 0
        else:
            assert diagnosis.branch is None
    assert causes == {iksel.Cause.no_branch, iksel.Cause.joint_limits}


# Derivatives and calibrated arms


def test_inverse_jacobian_follows_a_moving_target(made) -> None:
    robot = made.robot("ur3")
    qs = robot.random_configurations(CASES, 11)
    derivatives = robot.inverse_jacobian(qs)
    assert derivatives.shape == (CASES, 6, 6)
    rng = np.random.default_rng(12)
    for q, derivative in zip(qs, derivatives, strict=True):
        np.testing.assert_array_equal(derivative, robot.inverse_jacobian(q))
        if np.linalg.norm(derivative) > 30:
            continue
        twist = 1e-6 * rng.normal(size=6)
        moved = robot.fk(q + derivative @ twist)
        error = iksel_cpp.pose_error(moved, robot.fk(q))
        np.testing.assert_allclose(error, twist, atol=1e-9)
        damped = robot.inverse_jacobian(q, damping=0.1)
        assert np.linalg.norm(damped, 2) <= 5 + 1e-9
    with pytest.raises(iksel.InvalidArgumentError, match="damping"):
        robot.inverse_jacobian(qs[0], damping=-1)


def test_a_calibrated_arm_uses_the_nominal_database(made) -> None:
    nominal = made.robot("ur3")
    rng = np.random.default_rng(13)

    def shift(match: re.Match[str]) -> str:
        values = np.array(match[2].split(), float) + 1e-3 * rng.uniform(-1, 1, 3)
        return f'<origin {match[1]}="{" ".join(map(repr, values.tolist()))}"'

    urdf = re.sub(r'<origin (xyz)="([^"]*)"', shift, nominal.urdf)
    robot = iksel.Robot.from_urdf(urdf, nominal.base_link, nominal.tip_link)
    database = iksel.Database.build(nominal)
    with pytest.raises(iksel.DatabaseMismatchError, match="another chain"):
        iksel.Solver(robot, database=database)
    solver = iksel.Solver(robot, database=database, nominal=nominal)
    assert 1e-4 < solver.calibration_deviation[0] < 0.02
    targets = robot.fk(robot.random_configurations(10 * CASES, 14))
    for one in (solver, pickle.loads(pickle.dumps(solver))):
        batch = one.solve_batch(targets)
        assert batch.solved >= 10 * CASES - 1
        for target, q in zip(targets, batch.q, strict=True):
            assert np.abs(iksel.pose_error(target, robot.fk(q))).max() <= 1e-6
        assert one.nominal.chain_hash == nominal.chain_hash
    with pytest.raises(iksel.DatabaseMismatchError, match="deviates by"):
        iksel.Solver(
            robot,
            database=database,
            nominal=nominal,
            max_calibration_deviation=(1e-6, 1e-6),
        )
    for wrong in ((-1.0, 0.1), (0.05, -1e-9), (np.nan, 0.1), (0.05, np.nan)):
        with pytest.raises(
            iksel.InvalidArgumentError,
            match=r"^option max_calibration_deviation: (-|nan).* is not in 0 \.\. inf$",
        ):
            iksel.Solver(robot, nominal=nominal, max_calibration_deviation=wrong)


# Command line


def test_tasks_on_the_command_line(run: Run) -> None:
    words = "evaluate xarm5 --task free_spin --targets 100 --json"
    out = assert_good(run(words)).json()
    assert out["solved"] == 100
    assert out["false_success"] == 0
    assert out["overrides"]["task"] == "free_spin"
    far = "solve ur3 --pose 0.9 0 0.3 0 0 0 "
    out = assert_good(run(far + "--diagnose --json"), 1).json()
    assert out["diagnosis"]["cause"] == "out_of_reach"
    assert out["diagnosis"]["best_effort_is_solution"] is False
    text = assert_good(run(far + "--diagnose"), 1).out
    assert "NO SOLUTION" in text
    assert "beyond" in text
    assert_good(run(far + "--task box:0.5,0.5,0.5,inf,inf,inf"))
    assert_bad(run(far + "--task sideways"), "position_only")
    assert_bad(run(far + "--task box:1,2"), "RX,RY,RZ")
    reached = "solve panda --from-q 0 -0.5 0 -2 0 1.6 0.8 --objective "
    assert_good(run(reached + "manipulability"))
    assert_good(run(reached + "limits --all"))


def test_paths_and_trackers_follow_a_task(made) -> None:
    """Any spin on the way: each waypoint's axis and position, none of its spin."""
    robot = made.robot("panda")
    task = iksel.Task.free_spin()
    solver = iksel.Solver(
        robot, iksel.SolverOptions(task=task), made.solver("panda").database
    )
    start = np.array([0.2, -0.4, 0.1, -2.0, 0.3, 1.7, 0.5])
    line = np.repeat(robot.fk(start)[np.newaxis], 20, axis=0)
    line[:, 0, 3] += np.linspace(0, 0.1, 20)
    spins = iksel.pose_from_euler([0, 0, 0], [0, 0, 1.0])
    line[1::2] = line[1::2] @ spins
    path = solver.solve_path(line, start)
    assert path.success
    tracker = solver.tracker(start)
    for pose, q in zip(line, path.q, strict=True):
        tracked = tracker.track(pose, 0.1)
        assert tracked.success
        for answer in (q, tracked.q):
            reached = robot.fk(answer)
            assert np.linalg.norm(reached[:3, 3] - pose[:3, 3]) <= 1e-6
            assert angle_between(reached[:3, 2], pose[:3, 2]) <= 1e-6
    # Spinning back and forth is not what the joints do.
    assert np.abs(np.diff(path.q, axis=0)).max() < 0.1
