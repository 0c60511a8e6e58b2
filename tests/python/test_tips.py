# SPDX-License-Identifier: BSD-3-Clause
"""Several tips at once, from Python."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from trees import two_armed, two_arms_on_torso
from tubes import URDF
from urdf_text import joint, limits, link, mimic, robot

import iksel
import iksel.exact
import iksel.spheres

SEED = 5


@pytest.fixture(scope="module")
def solver() -> iksel.Solver:
    return iksel.Solver(two_armed(iksel.load_robot("ur5e")))


@pytest.fixture(scope="module")
def targets(solver: iksel.Solver) -> np.ndarray:
    return solver.robot.fk(solver.robot.random_configurations(50, SEED))


def test_the_robot_is_the_union_of_its_chains(solver) -> None:
    robot = solver.robot
    assert robot.tips == 2
    assert robot.dof == 14 == len(robot.joint_names) == len(robot.joint_types)
    assert [robot.joint_names[i] for i in robot.shared_joints] == ["lift", "turn"]
    q = robot.random_configurations(4, SEED)
    poses = robot.fk(q)
    jacobians = robot.jacobian(q)
    assert poses.shape == (4, 2, 4, 4)
    assert jacobians.shape == (4, 12, 14)
    for tip in range(2):
        chain, columns = robot.chain(tip), robot.joints_of(tip)
        assert chain.joint_names == [robot.joint_names[j] for j in columns]
        np.testing.assert_array_equal(chain.fk(q[:, columns]), poses[:, tip])
        rows = slice(6 * tip, 6 * tip + 6)
        expected = np.zeros((4, 6, 14))
        expected[:, :, columns] = chain.jacobian(q[:, columns])
        np.testing.assert_array_equal(jacobians[:, rows], expected)
    assert robot.within_limits(q[0])
    assert not robot.within_limits(robot.upper + 0.1)


def test_pinocchio_agrees() -> None:
    pinocchio = pytest.importorskip("pinocchio")
    arm = iksel.load_robot("panda")
    robot = two_armed(arm)
    model = pinocchio.buildModelFromXML(two_arms_on_torso(arm))
    data = model.createData()
    q = robot.random_configurations(20, SEED)
    for row, poses, jacobian in zip(q, robot.fk(q), robot.jacobian(q), strict=True):
        values = np.zeros(model.nq)
        order = []
        for name, value in zip(robot.joint_names, row, strict=True):
            joint = model.joints[model.getJointId(name)]
            values[joint.idx_q] = value
            order.append(joint.idx_v)
        pinocchio.computeJointJacobians(model, data, values)
        pinocchio.updateFramePlacements(model, data)
        for tip, name in enumerate(robot.tip_links):
            frame = model.getFrameId(name)
            there = data.oMf[frame].homogeneous
            np.testing.assert_allclose(there, poses[tip], atol=1e-12)
            world = pinocchio.ReferenceFrame.LOCAL_WORLD_ALIGNED
            other = pinocchio.getFrameJacobian(model, data, frame, world)[:, order]
            np.testing.assert_allclose(
                other, jacobian[6 * tip : 6 * tip + 6], atol=1e-12
            )


def test_the_batch_is_the_loop(solver, targets) -> None:
    batch = solver.solve_batch(targets, threads=2)
    assert len(batch) == batch.solved == 50, f"seed {SEED}"
    assert batch.success.all()
    for i, (row, poses) in enumerate(zip(batch, targets, strict=True)):
        one = solver.solve(poses)
        assert one
        np.testing.assert_array_equal(one.q, batch.q[i])
        assert row.position_error == one.position_error
        error = solver.robot.fk(one.q)[:, :3, 3] - poses[:, :3, 3]
        assert np.linalg.norm(error, axis=1).max() < 1e-6
        assert solver.robot.within_limits(one.q)


def test_nearest_by_an_objective_is_as_near_as_by_near(solver, targets) -> None:
    """Which are two ways to ask for the same."""
    other = solver.robot.random_configurations(10, 2)
    for pose, near in zip(targets[::5], other, strict=True):
        posture = iksel.Objective.near_posture(near)
        by_objective = solver.solve(pose, objective=posture)
        asked = solver.solve(pose, near=near)
        lengths = [np.linalg.norm(each.q - near) for each in (by_objective, asked)]
        assert lengths[0] == pytest.approx(lengths[1], abs=1e-3)


def test_near_may_be_one_for_all_or_one_each(solver, targets) -> None:
    q = solver.robot.random_configurations(50, SEED)
    each = solver.solve_batch(targets[:5], near=q[:5])
    np.testing.assert_allclose(each.move, 0, atol=1e-9)
    same = solver.solve_batch(targets[:5], near=q[0], norm="max")
    for i in range(5):
        one = solver.solve(targets[i], near=q[0], norm="max")
        np.testing.assert_array_equal(one.q, same.q[i])
        assert one.move == pytest.approx(np.abs(one.q - q[0]).max())
    # Whoever counts little moves more.
    weights = np.ones(14)
    weights[2:] = 10
    there = solver.solve(targets[1], near=q[0], weights=weights)
    assert there.move == pytest.approx(np.linalg.norm(weights * (there.q - q[0])))


def test_each_tip_has_a_task(solver, targets) -> None:
    tasks = [iksel.Task.position_only(), iksel.Task.free_spin()]
    turned = targets[0].copy()
    turned[0, :3, :3] = turned[0, :3, :3] @ np.diag([1.0, -1, -1])
    result = solver.solve(turned, tasks=tasks)
    assert result
    reached = solver.robot.fk(result.q)
    np.testing.assert_allclose(reached[:, :3, 3], turned[:, :3, 3], atol=2e-6)
    np.testing.assert_allclose(reached[1, :3, 2], turned[1, :3, 2], atol=2e-6)
    positions = solver.solve(targets[0][:, :3, 3], tasks=[tasks[0]] * 2)
    assert positions


def test_what_cannot_be_reached_is_named(solver, targets) -> None:
    far = targets[0].copy()
    far[1, 0, 3] += 9
    result = solver.solve(far)
    assert not result
    assert result.q is None
    assert np.isnan(result.position_error)
    assert result.proven
    assert result.unreachable_tip == 1
    assert solver.solve(targets[0]).unreachable_tip is None
    diagnosis = solver.diagnose(far)
    assert diagnosis.unreachable_tip == 1
    assert "r_tool0" in diagnosis.message
    assert diagnosis.cause == iksel.Cause.out_of_reach
    assert len(diagnosis.q) == solver.robot.chain(1).dof
    batch = solver.solve_batch(np.stack([far, targets[0]]))
    assert np.isnan(batch.q[0]).all()
    assert batch.unreachable_tip.tolist() == [1, -1]
    assert [row.unreachable_tip for row in batch] == [1, None]
    assert batch[::-1].unreachable_tip.tolist() == [-1, 1]
    again = pickle.loads(pickle.dumps(batch))
    np.testing.assert_array_equal(again.unreachable_tip, batch.unreachable_tip)
    assert batch[0].status == iksel.Status.out_of_reach
    assert solver.solve_batch([]).q.shape == (0, 14)
    with pytest.raises(iksel.InvalidArgumentError, match="ambiguous"):
        bool(batch)


def test_a_filter_sees_all_joints(solver, targets) -> None:
    seen = []

    def left_elbow_up(q: np.ndarray) -> np.ndarray:
        seen.append(q.shape)
        return q[:, 4] > 0

    found = [solver.solve(poses, filter=left_elbow_up) for poses in targets[:10]]
    assert all(shape[1:] == (14,) for shape in seen)
    assert any(found)
    assert all(result.q[4] > 0 for result in found if result)
    refused = solver.solve(targets[0], filter=lambda q: np.zeros(len(q), bool))
    assert refused.status == iksel.Status.rejected
    with pytest.raises(ZeroDivisionError):
        solver.solve(targets[0], filter=lambda q: 1 / 0)


def test_tools_and_locked_joints() -> None:
    arm = iksel.load_robot("ur5e")
    tools = np.stack([np.eye(4)] * 2)
    tools[1, 2, 3] = 0.1
    robot = iksel.Robot.from_urdf(
        two_arms_on_torso(arm),
        tip_links=["l_tool0", "r_tool0"],
        base_link="lifted",
        tcps=tools,
        locked_joints={"turn": 0.3},
    )
    assert robot.dof == 12
    assert robot.shared_joints == []
    np.testing.assert_array_equal(robot.tcps, tools)
    poses = robot.fk(robot.random_configurations(20, SEED))
    assert iksel.Solver(robot).solve_batch(poses).solved == 20


def test_coupled_limits_are_kept_and_pickled() -> None:
    arm = iksel.load_robot("ur5e")
    names = ["l_shoulder_lift_joint", "r_shoulder_lift_joint"]
    limit = iksel.CoupledLimit({names[0]: 1, names[1]: -1}, -0.3, 0.3)
    tips = ["l_" + arm.tip_link, "r_" + arm.tip_link]
    robot = iksel.Robot.from_urdf(
        two_arms_on_torso(arm), tip_links=tips, coupled_limits=[limit]
    )
    again = pickle.loads(pickle.dumps(robot))
    assert again.coupled_limits == robot.coupled_limits == [limit]
    columns = [robot.joint_names.index(name) for name in names]
    q = robot.random_configurations(50, SEED)
    for values in (q, iksel.Solver(again).solve_batch(robot.fk(q)).q):
        assert np.abs(np.diff(values[:, columns])).max() <= 0.3
    q[0, columns] = 0.4, 0.0
    assert not robot.within_limits(q[0])
    with pytest.raises(iksel.UnknownNameError, match="r_shoulder_lift_joint"):
        iksel.Robot.from_urdf(
            two_arms_on_torso(arm),
            tip_links=tips,
            coupled_limits=[iksel.CoupledLimit({"r_shoulder_lift": 1}, -1, 1)],
        )


def test_what_is_wrong_is_named(solver, targets) -> None:
    urdf = two_arms_on_torso(iksel.load_robot("ur5e"))

    def tree(urdf: str, tips: object, **keywords: object) -> iksel.Robot:
        return iksel.Robot.from_urdf(urdf, tip_links=tips, **keywords)

    wrong = iksel.InvalidArgumentError
    cases = [
        (iksel.UnknownNameError, "r_tool0", lambda: tree(urdf, ["l_tool0", "r_tol0"])),
        (wrong, "tip_links", lambda: tree(urdf, [])),
        (wrong, "tip_links", lambda: tree(urdf, "l_tool0")),
        (wrong, r"tip_links\[1\]", lambda: tree(urdf, ["l_tool0", "l_tool0"])),
        (wrong, "tcps", lambda: tree(urdf, ["l_tool0"], tcps=[np.eye(4)] * 2)),
        (wrong, "pose", lambda: solver.solve(targets)),
        (wrong, "pose", lambda: solver.solve(targets[0, 0])),
        (wrong, "l_tool0, r_tool0", lambda: solver.solve(targets[0, :1])),
        (wrong, "poses", lambda: solver.solve_batch(targets[0])),
        (wrong, "near", lambda: solver.solve(targets[0], near=[0.0])),
        (wrong, "near", lambda: solver.solve_batch(targets, near=np.zeros((3, 14)))),
        (wrong, "tasks", lambda: solver.solve(targets[0], tasks=[iksel.Task()])),
        (wrong, r"tasks\[0\]", lambda: solver.solve(targets[0], tasks=[3, 4])),
        (wrong, "l_tool0, r_tool0", lambda: solver.robot.chain(2)),
        (wrong, "in_frame_of", lambda: solver.solve(targets[0], in_frame_of=[1, 0])),
        (wrong, "in_frame_of", lambda: solver.solve(targets[0], in_frame_of=[None])),
        (wrong, "2 tips", lambda: solver.robot.tip_link),
        (wrong, "2 tips", lambda: solver.database),
        (wrong, "2 tips", lambda: solver.robot.inverse_jacobian(np.zeros(14))),
        (wrong, "2 tips", lambda: solver.self_motion(targets[0, 0])),
        (wrong, "tip_link", lambda: tree(urdf, ["l_tool0", "r_tool0"], tip_link="a")),
    ]
    for error, words, call in cases:
        with pytest.raises(error, match=words):
            call()


@pytest.mark.parametrize("name", ["ur5e", "panda", "cvr038"])
def test_one_tip_is_the_chain(name) -> None:
    """Of every call, to the last bit."""
    arm = iksel.load_robot(name)
    one = iksel.Robot.from_urdf(
        arm.urdf, base_link=arm.base_link, tip_links=[arm.tip_link], tcps=[arm.tcp]
    )
    assert one.tip_links == [arm.tip_link] == [one.tip_link]
    assert one.tips == 1
    assert one.shared_joints == []
    q = arm.random_configurations(20, SEED)
    poses = arm.fk(q)
    np.testing.assert_array_equal(one.fk(q), poses)
    np.testing.assert_array_equal(one.jacobian(q), arm.jacobian(q))
    there = poses[0] @ iksel.pose_from_euler([0, 0, 1e-3], [0, 0, 0])
    away = q[::-1]
    line = np.stack([poses[0], there])
    far = poses[0].copy()
    far[0, 3] += 3.0

    def asked(robot: iksel.Robot) -> list[np.ndarray]:
        solver = iksel.Solver(robot)
        tracker = solver.tracker(q[0])
        tracker.track(there, 0.01)
        return [
            solver.solve_batch(poses).q,
            solver.solve_batch(poses, near=away).q,
            solver.solve_batch(poses, task=iksel.Task.free_spin()).q,
            np.array([solver.solve(pose).q for pose in poses]),
            np.array([solver.solve(poses[i], near=away[i]).q for i in range(20)]),
            solver.solve(poses[1], objective="limits").q,
            solver.solve(far, closest=True).q,
            *(np.array(solver.solve_all(pose).q) for pose in poses[:5]),
            np.array(solver.solve_path(line, start=q[0]).q),
            np.array(tracker.q),
        ]

    for ours, theirs in zip(asked(one), asked(arm), strict=True):
        assert len(ours)
        np.testing.assert_array_equal(ours, theirs)


def test_what_one_tip_can_several_can(solver, targets) -> None:
    robot = solver.robot
    found = solver.solve_all(targets[0], 8)
    assert len(found) == 8
    for q in found.q:
        np.testing.assert_allclose(robot.fk(q), targets[0], atol=3e-6)
    best = solver.solve(targets[0], objective="limits")
    assert best.cost <= solver.solve(targets[0], objective="limits").cost
    far = targets[0].copy()
    far[0, 0, 3] += 3
    closest = solver.solve(far, closest=True)
    assert closest.status == iksel.Status.closest
    assert robot.within_limits(closest.q)
    seeded = solver.solve(targets[0], seeds=found.q[:2], database_seeds=False)
    assert np.abs(found.q[:2] - seeded.q).max(axis=1).min() < 1e-6


def test_hands_keep_what_they_carry(solver, targets) -> None:
    robot = solver.robot
    q = robot.random_configurations(1, SEED)[0]
    left, right = robot.fk(q)
    between = np.linalg.inv(left) @ right
    path = np.stack([np.stack([left, between])] * 20)
    path[:, 0, 2, 3] += np.linspace(0, 0.05, 20)
    moved = solver.solve_path(path, start=q, in_frame_of=[None, 0])
    assert moved, moved.first_unreachable
    for pose, want in zip(robot.fk(moved.q), path, strict=True):
        np.testing.assert_allclose(pose[0], want[0], atol=3e-6)
        np.testing.assert_allclose(np.linalg.inv(pose[0]) @ pose[1], between, atol=3e-6)
    assert np.abs(np.diff(moved.q, axis=0)).max() < 0.2
    with pytest.raises(iksel.InvalidArgumentError, match="by way of others"):
        solver.solve(targets[0], in_frame_of=[1, 0])


@pytest.mark.parametrize("name", ["ur5e", "panda"])
def test_hands_carry_to_the_tolerance(name) -> None:
    """At each of 200 waypoints; between them by the square of a step, or less."""
    robot = two_armed(iksel.load_robot(name))
    solver = iksel.Solver(robot)
    q = 0.5 * robot.random_configurations(1, SEED)[0]
    q = np.clip(q, robot.lower, robot.upper)
    left, right = robot.fk(q)
    between = np.linalg.inv(left) @ right
    path = np.stack([np.stack([left, between])] * 200)
    path[:, 0, 2, 3] += 0.05 * np.sin(np.linspace(0, np.pi, 200))
    moved = solver.solve_path(path, start=q, in_frame_of=[None, 0])
    assert moved, moved.first_unreachable

    def apart(values: np.ndarray) -> float:
        seen = np.linalg.inv(robot.fk(values)[:, 0]) @ robot.fk(values)[:, 1]
        turn = seen[:, :3, :3] @ between[:3, :3].T
        sine = np.linalg.norm(turn - turn.transpose(0, 2, 1), axis=(1, 2)) / np.sqrt(8)
        position = np.linalg.norm(seen[:, :3, 3] - between[:3, 3], axis=1)
        return max(position.max(), sine.max())

    assert apart(moved.q) <= 1e-6
    assert moved.largest_step < 0.05
    assert apart((moved.q[1:] + moved.q[:-1]) / 2) <= moved.largest_step**2


def test_a_tracker_keeps_what_hands_carry_as_its_pickle_does(solver) -> None:
    robot = solver.robot
    q = robot.random_configurations(1, SEED)[0]
    left, right = robot.fk(q)
    between = np.linalg.inv(left) @ right
    tasks = [iksel.Task.position_only(), {}]
    tracker = solver.tracker(q, tasks=tasks, in_frame_of=[None, 0])
    twin = pickle.loads(pickle.dumps(tracker))
    for _ in range(20):
        left[2, 3] += 2e-4
        result = tracker.track([left, between], 0.01)
        assert result.success
        first, second = robot.fk(tracker.q)
        np.testing.assert_allclose(first[:3, 3], left[:3, 3], atol=2e-6)
        np.testing.assert_allclose(np.linalg.inv(first) @ second, between, atol=3e-6)
        assert twin.track([left, between], 0.01).success
        np.testing.assert_array_equal(twin.q, tracker.q)


@pytest.mark.parametrize(
    ("criteria", "name"),
    [
        ({"tasks": [{}]}, "tasks: expected one for each of 2 tips"),
        ({"in_frame_of": [None]}, "in_frame_of: expected one for each of 2 tips"),
        ({"in_frame_of": [None, 2]}, r"in_frame_of\[1\]: 2 is not in"),
        ({"in_frame_of": [0, None]}, r"in_frame_of\[0\]: .* or is the tip itself"),
        ({"in_frame_of": [1, 0]}, r"in_frame_of\[0\]: .* by way of others"),
        ({"task": 3}, "task: expected"),
    ],
)
def test_a_tracker_names_criteria_that_do_not_fit(solver, criteria, name) -> None:
    for make in (solver.tracker, lambda *a, **k: iksel.Tracker(solver, *a, **k)):
        with pytest.raises((iksel.InvalidArgumentError, TypeError), match=name):
            make(np.zeros(solver.robot.dof), **criteria)
    alone = solver.chain_solver(0)
    with pytest.raises(iksel.InvalidArgumentError, match="in_frame_of"):
        alone.tracker(np.zeros(alone.robot.dof), in_frame_of=[0])


def test_a_tracker_and_its_pickle_follow_both_hands(solver) -> None:
    robot = solver.robot
    q = robot.random_configurations(1, SEED)[0]
    poses = robot.fk(q)
    tracker = solver.tracker(q, closest=True)
    for step in range(10):
        aim = poses.copy()
        aim[:, 2, 3] += 1e-3 * step
        tracker.track(aim, 0.05)
    again = pickle.loads(pickle.dumps(tracker))
    np.testing.assert_array_equal(again.q, tracker.q)
    assert again.track(aim, 0.05).status == tracker.track(aim, 0.05).status


def test_answers_keep_the_arms_apart_by_their_geometry() -> None:
    """Coal judges, by cylinders; what is known to be free is found."""
    pytest.importorskip("coal")
    arm = iksel.Robot.from_urdf(URDF, base_link="l0", tip_link="l6")
    urdf, robot = two_arms_on_torso(arm), two_armed(arm)
    spheres = iksel.spheres.from_urdf(urdf, robot, max_error=0.2, samples=300)
    assert any(a[0] != b[0] for a, b in spheres.pairs)
    scene = iksel.Scene(robot, spheres)
    exact = iksel.exact.ExactCollision(scene, urdf)
    q = robot.random_configurations(100, SEED)
    known = np.asarray(scene.is_free(q))
    assert 10 < known.sum() < 100
    batch = iksel.Solver(robot).solve_batch(robot.fk(q), scene=scene)
    assert batch.success[known].all()
    assert exact.geometry_is_free(batch.q[batch.success]).all()


def test_a_scene_knows_all_arms() -> None:
    arm = iksel.load_robot("panda")
    robot = two_armed(arm)
    links = [link for link in robot.link_names if link[:2] in ("l_", "r_")]
    ball = [[0.0, 0.0, 0.0, 0.08]]
    pairs = [(a, b) for a in links for b in links if a[:2] == "l_" and b[:2] == "r_"]
    spheres = iksel.RobotSpheres(dict.fromkeys(links, ball), pairs)
    scene = iksel.Scene(robot, spheres)
    q = robot.random_configurations(300, SEED)
    free = np.asarray(scene.is_free(q))
    assert 0 < free.sum() < 300
    poses = robot.fk(q[free][:40])
    solver = iksel.Solver(robot)
    batch = solver.solve_batch(poses, scene=scene)
    assert batch.solved >= 39
    assert np.asarray(scene.is_free(batch.q[batch.success])).all()
    for row, target in zip(batch, poses, strict=True):
        assert row.status in (iksel.Status.solved, iksel.Status.in_collision)
        if row:
            np.testing.assert_allclose(robot.fk(row.q), target, atol=3e-6)
    hit = robot.fk(q[~free][0])
    allowed = solver.solve(hit, scene=scene, exact=lambda q: np.ones(len(q), bool))
    assert allowed
    diagnosis = solver.diagnose(hit, scene=scene)
    assert diagnosis.cause in (iksel.Cause.none, iksel.Cause.collision)
    path = solver.solve_path(np.stack([poses[0]] * 3), start=q[free][0], scene=scene)
    assert path


def test_a_shared_joint_needs_room_between_its_limits() -> None:
    """Of what follows it, one bounds it from below, the other from above."""
    parts = [link("base", "chest", "left", "right", "left_hand", "right_hand")]
    parts.append(joint("torso", "base", "chest"))
    for side, low, high in (("left", 0, 1), ("right", -1, 0)):
        follower = mimic("torso", "", limits(low, high))
        parts.append(joint(f"{side}_mount", "chest", side, inside=follower))
        parts.append(joint(f"{side}_joint", side, f"{side}_hand", axis="0 1 0"))
    tips = ["left_hand", "right_hand"]
    with pytest.raises(iksel.UrdfError, match="'torso'.*nothing between its limits"):
        iksel.Robot.from_urdf(robot(*parts), tip_links=tips)


def test_a_joint_that_another_chain_limits_has_an_end() -> None:
    """Whichever of the two comes first."""
    text = robot(
        link("b", "a", "a2", "c", "c2"),
        joint("lead", "b", "a", kind="continuous"),
        joint("x", "a", "a2", inside=limits(-1, 1)),
        joint("follow", "b", "c", inside=mimic("lead", "", limits(-0.5, 0.5))),
        joint("y", "c", "c2", inside=limits(-1, 1)),
    )
    for tips in (["a2", "c2"], ["c2", "a2"]):
        both = iksel.Robot.from_urdf(text, tip_links=tips)
        assert both.joint_types == [iksel.JointType.revolute] * 3
        assert both.within_limits(both.random_configurations(200, SEED)).all()


@pytest.fixture(scope="module")
def coupled() -> iksel.Solver:
    """Two arms that share no joint; one limit is of both."""
    arm = iksel.load_robot("ur5e")
    elbows = {f"{side}_{arm.joint_names[2]}": 1 for side in "lr"}
    return iksel.Solver(
        iksel.Robot.from_urdf(
            two_arms_on_torso(arm),
            base_link="chest",
            tip_links=[f"{side}_{arm.tip_link}" for side in "lr"],
            coupled_limits=[iksel.CoupledLimit(elbows, lower=-0.2, upper=0.2)],
        )
    )


def test_solutions_of_arms_that_a_limit_couples_go_together(coupled) -> None:
    """Each arm's first solution need not go with the other's."""
    known = coupled.robot.random_configurations(400, SEED)
    assert coupled.solve_batch(coupled.robot.fk(known)).success.all()


def test_a_filter_sees_every_pair_of_solutions(coupled) -> None:
    for known in coupled.robot.random_configurations(40, SEED):

        def is_beside(q: np.ndarray, known: np.ndarray = known) -> np.ndarray:
            return (np.abs(q - known) < 0.3).all(axis=1)

        assert coupled.solve(coupled.robot.fk(known), filter=is_beside)
