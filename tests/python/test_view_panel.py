# SPDX-License-Identifier: BSD-3-Clause
"""What the viewer begins with, and what is typed, copied and drawn beside the robot."""

from __future__ import annotations

import numpy as np
import pytest
from test_view import free_port

import iksel
from iksel import view
from iksel.view._obstacles import shape_of
from iksel.view.session import Session

pytest.importorskip("viser", reason="pip install iksel[view]")

SEED = 33


@pytest.fixture
def show(made):
    """Make viewers of built-in robots, and close them in the end."""
    viewers = []

    def show_(name: str, **settings) -> view.Viewer:
        viewers.append(view.Viewer(made.solver(name), port=free_port(), **settings))
        return viewers[-1]

    yield show_
    for viewer in viewers:
        viewer.close()


def click(viewer, button) -> None:
    """What viser does when a button is clicked in the browser."""
    viewer._changed(button)


def numbers(field) -> np.ndarray:
    return np.array(field.value.split(), float)


@pytest.mark.parametrize("name", ["ur5e", "panda", "xarm5"])
@pytest.mark.parametrize("unit", ["degrees", "radians"])
def test_what_is_copied_can_be_typed(show, cases, name, unit) -> None:
    viewer = show(name)
    robot, fields = viewer.session.robot, viewer.controls.numbers
    viewer.controls.unit.value = unit
    angle = np.rad2deg(1) if unit == "degrees" else 1
    elsewhere = viewer.session.q.copy()
    for q in robot.random_configurations(cases // 10, seed=SEED):
        viewer.show(q)
        np.testing.assert_allclose(numbers(fields.q), q * angle, rtol=1e-5, atol=1e-6)
        q_text, pose_text = fields.q.value, fields.poses[0].value
        viewer.show(elsewhere)
        fields.q.value = f"[{', '.join(q_text.split())}]"
        click(viewer, fields.to_q)
        np.testing.assert_allclose(viewer.session.q, q, rtol=0, atol=3e-5)
        assert viewer.session.solved
        viewer.show(elsewhere)
        fields.poses[0].value = pose_text
        click(viewer, fields.to_poses[0])
        distance, turned = iksel.pose_error(viewer.session.target, robot.fk(q))
        assert distance < 1e-5
        assert turned < 3e-5


def test_a_target_is_typed_with_a_quaternion(show) -> None:
    viewer = show("ur5e")
    fields, robot = viewer.controls.numbers, viewer.session.robot
    pose = robot.fk(robot.random_configurations(1, seed=SEED)[0])
    values = [*pose[:3, 3], *iksel.quaternion_from_pose(pose)]
    fields.poses[0].value = " ".join(map(repr, map(float, values)))
    click(viewer, fields.to_poses[0])
    np.testing.assert_allclose(viewer.session.target, pose, rtol=0, atol=1e-12)
    assert viewer.session.solved


@pytest.mark.parametrize(
    ("q", "target", "reason"),
    [
        ("1 2 3", None, "q: expected 6 numbers"),
        ("1 2 3 4 5 six", None, "q: could not convert"),
        ("1 2 3 4 5 nan", None, "q: expected 6 numbers"),
        ("", None, "q: expected 6 numbers"),
        (None, "1 2 3 4 5", "target: expected 6 or 7 numbers"),
        (None, "0 0 0 2 0 0 0", "target: a quaternion has length 1"),
    ],
)
def test_what_is_no_number_moves_nothing(show, q, target, reason) -> None:
    viewer = show("ur5e")
    before, fields = viewer.session.q.copy(), viewer.controls.numbers
    if q is not None:
        fields.q.value = q
        click(viewer, fields.to_q)
    else:
        fields.poses[0].value = target
        click(viewer, fields.to_poses[0])
    assert viewer.text.startswith(f"**not moved**: {reason}")
    np.testing.assert_array_equal(viewer.session.q, before)


def test_the_unit_changes_what_is_shown_and_nothing_else(show) -> None:
    viewer = show("xarm6")
    before = viewer.session.q.copy()
    robot = viewer.session.robot
    in_degrees = [s.value for s in viewer.controls.joints]
    viewer.controls.unit.value = "radians"
    np.testing.assert_array_equal(viewer.session.q, before)
    in_radians = [s.value for s in viewer.controls.joints]
    np.testing.assert_allclose(np.deg2rad(in_degrees), in_radians, atol=1e-12)
    for slider, low in zip(viewer.controls.joints, robot.lower, strict=True):
        assert slider.min == pytest.approx(low, abs=2e-3)
        assert slider.min <= slider.value <= slider.max
    viewer.controls.joints[1].value = -0.25
    assert viewer.session.q[1] == pytest.approx(-0.25)


@pytest.mark.parametrize("name", iksel.robot_names())
def test_it_begins_upright_and_solved(made, name) -> None:
    session = Session(made.solver(name))
    robot, q = session.robot, session.q
    assert robot.within_limits(q)
    heights = robot.link_poses(q)[:, 2, 3]
    some = robot.link_poses(robot.random_configurations(500, seed=SEED))[..., 2, 3]
    # Of what it can stand up at least 45 %, with its tool before it.
    assert heights.max() - heights[0] > 0.45 * (some.max() - heights[0])
    assert robot.fk(q)[0, 3] > 0
    assert heights.min() >= min(0.0, some.min(axis=1).max()) - 0.05 * robot.reach
    # A joint is not turned by more than half a turn if it can do with less.
    revolute = np.array([k != iksel.JointType.prismatic for k in robot.joint_types])
    for turn in (-2 * np.pi, 2 * np.pi):
        other = q + turn
        inside = (robot.lower <= other) & (other <= robot.upper) & revolute
        assert (np.abs(q) <= np.abs(other) + 1e-9)[inside].all()


def from_the_middle(viewer, points) -> np.ndarray:
    """How far from the middle points (n, 3) are seen; 1: at the upper edge."""
    camera = viewer._server.initial_camera
    forwards = camera.look_at - camera.position
    forwards /= np.linalg.norm(forwards)
    depth = (points - camera.position) @ forwards
    assert (depth > 0).all()
    aside = points - camera.position - depth[:, None] * forwards
    return np.linalg.norm(aside, axis=1) / (depth * np.tan(camera.fov / 2))


@pytest.mark.parametrize("name", ["ur5e", "panda", "irb120", "wx250"])
def test_the_camera_sees_the_robot_and_little_else(show, name) -> None:
    viewer = show(name)
    for q in (viewer.session.q, np.zeros(viewer.session.robot.dof)):
        viewer.show(q)
        share = from_the_middle(viewer, viewer.scene._balls._node.batched_positions)
        assert 0.5 < share.max() < 1


def scene_of(robot) -> iksel.Scene:
    """Some of each shape, and a body that touches none."""
    tip = {robot.tip_link: np.array([[0, 0, 0, 0.001]])}
    scene = iksel.Scene(robot, iksel.RobotSpheres(tip, []))
    turned = iksel.pose_from_euler([0.4, 0.1, 0.9], [0.3, -0.2, 0.5])
    scene.add_box("box", [0.1, 0.2, 0.3], turned)
    scene.add_sphere("sphere", 0.1, np.array([0.5, 0.5, 0.5]))
    scene.add_cylinder("cylinder", 0.05, 0.3, turned)
    scene.add_capsule("capsule", 0.05, 0.3, turned)
    scene.add_half_space("floor", np.array([0, 0, -5.0]))
    scene.add_points("points", np.ones((7, 3)), 0.01)
    return scene


def test_obstacles_of_a_scene_are_shown_where_they_are(show, made) -> None:
    scene = scene_of(made.robot("ur5e"))
    viewer = show("ur5e", scene=scene)
    drawn = viewer.scene.obstacles
    assert len(drawn) == len(scene.obstacles) == 6
    for node, obstacle in zip(drawn, scene.obstacles.values(), strict=True):
        np.testing.assert_allclose(node.position, obstacle.pose[:3, 3], atol=1e-6)
        pose = iksel.pose_from_quaternion(node.position, node.wxyz)
        np.testing.assert_allclose(pose, obstacle.pose, atol=1e-6)
    by_name = dict(zip(scene.obstacles, drawn, strict=True))
    assert len(by_name["points"].points) == 7


@pytest.mark.parametrize("name", ["box", "sphere", "cylinder", "capsule"])
def test_shapes_of_obstacles_have_their_volume(made, name) -> None:
    obstacle = scene_of(made.robot("ur5e")).obstacles[name]
    vertices, faces = shape_of(obstacle, 1.0)
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    radius, length = obstacle.radius, obstacle.length
    expected = {
        "box": np.prod(obstacle.size),
        "sphere": 4 / 3 * np.pi * radius**3,
        "cylinder": np.pi * radius**2 * length,
        "capsule": np.pi * radius**2 * (length + 4 / 3 * radius),
    }
    assert volume == pytest.approx(expected[name], rel=0.02)


def test_answers_keep_free_of_the_scene(show, made) -> None:
    robot = made.robot("ur5e")
    spheres = iksel.RobotSpheres({"forearm_link": np.array([[0, 0, 0, 0.05]])}, [])
    scene = iksel.Scene(robot, spheres)
    free = show("ur5e")
    elbow = robot.link_poses(free.session.q)[robot.link_names.index("forearm_link")]
    scene.add_sphere("ball", 0.1, elbow[:3, 3])
    viewer = show("ur5e", scene=scene)
    assert scene.is_free(viewer.session.q[None]).all()
    for shown, is_free in ((free, False), (viewer, True)):
        shown.show(free.session.q.copy())
        shown.move_target(free.session.target)
        assert scene.is_free(shown.session.q[None])[0] == is_free
        assert shown.session.solved
    assert 0 < len(viewer.session.branches()) < len(free.session.branches())


def test_what_sliders_bring_into_collision_is_said(show, made) -> None:
    robot = made.robot("ur5e")
    spheres = iksel.RobotSpheres({"forearm_link": np.array([[0, 0, 0, 0.05]])}, [])
    scene = iksel.Scene(robot, spheres)
    viewer = show("ur5e", scene=scene)
    elbow = robot.link_poses(viewer.session.q)[robot.link_names.index("forearm_link")]
    assert "collision" not in viewer.text
    scene.add_sphere("ball", 0.1, elbow[:3, 3])
    viewer.show(viewer.session.q)
    assert "**in collision**: forearm_link touches ball\n" in viewer.text


@pytest.mark.parametrize("unit", ["degrees", "radians"])
def test_sliders_show_no_zero_below_zero(show, unit) -> None:
    viewer = show("ur5e")
    viewer.controls.unit.value = unit
    viewer.show(np.full(6, -1e-6))
    for slider in viewer.controls.joints:
        assert f"{slider.value:.{slider.precision}f}"[0] == "0"
    np.testing.assert_array_equal(viewer.session.q, np.full(6, -1e-6))
