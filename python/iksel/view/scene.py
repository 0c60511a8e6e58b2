# SPDX-License-Identifier: BSD-3-Clause
"""Draws a robot, ghosts of its other solutions, its targets and a map by viser."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from iksel._base import rotations
from iksel.view._obstacles import draw_obstacles
from iksel.view.skeleton import Placed, ball, cylinder
from iksel.view.visuals import PLAIN, Visuals

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from iksel_cpp import Obstacle

    from iksel._base.arrays import BoolArray, FloatArray, IntArray
    from iksel.view.skeleton import Skeleton
    from iksel.view.visuals import Piece

NO_ANSWER = (222, 150, 90)
JOINT = (52, 94, 168)
AT_LIMIT = (205, 45, 45)
GHOST = (120, 150, 190)
GHOST_OPACITY = 0.22
TARGET = 0.2  # size of the handles, as a share of the reach
# Shares of orientations from none to all: red, yellow, green, blue.
RAMP = np.array([[200, 40, 40], [235, 205, 60], [70, 165, 85], [45, 85, 190]], float)
OVERLAP = 0.42  # radius of a map's ball, by the distance between neighbours


class Copies:
    """Copies of one mesh, whose number may change from one drawing to the next."""

    def __init__(
        self, scene: Any, name: str, mesh: tuple[FloatArray, IntArray], **look: Any
    ) -> None:
        """Take viser's scene, the node's name and how viser is to show the mesh."""
        self._scene = scene
        self._name = name
        self._mesh = mesh
        self._look = {"lod": "off", **look}
        self._node: Any = None
        self.count = 0

    def draw(self, placed: Placed, colours: np.ndarray[Any, Any]) -> None:
        """Show them at their places, in colours (3,) or (m, 3) from 0 to 255."""
        count = len(placed.positions)
        rgb = np.broadcast_to(np.asarray(colours, np.uint8), (count, 3))
        if self._node is not None and count == self.count:
            self._node.batched_positions = placed.positions.astype(np.float32)
            self._node.batched_wxyzs = placed.wxyzs.astype(np.float32)
            self._node.batched_scales = placed.scales.astype(np.float32)
            self._node.batched_colors = rgb
            return
        self.clear()
        if count:
            self._node = self._scene.add_batched_meshes_simple(
                self._name,
                *self._mesh,
                placed.wxyzs,
                placed.positions,
                batched_scales=placed.scales.astype(np.float32),
                batched_colors=rgb,
                **self._look,
            )
        self.count = count

    def clear(self) -> None:
        """Show none."""
        if self._node is not None:
            self._node.remove()
        self._node = None
        self.count = 0


class Scene:
    """What is drawn. The base link's frame is the world's."""

    def __init__(self, scene: Any, skeleton: Skeleton, pieces: list[Piece]) -> None:
        """Take viser's scene, the links to draw, and what these look like."""
        self._scene = scene
        self._skeleton = skeleton
        reach = skeleton.reach
        scene.set_up_direction("+z")
        # Without a graphics card a frame takes twice as long with shadows.
        scene.configure_default_lights(cast_shadow=False)
        size = 2 * np.ceil(reach)
        scene.add_grid("/floor", width=size, height=size, cell_size=0.1)
        scene.add_frame("/base", axes_length=0.1 * reach, axes_radius=0.004 * reach)
        self._bones = Copies(scene, "/robot/links", cylinder(), flat_shading=True)
        self._balls = Copies(scene, "/robot/frames", ball())
        self.visuals = Visuals(scene, skeleton.robot, pieces)
        self._dressed = False
        ghost = {"opacity": GHOST_OPACITY}
        self._ghosts = Copies(scene, "/ghosts/links", cylinder(12), **ghost)
        self._ghost_balls = Copies(scene, "/ghosts/frames", ball(8), **ghost)
        self.obstacles: list[Any] = []
        self._map = Copies(scene, "/map", ball(6), lod="auto")
        tips = skeleton.robot.tip_links
        # Two hands are nearer to each other than one's handles may be large.
        size = TARGET * reach / np.sqrt(len(tips))
        self.targets = [
            scene.add_transform_controls(
                f"/target/{tip}", scale=size, line_width=4.0, depth_test=False
            )
            for tip in range(len(tips))
        ]
        self.names = [
            scene.add_label(f"/names/{tip}", link)
            for tip, link in enumerate(tips if len(tips) > 1 else ())
        ]

    def add_obstacles(self, obstacles: Mapping[str, Obstacle]) -> None:
        """Show obstacles, by name."""
        reach = self._skeleton.reach
        self.obstacles += draw_obstacles(self._scene, obstacles, reach)

    @property
    def ghosts(self) -> int:
        """Number of ghosts that are shown."""
        return self._ghost_balls.count // self._skeleton.frames

    @property
    def map_balls(self) -> int:
        """Number of balls that are shown of a map."""
        return self._map.count

    def dress(self, *, dressed: bool) -> None:
        """Show the robot as its links look like, if that is known, or as bars."""
        self._dressed = dressed and len(self.visuals) > 0
        self.visuals.show(visible=self._dressed)
        if self._dressed:
            self._bones.clear()
            self._balls.clear()

    def draw_robot(self, q: FloatArray, at_limit: BoolArray, *, solved: bool) -> None:
        """Show the robot at q (dof,), with joints (dof,) that are at a limit in red."""
        if self._dressed:
            links = () if solved else self._skeleton.links
            colours = dict.fromkeys(links, NO_ANSWER)
            moved = np.array(self._skeleton.moved)[at_limit]
            colours |= dict.fromkeys(moved.tolist(), AT_LIMIT)
            self.visuals.draw(q, colours)
            return
        drums = np.where(at_limit[:, None], AT_LIMIT, JOINT)
        link = PLAIN if solved else NO_ANSWER
        bars = np.tile(link, (self._skeleton.bars, 1))
        self._bones.draw(
            self._skeleton.cylinders(q[None]), np.concatenate([bars, drums])
        )
        self._balls.draw(self._skeleton.balls(q[None]), np.array(link))

    def draw_ghosts(self, q: FloatArray) -> None:
        """Show transparent robots at configurations (n, dof); of n = 0 none."""
        if len(q) == 0:
            self._ghosts.clear()
            self._ghost_balls.clear()
            return
        self._ghosts.draw(self._skeleton.cylinders(q), np.array(GHOST))
        self._ghost_balls.draw(self._skeleton.balls(q), np.array(GHOST))

    def draw_targets(self, poses: FloatArray, held: Sequence[Any] = ()) -> None:
        """Put the targets at T_base_tcp, (tips, 4, 4), but those that users hold."""
        for target, pose in zip(self.targets, poses, strict=True):
            if target not in held:
                target.position = pose[:3, 3]
                target.wxyz = rotations.quaternion_from_matrix(pose[:3, :3])
        for name, pose in zip(self.names, poses, strict=False):
            name.position = pose[:3, 3]

    def target_pose(self, tip: int = 0) -> FloatArray:
        """Where a tip's target has been dragged to, T_base_tcp, (4, 4)."""
        target = self.targets[tip]
        wxyz = np.asarray(target.wxyz, float)
        pose = np.eye(4)
        pose[:3, :3] = rotations.from_quaternion(wxyz / np.linalg.norm(wxyz))
        pose[:3, 3] = target.position
        return pose

    def draw_map(self, points: FloatArray, shares: FloatArray, spacing: float) -> None:
        """Show balls at points (n, 3) [m], coloured by shares (n,); of n = 0 none."""
        count = len(points)
        placed = Placed(
            points,
            np.tile([1.0, 0, 0, 0], (count, 1)),
            np.full((count, 3), OVERLAP * spacing),
        )
        self._map.draw(placed, share_colours(shares))


def share_colours(shares: FloatArray) -> np.ndarray[Any, Any]:
    """Colours (n, 3) from 0 to 255 of shares (n,) from 0 to 1."""
    at = np.linspace(0, 1, len(RAMP))
    colours = [np.interp(shares, at, channel) for channel in RAMP.T]
    return np.stack(colours, axis=-1).astype(np.uint8)
