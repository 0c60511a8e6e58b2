# SPDX-License-Identifier: BSD-3-Clause
"""The body of a robot as spheres.

They are made from a URDF, read from sphere files, and kept in a file.

    spheres = iksel.spheres.from_urdf("arm.urdf", robot, srdf="arm.srdf")
    iksel.spheres.save(spheres, "arm.spheres.npz")
    scene = iksel.Scene(robot, spheres)

Needs the library coal for `from_urdf`: `pip install iksel[collision]`.
"""

from __future__ import annotations

import contextlib
import zipfile
import zlib
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import InvalidArgumentError, RobotSpheres, Scene

from iksel._base.files import check_unpacked, replaced
from iksel.collision import SelfCollision
from iksel.collision._arm_links import read_urdf
from iksel.collision._cache_files import file_name, key_of
from iksel.collision._shapes import (
    import_coal,
    is_sphere,
    mesh_of,
    read_shapes,
    spheres_around,
)
from iksel.collision._sphere_cover import cover
from iksel.collision._sphere_files import from_curobo, from_json
from iksel.formats._urdf_xml import read_xml

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterable, Mapping

    from iksel_cpp import Robot

    from iksel._base.arrays import FloatArray
    from iksel.collision._shapes import Shape

    Spheres = dict[str, FloatArray]
    Pairs = list[tuple[str, str]]

__all__ = [
    "from_curobo",
    "from_json",
    "from_urdf",
    "load",
    "save",
    "with_pairs",
]

_FORMAT = "iksel spheres 1"
_METHOD = "cover 6"
"""To be changed with how spheres are made."""
PART_OF_BOX = 1 / 10
"""Of max_error, which spheres may stick out of a box: it takes few."""
PART_OF_CYLINDER = 1 / 40
"""The same of a cylinder."""


def from_urdf(
    urdf: str | os.PathLike[str],
    robot: Robot,
    *,
    max_error: float = 0.02,
    srdf: str | os.PathLike[str] | None = None,
    ignore: Iterable[tuple[str, str]] = (),
    samples: int = 5_000,
    seed: int = 0,
    other_joints: Mapping[str, float] | None = None,
    packages: Mapping[str, str | os.PathLike[str]] | None = None,
    xacro_args: Mapping[str, str] | None = None,
    trusted: bool = False,
    cache: str | os.PathLike[str] | None = None,
    progress: Callable[[int, int], Any] | None = None,
) -> RobotSpheres:
    """Cover the collision geometry of a URDF's links by spheres.

    Each shape lies inside its spheres, which stick out of it by `max_error` at most, of
    a box by a tenth and of a cylinder by a fortieth of that: the smaller, the more
    spheres. Spheres are taken as they are, so that a URDF made of them (as VAMP's are)
    keeps its own. Links are looked at in the pairs that
    iksel.collision.SelfCollision looks at.

    Args:
        urdf: Path of the URDF or xacro, or URDF text.
        robot: The arm, from a URDF with the same links.
        max_error: How far spheres may stick out of a mesh [m].
        srdf: Path of an SRDF, or its text, whose disable_collisions are not looked at.
        ignore: Pairs of links that may touch.
        samples: Configurations in which to look for pairs that always touch and,
            without an SRDF, for those that never do.
        seed: Of the samples.
        other_joints: Values of joints that are not the arm's [rad or m].
        packages: Folders of package:// names of meshes.
        xacro_args: Values of a xacro file's arguments.
        trusted: Whether a xacro file may run whatever Python it contains.
        cache: Folder, such as the database's, that keeps what is made here, in a file
            named after the robot and a hash of all that it depends on. None: it is made
            anew.
        progress: As SelfCollision's, while pairs of links are looked at.

    Raises:
        InvalidArgumentError: coal is missing, max_error is not above 0, or the cache
            cannot be written.
        UrdfError: The URDF, the SRDF or a mesh cannot be read.
        UnknownNameError: The URDF lacks a joint of the arm, or what an argument names.
    """
    if not 0 < max_error < np.inf:
        raise InvalidArgumentError(f"max_error: {max_error} m is not above 0")
    ignore = sorted(ignore)
    root, folder = read_urdf(
        urdf, packages or {}, xacro_args, robot.base_link, trusted=trusted
    )
    kept = None
    if cache is not None:
        listed = read_xml("srdf", srdf)[1] if srdf is not None else None
        options = (max_error, listed, ignore, samples, seed)
        others = sorted((other_joints or {}).items())
        made_of = (robot.chain_hash, *options, others)
        key = key_of(_METHOD, root, folder, packages or {}, made_of)
        kept = Path(cache) / file_name(robot.name, key, "spheres.npz")
        with contextlib.suppress(InvalidArgumentError):  # none, or a damaged one
            return load(kept)
    coal = import_coal()
    pairs = SelfCollision(
        urdf,
        robot,
        srdf=srdf,
        ignore=ignore,
        samples=samples,
        seed=seed,
        other_joints=other_joints,
        packages=packages,
        xacro_args=xacro_args,
        trusted=trusted,
        cache=cache,
        progress=progress,
    ).pairs
    shapes: dict[str, list[Shape]] = {}
    for shape in read_shapes(coal, root, folder, packages or {}):
        shapes.setdefault(shape.link, []).append(shape)
    links = {link: _cover_link(of_link, max_error) for link, of_link in shapes.items()}
    made = RobotSpheres(links, pairs)
    if kept is not None:
        save(made, kept)
    return made


