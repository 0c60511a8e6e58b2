# SPDX-License-Identifier: BSD-3-Clause
"""Self-collision as a filter, on an arm of simple shapes."""

from __future__ import annotations

import sys
import time
from functools import cache

import numpy as np
import pytest
from tubes import LENGTHS, NAMES, TUBE, URDF, joint

import iksel

coal = pytest.importorskip("coal")
collision = pytest.importorskip("iksel.collision")


@pytest.fixture(scope="module")
def arm() -> iksel.Robot:
    return iksel.Robot.from_urdf(URDF, base_link="l0", tip_link="l6")


def capsule_distance(a: np.ndarray, b: np.ndarray) -> float:
    """The smallest distance of points sampled on two segments, (2, 3) each [m]."""
    t = np.linspace(0, 1, 60)[:, None]
    p, q = (s[0] + t * (s[1] - s[0]) for s in (a, b))
    return float(np.linalg.norm(p[:, None] - q[None], axis=2).min())


@cache
def parts() -> list[iksel.Robot]:
    """The arm as far as l1, l2, ..., l6."""
    return [iksel.Robot.from_urdf(URDF, base_link="l0", tip_link=n) for n in NAMES[1:]]


def segments(q: np.ndarray) -> dict[str, np.ndarray]:
    """Axis of each link's tube in the base frame, by the library's own FK."""
    found = {"l0": np.array([[0, 0, 0], [0, 0, LENGTHS[0]]], dtype=float)}
    for i, part in enumerate(parts(), 1):
        pose = part.fk(q[:i])
        found[f"l{i}"] = np.stack([pose[:3, 3], (pose @ [0, 0, LENGTHS[i], 1])[:3]])
    return found


def test_agrees_with_the_distance_of_the_axes(arm) -> None:
    free = collision.SelfCollision(URDF, arm)
    assert ("l0", "l2") in free.pairs
    assert ("l0", "l1") not in free.pairs
    seen = {True: 0, False: 0}
    for q in arm.random_configurations(300, seed=3):
        axes = segments(q)
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
    pair = collision.SelfCollision(URDF, arm, margin=0.3, samples=99).colliding_links(
        bent
    )
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
    with pytest.raises(iksel.UrdfError, match="'l2'.*radius='-0.04', which is below 0"):
        collision.SelfCollision(URDF.replace(TUBE, TUBE.replace("0.04", "-0.04")), arm)
    with pytest.raises(iksel.UrdfError, match="'l2'.*size='1 1 -1', which is below 0"):
        collision.SelfCollision(URDF.replace(TUBE, '<box size="1 1 -1"/>'), arm)
    with pytest.raises(iksel.UrdfError, match="'l2'.*'cone'.*box, capsule, cylinder"):
        collision.SelfCollision(URDF.replace(TUBE, "<cone/>"), arm)
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
            iksel.UnknownNameError, match=r"'arm'; given: none.*for 'package://arm"
        ):
            collision.SelfCollision(urdf, arm)


def test_joints_that_the_arm_holds_are_where_it_holds_them() -> None:
    bent = np.array([0, 1.2, 2.6, 0, 0, 0])
    whole = iksel.Robot.from_urdf(URDF, base_link="l0", tip_link="l6")
    held = iksel.Robot.from_urdf(
        URDF, base_link="l0", tip_link="l6", locked_joints={"j2": 2.6}
    )
    expected = collision.SelfCollision(
        URDF, whole, margin=0.05, samples=99
    ).colliding_links(bent)
    rest = np.delete(bent, 2)
    assert expected is not None
    free = collision.SelfCollision(URDF, held, margin=0.05, samples=99)
    assert free.colliding_links(rest) == expected
    straight = collision.SelfCollision(URDF, held, other_joints={"j2": 0.0})
    assert straight(rest)


def test_without_coal_it_says_what_to_install(arm, monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, "coal", None)
    with pytest.raises(iksel.InvalidArgumentError, match=r"iksel\[collision\]"):
        collision.SelfCollision(URDF, arm)


FOLLOWERS = """<link name="f{i}"><collision><geometry><sphere radius="0.04"/></geometry>
  </collision></link><joint name="f{i}" type="revolute"><parent link="l0"/>
  <child link="f{i}"/><origin xyz="{i} 0 0"/><axis xyz="0 1 0"/>
  <limit lower="-9" upper="9" effort="1" velocity="1"/>
  <mimic joint="{follows}" multiplier="2" offset="0.1"/></joint>"""


def followers(*follows: str) -> str:
    tags = "".join(
        FOLLOWERS.format(i=i, follows=name) for i, name in enumerate(follows)
    )
    return URDF.replace("</robot>", tags + "</robot>")


