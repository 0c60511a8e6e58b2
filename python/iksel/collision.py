# SPDX-License-Identifier: BSD-3-Clause
"""Self-collision from a URDF's collision geometry, as a filter for solves.

    from iksel.collision import SelfCollision

    solver.solve(pose, filter=SelfCollision("arm.urdf", robot))

Needs the library coal: `pip install iksel[collision]`.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import InvalidArgumentError, UnknownNameError, UrdfError

from iksel._arrays import as_floats
from iksel.pose import pose_from_euler

if TYPE_CHECKING:
    import os
    from collections.abc import Iterable, Mapping

    import numpy.typing as npt
    from iksel_cpp import Robot

    from iksel._arrays import BoolArray, FloatArray


class SelfCollision:
    """Says which configurations of an arm are free of collisions between its links."""

    def __init__(
        self,
        urdf: str | os.PathLike[str],
        robot: Robot,
        *,
        margin: float = 0.0,
        ignore: Iterable[tuple[str, str]] = (),
        other_joints: Mapping[str, float] | None = None,
        packages: Mapping[str, str | os.PathLike[str]] | None = None,
    ) -> None:
        """Read the collision geometry of all links.

        Args:
            urdf: Path of the URDF, or its text. Boxes, cylinders, spheres and meshes.
            robot: The arm whose joint values are asked about, from the same URDF.
            margin: Links nearer than this collide [m].
            ignore: Pairs of links that may touch. Links that a joint connects may
                always, and so may links that do not move against each other.
            other_joints: Values of joints that are not the arm's [rad or m]; those that
                the arm holds are known, others are 0 if not given.
            packages: Folders of package:// names of meshes.

        Raises:
            InvalidArgumentError: coal is missing, or margin is negative.
            UrdfError: The URDF or a mesh cannot be read, or there is no collision
                geometry.
            UnknownNameError: The URDF lacks a joint of the arm, or what `ignore` or
                `other_joints` names; or `packages` lacks a folder.
        """
        if not 0 <= margin < np.inf:
            raise InvalidArgumentError(f"margin: {margin} m is not 0 or more")
        self._coal = _import_coal()
        text, folder = _read(urdf)
        try:
            root = ET.fromstring(text)  # noqa: S314 (the user's own file)
        except ET.ParseError as error:
            raise UrdfError(f"urdf: {error}") from None
        self._dof = robot.dof
        self._request = self._coal.CollisionRequest()
        self._request.security_margin = margin
        self._shapes = self._read_shapes(root, folder, packages or {})
        if not self._shapes:
            raise UrdfError("urdf: no link has collision geometry")
        self._tree = _Tree(root, robot, dict(other_joints or {}))
        self._pairs = self._make_pairs(ignore)

    @property
    def pairs(self) -> list[tuple[str, str]]:
        """The pairs of links that are looked at."""
        return list(self._pairs)

    def __call__(self, q: npt.ArrayLike) -> BoolArray:
        """Say which configurations are free.

        Args:
            q: Joint values, (n, dof) [rad or m].

        Returns:
            (n,) truth values.

        Raises:
            InvalidArgumentError: Wrong shape or dtype, or a number that is not finite.
        """
        values = as_floats("q", q, (self._dof,))
        free = [not self.colliding_links(one) for one in values.reshape(-1, self._dof)]
        return np.array(free, dtype=bool).reshape(values.shape[:-1])

    def colliding_links(self, q: npt.ArrayLike) -> tuple[str, str] | None:
        """The first pair of links that collide at q, (dof,), or None."""
        poses = self._tree.poses(as_floats("q", q, (self._dof,)))
        placed = {
            link: [
                (shape, self._coal.Transform3s(*_split(poses[link] @ origin)))
                for shape, origin in shapes
            ]
            for link, shapes in self._shapes.items()
        }
        for a, b in self._pairs:
            for shape_a, at_a in placed[a]:
                for shape_b, at_b in placed[b]:
                    result = self._coal.CollisionResult()
                    if self._coal.collide(
                        shape_a, at_a, shape_b, at_b, self._request, result
                    ):
                        return a, b
        return None

    def _make_pairs(self, ignore: Iterable[tuple[str, str]]) -> list[tuple[str, str]]:
        ignored = set()
        for pair in ignore:
            for link in pair:
                if link not in self._tree.links:
                    raise UnknownNameError(
                        f"ignore: the URDF has no link {link!r}; it has: "
                        f"{', '.join(self._tree.links)}"
                    )
            ignored.add(frozenset(pair))
        links = list(self._shapes)
        body, parent = self._tree.bodies()
        return [
            (a, b)
            for i, a in enumerate(links)
            for b in links[i + 1 :]
            if frozenset((a, b)) not in ignored
            and body[a] != body[b]
            and parent[body[a]] != body[b]
            and parent[body[b]] != body[a]
        ]

    def _read_shapes(
        self, root: ET.Element, folder: Path, packages: Mapping[str, Any]
    ) -> dict[str, list[tuple[Any, FloatArray]]]:
        shapes: dict[str, list[tuple[Any, FloatArray]]] = {}
        for link in root.findall("link"):
            name = link.get("name", "")
            for collision in link.findall("collision"):
                geometry = collision.find("geometry")
                if geometry is None or len(geometry) == 0:
                    raise UrdfError(f"urdf: link {name!r} has an empty collision")
                try:
                    shape = self._make_shape(geometry[0], folder, packages)
                except UrdfError as error:
                    raise type(error)(f"urdf: link {name!r}: {error}") from None
                shapes.setdefault(name, []).append((shape, _origin(collision)))
        return shapes

    def _make_shape(
        self, element: ET.Element, folder: Path, packages: Mapping[str, Any]
    ) -> Any:
        if element.tag == "box":
            return self._coal.Box(*_numbers(element, "size", 3))
        if element.tag == "sphere":
            return self._coal.Sphere(*_numbers(element, "radius", 1))
        if element.tag == "cylinder":
            (radius,) = _numbers(element, "radius", 1)
            return self._coal.Cylinder(radius, *_numbers(element, "length", 1))
        if element.tag == "mesh":
            path = _mesh_path(element.get("filename", ""), folder, packages)
            scale = np.array(_numbers(element, "scale", 3, "1 1 1"))
            return self._load_mesh(path, scale)
        raise UrdfError(
            f"no geometry {element.tag!r}; possible: box, cylinder, sphere, mesh"
        )

    def _load_mesh(self, path: Path, scale: FloatArray) -> Any:
        if not path.is_file():
            raise UrdfError(f"no mesh file {str(path)!r}")
        try:
            return self._coal.MeshLoader().load(str(path), scale)
        except (RuntimeError, ValueError) as error:
            raise UrdfError(f"mesh file {str(path)!r}: {error}") from None


class _Tree:
    """All links of a URDF and where they are."""

    def __init__(
        self, root: ET.Element, robot: Robot, others: dict[str, float]
    ) -> None:
        self.links = [link.get("name", "") for link in root.findall("link")]
        self._names = robot.joint_names
        self._joints: dict[str, _Joint] = {}
        for element in root.findall("joint"):
            joint = _Joint(element)
            self._joints[joint.child] = joint
        known = [joint.name for joint in self._joints.values()]
        for argument, names in (("robot", self._names), ("other_joints", others)):
            for name in names:
                if name not in known:
                    raise UnknownNameError(
                        f"{argument}: the URDF has no joint {name!r}; it has: "
                        f"{', '.join(known)}"
                    )
        self._others = {**robot.locked_joints, **others}

    def poses(self, q: FloatArray) -> dict[str, FloatArray]:
        """Pose of each link in the root link's frame."""
        values = {**self._others, **dict(zip(self._names, q.tolist(), strict=True))}
        poses: dict[str, FloatArray] = {}

        def pose(link: str) -> FloatArray:
            if link not in poses:
                joint = self._joints.get(link)
                poses[link] = (
                    np.eye(4)
                    if joint is None
                    else pose(joint.parent) @ joint.transform(values)
                )
            return poses[link]

        return {link: pose(link) for link in self.links}

    def bodies(self) -> tuple[dict[str, str], dict[str, str | None]]:
        """What moves as one.

        Returns:
            For each link the first link of those that are fixed to each other, their
            body; and for each body the one that it is joined to.
        """

        def body(link: str) -> str:
            joint = self._joints.get(link)
            return link if joint is None or joint.moves else body(joint.parent)

        body_of = {link: body(link) for link in self.links}
        parent_of = {
            first: None if joint is None else body_of[joint.parent]
            for first in body_of.values()
            for joint in [self._joints.get(first)]
        }
        return body_of, parent_of


