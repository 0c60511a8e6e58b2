# SPDX-License-Identifier: BSD-3-Clause
"""Scenes as plain data, as plans hold them, and at other places of the base."""

from __future__ import annotations

import copy
from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import RobotSpheres, Scene

if TYPE_CHECKING:
    from collections.abc import Mapping

    from iksel_cpp import Obstacle, Robot

    from iksel._base.arrays import FloatArray


def scene_data(scene: Scene) -> dict[str, Any]:
    """What a scene is made of, for JSON; without the robot."""
    carried = scene.attached_spheres
    return {
        "spheres": {link: rows.tolist() for link, rows in scene.spheres.links.items()},
        "pairs": [list(pair) for pair in scene.spheres.pairs],
        "other_joints": dict(scene.other_joints),
        "obstacles": {name: _plain(o) for name, o in scene.obstacles.items()},
        "attached": {
            name: {
                "link": link,
                "spheres": carried[name].tolist(),
                "may_touch": list(scene.may_touch[name]),
            }
            for name, link in scene.attached.items()
        },
    }


def scene_of_data(robot: Robot, data: Mapping[str, Any]) -> Scene:
    """The scene of scene_data().

    Raises:
        InvalidArgumentError: The data make no scene of that robot.
        UnknownNameError: The robot lacks a link or joint in it.
    """
    links = {link: np.array(rows) for link, rows in data["spheres"].items()}
    pairs = [(str(a), str(b)) for a, b in data["pairs"]]
    scene = Scene(robot, RobotSpheres(links, pairs), data["other_joints"])
    for name, obstacle in data["obstacles"].items():
        _add(scene, name, obstacle)
    attached = data["attached"].items()
    # What objects may touch may be one that comes later.
    for name, one in attached:
        scene.attach(name, one["link"], np.array(one["spheres"]))
    for name, one in attached:
        spheres = np.array(one["spheres"])
        scene.attach(name, one["link"], spheres, may_touch=one["may_touch"])
    return scene


def at_base(scene: Scene, T_world_base: FloatArray) -> Scene:  # noqa: N803 (frames)
    """A copy of a scene whose obstacles stand in the world, with the base elsewhere."""
    moved = copy.copy(scene)
    back = np.linalg.inv(T_world_base)
    for name, obstacle in scene.obstacles.items():
        moved.move(name, back @ obstacle.pose)
    return moved


def _plain(obstacle: Obstacle) -> dict[str, Any]:
    """The numbers of an obstacle."""
    points = obstacle.points
    return {
        "shape": obstacle.shape,
        "radius": obstacle.radius,
        "length": obstacle.length,
        "size": obstacle.size.tolist(),
        "points": None if points is None else points.tolist(),
        "pose": obstacle.pose.tolist(),
        "margin": obstacle.margin,
    }


def _add(scene: Scene, name: str, data: Mapping[str, Any]) -> None:
    """Add an obstacle of _plain()."""
    pose, margin = np.array(data["pose"]), data["margin"]
    radius, length = data["radius"], data["length"]
    if data["shape"] == "sphere":
        scene.add_sphere(name, radius, pose, margin)
    elif data["shape"] == "box":
        scene.add_box(name, data["size"], pose, margin)
    elif data["shape"] == "capsule":
        scene.add_capsule(name, radius, length, pose, margin)
    elif data["shape"] == "cylinder":
        scene.add_cylinder(name, radius, length, pose, margin)
    elif data["shape"] == "half_space":
        scene.add_half_space(name, pose, margin)
    else:
        points = np.array(data["points"]).reshape(-1, 3)
        scene.add_points(name, points, radius, pose, margin)
