# SPDX-License-Identifier: BSD-3-Clause
"""Files of spheres that other tools write."""

from __future__ import annotations

import json
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import InvalidArgumentError, RobotSpheres

from iksel._base.files import check_regular, read_text
from iksel.formats import _safe_yaml

if TYPE_CHECKING:
    import os

    from iksel._base.arrays import FloatArray


def from_curobo(path: str | os.PathLike[str]) -> RobotSpheres:
    """Read the spheres of a robot file of cuRobo, in YAML.

    That is `collision_spheres` of a robot, a mapping or the name of a file beside it
    (which may lie in a folder `spheres`), or that file itself; radii grow by
    `collision_sphere_buffer`, and pairs in `self_collision_ignore` are not looked at.
    Without such pairs, no pair is: see `with_pairs`. `self_collision_buffer` is not
    read.

    Args:
        path: Of the file.

    Raises:
        InvalidArgumentError: It cannot be read, or is no such file.
    """
    path = Path(path)
    data = _read_yaml(path)
    for key in ("robot_cfg", "kinematics"):
        inner = data.get(key)
        data = inner if isinstance(inner, dict) else data
    spheres = data.get("collision_spheres")
    if isinstance(spheres, str):
        spheres = _read_yaml(path.parent / spheres).get("collision_spheres")
    if not isinstance(spheres, dict):
        raise InvalidArgumentError(f"path: {str(path)!r} has no collision_spheres")
    buffer = data.get("collision_sphere_buffer", 0.0)
    listed = data.get("self_collision_ignore") or {}
    try:
        links = _read_links(path, spheres, "center", float(buffer or 0.0))
        ignored = {
            frozenset((link, str(other)))
            for link, others in listed.items()
            for other in others
        }
    except (AttributeError, TypeError, ValueError) as error:
        raise InvalidArgumentError(f"path: {str(path)!r}: {error}") from None
    pairs = combinations(links, 2) if ignored else ()
    return RobotSpheres(
        links, [pair for pair in pairs if frozenset(pair) not in ignored]
    )


def from_json(path: str | os.PathLike[str]) -> RobotSpheres:
    """Read a JSON file of spheres by link, as tools around VAMP and foam write them.

    For each link a list of spheres, each with `origin` (or `center`) and `radius` [m].
    No pair of links is looked at: see `with_pairs`.

    Args:
        path: Of the file.

    Raises:
        InvalidArgumentError: It cannot be read, or is no such file.
    """
    path = Path(path)
    try:
        data = json.loads(read_text(path))
    except (OSError, ValueError, RecursionError) as error:
        raise InvalidArgumentError(f"path: {error}") from None
    if not isinstance(data, dict):
        raise InvalidArgumentError(f"path: {str(path)!r} is no mapping of links")
    return RobotSpheres(_read_links(path, data, "origin", 0.0))


def _read_yaml(path: Path) -> dict[str, Any]:
    """The mapping that a YAML file holds.

    Raises:
        InvalidArgumentError: It cannot be read, or is none.
    """
    try:
        check_regular(path)
        data = _safe_yaml.load(read_text(path))
    except ImportError as error:
        raise InvalidArgumentError(
            f"path: YAML needs PyYAML, which cannot be imported ({error}); install "
            "it by: pip install pyyaml"
        ) from None
    except (OSError, ValueError) as error:
        raise InvalidArgumentError(f"path: {error}") from None
    if not isinstance(data, dict):
        raise InvalidArgumentError(f"path: {str(path)!r} is no mapping")
    return data


def _read_links(
    path: Path, data: dict[str, Any], centre: str, buffer: float
) -> dict[str, FloatArray]:
    """Spheres by link; those whose radius is not above 0 are none."""
    links = {}
    for link, spheres in data.items():
        rows = []
        for sphere in spheres if isinstance(spheres, list) else [spheres]:
            try:
                place = sphere.get(centre, sphere.get("center"))
                row = np.array([*place, sphere["radius"]], dtype=float)
            except (AttributeError, KeyError, TypeError, ValueError):
                row = np.empty(0)
            if row.shape != (4,):
                shown = str(sphere)[:80]
                raise InvalidArgumentError(
                    f"path: {str(path)!r}: link {link!r} has {shown!r}, expected "
                    f"{centre} (3 numbers) and radius"
                )
            if row[3] > 0:
                rows.append([*row[:3], row[3] + buffer])
        if rows:
            links[str(link)] = np.array(rows)
    return links