def with_pairs(
    spheres: RobotSpheres,
    robot: Robot,
    *,
    samples: int = 5_000,
    seed: int = 0,
    ignore: Iterable[tuple[str, str]] = (),
) -> RobotSpheres:
    """Look at all pairs of links but those whose spheres always touch.

    Pairs that touch in all samples, as neighbours do, are left out, and so is what
    `ignore` names.

    Args:
        spheres: Whose links count, not their pairs.
        robot: The arm.
        samples: Configurations that are looked at.
        seed: Of the samples.
        ignore: Pairs of links that may touch.

    Raises:
        UnknownNameError: The robot lacks a link.
    """
    ignored = {frozenset(pair) for pair in ignore}
    links = spheres.links
    q = robot.random_configurations(samples, seed=seed)
    pairs = []
    for pair in combinations(links, 2):
        if frozenset(pair) in ignored:
            continue
        alone = RobotSpheres({link: links[link] for link in pair}, [pair])
        if np.any(Scene(robot, alone).is_free(q)):
            pairs.append(pair)
    return RobotSpheres(links, pairs)


def save(spheres: RobotSpheres, path: str | os.PathLike[str]) -> None:
    """Write spheres to a file, for example beside the robot's database.

    Args:
        spheres: What is written.
        path: Of the file; numpy's npz. Its folder is made if there is none.

    Raises:
        InvalidArgumentError: It cannot be written.
    """
    links = spheres.links
    path = Path(path)
    with contextlib.suppress(OSError):  # which writing will tell
        path.parent.mkdir(parents=True, exist_ok=True)
    with replaced(path) as file:
        np.savez_compressed(
            file,
            format=np.array(_FORMAT),
            links=np.array(list(links), dtype=np.str_),
            counts=np.array([len(rows) for rows in links.values()]),
            spheres=np.concatenate(list(links.values())),
            pairs=np.array(spheres.pairs, dtype=np.str_).reshape(-1, 2),
        )


def load(path: str | os.PathLike[str]) -> RobotSpheres:
    """Read spheres that `save` wrote.

    Args:
        path: Of the file.

    Raises:
        InvalidArgumentError: It cannot be read, or is no such file.
    """
    try:
        check_unpacked(Path(path))
        # Opened here: numpy leaves a damaged file open.
        with Path(path).open("rb") as file, np.load(file, allow_pickle=False) as held:
            data = {name: held[name] for name in held.files}
        if data["format"] != _FORMAT:
            raise InvalidArgumentError(f"path: {str(path)!r} is of another format")
        rows = np.split(data["spheres"], np.cumsum(data["counts"])[:-1])
        links = dict(zip(data["links"].tolist(), rows, strict=True))
        return RobotSpheres(links, [(str(a), str(b)) for a, b in data["pairs"]])
    except (
        OSError,
        EOFError,
        ValueError,
        KeyError,
        IndexError,
        TypeError,
        MemoryError,
        zipfile.BadZipFile,
        zlib.error,
    ) as error:
        raise InvalidArgumentError(f"path: {str(path)!r}: {error}") from None


def _cover_link(shapes: list[Shape], max_error: float) -> FloatArray:
    """Spheres around the shapes of a link, in its frame, (n, 4)."""
    balls = np.array(
        [[*s.origin[:3, 3], s.geometry.radius] for s in shapes if is_sphere(s.geometry)]
    ).reshape(-1, 4)
    parts = [balls]
    meshes = []
    for shape in shapes:
        if is_sphere(shape.geometry):
            continue
        rows = spheres_around(
            shape,
            balls,
            of_box=PART_OF_BOX * max_error,
            of_cylinder=PART_OF_CYLINDER * max_error,
        )
        if rows is None:
            meshes.append(mesh_of(shape))
        else:
            parts.append(rows)
    if meshes:
        parts.append(cover(meshes, balls, max_error)[len(balls) :])
    return np.concatenate(parts)