def test_mimics_that_lead_nowhere_are_typed_errors(arm) -> None:
    for names in (("f0",), ("f1", "f0"), ("f1", "f2", "f1")):
        with pytest.raises(iksel.UrdfError, match="'f0' mimics itself .* circle"):
            collision.SelfCollision(followers(*names), arm)
    with pytest.raises(iksel.UnknownNameError, match="'f0' mimics 'motor'.*j0, j1"):
        collision.SelfCollision(followers("motor"), arm)


def test_links_that_hang_on_nothing_are_typed_errors(arm) -> None:
    island = "".join(f'<link name="i{k}"/>' for k in range(2)) + "".join(
        joint(f"i{k}", f"i{1 - k}", f"i{k}", 0, "1 0 0") for k in range(2)
    )
    with pytest.raises(iksel.UrdfError, match="circle|i0|i1"):
        collision.SelfCollision(URDF.replace("</robot>", island + "</robot>"), arm)


def prism_walls(path) -> None:
    """An STL file: four walls of a shaft 1 m wide and high, open at both ends."""
    corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
    lines = ["solid t"]
    for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1], strict=True):
        low, high = (ax, ay, -0.5), (bx, by, 0.5)
        for face in ((low, (bx, by, -0.5), high), (low, high, (ax, ay, 0.5))):
            lines += ["facet normal 0 0 0", "outer loop"]
            lines += ["vertex {} {} {}".format(*corner) for corner in face]
            lines += ["endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid t"]), encoding="utf-8")


@pytest.mark.parametrize("margin", [0.0, 0.05])
def test_agrees_with_all_shapes_against_all(arm, tmp_path, margin) -> None:
    """Boxes around shapes and hulls of meshes are only a quick first look."""
    prism_walls(tmp_path / "shaft.stl")
    shaft = (
        '<link name="shaft"><collision><origin xyz="0.2 0 0.5" rpy="0.3 0 0.2"/>'
        '<geometry><mesh filename="shaft.stl" scale="0.9 1.1 1"/></geometry>'
        '</collision></link><joint name="bolts" type="fixed"><parent link="l0"/>'
        '<child link="shaft"/></joint>'
    )
    urdf = tmp_path / "arm.urdf"
    urdf.write_text(URDF.replace("</robot>", shaft + "</robot>"), encoding="utf-8")
    free = collision.SelfCollision(urdf, arm, margin=margin, samples=0)
    mesh = coal.MeshLoader().load(str(tmp_path / "shaft.stl"), np.array([0.9, 1.1, 1]))
    tubes = [coal.Cylinder(0.04, length) for length in LENGTHS]
    request = coal.CollisionRequest()
    request.security_margin = margin
    in_shaft, verdicts = 0, []
    q = arm.random_configurations(300, seed=12)
    for one in q:
        poses = [np.eye(4), *(part.fk(one[: part.dof]) for part in parts())]
        shapes = {
            name: (tube, pose @ iksel.pose_from_euler([0, 0, length / 2], [0, 0, 0]))
            for name, tube, pose, length in zip(
                NAMES, tubes, poses, LENGTHS, strict=True
            )
        }
        shapes["shaft"] = mesh, iksel.pose_from_euler([0.2, 0, 0.5], [0.3, 0, 0.2])
        hits = []
        for pair in free.pairs:
            (a, at_a), (b, at_b) = (shapes[link] for link in pair)
            at = [
                coal.Transform3s(p[:3, :3].copy(), p[:3, 3].copy())
                for p in (at_a, at_b)
            ]
            if coal.collide(a, at[0], b, at[1], request, coal.CollisionResult()):
                hits.append(pair)
        in_shaft += any("shaft" in pair for pair in hits)
        assert free.colliding_links(one) == (hits[0] if hits else None)
        verdicts.append(not hits)
    assert free(q).tolist() == verdicts
    assert 5 < sum(verdicts) < 295
    assert in_shaft > 5


def test_a_thousand_configurations_take_no_time(arm, tmp_path) -> None:
    """Of seven meshes; 5 ms for each is many times what is needed."""
    prism_walls(tmp_path / "shaft.stl")
    text = URDF
    for length in LENGTHS:
        tube = f'<cylinder radius="0.04" length="{length}"/>'
        mesh = f'<mesh filename="shaft.stl" scale="0.07 0.07 {length}"/>'
        text = text.replace(tube, mesh)
    urdf = tmp_path / "arm.urdf"
    urdf.write_text(text, encoding="utf-8")
    free = collision.SelfCollision(urdf, arm, samples=0)
    q = arm.random_configurations(200, seed=13)
    start = time.process_time()
    verdicts = free(q)
    assert (time.process_time() - start) / len(q) < 5e-3
    assert 0 < verdicts.sum() < len(q)
