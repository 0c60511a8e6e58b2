# SPDX-License-Identifier: BSD-3-Clause
"""Reads the XML of URDF and SRDF files."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from iksel_cpp import UrdfError

from iksel._files import read_text
from iksel.pose import pose_from_euler

if TYPE_CHECKING:
    import os

    from iksel._arrays import FloatArray


def read_xml(
    argument: str, source: str | os.PathLike[str]
) -> tuple[ET.Element, str, Path]:
    """Read XML from a path or text.

    Returns:
        The root element, the text, and the folder that relative names start from.

    Raises:
        UrdfError: It cannot be read; the message names the argument.
    """
    if isinstance(source, str) and source.lstrip().startswith("<"):
        text, folder = source, Path()
    else:
        path = Path(source)
        try:
            text, folder = read_text(path), path.parent
        except (OSError, ValueError) as error:
            raise UrdfError(f"{argument}: {error}") from None
    try:
        return ET.fromstring(text), text, folder  # noqa: S314 (the user's own file)
    except (ET.ParseError, ValueError) as error:
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
    xyz = read_numbers(origin, "xyz", 3, "0 0 0")
    return pose_from_euler(xyz, read_numbers(origin, "rpy", 3, "0 0 0"))
