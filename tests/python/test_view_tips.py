# SPDX-License-Identifier: BSD-3-Clause
"""The viewer of robots with several tips: a target for each."""

from __future__ import annotations

import re
from types import SimpleNamespace

import numpy as np
import pytest
from test_view import drag, free_port
from trees import two_armed, two_arms_on_torso

import iksel
from iksel import view
from iksel.view._camera import VIEW_FROM
from iksel.view._maps import check_map
from iksel.view.skeleton import Skeleton

pytest.importorskip("viser", reason="pip install iksel[view]")

SEED = 4
TIPS = ["l_tool0", "r_tool0"]


@pytest.fixture(scope="module")
def solver(made) -> iksel.Solver:
    """Of a torso that lifts and turns, with two arms."""
    return iksel.Solver(two_armed(made.robot("ur5e")))


@pytest.fixture(autouse=True)
def patience(monkeypatch) -> None:
    """Let other work on the machine delay answers, but not prevent them."""
    monkeypatch.setattr("iksel.view.session.TIPS_DEADLINE", 20.0)


@pytest.fixture
def viewer(solver):
    with view.Viewer(solver, port=free_port()) as viewer:
        yield viewer


def assert_there(viewer) -> None:
    """The robot is drawn with both tips at their targets."""
    session = viewer.session
    assert session.solved
    assert session.robot.within_limits(session.q)
    reached = session.robot.fk(session.q)
    np.testing.assert_allclose(reached, session.targets, atol=3e-6)
    drawn = viewer.scene._balls._node.batched_positions[-2:]
    np.testing.assert_allclose(drawn, session.targets[:, :3, 3], atol=1e-5)
    for link in TIPS:
        assert f"- **{link}**: at its target\n" in viewer.text + "\n"


