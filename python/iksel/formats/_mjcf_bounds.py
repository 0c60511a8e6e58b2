# SPDX-License-Identifier: BSD-3-Clause
"""How large MJCF becomes, whose elements repeat others and include files."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from iksel_cpp import UrdfError

from iksel._base.files import check_regular
from iksel.formats._urdf_xml import read_xml

if TYPE_CHECKING:
    import xml.etree.ElementTree as ET
    from pathlib import Path

MOST_ELEMENTS = 100_000
"""MuJoCo needs 20 s and 2 GB for so many; real models have a tenth at most."""
MOST_POINTS = 10_000_000
"""Of a height field or a built-in mesh; real ones have less than a million."""

_COUNTED = ("replicate", "composite", "flexcomp")


def check_size(path: Path) -> None:
    """Refuse a model that MuJoCo would make too much of, before it begins.

    Raises:
        UrdfError: It has too many elements, or names a file that is no regular one.
    """
    if _size(path, path.parent, {}) > MOST_ELEMENTS:
        raise UrdfError(
            f"'{path}': refused: what it repeats makes more than {MOST_ELEMENTS} "
            "elements; give a model with fewer"
        )


def _size(path: Path, folder: Path, known: dict[str, float]) -> float:
    """Elements of a file, with all that it includes and repeats."""
    name = str(path)
    if name in known:
        return known[name]
    known[name] = 0.0  # in itself, which MuJoCo refuses
    if not path.exists():
        return 0.0  # as MuJoCo will say
    check_regular(path)
    root = read_xml("mjcf", path)[0]
    models = {e.get("name", ""): folder / e.get("file", "") for e in root.iter("model")}
    total, left = 0.0, [(root, 1.0)]
    while left:
        element, times = left.pop()
        total += times
        _check_points(path, element)
        if element.tag == "include":
            total += times * _size(folder / element.get("file", ""), folder, known)
        elif element.tag == "attach" and element.get("model", "") in models:
            total += times * _size(models[element.get("model", "")], folder, known)
        left += [(child, times * _count(element)) for child in element]
        total += times * (_count(element) - 1)
    known[name] = total
    return total


def _check_points(path: Path, element: ET.Element) -> None:
    """Refuse a shape that MuJoCo makes while it reads, if it has too many points."""
    if element.tag == "hfield":
        numbers = [element.get("nrow", "0"), element.get("ncol", "0")]
    elif element.tag == "mesh" and "builtin" in element.attrib:
        numbers = element.get("params", "").split()
    else:
        return
    try:
        points = math.prod(max(1.0, abs(float(number))) for number in numbers)
    except ValueError:
        return  # as MuJoCo will say
    # Of some shapes one number says how fine they are in both directions.
    largest = max((abs(float(number)) for number in numbers), default=0.0)
    if max(points, largest**2 if element.tag == "mesh" else 0.0) > MOST_POINTS:
        name = element.get("name", "")
        raise UrdfError(
            f"'{path}': refused: {element.tag} {name!r} has more than {MOST_POINTS} "
            "points; take it out"
        )


def _count(element: ET.Element) -> float:
    """How often an element's content is there."""
    if element.tag not in _COUNTED:
        return 1.0
    try:
        return math.prod(max(1.0, float(n)) for n in element.get("count", "1").split())
    except ValueError:
        return 1.0  # as MuJoCo will say
