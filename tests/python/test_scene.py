# SPDX-License-Identifier: BSD-3-Clause
"""Scenes against distances computed one by one, and against what coal says."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest
from tubes import LENGTHS, NAMES, URDF

import iksel
import iksel.exact
import iksel.spheres
from iksel.spheres import PART_OF_CYLINDER

SEED = 7


@pytest.fixture(scope="module")
def arm() -> iksel.Robot:
    return iksel.Robot.from_urdf(URDF, base_link="l0", tip_link="l6")


@pytest.fixture(scope="module")
def spheres() -> iksel.RobotSpheres:
    """A row of balls in each tube; neighbours touch always, and are not looked at."""
    links = {}
    for name, length in zip(NAMES, LENGTHS, strict=True):
        z = np.linspace(0, length, 2 + int(length / 0.05))
        rows = np.zeros((len(z), 4))
        rows[:, 2], rows[:, 3] = z, 0.045
        links[name] = rows
    pairs = [(a, b) for i, a in enumerate(NAMES) for b in NAMES[i + 3 :]]
    return iksel.RobotSpheres(links, pairs)


def turned(rng: np.random.Generator, reach: float = 0.9) -> np.ndarray:
    """A pose somewhere around the arm."""
    q = rng.normal(size=4)
    pose = iksel.pose_from_quaternion(
        rng.uniform(-reach, reach, 3), q / np.linalg.norm(q)
    )
    return np.asarray(pose)


class Brute:
    """The same obstacles, each by the distance from its own frame's origin or sides."""

    def __init__(self) -> None:
        self.distances = {}

    def fill(self, scene: iksel.Scene, rng: np.random.Generator) -> None:
        pose = {
            k: turned(rng) for k in ("sphere", "box", "capsule", "cylinder", "points")
        }
        size = rng.uniform(0.05, 0.4, 3)
        margin = {k: float(rng.uniform(0, 0.05)) for k in pose}
        points = rng.uniform(-0.3, 0.3, (40, 3))
        scene.add_sphere("sphere", 0.2, pose["sphere"], margin["sphere"])
        scene.add_box("box", size, pose["box"], margin["box"])
        scene.add_capsule("capsule", 0.05, 0.4, pose["capsule"], margin["capsule"])
        scene.add_cylinder("cylinder", 0.1, 0.3, pose["cylinder"], margin["cylinder"])
        scene.add_points("points", points, 0.01, pose["points"], margin["points"])
        plane = np.eye(4)
        plane[2, 3] = -0.1
        scene.add_half_space("floor", plane, 0.02)

        def out(v: np.ndarray) -> float:
            return float(np.linalg.norm(np.maximum(v, 0)))

        self.local = {k: np.linalg.inv(p) for k, p in pose.items()} | {
            "floor": np.eye(4)
        }
        self.margin = margin | {"floor": 0.02}
        self.distance = {
            "sphere": lambda p: np.linalg.norm(p) - 0.2,
            "box": lambda p: out(np.abs(p) - size / 2),
            "capsule": lambda p: (
                np.linalg.norm(p - [0, 0, np.clip(p[2], -0.2, 0.2)]) - 0.05
            ),
            "cylinder": lambda p: out(
                np.array([np.hypot(p[0], p[1]) - 0.1, abs(p[2]) - 0.15])
            ),
            "points": lambda p: np.linalg.norm(points - p, axis=1).min() - 0.01,
            "floor": lambda p: p[2] + 0.1,
        }

    def touching(self, centre: np.ndarray, radius: float) -> set[str]:
        return {
            k
            for k, distance in self.distance.items()
            if distance((self.local[k] @ [*centre, 1])[:3]) <= radius + self.margin[k]
        }


