# SPDX-License-Identifier: BSD-3-Clause
"""Self-collision as a filter, on an arm of simple shapes."""

from __future__ import annotations

import numpy as np
import pytest

import iksel

coal = pytest.importorskip("coal")
collision = pytest.importorskip("iksel.collision")


def link(name: str, length: float) -> str:
    if not length:
        return f'<link name="{name}"/>'
    return f"""<link name="{name}"><collision>
      <origin xyz="0 0 {length / 2}"/>
      <geometry><cylinder radius="0.04" length="{length}"/></geometry>
    </collision></link>"""


def joint(name: str, parent: str, child: str, z: float, axis: str) -> str:
    return f"""<joint name="{name}" type="revolute">
      <parent link="{parent}"/><child link="{child}"/>
      <origin xyz="0 0 {z}"/><axis xyz="{axis}"/>
      <limit lower="-2.9" upper="2.9" effort="1" velocity="1"/></joint>"""


LENGTHS = [0.15, 0.1, 0.4, 0.35, 0.1, 0.1, 0.05]
AXES = ["0 0 1", "0 1 0", "0 1 0", "0 0 1", "0 1 0", "0 0 1"]
NAMES = [f"l{i}" for i in range(7)]
URDF = (
    '<robot name="tubes">'
    + "".join(link(n, z) for n, z in zip(NAMES, LENGTHS, strict=True))
    + "".join(
        joint(f"j{i}", NAMES[i], NAMES[i + 1], LENGTHS[i], AXES[i]) for i in range(6)
    )
    + "</robot>"
)


@pytest.fixture(scope="module")
def arm() -> iksel.Robot:
    return iksel.Robot.from_urdf(URDF, base_link="l0", tip_link="l6")


def capsule_distance(a: np.ndarray, b: np.ndarray) -> float:
    """The smallest distance of points sampled on two segments, (2, 3) each [m]."""
    t = np.linspace(0, 1, 60)[:, None]
    p, q = (s[0] + t * (s[1] - s[0]) for s in (a, b))
    return float(np.linalg.norm(p[:, None] - q[None], axis=2).min())


def segments(arm: iksel.Robot, q: np.ndarray) -> dict[str, np.ndarray]:
    """Axis of each link's tube in the base frame, by the library's own FK."""
    found = {"l0": np.array([[0, 0, 0], [0, 0, LENGTHS[0]]], dtype=float)}
    for i in range(1, 7):
        part = iksel.Robot.from_urdf(URDF, base_link="l0", tip_link=f"l{i}")
        pose = part.fk(q[:i])
        found[f"l{i}"] = np.stack([pose[:3, 3], (pose @ [0, 0, LENGTHS[i], 1])[:3]])
    return found


def test_agrees_with_the_distance_of_the_axes(arm) -> None:
    free = collision.SelfCollision(URDF, arm)
    assert ("l0", "l2") in free.pairs
    assert ("l0", "l1") not in free.pairs
    seen = {True: 0, False: 0}
    for q in arm.random_configurations(60, seed=3):
        axes = segments(arm, q)
        distances = [capsule_distance(axes[a], axes[b]) for a, b in free.pairs]
        # A flat end lies inside its capsule: nearer than the radii says nothing.
        if min(distances) > 0.085:
            assert free(q[None]).tolist() == [True]
            seen[True] += 1
        if min(distances) < 0.03:
            assert free(q[None]).tolist() == [False]
            seen[False] += 1
    assert min(seen.values()) > 3


def test_margin_and_ignore(arm) -> None:
    bent = np.array([0, 1.2, 2.0, 0, 0, 0])
    pair = collision.SelfCollision(URDF, arm, margin=0.3).colliding_links(bent)
    assert pair is not None
    everything = collision.SelfCollision(URDF, arm).pairs
    assert collision.SelfCollision(URDF, arm, margin=9, ignore=everything)(bent)
    with pytest.raises(iksel.UnknownNameError, match="elbow"):
        collision.SelfCollision(URDF, arm, ignore=[("l0", "elbow")])


def test_solves_are_free_whenever_a_branch_is(arm) -> None:
    free = collision.SelfCollision(URDF, arm)
    solver = iksel.Solver(arm)
    counts = {True: 0, False: 0}
    for target in arm.fk(arm.random_configurations(40, seed=4)):
        result = solver.solve(target, filter=free)
        any_free = bool(free(solver.solve_all(target).q).any())
        assert result.success or not any_free
        assert not result.success or free(result.q[None])[0]
        counts[result.success] += 1
    assert counts[True] > 0


def test_errors_name_the_culprit(arm) -> None:
    with pytest.raises(iksel.UrdfError, match="no link has collision geometry"):
        collision.SelfCollision('<robot name="r"><link name="l"/></robot>', arm)
    with pytest.raises(iksel.UrdfError, match="urdf"):
        collision.SelfCollision("<robot", arm)
    with pytest.raises(iksel.InvalidArgumentError, match="margin"):
        collision.SelfCollision(URDF, arm, margin=-1)
    mesh = URDF.replace(
        '<cylinder radius="0.04" length="0.4"/>', '<mesh filename="package://x/a.stl"/>'
    )
    with pytest.raises(iksel.UnknownNameError, match="'x'"):
        collision.SelfCollision(mesh, arm)
