# SPDX-License-Identifier: BSD-3-Clause
"""What a URDF's links look like: their visual geometry, read and drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from iksel_cpp import UnknownNameError, UrdfError

from iksel._base import extras, rotations
from iksel.description import read_description
from iksel.formats._mesh_files import check_mesh_file
from iksel.formats._packages import resolve_path
from iksel.formats._urdf_xml import GEOMETRIES, read_numbers, read_origin, read_xml

if TYPE_CHECKING:
    import xml.etree.ElementTree as ET
    from collections.abc import Mapping
    from pathlib import Path

    from iksel_cpp import Robot

    from iksel._base.arrays import FloatArray, IntArray
    from iksel.description import Source
    from iksel.formats._packages import Packages

Colour = tuple[int, int, int]
PLAIN: Colour = (175, 182, 192)


class Piece(NamedTuple):
    """A part of one colour, fixed to a link."""

    link: str
    vertices: FloatArray
    """In the link's frame, (n, 3) [m]."""
    faces: IntArray
    """(m, 3)."""
    colour: Colour


def read_pieces(
    urdf: Source,
    packages: Packages | None,
    xacro_args: Mapping[str, str] | None,
    *,
    trusted: bool = False,
) -> tuple[list[Piece], list[str]]:
    """What the links of a robot look like.

    Args:
        urdf: As read_description() takes it.
        packages: Folders of package:// names; others are looked for around the file.
        xacro_args: Values of a xacro file's arguments.
        trusted: Whether a xacro file may run whatever Python it contains.

    Returns:
        The pieces, and why those that are not among them cannot be shown.

    Raises:
        UrdfError, UnknownNameError: The robot's file cannot be read.
    """
    read = read_description(
        urdf, packages=packages, xacro_args=xacro_args, trusted=trusted
    )
    root = read_xml("urdf", read.urdf)[0]
    named = {
        m.get("name"): colour
        for m in root.findall("material")
        if (colour := _colour(m))
    }
    pieces: list[Piece] = []
    lost: list[str] = []
    for link in root.findall("link"):
        for visual in link.findall("visual"):
            material = visual.find("material")
            colour = None
            if material is not None:
                colour = _colour(material) or named.get(material.get("name"))
            try:
                parts = _read_visual(visual, read.folder, packages or {})
            except (UrdfError, UnknownNameError) as error:
                lost.append(f"link {link.get('name')!r}: {error}")
                continue
            pieces += [
                Piece(link.get("name", ""), vertices, faces, colour or own or PLAIN)
                for vertices, faces, own in parts
            ]
    return pieces, lost


def _colour(material: ET.Element) -> Colour | None:
    """What a <material> says itself; None where that is no colour."""
    element = material.find("color")
    if element is None:
        return None
    try:
        r, g, b = (round(255 * x) for x in read_numbers(element, "rgba", 4)[:3])
    except UrdfError:
        return None
    return r, g, b


def _read_visual(
    visual: ET.Element, folder: Path, packages: Packages
) -> list[tuple[FloatArray, IntArray, Colour | None]]:
    """Vertices in the link's frame, faces and own colours of a <visual>'s parts."""
    geometry = visual.find("geometry")
    if geometry is None or len(geometry) == 0:
        raise UrdfError("an empty visual")
    element, origin = geometry[0], read_origin(visual)
    scale = np.ones(3)
    if element.tag == "mesh":
        path = resolve_path(element.get("filename", ""), packages, folder)
        scale = np.array(read_numbers(element, "scale", 3, "1 1 1"))
        meshes = _load(path)
    else:
        meshes = [_primitive(element)]
    return [
        (
            scale * mesh.vertices @ origin[:3, :3].T + origin[:3, 3],
            mesh.faces,
            _own_colour(mesh),
        )
        for mesh in meshes
    ]


