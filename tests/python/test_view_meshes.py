# SPDX-License-Identifier: BSD-3-Clause
"""The viewer's links as their URDF shows them."""

from __future__ import annotations

import re

import numpy as np
import pytest
from command_line import assert_bad
from test_view import free_port
from test_view_panel import from_the_middle
from urdf_text import joint

import iksel
from iksel import view
from iksel.view.scene import AT_LIMIT, NO_ANSWER
from iksel.view.visuals import PLAIN, read_pieces

pytest.importorskip("viser", reason="pip install iksel[view]")
trimesh = pytest.importorskip("trimesh", reason="comes with viser")

SEED = 7
RED = '<material name="paint"><color rgba="1 0 0 1"/></material>'
TURNED = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])  # by a quarter about z


def shown(geometry: str, origin: str = "", material: str = "") -> str:
    return f"<visual>{origin}<geometry>{geometry}</geometry>{material}</visual>"


def arm(hand: str) -> str:
    """Two joints; a red box, a cylinder and a ball, and what is given for the hand."""
    box = shown('<box size="0.2 0.1 0.4"/>', "", '<material name="paint"/>')
    turned = '<origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/>'
    cylinder = shown('<cylinder radius="0.1" length="2"/>', turned)
    ball = shown('<sphere radius="0.3"/>')
    return f"""<robot name="made">{RED}
      <link name="base">{box}</link>
      <link name="elbow">{cylinder}{ball}</link>
      <link name="hand">{hand}</link>
      {joint("first", "base", "elbow", axis="0 1 0")}
      {joint("second", "elbow", "hand")}
    </robot>"""


@pytest.fixture
def path(tmp_path):
    """A URDF whose hand is a mesh of a package around it, scaled."""
    folder = tmp_path / "made_description"
    (folder / "meshes").mkdir(parents=True)
    trimesh.creation.box([1, 1, 1]).export(folder / "meshes/hand.stl")
    mesh = '<mesh filename="package://made_description/meshes/hand.stl" scale="2 1 1"/>'
    file = folder / "arm.urdf"
    file.write_text(arm(shown(mesh)), encoding="utf-8")
    return file


@pytest.fixture
def viewer(path):
    solver = iksel.Solver(iksel.load_robot(path))
    with view.Viewer(solver, urdf=path, port=free_port()) as viewer:
        yield viewer


def half_size(piece) -> np.ndarray:
    return np.abs(piece.vertices - piece.vertices.mean(axis=0)).max(axis=0)


def test_pieces_are_what_the_urdf_says(path):
    pieces, lost = read_pieces(path, None, None)
    assert lost == []
    assert [p.link for p in pieces] == ["base", "elbow", "elbow", "hand"]
    box, cylinder, ball, hand = pieces
    assert [p.colour for p in pieces] == [(255, 0, 0), PLAIN, PLAIN, PLAIN]
    np.testing.assert_allclose(half_size(box), [0.1, 0.05, 0.2])
    np.testing.assert_allclose(cylinder.vertices[:, 2].min(), 2)
    np.testing.assert_allclose(cylinder.vertices[:, 2].max(), 4)
    np.testing.assert_allclose(cylinder.vertices.mean(axis=0), [1, 2, 3], atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(ball.vertices, axis=1), 0.3)
    np.testing.assert_allclose(half_size(hand), [1, 0.5, 0.5])


def test_a_mesh_is_scaled_before_it_is_turned(path):
    turned = '<origin rpy="0 0 1.5707963267948966"/>'
    mesh = '<mesh filename="meshes/hand.stl" scale="2 1 1"/>'
    path.write_text(arm(shown(mesh, turned)), encoding="utf-8")
    hand = read_pieces(path, None, None)[0][-1]
    np.testing.assert_allclose(half_size(hand), TURNED @ [1, 0.5, 0.5] * [-1, 1, 1])


def test_links_move_as_link_poses_says(viewer):
    robot, visuals = viewer.session.robot, viewer.scene.visuals
    assert len(visuals) == 4
    assert viewer.controls.meshes.visible
    for q in robot.random_configurations(20, seed=SEED):
        viewer.show(q)
        for name, frame in zip(visuals._links, visuals._frames, strict=True):
            pose = robot.link_poses(q)[robot.link_names.index(name)]
            placed = iksel.pose_from_quaternion(frame.position, frame.wxyz)
            np.testing.assert_allclose(placed, pose, atol=1e-6)


