# SPDX-License-Identifier: BSD-3-Clause
"""Mesh files of somebody else, looked at before a library reads them."""

from __future__ import annotations

import zipfile
from typing import TYPE_CHECKING

from iksel_cpp import UrdfError

from iksel._base.files import LARGEST, check_unpacked

if TYPE_CHECKING:
    from pathlib import Path

FORMATS = (".stl", ".dae", ".zae", ".obj", ".ply", ".glb", ".gltf", ".off", ".3mf")


def check_mesh_file(path: Path) -> None:
    """Refuse what is no mesh file, or unpacks to too much.

    Raises:
        UrdfError: It is not there, of another format, too large, or has XML entities.
    """
    if not path.is_file():
        raise UrdfError(f"no mesh file {str(path)!r}")
    if path.suffix.lower() not in FORMATS:
        listed = ", ".join(FORMATS)
        raise UrdfError(f"mesh file {str(path)!r} is of no format of: {listed}")
    try:
        _check_content(path)
    except (OSError, ValueError, zipfile.BadZipFile) as error:
        raise UrdfError(f"mesh file {str(path)!r}: {error}") from None


def _check_content(path: Path) -> None:
    """Raise a ValueError if a file is too large, or has entities of XML."""
    problem = None
    if path.stat().st_size > LARGEST:
        problem = f"it is larger than {LARGEST >> 20} MiB"
    elif zipfile.is_zipfile(path):
        check_unpacked(path)
    elif path.suffix.lower() == ".dae" and b"<!ENTITY" in path.read_bytes():
        problem = "it has an <!ENTITY>, which meshes have no need of"
    if problem is not None:
        raise ValueError(problem)