class _Joint:
    """A joint of a URDF."""

    def __init__(self, element: ET.Element) -> None:
        self.name = element.get("name", "")
        self.kind = element.get("type", "")
        self.moves = self.kind in {"revolute", "continuous", "prismatic"}
        self.parent = _link(element, "parent")
        self.child = _link(element, "child")
        self._origin = _origin(element)
        axis = element.find("axis")
        xyz = [1.0, 0.0, 0.0] if axis is None else _numbers(axis, "xyz", 3)
        self._axis = np.array(xyz) / (np.linalg.norm(xyz) or 1.0)
        mimic = element.find("mimic")
        self._follows = None if mimic is None else mimic.get("joint", "")
        self._factor = (
            1.0 if mimic is None else _numbers(mimic, "multiplier", 1, "1")[0]
        )
        self._offset = 0.0 if mimic is None else _numbers(mimic, "offset", 1, "0")[0]

    def transform(self, values: Mapping[str, float]) -> FloatArray:
        """Pose of the child link in the parent link's frame."""
        if not self.moves:
            return self._origin
        driver = self.name if self._follows is None else self._follows
        value = self._factor * values.get(driver, 0.0) + self._offset
        motion = np.eye(4)
        if self.kind == "prismatic":
            motion[:3, 3] = value * self._axis
        else:
            x, y, z = self._axis
            cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
            motion[:3, :3] += np.sin(value) * cross
            motion[:3, :3] += (1 - np.cos(value)) * cross @ cross
        moved: FloatArray = self._origin @ motion
        return moved


