# SPDX-License-Identifier: BSD-3-Clause
"""The viewer's layer of a reachability map."""

from __future__ import annotations

import numpy as np
import pytest
from reach_maps import computed
from test_view import free_port

import iksel
from iksel import reach, view
from iksel.view.controls import legend
from iksel.view.scene import share_colours

pytest.importorskip("viser", reason="pip install iksel[view]")


@pytest.fixture
def shown(made, tmp_path):
    """A viewer with a map, and the map."""
    robot = made.robot("ur5e")
    path = computed(tmp_path / "a.zarr", robot, spacing=0.2, orientations=72)
    found = reach.open(path)
    with view.Viewer(made.solver("ur5e"), port=free_port()) as viewer:
        yield viewer, found


def test_there_is_a_ball_where_something_is_reached(shown):
    viewer, found = shown
    assert not viewer.controls.map.visible
    assert not viewer.controls.legend.visible
    viewer.show_map(found)
    assert viewer.controls.map.visible
    assert viewer.controls.legend.visible
    (x, y, _), shares = found.box()
    half = (shares[:, y >= 0] > 0).sum()
    assert 0 < viewer.scene.map_balls == half
    viewer.controls.cut.value = False
    assert viewer.scene.map_balls == (shares > 0).sum() > half
    node = viewer.scene._map._node
    at = found.fraction_at(node.batched_positions)
    np.testing.assert_array_equal(node.batched_colors, share_colours(at))
    assert len(np.unique(at)) > 5
    assert np.isin(node.batched_positions[:, 0], x.astype(np.float32)).all()
    viewer.controls.map.value = False
    assert viewer.scene.map_balls == 0
    viewer.controls.map.value = True
    assert viewer.scene.map_balls == (shares > 0).sum()


def test_the_camera_sees_the_map(shown):
    viewer, found = shown
    camera = viewer._server.initial_camera
    before = np.linalg.norm(camera.position - camera.look_at)
    viewer.show_map(found)
    assert np.linalg.norm(camera.position - camera.look_at) > before


def test_the_legend_has_the_colours_of_the_balls():
    ends = share_colours(np.array([0.0, 1.0]))
    for red, green, blue in ends:
        assert f"rgb({red}, {green}, {blue})" in legend()


def test_maps_of_others_are_refused(shown, made):
    _, found = shown
    with (
        view.Viewer(made.solver("ur3e"), port=free_port()) as other,
        pytest.raises(iksel.InvalidArgumentError, match=r"map: it is of ur5e"),
    ):
        other.show_map(found)


def test_colours_go_from_red_to_blue():
    red, blue = share_colours(np.array([0.0, 1.0])).astype(int)
    assert red[0] > red[2]
    assert blue[2] > blue[0]
    assert len(np.unique(share_colours(np.linspace(0, 1, 50)), axis=0)) == 50