def test_free_and_contacts_are_those_of_brute_force(arm, spheres) -> None:
    rng = np.random.default_rng(SEED)
    seen = {True: 0, False: 0}
    for _ in range(30):
        scene, brute = iksel.Scene(arm, spheres), Brute()
        brute.fill(scene, rng)
        q = arm.random_configurations(19, seed=int(rng.integers(1 << 30)))
        poses = arm.link_poses(q)
        free = scene.is_free(q)
        for row in range(len(q)):
            balls = {
                name: [
                    ((poses[row, arm.link_names.index(name)] @ [*b[:3], 1])[:3], b[3])
                    for b in rows
                ]
                for name, rows in spheres.links.items()
            }
            expected = {
                (name, other)
                for name, of in balls.items()
                if name != "l0"  # which does not move
                for c, r in of
                for other in brute.touching(c, r)
            } | {
                (a, b)
                for a, b in spheres.pairs
                if any(
                    np.linalg.norm(c - d) <= r + s
                    for c, r in balls[a]
                    for d, s in balls[b]
                )
            }
            found = {(c.link, c.other) for c in scene.contacts(q[row])}
            assert found == expected
            assert bool(free[row]) == (not expected) == scene.is_free(q[row])
            seen[bool(free[row])] += 1
    assert min(seen.values()) > 20


def test_depths_are_how_far_things_have_to_part(arm, spheres) -> None:
    """A box moved away by the depth along its side no longer touches."""
    q = np.zeros(6)
    scene = iksel.Scene(arm, spheres)
    top = sum(LENGTHS) + 0.045
    scene.add_box("lid", [1, 1, 0.2], [0, 0, top + 0.1 - 0.012], margin=0.005)
    (contact,) = scene.contacts(q)
    assert (contact.link, contact.other, contact.is_obstacle) == ("l6", "lid", True)
    assert contact.depth == pytest.approx(0.017, abs=1e-9)
    scene.move("lid", [0, 0, top + 0.1 + 0.006])
    assert scene.is_free(q)
    assert scene.contacts(q) == []


def test_solves_are_free_whenever_a_branch_is(arm, spheres) -> None:
    solver = iksel.Solver(arm)
    rng = np.random.default_rng(SEED + 1)
    counts = {True: 0, False: 0}
    for target in arm.fk(arm.random_configurations(60, seed=SEED)):
        scene = iksel.Scene(arm, spheres)
        Brute().fill(scene, rng)
        every = solver.solve_all(target, max=1000)
        any_free = bool(np.any(scene.is_free(every.q)))
        free = solver.solve_all(target, scene=scene, near=np.zeros(6))
        result = solver.solve(target, scene=scene)
        near = solver.solve(target, scene=scene, near=np.zeros(6))
        assert result.success == near.success == free.success == any_free
        for answer in [*free, result, near]:
            if answer.success:
                assert scene.is_free(answer.q)
            else:
                assert answer.status is iksel.Status.in_collision
        if near.success:
            assert near.move <= free.move.min() + 1e-6
        elif every.success:
            diagnosis = solver.diagnose(target, scene=scene)
            assert diagnosis.cause is iksel.Cause.collision
            assert diagnosis.refused == len(every)
            assert diagnosis.contacts
            first = diagnosis.contacts[0]
            assert f"'{first.link}' touches" in diagnosis.message
            assert first.depth == max(c.depth for c in diagnosis.contacts)
        counts[result.success] += 1
    assert min(counts.values()) > 3


def test_batches_paths_and_trackers_stay_free(arm, spheres) -> None:
    solver = iksel.Solver(arm)
    scene = iksel.Scene(arm, spheres)
    scene.add_box("wall", [0.2, 2, 2], [0.45, 0, 0.5])
    targets = arm.fk(arm.random_configurations(300, seed=SEED))
    batch = solver.solve_batch(targets, scene=scene, threads=2)
    assert np.all(scene.is_free(batch.q[batch.success]))
    one_by_one = [solver.solve(target, scene=scene) for target in targets]
    assert [r.success for r in one_by_one] == batch.success.tolist()
    assert 50 < batch.success.sum() < 290
    filtered = solver.solve_batch(targets, scene=scene, filter=lambda q: q[:, 0] > 0)
    assert np.all(filtered.q[filtered.success][:, 0] > 0)
    assert np.all(scene.is_free(filtered.q[filtered.success]))

    start = batch.q[batch.success][0]
    poses = [arm.fk(start + i * 0.01 * np.array([1, 0, 0, 0, 0, 1])) for i in range(8)]
    path = solver.solve_path(poses, start=start, scene=scene)
    assert np.all(scene.is_free(path.q))
    assert path.success or path.status is iksel.Status.in_collision

    tracker = solver.tracker(start)
    scene.add_half_space("floor", [0, 0, arm.fk(start)[2, 3] + 9])
    result = tracker.track(poses[1], 1.0, scene=scene)
    assert result.status is iksel.Status.in_collision
    assert np.array_equal(tracker.q, start)
    scene.remove("floor")
    assert tracker.track(poses[0], 1.0, scene=scene)


