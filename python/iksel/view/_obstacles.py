# SPDX-License-Identifier: BSD-3-Clause
"""Draws the obstacles of a scene that answers keep free of."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from iksel._base import rotations
from iksel.view.skeleton import ball, cylinder, turned

if TYPE_CHECKING:
    from collections.abc import Mapping

    from iksel_cpp import Obstacle

    from iksel._base.arrays import FloatArray, IntArray

COLOUR = (196, 160, 110)
OPACITY = 0.6
SEGMENTS = 48


def draw_obstacles(
    scene: Any, obstacles: Mapping[str, Obstacle], reach: float
) -> list[Any]:
    """Show obstacles where they are, without their margins.

    Args:
        scene: Viser's.
        obstacles: By name.
        reach: Of the robot [m]; half spaces are shown that far.

    Returns:
        What viser made, one of each.
    """
    return [
        _draw(scene, f"/obstacles/{number}", obstacle, reach)
        for number, obstacle in enumerate(obstacles.values())
    ]


def _draw(scene: Any, name: str, obstacle: Obstacle, reach: float) -> Any:
    place = {
        "position": obstacle.pose[:3, 3],
        "wxyz": rotations.quaternion_from_matrix(obstacle.pose[:3, :3]),
    }
    if obstacle.shape == "points":
        # Viser draws squares of this edge; those of radius 0 have to be seen as well.
        size = max(2 * obstacle.radius, 0.005 * reach)
        return scene.add_point_cloud(
            name,
            np.asarray(obstacle.points, np.float32),
            COLOUR,
            point_size=size,
            point_shape="circle",
            precision="float32",
            **place,
        )
    vertices, faces = shape_of(obstacle, reach)
    return scene.add_mesh_simple(
        name,
        vertices.astype(np.float32),
        faces,
        color=COLOUR,
        opacity=OPACITY,
        flat_shading=True,
        side="double",
        **place,
    )


def shape_of(obstacle: Obstacle, reach: float) -> tuple[FloatArray, IntArray]:
    """The mesh of an obstacle in its frame; of a half space a part of its plane."""
    radius, length = obstacle.radius, obstacle.length
    if obstacle.shape == "sphere":
        vertices, faces = ball(SEGMENTS)
        return vertices * radius, faces
    if obstacle.shape == "cylinder":
        vertices, faces = cylinder(SEGMENTS)
        return vertices * [radius, radius, length], faces
    if obstacle.shape == "capsule":
        angles = np.linspace(-np.pi / 2, np.pi / 2, SEGMENTS)
        ends = np.where(angles < 0, -length / 2, length / 2)
        profile = np.stack(
            [radius * np.cos(angles), radius * np.sin(angles) + ends], axis=-1
        )
        profile[[0, -1], 0] = 0.0
        return turned(profile, SEGMENTS)
    edges = obstacle.size if obstacle.shape == "box" else [2 * reach, 2 * reach, 0.0]
    return _box(np.asarray(edges, float))


def corners(obstacles: Mapping[str, Obstacle]) -> FloatArray:
    """Points (n, 3) in the base frame that obstacles, but half spaces, are between."""
    found = [np.empty((0, 3))]
    for obstacle in obstacles.values():
        if obstacle.shape == "half_space":
            continue
        points = obstacle.points
        if points is None:
            points = shape_of(obstacle, 0.0)[0]
        found.append(points @ obstacle.pose[:3, :3].T + obstacle.pose[:3, 3])
    return np.concatenate(found)


def _box(edges: FloatArray) -> tuple[FloatArray, IntArray]:
    """A box about the origin; faces counterclockwise from outside."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    sides = [
        (0, 1, 3, 2),
        (4, 6, 7, 5),
        (0, 4, 5, 1),
        (2, 3, 7, 6),
        (0, 2, 6, 4),
        (1, 5, 7, 3),
    ]
    faces = [t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))]
    return corners * edges / 2, np.array(faces)
