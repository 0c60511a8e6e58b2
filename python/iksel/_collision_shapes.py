# SPDX-License-Identifier: BSD-3-Clause
"""Shapes of a URDF's collision geometry, and which of them touch."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from iksel_cpp import InvalidArgumentError, UrdfError

from iksel._packages import resolve_path
from iksel._sphere_cover import Mesh, Solid
from iksel._urdf_xml import read_numbers, read_origin

if TYPE_CHECKING:
    import xml.etree.ElementTree as ET
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from iksel._arm_links import ArmLinks
    from iksel._arrays import BoolArray, FloatArray, IntArray

_CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
_CHUNK = 256  # configurations placed at a time, which bounds the memory


class Shape(NamedTuple):
    """A shape of a link."""

    link: str
    geometry: Any
    hull: Any  # convex, around the geometry; the geometry itself where that is convex
    origin: FloatArray  # pose in the frame of the link, (4, 4)


class Placed:
    """Shapes of links at a batch of configurations."""

    def __init__(self, shapes: Shapes, poses: FloatArray) -> None:
        self._coal = shapes.coal
        self._links = poses
        # World boxes around the shapes, (n, shapes, 3) [m].
        frames = poses[:, shapes.link]
        centres = (frames[..., :3, :3] @ shapes.centre[..., None])[..., 0]
        self.centre = centres + frames[..., :3, 3]
        self.half = np.abs(frames[..., :3, :3] @ shapes.half_axes).sum(-1)
        self._link, self._origin = shapes.link, shapes.in_link
        self._made: dict[tuple[int, int], Any] = {}

    def at(self, n: int, shape: int) -> Any:
        """Coal's transform of a shape at configuration n."""
        if (n, shape) not in self._made:
            pose = self._links[n, self._link[shape]] @ self._origin[shape]
            self._made[n, shape] = self._coal.Transform3s(pose[:3, :3], pose[:3, 3])
        return self._made[n, shape]

    def near(self, pairs: IntArray, margins: FloatArray | float) -> BoolArray:
        """Whether the boxes of pairs (m, 2) of shapes are within margins, (n, m)."""
        a, b = pairs[:, 0], pairs[:, 1]
        gap = np.abs(self.centre[:, a] - self.centre[:, b])
        gap -= self.half[:, a]
        gap -= self.half[:, b]
        close: BoolArray = gap.max(-1) <= margins
        return close


def place(shapes: Shapes, links: ArmLinks, q: FloatArray) -> Iterator[Placed]:
    """Place the shapes at configurations (n, dof), some of them at a time."""
    for start in range(0, len(q), _CHUNK):
        yield Placed(shapes, links.poses(q[start : start + _CHUNK]))


class Shapes:
    """All shapes of a URDF, on the links that an arm moves."""

    def __init__(self, coal: Any, shapes: Sequence[Shape], links: ArmLinks) -> None:
        self.coal = coal
        self.links = list(dict.fromkeys(shape.link for shape in shapes))
        self.of_link = {
            link: [i for i, shape in enumerate(shapes) if shape.link == link]
            for link in self.links
        }
        self.link = np.array([links.index[shape.link] for shape in shapes])
        self.in_link = np.array([shape.origin for shape in shapes])
        boxes = np.array([_local_box(shape.geometry) for shape in shapes])
        rotation = self.in_link[:, :3, :3]
        centre = (rotation @ boxes[:, 0, :, None])[..., 0]
        self.centre = centre + self.in_link[:, :3, 3]
        self.half_axes = rotation * boxes[:, 1, None, :]
        base = links.body[links.base]
        self.moving = np.array([links.body[shape.link] != base for shape in shapes])
        self._shapes = shapes
        self._tests: dict[tuple[int, int], tuple[Any, Any]] = {}
        self._result = coal.CollisionResult()
        self._requests: dict[float, Any] = {}

    def geometry(self, shape: int) -> Any:
        """Coal's geometry of a shape."""
        return self._shapes[shape].geometry

    def parts(self, pair: tuple[str, str]) -> list[tuple[int, int]]:
        """The pairs of shapes of two links."""
        a, b = (self.of_link[link] for link in pair)
        return [(i, j) for i in a for j in b]

    def touch(
        self,
        placed: Placed,
        n: int,
        pair: tuple[int, int],
        margin: float,
        *,
        hulls: bool = False,
    ) -> bool:
        """Whether two shapes are within margin at configuration n; or their hulls."""
        convex, exact = self._tests_of(pair)
        at = placed.at(n, pair[0]), placed.at(n, pair[1])
        request = self._request(margin)
        if not self._collide(convex, at, request):
            return False
        return hulls or exact is None or self._collide(exact, at, request)

    def _collide(self, test: Any, at: tuple[Any, Any], request: Any) -> bool:
        self._result.clear()
        return bool(test(*at, request, self._result))

    def _tests_of(self, pair: tuple[int, int]) -> tuple[Any, Any]:
        if pair not in self._tests:
            a, b = self._shapes[pair[0]], self._shapes[pair[1]]
            make = self.coal.ComputeCollision
            convex = a.hull is a.geometry and b.hull is b.geometry
            exact = None if convex else make(a.geometry, b.geometry)
            self._tests[pair] = make(a.hull, b.hull), exact
        return self._tests[pair]

    def _request(self, margin: float) -> Any:
        if margin not in self._requests:
            request = self._requests[margin] = self.coal.CollisionRequest()
            request.security_margin = margin
            request.enable_contact = False
        return self._requests[margin]


