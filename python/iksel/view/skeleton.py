# SPDX-License-Identifier: BSD-3-Clause
"""Clean links of a robot: balls at its frames, bars between them, drums at its joints.

Made of the chains alone, so every robot has them, with or without mesh files.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from iksel_cpp import JointType, LinkTree

if TYPE_CHECKING:
    from collections.abc import Mapping

    from iksel_cpp import Robot

    from iksel._base.arrays import FloatArray, IntArray

# Sizes as shares of the robot's reach: at the base, and at the TCP. Arms become thinner
# towards their tools.
BAR = np.array([0.038, 0.02])  # radii
BALL = np.array([0.042, 0.022])
DRUM = np.array([0.056, 0.032])
HEIGHT = np.array([0.13, 0.075])  # of a drum, along its joint's axis
LEAST = 1e-6  # [m]; a bar between frames that coincide has this length


class Placed(NamedTuple):
    """Copies of one mesh: where they are, and how much they are stretched."""

    positions: FloatArray
    """In the base frame, (m, 3) [m]."""
    wxyzs: FloatArray
    """Rotations, (m, 4)."""
    scales: FloatArray
    """Along the mesh's x, y and z, (m, 3)."""


class Skeleton:
    """The links of a robot's chains, from its base link to its TCPs.

    Attributes:
        robot: The robot.
        links: Names of the links, parents first: those of the first tip's chain, then
            those that only the second's has, and so on.
        reach: How far the farthest of the tips reaches [m].
        centre: Of where they reach, in the base frame, (3,) [m].
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        arms = [robot.chain(tip) for tip in range(robot.tips)]
        self.reach = max(arm.reach for arm in arms)
        self.centre = np.mean([arm.reach_centre for arm in arms], axis=0)
        joints = {j.child_link: j for j in LinkTree.from_urdf(robot.urdf).joints}
        parent = {link: joint.parent_link for link, joint in joints.items()}
        chains = [_chain(parent, robot.base_link, tip) for tip in robot.tip_links]
        self.links = list(dict.fromkeys(link for chain in chains for link in chain))
        # Each frame but the base's, also the TCPs', has a bar that begins at another's.
        starts = [self.links.index(parent[link]) for link in self.links[1:]]
        self._starts = starts + [self.links.index(tip) for tip in robot.tip_links]
        self._shares = _shares(self.links, chains)
        self._index = [robot.link_names.index(name) for name in self.links]
        moved = {joint.name: link for link, joint in joints.items()}
        names = [moved[name] for name in robot.joint_names]
        self._moved = [self.links.index(name) for name in names]
        self._slides = [kind == JointType.prismatic for kind in robot.joint_types]
        # Of each joint the first tip that it moves.
        of_tips = [set(robot.joints_of(tip)) for tip in range(robot.tips)]
        self._tip = [
            next(tip for tip, moving in enumerate(of_tips) if joint in moving)
            for joint in range(robot.dof)
        ]

    @property
    def moved(self) -> list[str]:
        """The links that the joints move, of each joint the first."""
        return [self.links[i] for i in self._moved]

    @property
    def frames(self) -> int:
        """Number of frames of one robot: its links' and its TCPs'."""
        return len(self.links) + self.robot.tips

    @property
    def bars(self) -> int:
        """Number of bars of one robot, each from one frame to the next."""
        return self.frames - 1

    def points(self, q: FloatArray) -> FloatArray:
        """Origins of the links' frames and the TCPs, (n, frames, 3), for (n, dof)."""
        poses = self.robot.link_poses(q)[:, self._index]
        tips = self.robot.fk(q).reshape(len(q), -1, 4, 4)
        return np.concatenate([poses[..., :3, 3], tips[..., :3, 3]], 1)

    def balls(self, q: FloatArray) -> Placed:
        """Unit balls at the frames of configurations (n, dof)."""
        points = self.points(q)
        sizes = np.broadcast_to(self._sizes(BALL)[:, None], points.shape)
        points = points.reshape(-1, 3)
        turns = np.tile([1.0, 0, 0, 0], (len(points), 1))
        return Placed(points, turns, sizes.reshape(-1, 3))

    def cylinders(self, q: FloatArray) -> Placed:
        """Unit cylinders (along z): for each configuration the bars, then the drums."""
        points = self.points(q)
        starts, ends = points[:, self._starts], points[:, 1:]
        lengths = np.maximum(np.linalg.norm(ends - starts, axis=-1), LEAST)
        radii = np.broadcast_to(self._sizes(BAR)[1:], lengths.shape)
        bars = np.stack([radii, radii, lengths], axis=-1)
        radius, height = (self._sizes(s)[self._moved] for s in (DRUM, HEIGHT))
        drums = np.tile(np.stack([radius, radius, height], -1), (len(q), 1, 1))
        along = np.concatenate([ends - starts, self._axes(q)], axis=1)
        middles = np.concatenate([(starts + ends) / 2, points[:, self._moved]], axis=1)
        scales = np.concatenate([bars, drums], axis=1)
        return Placed(
            middles.reshape(-1, 3),
            turns_of_z(along.reshape(-1, 3)),
            scales.reshape(-1, 3),
        )

    def _sizes(self, ends: FloatArray) -> FloatArray:
        """Sizes at the frames of the links and the TCPs, (frames,) [m]."""
        sizes = ends[0] + self._shares * (ends[1] - ends[0])
        return np.asarray(self.reach * sizes)

    def _axes(self, q: FloatArray) -> FloatArray:
        """Directions along which joints turn or slide, (n, dof, 3)."""
        jacobian = self.robot.jacobian(q).reshape(len(q), self.robot.tips, 6, -1)
        jacobian = jacobian[:, self._tip, :, np.arange(self.robot.dof)].swapaxes(0, 1)
        slides = np.array(self._slides)[:, None]
        return np.asarray(np.where(slides, jacobian[..., :3], jacobian[..., 3:]))


