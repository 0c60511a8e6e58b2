# SPDX-License-Identifier: BSD-3-Clause
"""Spheres made and kept, and coal as the second opinion on them."""

from __future__ import annotations

import numpy as np
import pytest
from tubes import LENGTHS, NAMES, URDF

import iksel
import iksel.exact
import iksel.spheres
from iksel.spheres import PART_OF_CYLINDER

pytest.importorskip("coal")

SEED = 11
RADIUS = 0.04


@pytest.fixture(scope="module")
def arm() -> iksel.Robot:
    return iksel.Robot.from_urdf(URDF, base_link="l0", tip_link="l6")


@pytest.fixture(scope="module")
def spheres(arm: iksel.Robot) -> iksel.RobotSpheres:
    # So much that the spheres of cylinders stick out by 4 cm.
    error = 0.04 / PART_OF_CYLINDER
    return iksel.spheres.from_urdf(URDF, arm, max_error=error, samples=500)


def rods() -> str:
    """The tubes, with a ball on both ends of each."""
    text = URDF
    for name, length in zip(NAMES, LENGTHS, strict=True):
        balls = "".join(
            f'<collision><origin xyz="0 0 {z}"/><geometry><sphere radius="{RADIUS}"/>'
            "</geometry></collision>"
            for z in (0, length)
        )
        text = text.replace(f'<link name="{name}">', f'<link name="{name}">{balls}')
    return text


def test_rods_are_covered_closely(arm) -> None:
    made = iksel.spheres.from_urdf(rods(), arm, max_error=0.02, samples=100)
    rng = np.random.default_rng(SEED)
    for name, length in zip(NAMES, LENGTHS, strict=True):
        rows = made.links[name]
        along = np.clip(rows[:, 2], 0, length)
        off = np.linalg.norm(rows[:, :3] - np.c_[0 * along, 0 * along, along], axis=1)
        assert np.all(off + rows[:, 3] <= RADIUS + 0.02 * PART_OF_CYLINDER)
        turn, z = rng.uniform(0, 2 * np.pi, 4_000), rng.uniform(0, length, 4_000)
        points = np.c_[RADIUS * np.cos(turn), RADIUS * np.sin(turn), z]
        inside = np.linalg.norm(points[:, None] - rows[:, :3], axis=2) <= rows[:, 3]
        assert inside.any(axis=1).all()
    assert len(made.links["l2"]) < 40


def test_a_second_opinion_finds_what_spheres_refuse(arm, spheres) -> None:
    solver = iksel.Solver(arm)
    rng = np.random.default_rng(SEED)
    scene = iksel.Scene(arm, spheres)
    for i in range(4):
        place = np.append(rng.uniform(-0.5, 0.5, 2), rng.uniform(0, 0.8))
        scene.add_box(f"box {i}", rng.uniform(0.1, 0.3, 3), place)
    exact = iksel.exact.ExactCollision(scene, URDF)
    targets = arm.fk(arm.random_configurations(60, seed=SEED))
    more = lost = 0
    batch = solver.solve_batch(targets, scene=scene, exact=exact)
    for target, row in zip(targets, batch.success, strict=True):
        plain = solver.solve(target, scene=scene)
        result = solver.solve(target, scene=scene, exact=exact)
        near = solver.solve(target, scene=scene, exact=exact, near=np.zeros(6))
        every = solver.solve_all(target, scene=scene, exact=exact, max=1000)
        q = solver.solve_all(target, max=1000).q
        any_free = bool(exact.geometry_is_free(q).any())
        assert [bool(result), bool(near), bool(every), bool(row)] == [any_free] * 4
        for answer in [*every, result, near]:
            assert not answer or exact.geometry_is_free(answer.q[None]).all()
        assert any_free or result.status is iksel.Status.in_collision
        more += any_free and not plain
        lost += not any_free
    assert more > 1
    assert lost > 1
    path = solver.solve_path(targets[:1], scene=scene, exact=exact)
    assert path.success == bool(batch.success[0])
    with pytest.raises(iksel.InvalidArgumentError, match="exact: there is no scene"):
        solver.solve(targets[0], exact=exact)
    with pytest.raises(TypeError, match="exact"):
        solver.solve(targets[0], scene=scene, exact=True)


