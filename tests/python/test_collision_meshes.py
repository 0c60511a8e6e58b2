# SPDX-License-Identifier: BSD-3-Clause
"""Self-collision of arms whose links are large, uneven meshes."""

from __future__ import annotations

import json
from itertools import count
from pathlib import Path

import numpy as np
import pytest

import iksel
from iksel import collision
from iksel.collision import _proof as proof
from iksel.collision._search import PairSearch
from iksel.collision._shapes import Shapes

coal = pytest.importorskip("coal")

LINKS = 7


def vector(values) -> str:
    return " ".join(f"{x:.6f}" for x in values)


def write_mesh(path: Path, rng: np.random.Generator, rings: int) -> None:
    """A binary STL of a bent, bumpy tube along z, which is far from convex."""
    turns = np.linspace(0, 2 * np.pi, 2 * rings, endpoint=False)
    along = np.linspace(0, 1, rings)
    radius = 0.02 + 0.015 * rng.uniform(size=(rings, len(turns)))
    bend = 0.06 * np.sin(np.pi * along) * rng.uniform(-1, 1)
    x = radius * np.cos(turns) + bend[:, None]
    y = radius * np.sin(turns)
    z = np.broadcast_to(0.2 * along[:, None], x.shape)
    grid = np.stack([x, y, z], axis=-1)
    side = np.roll(grid, -1, axis=1)
    faces = [(grid[:-1], side[:-1], side[1:]), (grid[:-1], side[1:], grid[1:])]
    triangles = np.concatenate([np.stack(f, 2).reshape(-1, 3, 3) for f in faces])
    rows = np.zeros(
        len(triangles), dtype=[("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]
    )
    rows["v"] = triangles
    path.write_bytes(bytes(80) + np.uint32(len(rows)).tobytes() + rows.tobytes())


def write_arm(folder: Path, rng: np.random.Generator, rings: int) -> Path:
    """A chain of such links, at random places and on random axes."""
    parts = []
    for i in range(LINKS):
        write_mesh(folder / f"{i}.stl", rng, rings)
        parts.append(
            f'<link name="l{i}"><collision><geometry><mesh filename="{i}.stl"/>'
            "</geometry></collision></link>"
        )
    for i in range(LINKS - 1):
        xyz = [*rng.uniform(-0.08, 0.08, 2), rng.uniform(0.05, 0.25)]
        low = rng.uniform(-2.8, 0)
        axis = [*rng.normal(size=2), 0.3 * rng.normal()]  # so that the arm folds
        parts.append(
            f'<joint name="j{i}" type="revolute"><parent link="l{i}"/>'
            f'<child link="l{i + 1}"/><origin xyz="{vector(xyz)}"/>'
            f'<axis xyz="{vector(axis)}"/><limit lower="{low}" '
            f'upper="{low + rng.uniform(0.5, 4)}" effort="1" velocity="1"/></joint>'
        )
    path = folder / "arm.urdf"
    path.write_text(f'<robot name="arm">{"".join(parts)}</robot>', "utf-8")
    return path


def touching(path: Path, robot: iksel.Robot, q: np.ndarray) -> set[tuple[str, str]]:
    """Pairs of links whose meshes touch at some configurations, by coal alone."""
    meshes = [
        coal.MeshLoader().load(str(path.parent / f"{i}.stl"), np.ones(3))
        for i in range(LINKS)
    ]
    places = robot.link_poses(q)
    found = set()
    for i in range(LINKS):
        for j in range(i + 1, LINKS):
            test = coal.ComputeCollision(meshes[i], meshes[j])
            for pose in places:
                a, b = (coal.Transform3s(p[:3, :3], p[:3, 3]) for p in pose[[i, j]])
                result = coal.CollisionResult()
                if test(a, b, coal.CollisionRequest(), result):
                    found.add((f"l{i}", f"l{j}"))
                    break
    return found


@pytest.mark.parametrize("seed", [0, 3, 6, 8, 9, 10])
def test_no_pair_is_left_out_that_collides(tmp_path: Path, seed: int) -> None:
    """By the meshes themselves, at configurations that the search has not seen."""
    path = write_arm(tmp_path, np.random.default_rng(seed), rings=30)
    robot = iksel.load_robot(path)
    free = collision.SelfCollision(path, robot, samples=1_000)
    q = robot.random_configurations(1_500, seed=seed + 100)
    left_out = {p for p, why in free.ignored.items() if why in ("apart", "never")}
    assert left_out, f"seed {seed}: nothing is left out"
    assert not left_out & touching(path, robot, q), f"seed {seed}"


def test_proofs_have_a_budget_for_all_pairs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No mesh is looked at in them, and hulls so often at most, of all pairs."""
    path = write_arm(tmp_path, np.random.default_rng(1), rings=10)
    robot = iksel.load_robot(path)
    whole = collision.SelfCollision(path, robot, samples=0)
    touch, tests = Shapes.touch, []

    def note(*arguments, **settings) -> bool:
        tests.append(settings.get("hulls", False))
        return touch(*arguments, **settings)

    monkeypatch.setattr(Shapes, "touch", note)
    monkeypatch.setattr(proof, "_MOST_TESTS", 12)
    hurried = collision.SelfCollision(path, robot, samples=0)
    assert 0 < len(tests) <= 12
    assert all(tests)
    assert set(hurried.pairs) > set(whole.pairs)


def test_progress_is_reported(tmp_path: Path) -> None:
    path = write_arm(tmp_path, np.random.default_rng(2), rings=5)
    robot = iksel.load_robot(path)
    calls = []
    found = collision.SelfCollision(
        path, robot, samples=50, progress=lambda *now: calls.append(now)
    )
    adjacent = list(found.ignored.values()).count("adjacent")
    total = 2 * (LINKS * (LINKS - 1) // 2 - adjacent)
    done = [n for n, _ in calls]
    assert {of for _, of in calls} == {total}
    assert done == sorted(done)
    assert done[-1] == total
    assert len(done) > total // 2

    def stop(*_: int) -> None:
        raise InterruptedError

    with pytest.raises(InterruptedError):
        collision.SelfCollision(path, robot, progress=stop)


def test_what_was_found_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In a file for all that it depends on; one that is damaged is made anew."""
    path = write_arm(tmp_path, np.random.default_rng(3), rings=5)
    robot = iksel.load_robot(path)
    folder = tmp_path / "made"

    def find(**settings) -> dict[tuple[str, str], str]:
        settings = {"samples": 60, "cache": folder, "margin": 0.01, **settings}
        found = collision.SelfCollision(path, robot, **settings)
        return {**found.ignored, **dict.fromkeys(found.pairs, "")}

    first = find(cache=None)
    assert find() == first
    (file,) = folder.iterdir()
    text = file.read_text("utf-8")
    searches = count()

    def search(*_: object) -> None:
        next(searches)
        raise InterruptedError

    with monkeypatch.context() as patch:
        patch.setattr(PairSearch, "run", search)
        assert find() == first
        for other in ({"margin": 0.0}, {"samples": 61}, {"seed": 1}):
            with pytest.raises(InterruptedError):
                find(**other)
    assert next(searches) == 3
    known = json.loads(text)["pairs"]
    for damaged in (text[:-5], "[]", text.replace("l0", "lx"), '{"pairs": [[1]]}'):
        file.write_text(damaged, "utf-8")
        assert find() == first
        assert json.loads(file.read_text("utf-8"))["pairs"] == known
    write_mesh(tmp_path / "0.stl", np.random.default_rng(9), rings=6)
    find()
    assert len(list(folder.iterdir())) == 2
    with pytest.raises(iksel.InvalidArgumentError, match="cannot be written"):
        find(cache=path)
