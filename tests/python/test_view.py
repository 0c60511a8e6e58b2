# SPDX-License-Identifier: BSD-3-Clause
"""The viewer: what it shows, by viser's own server and without a browser."""

from __future__ import annotations

import importlib
import socket
import subprocess
import sys
import threading
import time
import urllib.request

import numpy as np
import pytest

import iksel
from iksel import view
from iksel.view import skeleton

pytest.importorskip("viser", reason="pip install iksel[view]")

SEED = 20260


def free_port() -> int:
    with socket.socket() as some:
        some.bind(("127.0.0.1", 0))
        return some.getsockname()[1]


@pytest.fixture
def show(made):
    """Make viewers of built-in robots, and close them in the end."""
    viewers = []

    def show_(name: str = "ur5e", solver=None) -> view.Viewer:
        solver = made.solver(name) if solver is None else solver
        viewers.append(view.Viewer(solver, port=free_port()))
        return viewers[-1]

    yield show_
    for viewer in viewers:
        viewer.close()


def drag(viewer, pose, tip: int = 0) -> None:
    """What viser does when a target is dragged in the browser."""
    target = viewer.scene.targets[tip]
    target.position = pose[:3, 3]
    target.wxyz = iksel.quaternion_from_pose(pose)
    for listen in target._impl_aux.update_cb:
        listen(None)


def drawn_tip(viewer) -> np.ndarray:
    """Where the last ball of the drawn robot is."""
    return viewer.scene._balls._node.batched_positions[-1]