def import_coal() -> Any:
    """Import the library coal, or say how to install it."""
    try:
        import coal  # noqa: PLC0415 (an optional extra)
    except ImportError as error:
        raise InvalidArgumentError(
            f"self-collision needs coal, which cannot be imported ({error}); "
            "install it by: pip install 'iksel[collision]'"
        ) from None
    return coal


def read_shapes(
    coal: Any, root: ET.Element, folder: Path, packages: Mapping[str, Any]
) -> list[Shape]:
    """Read the collision geometry of all links of a URDF."""
    shapes = []
    for link in root.findall("link"):
        name = link.get("name", "")
        for collision in link.findall("collision"):
            geometry = collision.find("geometry")
            if geometry is None or len(geometry) == 0:
                raise UrdfError(f"urdf: link {name!r} has an empty collision")
            try:
                shape = _make_shape(coal, geometry[0], folder, packages)
                origin = read_origin(collision)
            except UrdfError as error:
                raise type(error)(f"urdf: link {name!r}: {error}") from None
            shapes.append(Shape(name, shape, _hull(shape), origin))
    if not shapes:
        raise UrdfError("urdf: no link has collision geometry")
    return shapes


def _make_shape(
    coal: Any, element: ET.Element, folder: Path, packages: Mapping[str, Any]
) -> Any:
    if element.tag == "box":
        return coal.Box(*read_numbers(element, "size", 3))
    if element.tag == "sphere":
        return coal.Sphere(*read_numbers(element, "radius", 1))
    if element.tag == "cylinder":
        (radius,) = read_numbers(element, "radius", 1)
        return coal.Cylinder(radius, *read_numbers(element, "length", 1))
    if element.tag == "mesh":
        path = resolve_path(element.get("filename", ""), packages, folder)
        scale = np.array(read_numbers(element, "scale", 3, "1 1 1"))
        return _load_mesh(coal, path, scale)
    raise UrdfError(
        f"no geometry {element.tag!r}; possible: box, cylinder, sphere, mesh"
    )


def _load_mesh(coal: Any, path: Path, scale: FloatArray) -> Any:
    if not path.is_file():
        raise UrdfError(f"no mesh file {str(path)!r}")
    try:
        return coal.MeshLoader().load(str(path), scale)
    except (RuntimeError, ValueError) as error:
        raise UrdfError(f"mesh file {str(path)!r}: {error}") from None


def _hull(shape: Any) -> Any:
    """The convex hull of a mesh; other shapes are convex."""
    if not hasattr(shape, "buildConvexHull"):
        return shape
    try:
        shape.buildConvexHull(False, "Qt")  # noqa: FBT003 (coal's own signature)
    except (RuntimeError, ValueError):
        return shape  # flat, which has no hull
    return shape.convex or shape


def is_sphere(geometry: Any) -> bool:
    """Whether one of coal's shapes is a ball."""
    return type(geometry).__name__ == "Sphere"


