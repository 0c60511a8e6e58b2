# SPDX-License-Identifier: BSD-3-Clause
"""Shapes of a URDF's collision geometry, and which of them touch."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from iksel_cpp import InvalidArgumentError, UrdfError

from iksel.collision._primitive_cover import cover_box, cover_cylinder
from iksel.collision._sphere_cover import Mesh
from iksel.formats._mesh_files import check_mesh_file
from iksel.formats._packages import resolve_path
from iksel.formats._urdf_xml import GEOMETRIES, read_numbers, read_origin

if TYPE_CHECKING:
    import xml.etree.ElementTree as ET
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from iksel._base.arrays import BoolArray, FloatArray, IntArray
    from iksel.collision._arm_links import ArmLinks

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
        # Of the last test; not the shapes', which many threads may ask about at once.
        self.result = shapes.coal.CollisionResult()

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
        result = placed.result
        result.clear()
        if not convex(*at, request, result):
            return False
        if hulls or exact is None:
            return True
        result.clear()
        return bool(exact(*at, request, result))

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
            request = self.coal.CollisionRequest()
            request.security_margin = margin
            request.enable_contact = False
            self._requests[margin] = request
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
        return coal.Box(*_read_lengths(element, "size", 3))
    if element.tag == "sphere":
        return coal.Sphere(*_read_lengths(element, "radius", 1))
    if element.tag in {"cylinder", "capsule"}:  # that has half a ball on each end
        (radius,) = _read_lengths(element, "radius", 1)
        make = coal.Cylinder if element.tag == "cylinder" else coal.Capsule
        return make(radius, *_read_lengths(element, "length", 1))
    if element.tag == "mesh":
        path = resolve_path(element.get("filename", ""), packages, folder)
        scale = np.array(read_numbers(element, "scale", 3, "1 1 1"))
        return _load_mesh(coal, path, scale)
    raise UrdfError(f"no geometry {element.tag!r}; possible: {GEOMETRIES}")


def _read_lengths(element: ET.Element, attribute: str, count: int) -> list[float]:
    lengths = read_numbers(element, attribute, count)
    if min(lengths) < 0:
        text = element.get(attribute)
        raise UrdfError(f"{element.tag} with {attribute}={text!r}, which is below 0")
    return lengths


def _load_mesh(coal: Any, path: Path, scale: FloatArray) -> Any:
    check_mesh_file(path)
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


def mesh_of(shape: Shape) -> Mesh:
    """A mesh in the frame of its link."""
    geometry = shape.geometry
    faces = [geometry.tri_indices(i) for i in range(geometry.num_tris)]
    vertices = np.array(geometry.vertices(), dtype=float)
    return Mesh(
        _placed(vertices, shape.origin),
        np.array([[t[0], t[1], t[2]] for t in faces], dtype=int),
    )


def spheres_around(
    shape: Shape, balls: FloatArray, *, of_box: float, of_cylinder: float
) -> FloatArray | None:
    """Spheres that cover a box, cylinder or capsule, in the frame of its link.

    Args:
        shape: Any shape.
        balls: The spheres of its link, (n, 4).
        of_box: How far spheres may stick out of a box [m].
        of_cylinder: The same of a cylinder or capsule [m].

    Returns:
        (m, 4), rows of centre and radius [m]; None if it is none of them.
    """
    geometry = shape.geometry
    kind = type(geometry).__name__
    if kind == "Box":
        rows = cover_box(np.array(geometry.halfSide), of_box)
    elif kind == "Cylinder":
        half = geometry.halfLength
        bare = (_is_bare(shape, -half, balls), _is_bare(shape, half, balls))
        rows = cover_cylinder(geometry.radius, half, of_cylinder, bare=bare)
    elif kind == "Capsule":
        radius, half = geometry.radius, geometry.halfLength
        ends = [[0, 0, -half, radius], [0, 0, half, radius]]
        between = cover_cylinder(radius, half, of_cylinder, bare=(False, False))
        rows = np.concatenate([ends, between])
    else:
        return None
    return np.column_stack([_placed(rows[:, :3], shape.origin), rows[:, 3]])


def _is_bare(cylinder: Shape, height: float, balls: FloatArray) -> bool:
    """Whether no ball that is as thick stands around an end."""
    radius = cylinder.geometry.radius
    end = cylinder.origin[:3, 3] + height * cylinder.origin[:3, 2]
    off = np.linalg.norm(balls[:, :3] - end, axis=1)
    return not np.any(off + radius <= balls[:, 3] * (1 + 1e-6))


def _placed(points: FloatArray, pose: FloatArray) -> FloatArray:
    placed: FloatArray = points @ pose[:3, :3].T + pose[:3, 3]
    return placed


def _local_box(shape: Any) -> tuple[FloatArray, FloatArray]:
    """Centre and half lengths [m] of the box around a shape, in its own frame."""
    shape.computeLocalAABB()
    low, high = shape.aabb_local.min_.copy(), shape.aabb_local.max_.copy()
    return (low + high) / 2, (high - low) / 2