def test_attached_objects_move_with_their_link(arm, spheres) -> None:
    q = np.zeros(6)
    scene = iksel.Scene(arm, spheres)
    scene.add_box("shelf", [0.5, 0.5, 0.02], [0, 0, sum(LENGTHS) + 0.2])
    assert scene.is_free(q)
    scene.attach("cup", "l6", [[0, 0, LENGTHS[6] + 0.13, 0.08]])
    (contact,) = scene.contacts(q)
    assert (contact.link, contact.other) == ("cup", "shelf")
    assert contact.depth == pytest.approx(0.02, abs=1e-9)
    assert scene.attached == {"cup": "l6"}
    target = arm.fk(q)
    message = iksel.Solver(arm).diagnose(target, scene=scene).message
    assert "object 'cup' touches box 'shelf' by 20 mm:" in message
    scene.add_box("board", [0.5, 0.5, 0.02], [0, 0, sum(LENGTHS) + 0.22 - 5e-10])
    exact = iksel.SolverOptions(position_tolerance=1e-11, rotation_tolerance=1e-11)
    message = iksel.Solver(arm, exact).diagnose(target, scene=scene).message
    assert "object 'cup' touches box 'board':" in message  # by no more than rounding
    scene.remove("board")
    folded = np.array([0, 1.5, 2.6, 0, 2.0, 0])
    touched = {c.other for c in scene.contacts(folded) if c.link == "cup"}
    touched |= {c.link for c in scene.contacts(folded) if c.other == "cup"}
    scene.attach(
        "cup", "l6", [[0, 0, LENGTHS[6] + 0.13, 0.08]], may_touch=[*touched - {"shelf"}]
    )
    assert not any("cup" in (c.link, c.other) for c in scene.contacts(folded))
    scene.remove("cup")
    assert scene.is_free(q)


def test_a_scene_is_a_value(arm, spheres) -> None:
    scene = iksel.Scene(arm, spheres)
    Brute().fill(scene, np.random.default_rng(SEED))
    scene.attach("cup", "l6", [[0, 0, 0.1, 0.05]], may_touch=["l3"])
    q = arm.random_configurations(200, seed=SEED)
    free = scene.is_free(q)
    for other in (
        copy.copy(scene),
        copy.deepcopy(scene),
        pickle.loads(pickle.dumps(scene)),
    ):
        assert list(other.obstacles) == list(scene.obstacles)
        assert np.array_equal(other.is_free(q), free)
        for name in other.obstacles:
            other.remove(name)
        other.remove("cup")
        assert np.array_equal(scene.is_free(q), free)
        assert not np.array_equal(other.is_free(q), free)
        assert pickle.loads(pickle.dumps(other.spheres)).pairs == spheres.pairs