def test_links_without_spheres_are_not_looked_at(arm, spheres) -> None:
    pair = spheres.pairs[0]
    alone = iksel.RobotSpheres({link: spheres.links[link] for link in pair}, [pair])
    ignored = [other for other in spheres.pairs if other != pair]
    geometry = iksel.collision.SelfCollision(URDF, arm, ignore=ignored, samples=500)
    assert geometry.pairs == [pair]
    exact = iksel.exact.ExactCollision(iksel.Scene(arm, alone), URDF)
    q = arm.random_configurations(500, seed=SEED)
    free = exact.geometry_is_free(q)
    np.testing.assert_array_equal(free, geometry(q))
    assert not free.all()


def test_attached_objects_count_by_their_spheres(arm, spheres) -> None:
    """Of objects alone, coal finds what spheres find."""
    rng = np.random.default_rng(SEED)
    alone = iksel.RobotSpheres(spheres.links, [])
    scene = iksel.Scene(arm, alone)
    scene.attach("cup", "l6", [[0, 0, 0.2, 0.08], [0.1, 0, 0.2, 0.03]])
    scene.attach("lid", "l3", [[0.2, 0, 0.1, 0.1]], may_touch=["cup"])
    scene.add_box("wall", [0.1, 1, 1], [0.5, 0, 0.5])
    assert scene.may_touch == {"cup": [], "lid": ["cup"]}
    assert scene.attached_spheres["lid"].tolist() == [[0.2, 0, 0.1, 0.1]]
    exact = iksel.exact.ExactCollision(scene, URDF)
    seen = {"link": 0, "wall": 0, "free": 0}
    for q in arm.random_configurations(1_000, seed=int(rng.integers(1 << 30))):
        contacts = scene.contacts(q)
        objects = {c for c in contacts if {"cup", "lid"} & {c.link, c.other}}
        assert not any({c.link, c.other} == {"cup", "lid"} for c in objects)
        real = exact.geometry_is_free(q[None])[0]
        if not contacts:
            assert real
            seen["free"] += 1
        elif any(c.other == "wall" and c.link in {"cup", "lid"} for c in objects):
            assert not real  # a box, and spheres that are what they are
            seen["wall"] += 1
        elif not real and not any(c.is_obstacle for c in contacts):
            assert objects
            seen["link"] += 1
    assert min(seen.values()) > 10


def test_spheres_are_kept_in_a_cache(arm, tmp_path, monkeypatch) -> None:
    folder = tmp_path / "kept"
    options = {"max_error": 0.05, "samples": 50, "cache": folder}
    made = iksel.spheres.from_urdf(URDF, arm, **options)
    (file,) = folder.glob("*.spheres.npz")
    assert file.name.startswith("tubes-")

    def forbidden(*_: object, **__: object) -> None:
        raise AssertionError

    with monkeypatch.context() as patch:
        patch.setattr(iksel.spheres, "spheres_around", forbidden)
        again = iksel.spheres.from_urdf(URDF, arm, **options)
        for name, rows in made.links.items():
            assert np.array_equal(again.links[name], rows)
        assert again.pairs == made.pairs
        with pytest.raises(AssertionError):
            iksel.spheres.from_urdf(URDF, arm, **{**options, "max_error": 0.06})
        thicker = URDF.replace('"0.04"', '"0.05"')
        with pytest.raises(AssertionError):
            iksel.spheres.from_urdf(thicker, arm, **options)
    content = file.read_bytes()
    file.write_bytes(content[: len(content) // 2])
    again = iksel.spheres.from_urdf(URDF, arm, **options)
    assert np.array_equal(again.links["l2"], made.links["l2"])
    assert len(iksel.spheres.load(file).links) == len(made.links)
    with pytest.raises(iksel.InvalidArgumentError, match="cannot be written"):
        iksel.spheres.from_urdf(URDF, arm, **{**options, "cache": file})
