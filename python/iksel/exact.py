# SPDX-License-Identifier: BSD-3-Clause
"""A second opinion on a scene: by the robot's own collision geometry, not its spheres.

As a filter, where spheres touch::

    exact = iksel.exact.ExactCollision(scene, "arm.urdf")
    result = solver.solve(pose, scene=scene)
    if result.status is iksel.Status.in_collision:
        result = solver.solve(pose, filter=exact)

Spheres stick out of the links that they cover, and so refuse some configurations that
are free. Needs the library coal: `pip install iksel[collision]`.
"""

from __future__ import annotations

import copy
from itertools import combinations
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from iksel_cpp import InvalidArgumentError

from iksel._arrays import as_floats
from iksel._collision_shapes import import_coal
from iksel.collision import SelfCollision

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterable, Mapping

    import numpy.typing as npt
    from iksel_cpp import Obstacle, Scene

    from iksel._arrays import BoolArray, FloatArray
    from iksel._collision_shapes import Placed


class _Solid(NamedTuple):
    """An obstacle for coal."""

    geometry: Any
    places: Callable[[FloatArray, FloatArray], Iterable[Any]]
    """Coal's transforms of it that may touch what lies between two corners (3,) [m]."""
    request: Any
    lower: FloatArray  # of the box around it, its margin included, (3,) [m]
    upper: FloatArray


class ExactCollision:
    """Says which configurations are free, in a scene as it is when this is made.

    Those that the scene's spheres let through are free; coal is asked about the others
    only, with the links' own geometry. Links that the arm does not move are not held
    against obstacles, and links against each other in the pairs of the scene's spheres.
    """

    def __init__(
        self,
        scene: Scene,
        urdf: str | os.PathLike[str],
        *,
        other_joints: Mapping[str, float] | None = None,
        packages: Mapping[str, str | os.PathLike[str]] | None = None,
        xacro_args: Mapping[str, str] | None = None,
    ) -> None:
        """Read the collision geometry of the links.

        Args:
            scene: Its obstacles and pairs; objects that are attached count by their
                spheres, which are all there is of them.
            urdf: Path of the URDF or xacro, or URDF text.
            other_joints: Values of joints that are not the arm's [rad or m].
            packages: Folders of package:// names of meshes.
            xacro_args: Values of a xacro file's arguments.

        Raises:
            InvalidArgumentError: coal is missing, or objects are attached.
            UrdfError: The URDF or a mesh cannot be read.
            UnknownNameError: The URDF lacks a link or joint.
        """
        if scene.attached:
            raise InvalidArgumentError(
                f"scene: objects are attached ({', '.join(scene.attached)}), of which "
                "there is nothing but their spheres"
            )
        self._coal = import_coal()
        self._scene = copy.copy(scene)
        pairs = {frozenset(pair) for pair in scene.spheres.pairs}
        others = combinations(scene.spheres.links, 2)
        self._self = SelfCollision(
            urdf,
            scene.robot,
            ignore=[pair for pair in others if frozenset(pair) not in pairs],
            keep=scene.spheres.pairs,
            samples=0,
            other_joints=other_joints,
            packages=packages,
            xacro_args=xacro_args,
        )
        self._solids = [self._solid(o) for o in scene.obstacles.values()]

    @property
    def scene(self) -> Scene:
        """A copy of the scene as it was."""
        return copy.copy(self._scene)

    def __call__(self, q: npt.ArrayLike) -> BoolArray:
        """Say which configurations are free.

        Args:
            q: Joint values, (n, dof) [rad or m].

        Returns:
            (n,) truth values.

        Raises:
            InvalidArgumentError: Wrong shape or dtype, or a number that is not finite.
        """
        values = as_floats("q", q, (self._scene.robot.dof,))
        rows = values.reshape(-1, values.shape[-1])
        free = np.asarray(self._scene.is_free(rows), dtype=bool)
        free[~free] = self.geometry_is_free(rows[~free])
        return free.reshape(values.shape[:-1])

    def geometry_is_free(self, q: FloatArray) -> BoolArray:
        """The same by coal alone, whatever the spheres say.

        Args:
            q: Joint values, (n, dof) [rad or m].

        Returns:
            (n,) truth values.
        """
        free = self._self(q)
        start = 0
        for placed in self._self.place(q):
            for n in range(len(placed.centre)):
                row = start + n
                free[row] = free[row] and not self._touches(placed, n)
            start += len(placed.centre)
        return free

    def _touches(self, placed: Placed, n: int) -> bool:
        """Whether a moving link touches an obstacle at configuration n."""
        for solid in self._solids:
            low = placed.centre[n] - placed.half[n]
            high = placed.centre[n] + placed.half[n]
            near = ((low <= solid.upper) & (high >= solid.lower)).all(axis=1)
            for shape in np.flatnonzero(near & self._self.moves).tolist():
                geometry, at = self._self.geometry(shape), placed.at(n, shape)
                for place in solid.places(low[shape], high[shape]):
                    result = self._coal.CollisionResult()
                    if self._coal.collide(
                        geometry, at, solid.geometry, place, solid.request, result
                    ):
                        return True
        return False

    def _solid(self, obstacle: Obstacle) -> _Solid:
        coal = self._coal
        pose = np.asarray(obstacle.pose)
        reach = np.zeros(3)
        if obstacle.shape == "box":
            geometry = coal.Box(*obstacle.size)
            reach = np.abs(pose[:3, :3]) @ obstacle.size / 2
        elif obstacle.shape in {"sphere", "points"}:
            geometry = coal.Sphere(obstacle.radius)
            reach = np.full(3, obstacle.radius)
        elif obstacle.shape == "half_space":
            geometry = coal.Halfspace(np.array([0.0, 0.0, 1.0]), 0.0)
            reach = np.full(3, np.inf)
        else:
            make = coal.Capsule if obstacle.shape == "capsule" else coal.Cylinder
            geometry = make(obstacle.radius, obstacle.length)
            reach = np.full(3, obstacle.radius + obstacle.length / 2)
        request = coal.CollisionRequest()
        request.enable_contact = False
        request.security_margin = obstacle.margin
        centres = pose[None, :3, 3]
        if obstacle.points is not None:
            centres = obstacle.points @ pose[:3, :3].T + centres
        gap = reach + obstacle.margin

        def places(low: FloatArray, high: FloatArray) -> Iterable[Any]:
            near = ((centres >= low - gap) & (centres <= high + gap)).all(axis=1)
            return [coal.Transform3s(pose[:3, :3], c) for c in centres[near]]

        lower, upper = centres.min(axis=0) - gap, centres.max(axis=0) + gap
        return _Solid(geometry, places, request, lower, upper)