def test_each_target_is_dragged_by_itself(viewer, cases) -> None:
    session, rng = viewer.session, np.random.default_rng(SEED)
    assert_there(viewer)
    solved = 0
    for step in range(cases // 5):
        tip = step % 2
        pose = session.targets[tip] @ iksel.pose_from_euler(
            rng.normal(size=3) * 0.03, rng.normal(size=3) * 0.1
        )
        other = session.targets[1 - tip].copy()
        drag(viewer, pose, tip)
        np.testing.assert_allclose(session.targets[tip], pose, atol=1e-9)
        np.testing.assert_array_equal(session.targets[1 - tip], other)
        np.testing.assert_allclose(viewer.scene.target_pose(1 - tip), other, atol=1e-9)
        if session.solved:
            solved += 1
            assert_there(viewer)
    assert solved > cases // 10, f"seed {SEED}"


def test_all_targets_are_moved_at_once(viewer) -> None:
    robot = viewer.session.robot
    for poses in robot.fk(robot.random_configurations(10, seed=SEED)):
        viewer.move_target(poses)
        assert_there(viewer)
        viewer.move_target(poses[1], tip=1)
        assert_there(viewer)


def test_names_go_with_their_targets(viewer, made) -> None:
    drag(
        viewer,
        viewer.session.targets[1] @ iksel.pose_from_euler([0.02] * 3, [0] * 3),
        1,
    )
    names = viewer.scene.names
    assert [name.text for name in names] == TIPS
    for name, pose in zip(names, viewer.session.targets, strict=True):
        np.testing.assert_allclose(name.position, pose[:3, 3], atol=1e-6)
    with view.Viewer(made.solver("ur5e"), port=free_port()) as one:
        assert one.scene.names == []
        assert "ur5e" not in one.text
        assert [task.label for task in one.controls.tasks] == ["task"]
    assert [task.label for task in viewer.controls.tasks] == [
        f"task {link}" for link in TIPS
    ]


def test_the_tip_that_cannot_be_there_is_named(viewer) -> None:
    session = viewer.session
    before, targets = session.q.copy(), session.targets.copy()
    far = targets[1].copy()
    far[0, 3] += 3.0
    drag(viewer, far, 1)
    assert not session.solved
    np.testing.assert_array_equal(session.q, before)
    assert "cannot be reached even by itself: r_tool0\n" in viewer.text
    diagnosis = session.solver.chain_solver(1).diagnose(far)
    line = f"- **r_tool0**: 3000.0 mm, 0.0° away; out_of_reach, proven: {diagnosis}"
    assert line.partition(": Diagnosis")[0] in viewer.text
    assert diagnosis.message in viewer.text
    assert "- **l_tool0**: 0.0 mm, 0.0° away\n" in viewer.text
    drag(viewer, targets[1], 1)
    assert_there(viewer)


def test_what_only_both_together_cannot_is_said(solver) -> None:
    robot = solver.robot
    session = view.Session(solver)
    q = robot.random_configurations(4000, seed=SEED)
    poses = robot.fk(q)
    turn = robot.joint_names.index("turn")
    # The hands that are farthest out with the torso turned one way and the other.
    away = np.linalg.norm(poses[..., :2, 3], axis=-1)
    left = poses[np.argmax(away[:, 0] + 3 * (q[:, turn] > 1.4)), 0]
    right = poses[np.argmax(away[:, 1] + 3 * (q[:, turn] < -1.4)), 1]
    session.move_target([left, right])
    assert not session.solved, f"seed {SEED}"
    assert session.tip_reasons == ["", ""]
    assert session.reason.startswith("each tip can be at its target by itself, but")
    for tip, pose in enumerate((left, right)):
        assert solver.chain_solver(tip).solve(pose)


def test_no_answer_is_waited_for(solver, monkeypatch) -> None:
    monkeypatch.setattr("iksel.view.session.TIPS_DEADLINE", 1e-9)
    session = view.Session(solver)
    before = session.q.copy()
    session.move_target(solver.robot.fk(solver.robot.random_configurations(1, 9)[0]))
    assert session.status == iksel.Status.out_of_time
    np.testing.assert_array_equal(session.q, before)
    assert session.reason.startswith("each tip can be at its target by itself, but")


def test_answers_keep_free_of_the_scene(solver) -> None:
    robot = solver.robot
    links = [link for link in robot.link_names if link[:2] in ("l_", "r_")]
    ball = (0.0, 0.0, 0.0, 0.05)
    body = iksel.RobotSpheres({link: [ball] for link in links}, [])
    scene = iksel.Scene(robot, body)
    session = view.Session(solver, scene=scene)
    before, targets = session.q.copy(), session.targets.copy()
    assert scene.is_free(before[None]).all()
    # What one hand has to touch is the reason, and neither chain's alone.
    scene.add_sphere("ball", 0.1, targets[1, :3, 3])
    targets[0, 2, 3] += 0.01
    session.move_target(targets)
    assert session.status == iksel.Status.in_collision
    np.testing.assert_array_equal(session.q, before)
    assert session.tip_reasons == ["", ""]
    # Hand, flange and last wrist have the same ball.
    assert re.fullmatch(r"collision: r_\w+ would touch ball", session.reason)
    scene.remove("ball")
    session.move_target(targets)
    assert session.solved
    assert scene.is_free(session.q[None]).all()


def test_a_shared_joint_takes_both_targets_along(viewer) -> None:
    session = viewer.session
    robot, before = session.robot, session.targets.copy()
    slider = viewer.controls.joints[robot.joint_names.index("turn")]
    slider.value += 10.0
    turned = iksel.pose_from_euler([0, 0, 0], [0, 0, np.deg2rad(10)])
    np.testing.assert_allclose(session.targets, turned @ before, atol=1e-9)
    slider = viewer.controls.joints[robot.joint_names.index("r_elbow_joint")]
    moved = session.targets.copy()
    slider.value -= 10.0
    np.testing.assert_allclose(session.targets[0], moved[0], atol=1e-12)
    assert np.abs(session.targets[1] - moved[1]).max() > 1e-3


def test_each_tip_has_a_task(viewer) -> None:
    session = viewer.session
    robot = session.robot
    viewer.controls.tasks[1].value = "position only"
    assert session.task_names == ["pose", "position only"]
    tilted = session.targets[1] @ iksel.pose_from_euler([0, 0, 0], [0, 0, 1.5])
    elsewhere = session.q.copy()
    drag(viewer, tilted, 1)
    assert session.solved
    np.testing.assert_allclose(session.q, elsewhere, atol=1e-6)  # nothing to do
    viewer.controls.tasks[1].value = "pose"
    assert_there(viewer)
    assert np.abs(session.q - elsewhere).max() > 0.1
    session.set_task("free spin")
    assert session.task_names == ["free spin"] * 2
    reached = robot.fk(session.q)
    np.testing.assert_allclose(
        reached[..., :3, 2:], session.targets[..., :3, 2:], atol=3e-6
    )


def test_branches_have_both_tips_at_their_targets(viewer) -> None:
    viewer.controls.ghosts.value = True
    session, scene = viewer.session, viewer.scene
    count = len(session.branches())
    assert scene.ghosts == count > 8
    assert f"solutions: {count} or more\n" in viewer.text
    balls = scene._ghost_balls._node.batched_positions.reshape(count, -1, 3)
    tips = session.targets[None, :, :3, 3]
    np.testing.assert_allclose(balls[:, -2:], np.repeat(tips, count, 0), atol=1e-5)


@pytest.mark.parametrize("choice", view.session.CHOICES)
def test_every_choice_is_there_for_several(viewer, choice) -> None:
    session = viewer.session
    viewer.controls.choice.value = choice
    before = session.q.copy()
    drag(viewer, session.targets[0] @ iksel.pose_from_euler([0.005] * 3, [0] * 3))
    assert_there(viewer)
    if choice != "any":
        assert np.abs(session.q - before).max() < 0.1


def test_both_are_tracked_as_near_as_it_gets(viewer) -> None:
    session = viewer.session
    viewer.controls.choice.value = "tracked"
    start, there = session.q.copy(), session.targets.copy()
    for height in np.linspace(0, 0.05, 10):
        pose = there[0].copy()
        pose[2, 3] += height
        drag(viewer, pose)
        assert_there(viewer)
    assert 0 < np.abs(session.q - start).max() < 1
    for _ in range(30):
        pose[0, 3] += 0.1
        drag(viewer, pose)
        assert session.robot.within_limits(session.q)
    assert session.status == iksel.Status.closest
    assert viewer.text.startswith("**closest** (")
    assert "as near as it gets from here" in viewer.text
    # It has gone after the target, by nearly as much as that went.
    went = np.linalg.norm(session.robot.fk(session.q)[0, :3, 3] - there[0, :3, 3])
    assert went > 0.1
    assert session.errors()[0][0] > 1
    before = session.q.copy()
    viewer.controls.tasks[1].value = "position only"
    np.testing.assert_array_equal(session.q, before)
    assert "keeps to the solver's own task" in viewer.text
    viewer.controls.tasks[1].value = "pose"
    assert "keeps to the solver's own task" not in viewer.text


def test_targets_are_typed_for_each(viewer, solver) -> None:
    fields = viewer.controls.numbers
    pose = viewer.session.targets[1].copy()
    pose[2, 3] += 0.02
    values = [*pose[:3, 3], *iksel.quaternion_from_pose(pose)]
    other = viewer.session.targets[0].copy()
    fields.poses[1].value = " ".join(map(repr, map(float, values)))
    viewer._changed(fields.to_poses[1])
    np.testing.assert_allclose(viewer.session.targets, [other, pose], atol=1e-12)
    assert_there(viewer)
    fields.poses[0].value = "1 2"
    viewer._changed(fields.to_poses[0])
    assert viewer.text.startswith("**not moved**: target: expected 6 or 7 numbers")


def test_what_is_of_one_tip_is_said(viewer) -> None:
    assert viewer.controls.motion is None
    assert "self-motion: shown of robots with one tip only" in viewer.text


def test_a_path_of_both_is_played(viewer, monkeypatch) -> None:
    session = viewer.session
    poses = np.array([session.targets] * 5)
    poses[:, :, 2, 3] -= np.linspace(0, 0.03, 5)[:, None]
    path = session.solver.solve_path(poses, session.q)
    assert path
    viewer.play(path, dt=0)
    np.testing.assert_array_equal(session.q, path.q[-1])
    np.testing.assert_allclose(session.targets, poses[-1], atol=3e-6)


def test_a_map_of_one_of_the_tips_is_taken(solver, made) -> None:
    robot = solver.robot
    for tip in range(2):
        check_map(robot, SimpleNamespace(robot=robot.chain(tip)))
    with pytest.raises(iksel.InvalidArgumentError, match="base -> l_tool0, r_tool0"):
        check_map(robot, SimpleNamespace(robot=made.robot("ur5e")))


def test_wrong_arguments_are_named(viewer) -> None:
    pose = viewer.session.targets[0]
    before = viewer.session.targets.copy()
    for words, call in (
        (r"^pose: expected shape \(2, 4, 4\)", lambda: viewer.move_target(pose)),
        (r"^pose: expected shape \(4, 4\)", lambda: viewer.move_target(before, tip=0)),
        ("^tip: 2 is no number of one of l_t", lambda: viewer.move_target(pose, tip=2)),
        ("^tip: -1 is no number", lambda: viewer.session.set_task("pose", -1)),
    ):
        with pytest.raises(iksel.InvalidArgumentError, match=words):
            call()
    np.testing.assert_array_equal(viewer.session.targets, before)


@pytest.mark.parametrize("tips", [TIPS, ["r_tool0", "l_forearm_link", "l_tool0"]])
def test_links_are_those_of_the_chains(made, tips) -> None:
    text = two_arms_on_torso(made.robot("ur5e"))
    tools = np.stack(
        [iksel.pose_from_euler([0, 0, 0.1 * i], [0] * 3) for i in range(len(tips))]
    )
    robot = iksel.Robot.from_urdf(text, tip_links=tips, tcps=tools)
    bones = Skeleton(robot)
    q = robot.random_configurations(3, seed=SEED)
    points, placed = bones.points(q), bones.cylinders(q)
    count = bones.bars + robot.dof
    assert points.shape == (3, len(bones.links) + len(tips), 3) == (3, bones.frames, 3)
    assert len(placed.positions) == 3 * count
    along = iksel.pose_from_quaternion(np.zeros(3), placed.wxyzs)[:, :3, 2]
    along = along.reshape(3, count, 3)
    middles = placed.positions.reshape(3, count, 3)
    lengths = placed.scales.reshape(3, count, 3)
    seen = set()
    for tip in range(len(tips)):
        chain, columns = Skeleton(robot.chain(tip)), robot.joints_of(tip)
        frames = [bones.links.index(link) for link in chain.links]
        frames.append(len(bones.links) + tip)
        its = chain.points(q[:, columns])
        np.testing.assert_allclose(points[:, frames], its, atol=1e-12)
        # The bar to each frame but the base's begins at the one before.
        bars = np.array(frames[1:]) - 1
        half = along[:, bars] * lengths[:, bars, 2:] / 2
        np.testing.assert_allclose(middles[:, bars] - half, its[:, :-1], atol=2e-6)
        np.testing.assert_allclose(middles[:, bars] + half, its[:, 1:], atol=2e-6)
        alone = chain.cylinders(q[:, columns])
        drums = iksel.pose_from_quaternion(np.zeros(3), alone.wxyzs)[:, :3, 2]
        drums = drums.reshape(3, -1, 3)[:, chain.bars :]
        mine = along[:, bones.bars :][:, columns]
        np.testing.assert_allclose(mine, drums, atol=1e-9)
        seen |= set(bars)
    assert len(seen) == bones.bars


def test_it_begins_free_and_upright(solver) -> None:
    session = view.Session(solver)
    robot, q = session.robot, session.q
    assert robot.within_limits(q)
    assert robot.link_poses(q)[:, 2, 3].min() >= -1e-9
    assert (session.targets[:, 0, 3] > 0).all()
    jacobian = robot.jacobian(q)
    assert np.linalg.svd(jacobian, compute_uv=False).prod() > 1e-3


@pytest.mark.parametrize("name", ["ur5e", "panda", "iiwa7"])
def test_no_tool_is_behind_another_at_first(made, name) -> None:
    session = view.Session(iksel.Solver(two_armed(made.robot(name))))
    left, right = session.targets[:, :3, 3]
    aside = np.cross(left - right, VIEW_FROM / np.linalg.norm(VIEW_FROM))
    assert np.linalg.norm(aside) > 0.5 * session.robot.chain(0).reach