@pytest.mark.parametrize("name", ["ur5e", "panda", "xarm6", "valkyrie_right_arm"])
def test_a_robot_follows_the_target(show, name, cases):
    viewer = show(name)
    robot = viewer.session.robot
    for pose in robot.fk(robot.random_configurations(cases // 10, seed=SEED)):
        drag(viewer, pose)
        assert viewer.session.solved
        distance, angle = iksel.pose_error(pose, robot.fk(viewer.session.q))
        assert distance < 2e-6
        assert angle < 2e-6
        assert robot.within_limits(viewer.session.q)
        np.testing.assert_allclose(drawn_tip(viewer), pose[:3, 3], atol=1e-5)
        assert viewer.text.startswith("**solved** in ")
        for slider, value in zip(viewer.controls.joints, viewer.session.q, strict=True):
            assert np.cos(np.deg2rad(slider.value) - value) == pytest.approx(1)


def test_without_an_answer_the_robot_stays_and_the_reason_is_shown(show):
    viewer = show()
    before, tip = viewer.session.q.copy(), drawn_tip(viewer).copy()
    pose = viewer.session.target.copy()
    pose[0, 3] += 3.0
    drag(viewer, pose)
    assert not viewer.session.solved
    np.testing.assert_array_equal(viewer.session.q, before)
    np.testing.assert_array_equal(drawn_tip(viewer), tip)
    np.testing.assert_allclose(viewer.session.target, pose, atol=1e-6)
    diagnosis = viewer.session.solver.diagnose(viewer.session.target)
    assert "**no answer**" in viewer.text
    assert f"out_of_reach, proven: {diagnosis.message}" in viewer.text
    pose[0, 3] -= 3.0
    drag(viewer, pose)
    assert viewer.session.solved
    assert "out_of_reach" not in viewer.text


def test_sliders_turn_joints_and_take_the_target_along(show):
    viewer = show()
    robot = viewer.session.robot
    q = viewer.session.q.copy()
    for joint, slider in enumerate(viewer.controls.joints):
        q[joint] = 0.1 * joint - 0.2
        slider.value = np.rad2deg(q[joint])
        np.testing.assert_allclose(viewer.session.q, q, rtol=0, atol=1e-15)
    pose = robot.fk(q)
    np.testing.assert_allclose(viewer.session.target, pose, rtol=0, atol=1e-14)
    np.testing.assert_allclose(viewer.scene.target_pose(), pose, atol=1e-9)
    np.testing.assert_allclose(drawn_tip(viewer), pose[:3, 3], atol=1e-6)


def test_sliders_have_the_limits_and_endless_joints_a_turn(show):
    viewer = show("gen3_6dof")
    robot = viewer.session.robot
    endless = ~np.isfinite(robot.upper)
    assert endless.any()
    assert not endless.all()
    for slider, low, high, no_end in zip(
        viewer.controls.joints, robot.lower, robot.upper, endless, strict=True
    ):
        ends = (-np.pi, np.pi) if no_end else (low, high)
        shown = (slider.min, slider.max)
        assert shown == pytest.approx(np.rad2deg(ends), rel=0, abs=0.11)
        # Fields have room for six characters.
        assert all(len(f"{end:g}") <= 6 for end in shown)
    viewer.show(np.where(endless, 4.0, 0.0))
    shown = [np.deg2rad(slider.value) for slider in viewer.controls.joints]
    assert shown == pytest.approx(list(np.where(endless, 4.0 - 2 * np.pi, 0.0)))
    np.testing.assert_array_equal(viewer.session.q, np.where(endless, 4.0, 0.0))


def test_there_are_as_many_ghosts_as_solutions(show, cases):
    viewer = show()
    robot, solver = viewer.session.robot, viewer.session.solver
    assert viewer.scene.ghosts == 0
    viewer.controls.ghosts.value = True
    counts = set()
    for pose in robot.fk(robot.random_configurations(cases // 10, seed=SEED)):
        drag(viewer, pose)
        expected = solver.solve_all(viewer.session.target)
        assert viewer.scene.ghosts == len(expected)
        assert f"solutions: {len(expected)}" in viewer.text
        balls = viewer.scene._ghost_balls._node.batched_positions
        tips = balls.reshape(len(expected), -1, 3)[:, -1]
        np.testing.assert_allclose(tips, [pose[:3, 3]] * len(tips), atol=1e-5)
        counts.add(len(expected))
    assert len(counts) > 1
    pose[0, 3] += 3
    drag(viewer, pose)
    assert viewer.scene.ghosts == 0
    viewer.show(np.full(6, 0.5))
    assert viewer.scene.ghosts > 0
    viewer.controls.ghosts.value = False
    assert viewer.scene.ghosts == 0


def test_it_stays_near_unless_told_otherwise(show):
    viewer = show()
    solver = viewer.session.solver
    start = viewer.session.q.copy()
    far = solver.solve_all(viewer.session.target, near=start).q[-1]
    assert np.abs(far - start).max() > 0.5
    viewer.show(far)
    pose = viewer.session.target.copy()
    pose[2, 3] += 0.001
    drag(viewer, pose)
    assert np.abs(viewer.session.q - far).max() < 0.1
    assert viewer.session.choice == "nearest"
    viewer.controls.choice.value = "any"
    assert viewer.session.choice == "any"
    drag(viewer, pose)
    expected = solver.solve(viewer.session.target).q
    np.testing.assert_array_equal(viewer.session.q, expected)


def test_the_branch_is_kept(show, cases):
    viewer = show("cvr038")
    session, robot = viewer.session, viewer.session.robot
    viewer.controls.choice.value = "same branch"
    rng = np.random.default_rng(SEED)
    followed = stayed = 0
    for q in robot.random_configurations(cases, seed=SEED):
        viewer.show(q)
        pose = session.target.copy()
        pose[:3, 3] += rng.normal(size=3) * 0.01
        drag(viewer, pose)
        others = session.solver.solve_all(session.target)
        if session.solved:
            followed += 1
            assert np.abs(session.q - q).max() < 1.0
            continue
        np.testing.assert_array_equal(session.q, q)
        ended = "branch does not go on to there" in viewer.text
        assert ended == bool(len(others))
        stayed += ended
    assert followed > cases / 2
    assert stayed > cases / 40
    with pytest.raises(iksel.InvalidArgumentError, match=r"'x' is none of nearest, s"):
        session.set_choice("x")


def test_another_choice_looks_again_where_there_is_no_answer(show):
    viewer = show()
    session, choice = viewer.session, viewer.controls.choice
    q = session.q.copy()
    choice.value = "any"
    np.testing.assert_array_equal(session.q, q)
    pose = session.target.copy()
    pose[0, 3] += 3.0
    drag(viewer, pose)
    choice.value = "tracked"
    assert session.status == iksel.Status.closest
    assert "as near as it gets" in viewer.text
    assert np.abs(session.q - q).max() > 0.1


@pytest.mark.parametrize("name", ["ur5e", "panda"])
def test_a_tracker_goes_as_near_as_it_gets(show, name):
    viewer = show(name)
    session, robot = viewer.session, viewer.session.robot
    viewer.controls.choice.value = "tracked"
    tracker = session.solver.tracker(session.q, closest=True)
    pose = session.target.copy()
    statuses = set()
    for step in range(60):
        pose[0, 3] += 0.05 if step < 30 else -0.05
        drag(viewer, pose)
        expected = tracker.track(session.target, 1e3)
        np.testing.assert_array_equal(session.q, expected.q)
        assert session.status == expected.status
        assert session.solved == (expected.status == iksel.Status.solved)
        assert robot.within_limits(session.q)
        statuses.add(session.status)
    assert {iksel.Status.solved, iksel.Status.closest} <= statuses
    # From elsewhere it begins anew.
    elsewhere = robot.random_configurations(1, seed=SEED)[0]
    viewer.show(elsewhere)
    drag(viewer, robot.fk(elsewhere))
    np.testing.assert_allclose(session.q, elsewhere, atol=1e-6)


def test_tasks(show):
    viewer = show("xarm5")
    robot = viewer.session.robot
    assert list(viewer.session.tasks) == ["pose", "free spin", "position only"]
    pose = robot.fk(viewer.session.q)
    spun = pose @ iksel.pose_from_euler([0, 0, 0], [0, 0, 2.0])
    tilted = pose @ iksel.pose_from_euler([0, 0, 0], [0.3, 0.2, 0])
    # What each task reaches of: the pose, tilted as five joints cannot.
    drag(viewer, tilted)
    assert not viewer.session.solved
    viewer.controls.tasks[0].value = "position only"
    assert viewer.session.solved
    reached = robot.fk(viewer.session.q)
    np.testing.assert_allclose(reached[:3, 3], tilted[:3, 3], atol=2e-6)
    viewer.controls.tasks[0].value = "free spin"
    drag(viewer, spun)
    assert viewer.session.solved
    reached = robot.fk(viewer.session.q)
    np.testing.assert_allclose(reached[:3, 3], spun[:3, 3], atol=2e-6)
    np.testing.assert_allclose(reached[:3, 2], spun[:3, 2], atol=2e-6)
    with pytest.raises(iksel.InvalidArgumentError, match=r"'x' is none of pose, free"):
        viewer.session.set_task("x")


def test_a_solver_s_own_task_is_offered(made):
    task = iksel.Task.upright()
    solver = iksel.Solver(made.robot("ur5e"), iksel.SolverOptions(task=task))
    session = view.Session(solver)
    assert session.task_names == ["the solver's"]
    assert session.tasks["the solver's"] == task
    assert len(session.tasks) == 4


def test_self_motion_leaves_the_tool_where_it_is(show):
    viewer = show("panda")
    robot, session = viewer.session.robot, viewer.session
    pose = session.target.copy()
    elbows = []
    for share in np.linspace(0, 1, 11):
        viewer.controls.motion.value = float(share)
        distance, angle = iksel.pose_error(pose, robot.fk(session.q))
        assert distance < 2e-6
        assert angle < 2e-6
        np.testing.assert_array_equal(session.target, pose)
        assert session.share == pytest.approx(share, abs=0.02)
        elbows.append(session.q[6])
        assert "self-motion: arc " in viewer.text
    assert np.ptp(elbows) > 1
    motion = session.solver.self_motion(pose, 0.02)
    np.testing.assert_array_equal(session.q, motion[len(motion) - 1].q[-1])
    viewer.controls.tasks[0].value = "position only"
    assert session.arcs is None
    assert viewer.controls.motion.disabled


@pytest.mark.parametrize("name", ["ur5e", "irb14050"])
def test_robots_without_a_self_motion_have_no_slider(show, name):
    viewer = show(name)
    assert viewer.controls.motion is None
    assert "self-motion" not in viewer.text


def test_limits_and_manipulability_are_shown(show):
    viewer = show()
    robot = viewer.session.robot
    q = np.full(6, 0.5)
    q[2] = robot.upper[2] - 0.05
    viewer.show(q)
    value = np.linalg.svd(robot.jacobian(q), compute_uv=False).prod()
    assert f"manipulability: {value:.4g}" in viewer.text
    assert "nearest limit: elbow_joint, 2.86° off (1 % of its range)" in viewer.text
    drums = viewer.scene._bones._node.batched_colors[-6:]
    assert len({tuple(colour) for colour in drums}) == 1
    q[2] = robot.upper[2]
    viewer.show(q)
    drums = viewer.scene._bones._node.batched_colors[-6:]
    assert [tuple(c) != tuple(drums[0]) for c in drums] == [0, 0, 1, 0, 0, 0]
    q[2] += 0.1
    viewer.show(q)
    assert "**outside the limits**: elbow_joint" in viewer.text


def test_a_path_is_played(show, monkeypatch):
    viewer = show()
    start = viewer.session.q
    pose = viewer.session.target
    poses = np.array([pose] * 5)
    poses[:, 2, 3] -= np.linspace(0, 0.05, 5)
    path = viewer.session.solver.solve_path(poses, start)
    assert path
    seen = []
    monkeypatch.setattr(
        viewer.scene, "draw_robot", lambda q, *_, **__: seen.append(q.copy())
    )
    started = time.monotonic()
    assert viewer.play(path, dt=0.02) is viewer
    assert time.monotonic() - started > 0.09
    np.testing.assert_array_equal(seen, path.q)
    for wrong in ([0.0] * 6, [[0.0] * 5], [[np.nan] * 6]):
        with pytest.raises(iksel.InvalidArgumentError, match=r"^path: "):
            viewer.play(wrong)
    with pytest.raises(iksel.InvalidArgumentError, match=r"^dt: .*-1"):
        viewer.play(path, dt=-1)


def test_wrong_arguments_are_named(show):
    viewer = show()
    for wrong in ([0.0] * 5, [[0.0] * 6], [np.inf] * 6):
        with pytest.raises(iksel.InvalidArgumentError, match=r"^q: "):
            viewer.show(wrong)
    for wrong in (np.zeros((4, 4)), np.tile(np.eye(4), (2, 1, 1))):
        with pytest.raises(iksel.InvalidArgumentError, match=r"^pose: "):
            viewer.move_target(wrong)


def test_waiting_ends_with_closing(show):
    viewer = show()
    waiting = threading.Thread(target=viewer.wait)
    waiting.start()
    assert waiting.is_alive()
    viewer.close()
    waiting.join(5)
    assert not waiting.is_alive()
    viewer.close()


@pytest.mark.parametrize("name", iksel.robot_names())
def test_links_go_from_the_base_to_the_tool(made, name):
    robot = made.robot(name)
    bones = skeleton.Skeleton(robot)
    q = robot.random_configurations(3, seed=SEED)
    assert bones.links[0] == robot.base_link
    assert bones.links[-1] == robot.tip_link
    points = bones.points(q)
    np.testing.assert_allclose(points[:, -1], robot.fk(q)[:, :3, 3], atol=1e-12)
    placed = bones.cylinders(q)
    count = bones.bars + robot.dof
    assert len(placed.positions) == 3 * count
    # Each bar's ends are the frames that it joins.
    along = iksel.pose_from_quaternion(np.zeros(3), placed.wxyzs)[:, :3, 2]
    half = along * placed.scales[:, 2:] / 2
    for ends, frames in (
        (placed.positions - half, points[:, :-1]),
        (placed.positions + half, points[:, 1:]),
    ):
        shown = ends.reshape(3, count, 3)[:, : bones.bars]
        np.testing.assert_allclose(shown, frames, atol=2e-6)


def test_drums_stand_along_the_joints_axes(made):
    robot = made.robot("ur5e")
    bones = skeleton.Skeleton(robot)
    q = robot.random_configurations(1, seed=SEED)
    placed = bones.cylinders(q)
    shown = iksel.pose_from_quaternion(np.zeros(3), placed.wxyzs)[bones.bars :, :3, 2]
    # All of this robot's joints turn about the z axes of the links they move.
    poses = robot.link_poses(q)[0]
    links = [i for i, n in enumerate(robot.link_names) if n.endswith("_link")]
    axes = poses[[links[0] + 2 + i for i in range(6)], :3, 2]
    np.testing.assert_allclose(shown, axes, atol=1e-9)


def test_directions_against_z_are_no_trouble():
    directions = np.array([[0, 0, 2.0], [0, 0, -1], [1, 0, 0], [1e-12, 0, -1]])
    turns = skeleton.turns_of_z(directions)
    shown = iksel.pose_from_quaternion(np.zeros(3), turns)[:, :3, 2]
    unit = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    np.testing.assert_allclose(shown, unit, atol=1e-9)


@pytest.mark.parametrize("make", [skeleton.ball, skeleton.cylinder])
def test_meshes_are_closed_and_face_outwards(make):
    vertices, faces = make(64)
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    expected = 4 / 3 * np.pi if make is skeleton.ball else np.pi
    assert volume == pytest.approx(expected, rel=0.02)


def test_importing_iksel_imports_no_viser():
    program = "import sys, iksel, iksel.view, iksel.cli; print('viser' in sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout == "False\n"


def test_a_missing_extra_is_named(made, monkeypatch):
    monkeypatch.setitem(sys.modules, "viser", None)
    with pytest.raises(view.MissingExtraError, match=r"pip install 'iksel\[view\]'"):
        view.Viewer(made.solver("ur5e"))
    assert issubclass(view.MissingExtraError, iksel.Error)
    assert issubclass(view.MissingExtraError, ImportError)


@pytest.mark.parametrize("port", [70000, -1, "x", 1.5, True, None, 65536])
def test_no_port_is_an_error_at_once(made, port) -> None:
    with pytest.raises(iksel.InvalidArgumentError, match="^port: "):
        view.Viewer(made.solver("ur5e"), port=port)


def test_it_listens_at_addresses_of_ipv6(made) -> None:
    try:
        with socket.create_server(("::1", 0), family=socket.AF_INET6) as some:
            port = some.getsockname()[1]
    except OSError:
        pytest.skip("this machine has no IPv6")
    with view.Viewer(made.solver("ur5e"), host="::1", port=port) as viewer:
        assert viewer.url == f"http://[::1]:{viewer.port}"
        with urllib.request.urlopen(viewer.url, timeout=10) as page:
            assert page.status == 200


def test_the_last_port_taken_is_an_error(made) -> None:
    """viser would try 65536, and wait for ever."""
    with socket.socket() as some:
        some.bind(("127.0.0.1", 65535))
        some.listen()
        with pytest.raises(iksel.InvalidArgumentError, match="none is free"):
            view.Viewer(made.solver("ur5e"), port=65535)


def ask(viewer, origin, host=None) -> bool:
    """Whether a page of an origin may connect; asks for `host` as browsers do."""
    refusal = importlib.import_module("websockets.exceptions").InvalidStatus
    connect = importlib.import_module("websockets.sync.client").connect
    headers = {"Origin": origin} if origin else {}
    url = f"ws://{host or f'127.0.0.1:{viewer.port}'}"
    try:
        with (
            socket.create_connection(("127.0.0.1", viewer.port)) as link,
            connect(url, sock=link, additional_headers=headers),
        ):
            return True
    except refusal as error:
        return error.response.status_code != 403


def test_pages_of_other_sites_are_refused(show) -> None:
    viewer = show()
    port = viewer.port
    assert ask(viewer, None)
    assert ask(viewer, f"http://127.0.0.1:{port}")
    assert ask(viewer, f"http://localhost:{port}", f"localhost:{port}")
    foreign = f"evil.example:{port}"
    for origin, host in (
        ("http://evil.example", None),
        (f"http://{foreign}", None),
        (f"http://{foreign}", foreign),  # a name that was made to point here
        ("null", None),
        (f"http://localhost:{port + 1}", None),
    ):
        assert not ask(viewer, origin, host)


def test_pages_that_are_allowed_may_connect(made) -> None:
    origins = ["https://lab.example:8443", "https://Desk.example/"]
    port = free_port()
    with view.Viewer(made.solver("ur5e"), port=port, origins=origins) as viewer:
        for origin in ("https://lab.example:8443", "https://desk.example"):
            assert ask(viewer, origin)
            assert ask(viewer, origin, "lab.example:8443")  # as a proxy passes it on
        assert ask(viewer, f"http://127.0.0.1:{port}")
        for origin in ("http://lab.example:8443", "https://lab.example", "null"):
            assert not ask(viewer, origin)


@pytest.mark.parametrize(
    "origins", ["https://a.example", ["lab.example"], ["https://a/b"], ["*"], [""]]
)
def test_what_is_no_origin_is_named(made, origins) -> None:
    with pytest.raises(iksel.InvalidArgumentError, match="^origins: "):
        view.Viewer(made.solver("ur5e"), port=free_port(), origins=origins)