def _load(path: Path) -> list[Any]:
    """The meshes of a file, at their places."""
    trimesh = _trimesh()
    check_mesh_file(path)
    try:
        scene = trimesh.load_scene(path)
        return [mesh for mesh in scene.dump() if len(getattr(mesh, "faces", ()))]
    except Exception as error:  # noqa: BLE001 (of readers of many formats)
        reason = " ".join(str(error).split()) or type(error).__name__
        raise UrdfError(f"mesh file {str(path)!r}: {reason}") from None


def _primitive(element: ET.Element) -> Any:
    creation = _trimesh().creation
    if element.tag == "box":
        return creation.box(read_numbers(element, "size", 3))
    if element.tag == "sphere":
        return creation.icosphere(radius=read_numbers(element, "radius", 1)[0])
    if element.tag in {"cylinder", "capsule"}:  # that has half a ball on each end
        radius, length = (
            read_numbers(element, name, 1)[0] for name in ("radius", "length")
        )
        make = creation.cylinder if element.tag == "cylinder" else creation.capsule
        return make(radius=radius, height=length)
    raise UrdfError(f"no geometry {element.tag!r}; possible: {GEOMETRIES}")


def _own_colour(mesh: Any) -> Colour | None:
    """The colour that a mesh's file gives it."""
    visual = mesh.visual
    if getattr(visual, "material", None) is not None:
        colour = visual.material.main_color
    elif visual.defined:
        colour = visual.main_color
    else:
        return None
    r, g, b = (int(x) for x in colour[:3])
    return r, g, b


def _trimesh() -> Any:
    return extras.need("trimesh", user="iksel.view", extra="'iksel[view]'")


class Visuals:
    """Pieces that are drawn by viser, and move with their links."""

    def __init__(self, scene: Any, robot: Robot, pieces: list[Piece]) -> None:
        """Take viser's scene, the robot, and what its links look like."""
        self._robot = robot
        links = dict.fromkeys(piece.link for piece in pieces)
        self._links = [name for name in links if name in robot.link_names]
        self._index = [robot.link_names.index(name) for name in self._links]
        self._root = scene.add_frame("/meshes", show_axes=False)
        self._frames = [
            scene.add_frame(f"/meshes/{i}", show_axes=False)
            for i in range(len(self._links))
        ]
        self._parts = [
            (
                piece,
                scene.add_mesh_simple(
                    f"/meshes/{self._links.index(piece.link)}/{i}",
                    piece.vertices.astype(np.float32),
                    piece.faces,
                    color=piece.colour,
                    flat_shading=True,
                    side="double",
                ),
            )
            for i, piece in enumerate(pieces)
            if piece.link in self._links
        ]
        self._boxes: list[list[FloatArray]] = [[] for _ in self._links]
        for piece, _ in self._parts:
            edges = np.stack([piece.vertices.min(axis=0), piece.vertices.max(axis=0)])
            box = np.stack(np.meshgrid(*edges.T), axis=-1).reshape(-1, 3)
            self._boxes[self._links.index(piece.link)].append(box)
        self._shown: dict[str, Colour] | None = None

    def corners(self, q: FloatArray) -> FloatArray:
        """Points (n, 3) in the base frame that the pieces are between at q (dof,)."""
        poses = self._robot.link_poses(q)[self._index]
        found = [
            box @ pose[:3, :3].T + pose[:3, 3]
            for boxes, pose in zip(self._boxes, poses, strict=True)
            for box in boxes
        ]
        return np.concatenate([np.empty((0, 3)), *found])

    def __len__(self) -> int:
        """Number of pieces."""
        return len(self._parts)

    def show(self, *, visible: bool) -> None:
        """Show them, or not."""
        self._root.visible = visible

    def draw(self, q: FloatArray, colours: dict[str, Colour]) -> None:
        """Put them where they are at q (dof,); those of some links in other colours."""
        poses = self._robot.link_poses(q)[self._index]
        turns = rotations.quaternion_from_matrix(poses[:, :3, :3])
        for frame, pose, wxyz in zip(self._frames, poses, turns, strict=True):
            frame.position, frame.wxyz = pose[:3, 3], wxyz
        if colours != self._shown:
            for piece, node in self._parts:
                node.color = colours.get(piece.link, piece.colour)
            self._shown = colours