def test_errors_name_the_culprit(arm, spheres) -> None:
    with pytest.raises(
        iksel.InvalidArgumentError, match=r"there are none.*iksel\.spheres"
    ):
        iksel.Scene(arm, iksel.RobotSpheres({}))
    with pytest.raises(iksel.UnknownNameError, match="no link 'l9'.*l0, l1"):
        iksel.Scene(arm, iksel.RobotSpheres({"l9": [[0, 0, 0, 1]]}))
    with pytest.raises(iksel.InvalidArgumentError, match="number 0 of 'l1'.*-1 m"):
        iksel.RobotSpheres({"l1": [[0, 0, 0, -1]]})
    with pytest.raises(iksel.InvalidArgumentError, match="pairs: 'l2' has no spheres"):
        iksel.RobotSpheres({"l1": [[0, 0, 0, 1]]}, [("l1", "l2")])
    scene = iksel.Scene(arm, spheres)
    with pytest.raises(iksel.InvalidArgumentError, match="size: 0 m is not above 0"):
        scene.add_box("box", [1, 0, 1], np.eye(4))
    with pytest.raises(iksel.InvalidArgumentError, match="name: 'l3' is a link"):
        scene.add_box("l3", [1, 1, 1], np.eye(4))
    with pytest.raises(iksel.InvalidArgumentError, match="points: there are none"):
        scene.add_points("cloud", np.zeros((0, 3)), 0.1)
    with pytest.raises(iksel.InvalidArgumentError, match="margin: -1 m"):
        scene.add_sphere("ball", 1.0, np.eye(4), margin=-1)
    with pytest.raises(iksel.UnknownNameError, match="no obstacle 'box'"):
        scene.move("box", np.eye(4))
    with pytest.raises(
        iksel.UnknownNameError, match="link: the URDF has no link 'hand'"
    ):
        scene.attach("cup", "hand", [[0, 0, 0, 1]])
    with pytest.raises(iksel.UnknownNameError, match="may_touch: .*'hand'"):
        scene.attach("cup", "l6", [[0, 0, 0, 1]], may_touch=["hand"])
    other = iksel.Solver(iksel.load_robot("ur3"))
    with pytest.raises(
        iksel.InvalidArgumentError, match="scene: it is of another chain"
    ):
        other.solve(np.eye(4), scene=scene)
    with pytest.raises(TypeError, match="expected a Scene"):
        other.solve(np.eye(4), scene=[])


def test_spheres_of_a_urdf_cover_it_and_stick_out_by_no_more(arm) -> None:
    pytest.importorskip("coal")
    made = iksel.spheres.from_urdf(URDF, arm, max_error=0.03, samples=100)
    rng = np.random.default_rng(SEED)
    for name, length in zip(NAMES, LENGTHS, strict=True):
        rows = made.links[name]
        turn = rng.uniform(0, 2 * np.pi, 4_000)
        across = 0.04 * np.sqrt(rng.uniform(0, 1, turn.size))
        z = length * rng.uniform(0, 1, turn.size)
        points = np.stack([across * np.cos(turn), across * np.sin(turn), z], 1)
        inside = np.linalg.norm(points[:, None] - rows[:, :3], axis=2) <= rows[:, 3]
        assert inside.any(axis=1).all()
        depth = np.minimum(
            0.04 - np.hypot(rows[:, 0], rows[:, 1]),
            np.minimum(rows[:, 2], length - rows[:, 2]),
        )
        assert np.all(rows[:, 3] - depth <= 0.03 * PART_OF_CYLINDER * (1 + 1e-6))
    fewer = iksel.spheres.from_urdf(URDF, arm, max_error=0.06, samples=100)
    assert len(fewer.links["l2"]) < len(made.links["l2"])


