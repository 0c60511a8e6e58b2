# SPDX-License-Identifier: BSD-3-Clause
"""Names of files that keep what is made of the geometry of a robot."""

from __future__ import annotations

import hashlib
import re
import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING, Any

from iksel.formats._packages import resolve_path

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path


def key_of(
    method: str,
    root: ET.Element,
    folder: Path,
    packages: Mapping[str, Any],
    options: object,
) -> str:
    """A hash of all that spheres, or pairs of links, depend on.

    Args:
        method: How they are made: another name with each change of that.
        root: The URDF.
        folder: Where its relative file names start.
        packages: Folders of packages.
        options: What else there is, with a repr that tells it from any other.

    Raises:
        UnknownNameError: A package is nowhere.
    """
    key = hashlib.sha256(f"{method} {options!r}".encode())
    key.update(ET.tostring(root))
    for mesh in root.iterfind(".//collision/geometry/mesh"):
        path = resolve_path(mesh.get("filename", ""), packages, folder)
        if path.is_file():
            key.update(hashlib.sha256(path.read_bytes()).digest())
    return key.hexdigest()


def file_name(robot: str, key: str, suffix: str) -> str:
    """The name of a file for a robot of that name."""
    return f"{re.sub(r'[^A-Za-z0-9_.-]', '_', robot)}-{key[:16]}.{suffix}"
