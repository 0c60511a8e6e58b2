# SPDX-License-Identifier: BSD-3-Clause
"""Reads the XML of URDF and SRDF files."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from iksel_cpp import UrdfError, mend_xml

from iksel._base.files import read_bytes
from iksel.pose import pose_from_euler

if TYPE_CHECKING:
    import os

    from iksel._base.arrays import FloatArray


GEOMETRIES = "box, capsule, cylinder, sphere, mesh"
"""What a URDF draws links with; capsules from version 1.1 on."""


def is_xml(source: object) -> bool:
    """Whether a source is XML text and no path."""
    return isinstance(source, str) and source.lstrip(" \t\r\n\ufeff").startswith("<")


def parse_xml(data: bytes, link: str = "") -> tuple[ET.Element, str]:
    """The root element of an XML file, and its text as mend_xml writes it.

    Args:
        data: What the file holds.
        link: Of a URDF with several trees of links, the one of this link is meant.

    Raises:
        UrdfError: It is no XML.
    """
    text = mend_xml(data, link)
    return ET.fromstring(text), text  # noqa: S314 (without entities of its own)


def read_xml(
    argument: str, source: str | os.PathLike[str], link: str = ""
) -> tuple[ET.Element, str, Path]:
    """Read XML from a path or text.

    Args:
        argument: What errors are of.
        source: Path of the file, or its text.
        link: Of a URDF with several trees of links, the one of this link is meant.

    Returns:
        The root element, the text, and the folder that relative names start from.

    Raises:
        UrdfError: It cannot be read; the message names the argument.
    """
    try:
        if isinstance(source, str) and is_xml(source):
            return *parse_xml(source.encode("utf-8", "replace"), link), Path()
        path = Path(source)
        return *parse_xml(read_bytes(path), link), path.parent
    except (OSError, ValueError, UrdfError) as error:
        raise UrdfError(f"{argument}: {error}") from None


def read_numbers(
    element: ET.Element, attribute: str, count: int, default: str = ""
) -> list[float]:
    """The finite numbers that an attribute holds; else a UrdfError."""
    text = element.get(attribute, default)
    try:
        numbers = [float(word) for word in text.split()]
    except ValueError:
        numbers = []
    if len(numbers) != count or not np.isfinite(numbers).all():
        raise UrdfError(
            f"{element.tag} with {attribute}={text!r}, expected {count} numbers"
        )
    return numbers


def read_origin(element: ET.Element) -> FloatArray:
    """The pose (4, 4) that <origin> gives; the identity without one."""
    origin = element.find("origin")
    if origin is None:
        return np.eye(4)
    if origin.get("quat_xyzw") is not None:
        raise UrdfError(
            "an origin with quat_xyzw, which URDF knows from version 1.1 on, as four "
            'numbers and without rpy: write <robot version="1.1">, or rpy in its place'
        )
    xyz = read_numbers(origin, "xyz", 3, "0 0 0")
    return pose_from_euler(xyz, read_numbers(origin, "rpy", 3, "0 0 0"))
