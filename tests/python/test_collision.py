# SPDX-License-Identifier: BSD-3-Clause
"""Self-collision as a filter, on an arm of simple shapes."""

from __future__ import annotations

import sys

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


TUBE = '<cylinder radius="0.04" length="0.4"/>'
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
    for q in arm.random_configurations(300, seed=3):
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
    with pytest.raises(iksel.UrdfError, match="'l2' has an empty collision"):
        collision.SelfCollision(URDF.replace(TUBE, ""), arm)
    with pytest.raises(iksel.UrdfError, match="'l2'.*cylinder with radius='wide'"):
        collision.SelfCollision(URDF.replace(TUBE, TUBE.replace("0.04", "wide")), arm)
    with pytest.raises(iksel.UrdfError, match="'l2'.*'capsule'.*box, cylinder"):
        collision.SelfCollision(URDF.replace(TUBE, "<capsule/>"), arm)
    with pytest.raises(iksel.UrdfError, match=r"absent\.urdf"):
        collision.SelfCollision("absent.urdf", arm)
    with pytest.raises(iksel.UnknownNameError, match="'gripper'.*j0, j1"):
        collision.SelfCollision(URDF, arm, other_joints={"gripper": 1.0})
    with pytest.raises(iksel.UnknownNameError, match=r"robot: .*'j5'"):
        collision.SelfCollision(URDF.replace('"j5"', '"j6"'), arm)
    free = collision.SelfCollision(URDF, arm)
    with pytest.raises(iksel.InvalidArgumentError, match=r"q: .*\(5,\)"):
        free(np.zeros(5))
    with pytest.raises(iksel.InvalidArgumentError, match="q: not finite"):
        free(np.full((2, 6), np.nan))


def tetrahedron(path) -> None:
    """An STL file in text, corners at 0 and 0.1 m along each axis."""
    corners = ["0 0 0", "0.1 0 0", "0 0.1 0", "0 0 0.1"]
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    lines = ["solid t"]
    for face in faces:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {corners[i]}" for i in face]
        lines += ["endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid t"]), encoding="utf-8")


@pytest.mark.parametrize("form", ["relative", "file", "package"])
def test_meshes(arm, tmp_path, form) -> None:
    name = {
        "relative": "meshes/a b.stl",
        "file": f"file://{tmp_path}/meshes/a b.stl",
        "package": "package://arm/meshes/a b.stl",
    }[form]
    text = URDF.replace(TUBE, f'<mesh filename="{name}" scale="20 20 20"/>')
    urdf = tmp_path / "arm.urdf"
    urdf.write_text(text, encoding="utf-8")
    packages = {"arm": tmp_path}
    with pytest.raises(iksel.UrdfError, match=r"'l2': no mesh file '.*a b\.stl'"):
        collision.SelfCollision(urdf, arm, packages=packages)
    mesh = tmp_path / "meshes" / "a b.stl"
    mesh.parent.mkdir()
    mesh.write_text("no mesh", encoding="utf-8")
    with pytest.raises(iksel.UrdfError, match=r"'l2': mesh file '.*a b\.stl'"):
        collision.SelfCollision(urdf, arm, packages=packages)
    tetrahedron(mesh)
    # 2 m wide at the upper arm: the base is inside whenever the arm hangs over it.
    free = collision.SelfCollision(urdf, arm, packages=packages)
    assert not free(np.zeros(6))
    if form == "package":
        with pytest.raises(
            iksel.UnknownNameError, match=r"'arm' of mesh .*given: none"
        ):
            collision.SelfCollision(urdf, arm)


def test_joints_that_the_arm_holds_are_where_it_holds_them() -> None:
    bent = np.array([0, 1.2, 2.6, 0, 0, 0])
    whole = iksel.Robot.from_urdf(URDF, base_link="l0", tip_link="l6")
    held = iksel.Robot.from_urdf(
        URDF, base_link="l0", tip_link="l6", locked_joints={"j2": 2.6}
    )
    expected = collision.SelfCollision(URDF, whole, margin=0.05).colliding_links(bent)
    rest = np.delete(bent, 2)
    assert expected is not None
    free = collision.SelfCollision(URDF, held, margin=0.05)
    assert free.colliding_links(rest) == expected
    straight = collision.SelfCollision(URDF, held, other_joints={"j2": 0.0})
    assert straight(rest)


def test_without_coal_it_says_what_to_install(arm, monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, "coal", None)
    with pytest.raises(iksel.InvalidArgumentError, match=r"iksel\[collision\]"):
        collision.SelfCollision(URDF, arm)