def test_a_mesh_and_a_box_are_covered(arm, tmp_path) -> None:
    pytest.importorskip("coal")
    corners = ["0 0 0", "0.2 0 0", "0 0.2 0", "0 0 0.2"]
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    lines = ["solid t"]
    for face in faces:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {corners[i]}" for i in face]
        lines += ["endloop", "endfacet"]
    (tmp_path / "t.stl").write_text("\n".join([*lines, "endsolid t"]))
    text = URDF.replace(
        '<cylinder radius="0.04" length="0.4"/>', '<mesh filename="t.stl"/>'
    ).replace('<cylinder radius="0.04" length="0.35"/>', '<box size="0.1 0.2 0.3"/>')
    path = tmp_path / "arm.urdf"
    path.write_text(text)
    made = iksel.spheres.from_urdf(path, arm, max_error=0.03, samples=100)
    rng = np.random.default_rng(SEED)
    weights = rng.dirichlet(np.ones(4), 20_000)
    tetrahedron = weights[:, 1:] * 0.2 + [0, 0, 0.2]  # the origin of the collision
    box = rng.uniform(-0.5, 0.5, (20_000, 3)) * [0.1, 0.2, 0.3] + [0, 0, 0.175]
    for name, points in (("l2", tetrahedron), ("l3", box)):
        rows = made.links[name]
        inside = np.linalg.norm(points[:, None] - rows[:, :3], axis=2) <= rows[:, 3]
        assert inside.any(axis=1).all()


def test_spheres_that_cover_never_pass_what_coal_calls_a_contact(arm) -> None:
    pytest.importorskip("coal")
    # So much that the spheres of cylinders stick out by 3 cm.
    error = 0.03 / PART_OF_CYLINDER
    made = iksel.spheres.from_urdf(URDF, arm, max_error=error, samples=100)
    rng = np.random.default_rng(SEED)
    passed = refused = 0
    for _ in range(6):
        scene = iksel.Scene(arm, made)
        Brute().fill(scene, rng)
        exact = iksel.exact.ExactCollision(scene, URDF)
        q = arm.random_configurations(150, seed=int(rng.integers(1 << 30)))
        free, real = scene.is_free(q), exact.geometry_is_free(q)
        assert not np.any(free & ~real)
        assert np.array_equal(exact(q), real)
        passed += free.sum()
        refused += (~free & real).sum()
    assert passed > 50
    assert refused > 5  # where the spheres stick out


def test_sphere_files(arm, tmp_path) -> None:
    pytest.importorskip("yaml")
    spheres = tmp_path / "spheres"
    spheres.mkdir()
    (spheres / "arm.yml").write_text(
        "collision_spheres:\n"
        "  l1: [{center: [0, 0, 0.1], radius: 0.05}]\n"
        "  l4: [{center: [0, 0, 0], radius: 0.04}, {center: [0, 0, 1], radius: -9}]\n"
        "  l5: [{center: [0, 0, 0], radius: 0.04}]\n"
    )
    (tmp_path / "arm.yml").write_text(
        "robot_cfg:\n  kinematics:\n    collision_spheres: spheres/arm.yml\n"
        "    collision_sphere_buffer: 0.01\n"
        "    self_collision_ignore: {l4: [l5]}\n"
    )
    read = iksel.spheres.from_curobo(tmp_path / "arm.yml")
    assert read.links["l4"].tolist() == [[0, 0, 0, pytest.approx(0.05)]]
    assert read.pairs == [("l1", "l4"), ("l1", "l5")]
    (tmp_path / "arm.json").write_text(
        '{"l1": [{"origin": [0, 0, 0.1], "radius": 0.06}],'
        ' "l4": [{"origin": [0, 0, 0], "radius": 0.05}]}'
    )
    bare = iksel.spheres.from_json(tmp_path / "arm.json")
    assert np.array_equal(bare.links["l4"], read.links["l4"])
    assert bare.pairs == []
    assert iksel.spheres.with_pairs(bare, arm, samples=200).pairs == [("l1", "l4")]
    file = tmp_path / "arm.npz"
    iksel.spheres.save(read, file)
    again = iksel.spheres.load(file)
    assert again.pairs == read.pairs
    assert all(np.array_equal(again.links[k], rows) for k, rows in read.links.items())
    for bad in ('{"l1": [{"origin": [0, 0], "radius": 1}]}', "[]", "{"):
        (tmp_path / "bad.json").write_text(bad)
        with pytest.raises(iksel.InvalidArgumentError, match="path: "):
            iksel.spheres.from_json(tmp_path / "bad.json")
        with pytest.raises(iksel.InvalidArgumentError, match="path: "):
            iksel.spheres.load(tmp_path / "bad.json")