def _import_coal() -> Any:
    try:
        import coal  # noqa: PLC0415 (an optional extra)
    except ImportError as error:
        raise InvalidArgumentError(
            f"self-collision needs coal, which cannot be imported ({error}); "
            "install it by: pip install 'iksel[collision]'"
        ) from None
    return coal


def _read(urdf: str | os.PathLike[str]) -> tuple[str, Path]:
    """The text, and the folder that relative mesh names start from."""
    if isinstance(urdf, str) and urdf.lstrip().startswith("<"):
        return urdf, Path()
    path = Path(urdf)
    try:
        return path.read_text("utf-8"), path.parent
    except OSError as error:
        raise UrdfError(f"urdf: {error}") from None


def _link(joint: ET.Element, end: str) -> str:
    element = joint.find(end)
    return "" if element is None else element.get("link", "")


def _numbers(
    element: ET.Element, attribute: str, count: int, default: str = ""
) -> list[float]:
    text = element.get(attribute, default)
    try:
        numbers = [float(word) for word in text.split()]
    except ValueError:
        numbers = []
    if len(numbers) != count:
        raise UrdfError(
            f"{element.tag} with {attribute}={text!r}, expected {count} numbers"
        )
    return numbers


def _origin(element: ET.Element) -> FloatArray:
    origin = element.find("origin")
    if origin is None:
        return np.eye(4)
    xyz = _numbers(origin, "xyz", 3, "0 0 0")
    return pose_from_euler(xyz, _numbers(origin, "rpy", 3, "0 0 0"))


def _split(pose: FloatArray) -> tuple[FloatArray, FloatArray]:
    return pose[:3, :3], pose[:3, 3]


def _mesh_path(name: str, folder: Path, packages: Mapping[str, Any]) -> Path:
    if name.startswith("package://"):
        package, _, rest = name.removeprefix("package://").partition("/")
        if package not in packages:
            listed = ", ".join(packages) or "none"
            raise UnknownNameError(
                f"packages: no folder for package {package!r} of mesh {name!r}; given: "
                f"{listed}"
            )
        return Path(packages[package]) / rest
    return folder / name.removeprefix("file://")