def _chain(parent: Mapping[str, str], base: str, tip: str) -> list[str]:
    """The links from one to another that hangs on it, both included."""
    links = [tip]
    while links[-1] != base:
        links.append(parent[links[-1]])
    return links[::-1]


def _shares(links: list[str], chains: list[list[str]]) -> FloatArray:
    """How far along its chain each link's frame is, 0 at the base; then 1 of each TCP.

    A link of several chains is as far as it is along the longest.
    """
    shares = dict.fromkeys(links, 1.0)
    for chain in chains:
        for i, link in enumerate(chain):
            shares[link] = min(shares[link], i / len(chain))
    return np.array([*shares.values(), *[1.0] * len(chains)])


def turns_of_z(directions: FloatArray) -> FloatArray:
    """The least rotations (w, x, y, z) of z onto directions (n, 3) of any length."""
    lengths = np.linalg.norm(directions, axis=-1, keepdims=True)
    x, y, z = (directions / np.where(lengths > 0, lengths, 1.0)).T
    turns = np.stack([1 + z, -y, x, np.zeros_like(z)], axis=-1)
    turns[turns[:, 0] < 1e-9] = [0.0, 1.0, 0.0, 0.0]
    return np.asarray(turns / np.linalg.norm(turns, axis=-1, keepdims=True))


def turned(profile: FloatArray, segments: int) -> tuple[FloatArray, IntArray]:
    """The mesh that a profile (k, 2) of radius and height makes when turned about z.

    Returns:
        Vertices (k * segments, 3), and faces of three vertices, counterclockwise from
        outside if the profile goes upwards.
    """
    angles = 2 * np.pi * np.arange(segments) / segments
    radius, height = profile.T
    vertices = np.stack(
        [
            np.outer(radius, np.cos(angles)),
            np.outer(radius, np.sin(angles)),
            np.outer(height, np.ones(segments)),
        ],
        axis=-1,
    ).reshape(-1, 3)
    ring, at = np.meshgrid(
        np.arange(len(profile) - 1), np.arange(segments), indexing="ij"
    )
    a, b = ring * segments + at, ring * segments + (at + 1) % segments
    c, d = a + segments, b + segments
    faces = np.concatenate([np.stack([a, b, d], -1), np.stack([a, d, c], -1)])
    return vertices, faces.reshape(-1, 3)


def cylinder(segments: int = 24) -> tuple[FloatArray, IntArray]:
    """A closed cylinder of radius 1 and height 1 about the origin, along z."""
    profile = np.array([[0, -0.5], [1, -0.5], [1, 0.5], [0, 0.5]], float)
    return turned(profile, segments)


def ball(segments: int = 16) -> tuple[FloatArray, IntArray]:
    """A ball of radius 1 about the origin."""
    angles = np.linspace(-np.pi / 2, np.pi / 2, segments // 2 + 1)
    profile = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    profile[[0, -1], 0] = 0.0
    return turned(profile, segments)