def test_the_camera_sees_what_is_beside_the_chain(path):
    """As a head beside the arms."""
    text = path.read_text(encoding="utf-8")
    head = shown('<box size="0.2 0.2 0.2"/>', '<origin xyz="0 0 0.9"/>')
    path.write_text(text.replace('<link name="base">', f'<link name="base">{head}'))
    solver = iksel.Solver(iksel.load_robot(path))
    with view.Viewer(solver, urdf=path, port=free_port()) as viewer:
        assert from_the_middle(viewer, np.array([[0, 0, 1.0], [0, 0, -0.2]])).max() < 1


def test_colours_say_what_the_bars_colours_say(viewer):
    robot, visuals = viewer.session.robot, viewer.scene.visuals

    def colours() -> dict[str, tuple[int, ...]]:
        return {piece.link: tuple(node.color) for piece, node in visuals._parts}

    viewer.show((robot.lower + robot.upper) / 2)
    assert colours() == {"base": (255, 0, 0), "elbow": PLAIN, "hand": PLAIN}
    viewer.show([robot.upper[0], 0.1])
    assert colours() == {"base": (255, 0, 0), "elbow": AT_LIMIT, "hand": PLAIN}
    viewer.show([0.1, 0.1])
    pose = viewer.session.target.copy()
    pose[0, 3] += 9
    viewer.move_target(pose)
    assert set(colours().values()) == {NO_ANSWER}


def test_meshes_are_switched_to_bars_and_back(viewer):
    scene = viewer.scene
    for visible in (False, True):
        viewer.controls.meshes.value = visible
        assert scene.visuals._root.visible is visible
        assert (scene._bones.count == 0) is visible
        assert (scene._balls.count == 0) is visible


@pytest.mark.parametrize(
    ("geometry", "reason"),
    [
        ('<mesh filename="absent.stl"/>', "no mesh file .*absent.stl"),
        ('<mesh filename="arm.urdf"/>', "mesh file .*arm.urdf"),
        ('<mesh filename="package://other/a.stl"/>', "no folder for package 'other'"),
        ('<cone radius="1"/>', "no geometry 'cone'; possible: box"),
        ('<box size="1 1"/>', "size='1 1', expected 3 numbers"),
        ("", "an empty visual"),
    ],
)
def test_what_cannot_be_shown_is_said_and_the_rest_shown(path, geometry, reason):
    path.write_text(arm(shown(geometry)), encoding="utf-8")
    solver = iksel.Solver(iksel.load_robot(path))
    with view.Viewer(solver, urdf=path, port=free_port()) as viewer:
        (lost,) = viewer.lost
        assert lost.startswith("link 'hand': ")
        assert re.search(reason, lost)
        assert f"not shown of the meshes: 1, such as {lost}" in viewer.text
        assert len(viewer.scene.visuals) == 3


def test_without_visual_geometry_there_are_bars(made):
    with view.Viewer(made.solver("ur3"), urdf="ur3", port=free_port()) as viewer:
        assert len(viewer.scene.visuals) == 0
        assert not viewer.controls.meshes.visible
        assert viewer.scene._bones.count > 0


def test_a_notebook_shows_the_page(viewer):
    assert f'<iframe src="{viewer.url}"' in viewer._repr_html_()


def test_a_file_that_cannot_be_read_is_refused(made, run):
    with pytest.raises(iksel.UrdfError, match="absent.urdf"):
        view.Viewer(made.solver("ur3"), urdf="absent.urdf", port=free_port())
    assert_bad(run("view absent.urdf"), "absent.urdf")


def test_collada_is_read(path):
    pytest.importorskip("collada", reason="pip install iksel[view]")
    file = path.parent / "meshes/hand.dae"
    file.write_bytes(
        trimesh.exchange.dae.export_collada(trimesh.creation.box([1, 1, 1]))
    )
    mesh = '<mesh filename="meshes/hand.dae" scale="1 3 1"/>'
    path.write_text(arm(shown(mesh)), encoding="utf-8")
    pieces, lost = read_pieces(path, None, None)
    assert lost == []
    np.testing.assert_allclose(half_size(pieces[-1]), [0.5, 1.5, 0.5])