def round_rod(shape: Shape, balls: FloatArray, max_error: float) -> FloatArray | None:
    """Spheres along a cylinder whose ends lie in balls that are as thick.

    So it is a capsule, which spheres on its axis cover closely.

    Args:
        shape: The cylinder, or any other shape.
        balls: Those of its link, (n, 4).
        max_error: How far spheres may stick out [m].

    Returns:
        (m, 4), rows of centre and radius [m]; None if it is no such cylinder.
    """
    geometry = shape.geometry
    if type(geometry).__name__ != "Cylinder":
        return None
    radius, half = geometry.radius, geometry.halfLength
    middle, axis = shape.origin[:3, 3], shape.origin[:3, 2]
    slack = 1e-6 * min(radius, max_error)
    for end in (middle - half * axis, middle + half * axis):
        off = np.linalg.norm(balls[:, :3] - end, axis=1)
        if not np.any(off + radius <= balls[:, 3] + slack):
            return None
    # A sphere of radius R covers the cylinder where R^2 - radius^2 >= the way along it.
    reach = np.sqrt((radius + max_error - slack) ** 2 - radius**2)
    count = int(np.ceil(half / reach))
    along = (2 * np.arange(count) + 1 - count) * half / count
    thick = np.hypot(radius, half / count) + slack
    rows: FloatArray = np.column_stack(
        [middle + along[:, None] * axis, np.full(count, thick)]
    )
    return rows


def solid_of(shape: Shape, max_error: float) -> Solid:
    """A box, cylinder or mesh in the frame of its link, by triangles around it."""
    geometry = shape.geometry
    kind = type(geometry).__name__
    if kind == "Box":
        half = np.array(geometry.halfSide)
        mesh = _prism(half[:2] * _CORNERS, float(half[2]))
    elif kind == "Cylinder":
        half = np.array([geometry.radius, geometry.halfLength])
        # Sides so many that the corners stick out by a part of the error only.
        ratio = min(max_error / geometry.radius / 20, 0.5)
        count = max(8, int(np.ceil(np.pi / np.arccos(1 / (1 + ratio)))))
        angles = 2 * np.pi * np.arange(count) / count
        corner = geometry.radius / np.cos(np.pi / count)
        around = corner * np.column_stack([np.cos(angles), np.sin(angles)])
        mesh = _prism(around, float(geometry.halfLength))
    else:
        half = np.zeros(0)
        faces = [geometry.tri_indices(i) for i in range(geometry.num_tris)]
        mesh = Mesh(
            np.array(geometry.vertices(), dtype=float),
            np.array([[t[0], t[1], t[2]] for t in faces], dtype=int),
        )
    rotation, place = shape.origin[:3, :3], shape.origin[:3, 3]

    def holds(points: FloatArray) -> BoolArray:
        local = np.abs((points - place) @ rotation)
        if kind == "Cylinder":
            local = np.column_stack([np.hypot(local[:, 0], local[:, 1]), local[:, 2]])
        if not half.size:
            return np.zeros(len(points), dtype=bool)
        return np.asarray((local < half * (1 - 1e-9)).all(axis=1))

    return Solid(Mesh(mesh.vertices @ rotation.T + place, mesh.triangles), holds)


def _prism(around: FloatArray, half: float) -> Mesh:
    """A polygon (n, 2) in the plane, convex, from -half to half in z."""
    n = len(around)
    ends = [np.column_stack([around, np.full(n, z)]) for z in (-half, half)]
    i = np.arange(n)
    j = (i + 1) % n
    fan = np.column_stack([np.zeros(n - 2, dtype=int), i[1:-1], i[2:]])
    sides = [np.column_stack([i, j, j + n]), np.column_stack([i, j + n, i + n])]
    return Mesh(np.concatenate(ends), np.concatenate([fan, fan + n, *sides]))


def _local_box(shape: Any) -> tuple[FloatArray, FloatArray]:
    """Centre and half lengths [m] of the box around a shape, in its own frame."""
    shape.computeLocalAABB()
    low, high = shape.aabb_local.min_.copy(), shape.aabb_local.max_.copy()
    return (low + high) / 2, (high - low) / 2
