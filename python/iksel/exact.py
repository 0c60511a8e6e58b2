# SPDX-License-Identifier: BSD-3-Clause
"""A second opinion on a scene: by the robot's own collision geometry, not its spheres.

    exact = iksel.exact.ExactCollision(scene, "arm.urdf")
    result = solver.solve(pose, scene=scene, exact=exact)

Spheres stick out of the links that they cover, and so refuse some configurations that
are free. Needs the library coal: `pip install iksel[collision]`.
"""

from __future__ import annotations

import copy
import xml.etree.ElementTree as ET
from itertools import combinations
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from iksel._base.arrays import as_floats
from iksel.collision import SelfCollision
from iksel.collision._arm_links import ArmLinks, read_urdf
from iksel.collision._shapes import import_coal
from iksel.formats._packages import resolve_path

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterable, Mapping

    import numpy.typing as npt
    from iksel_cpp import Obstacle, Scene

    from iksel._base.arrays import BoolArray, FloatArray
    from iksel.collision._shapes import Placed


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
    Attached objects are their spheres, which are all there is of them.
    """

    def __init__(
        self,
        scene: Scene,
        urdf: str | os.PathLike[str],
        *,
        other_joints: Mapping[str, float] | None = None,
        packages: Mapping[str, str | os.PathLike[str]] | None = None,
        xacro_args: Mapping[str, str] | None = None,
        trusted: bool = False,
    ) -> None:
        """Read the collision geometry of the links.

        Args:
            scene: Its obstacles, pairs and attached objects.
            urdf: Path of the URDF or xacro, or URDF text.
            other_joints: Values of joints that are not the arm's [rad or m].
            packages: Folders of package:// names of meshes.
            xacro_args: Values of a xacro file's arguments.
            trusted: Whether a xacro file may run whatever Python it contains.

        Raises:
            InvalidArgumentError: coal is missing.
            UrdfError: The URDF or a mesh cannot be read.
            UnknownNameError: The URDF lacks a link or joint.
        """
        self._coal = import_coal()
        self._scene = copy.copy(scene)
        root, folder = read_urdf(
            urdf, packages or {}, xacro_args, scene.robot.base_link, trusted=trusted
        )
        _add_objects(root, scene)
        for mesh in root.iter("mesh"):
            name = resolve_path(mesh.get("filename", ""), packages or {}, folder)
            mesh.set("filename", str(name.absolute()))
        links = ArmLinks(root, scene.robot, other_joints or {})
        pairs = _pairs_of(scene, links)
        # Links without spheres belong to no pair of the scene's.
        bodies = dict.fromkeys([*scene.spheres.links, *scene.attached, *links.links])
        self._self = SelfCollision(
            ET.tostring(root, encoding="unicode"),
            scene.robot,
            ignore=[p for p in combinations(bodies, 2) if frozenset(p) not in pairs],
            keep=[(a, b) for a, b in pairs],
            samples=0,
            other_joints=other_joints,
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


def _add_objects(root: ET.Element, scene: Scene) -> None:
    """Add a link for each attached object, fixed to the one that carries it."""
    for name, link in scene.attached.items():
        added = ET.SubElement(root, "link", name=name)
        for x, y, z, radius in scene.attached_spheres[name].tolist():
            collision = ET.SubElement(added, "collision")
            ET.SubElement(collision, "origin", xyz=f"{x!r} {y!r} {z!r}")
            geometry = ET.SubElement(collision, "geometry")
            ET.SubElement(geometry, "sphere", radius=repr(radius))
        joint = ET.SubElement(root, "joint", name=f"carries {name}", type="fixed")
        ET.SubElement(joint, "parent", link=link)
        ET.SubElement(joint, "child", link=name)


def _pairs_of(scene: Scene, links: ArmLinks) -> set[frozenset[str]]:
    """The pairs of links and attached objects that a scene looks at."""
    pairs = {frozenset(pair) for pair in scene.spheres.pairs}
    for name in scene.attached:
        may = {name, *scene.may_touch[name]}
        may |= {other for other, names in scene.may_touch.items() if name in names}
        others = {*scene.spheres.links, *scene.attached} - may
        pairs |= {frozenset((name, other)) for other in others}
    # What does not move against each other touches always or never.
    return {
        pair for pair in pairs if len({links.body[link] for link in pair}) == len(pair)
    }
