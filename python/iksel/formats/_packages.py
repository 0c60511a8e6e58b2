# SPDX-License-Identifier: BSD-3-Clause
"""Folders of ROS packages, which package:// names and $(find ...) speak of."""

from __future__ import annotations

import itertools
import os
from pathlib import Path
from typing import TYPE_CHECKING

from iksel_cpp import UnknownNameError, UrdfError

from iksel.formats._urdf_xml import read_xml

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    Packages = Mapping[str, str | os.PathLike[str]]

_SCHEMES = ("package://", "model://")


def find_package(name: str, packages: Packages, near: Path) -> Path:
    """The folder of a ROS package.

    Looked for, in this order: in `packages`; among the folders that hold `near`, and
    beside them; in $ROS_PACKAGE_PATH and $AMENT_PREFIX_PATH. A folder is the package's
    if its package.xml names it or, without that file, if it has the package's name.
    Where none is, a folder of that name is taken though its package.xml has another:
    installed packages are named by their folders.

    Args:
        name: The package's.
        packages: Folders by names, given by the user.
        near: The folder of the file that names the package.

    Raises:
        UnknownNameError: It is nowhere.
    """
    if name in packages:
        return Path(packages[name])
    folders = [f for f in _candidates(name, near.absolute()) if f.is_dir()]
    named = (f for f in folders if _package_name(f) == name)
    of_that_name = (f for f in folders if f.name == name)
    for folder in itertools.chain(named, of_that_name):
        return folder
    listed = ", ".join(packages) or "none"
    raise UnknownNameError(
        f"packages: no folder for package {name!r}; given: {listed}; it is neither "
        f"around {str(near.absolute())!r} nor in ROS_PACKAGE_PATH or AMENT_PREFIX_PATH"
    )


def resolve_path(name: str, packages: Packages, folder: Path) -> Path:
    """The path that a file name in a URDF stands for.

    Args:
        name: A path, a file:// name, or a package:// name.
        packages: Folders of packages, as for find_package.
        folder: Where relative paths start.

    Raises:
        UnknownNameError: Its package is nowhere.
    """
    for scheme in _SCHEMES:
        if name.startswith(scheme):
            # Files have one slash too many.
            package, _, rest = name.removeprefix(scheme).lstrip("/").partition("/")
            try:
                return find_package(package, packages, folder) / rest
            except UnknownNameError as error:
                raise UnknownNameError(f"{error} (for {name!r})") from None
    return folder / name.removeprefix("file://")


def _candidates(name: str, near: Path) -> Iterator[Path]:
    """Folders that may be the package's, the most likely first."""
    for folder in (near, *near.parents):
        yield folder
        yield folder / name
    for root in _roots("ROS_PACKAGE_PATH"):
        yield root
        yield root / name
    for root in _roots("AMENT_PREFIX_PATH"):
        yield root / "share" / name


def _roots(variable: str) -> list[Path]:
    value = os.environ.get(variable, "")
    return [Path(root) for root in value.split(os.pathsep) if root]


def _package_name(folder: Path) -> str:
    """The name that a folder's package.xml gives it, or else its own."""
    try:
        root = read_xml("packages", folder / "package.xml")[0]
    except UrdfError:
        return folder.name
    return (root.findtext("name") or folder.name).strip()
