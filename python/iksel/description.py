# SPDX-License-Identifier: BSD-3-Clause
"""One way in for every format: whatever a robot is written in becomes URDF.

from iksel.description import read_description

print(read_description("arm.urdf.xacro", xacro_args={"prefix": "left_"}).urdf)
"""

from __future__ import annotations

import dataclasses
import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from iksel_cpp import UrdfError, mend_xml

from iksel.formats import _descriptions, _mjcf, _models, _xacro
from iksel.formats._manifest import manifest, urdf_text
from iksel.formats._urdf_xml import is_xml, read_xml

if TYPE_CHECKING:
    import xml.etree.ElementTree as ET
    from collections.abc import Mapping

    from iksel.formats._packages import Packages

Source = Any
"""A robot in one of the forms that `read_description` lists."""

Format = Literal["URDF", "xacro", "MJCF", "object"]

FILE_SUFFIXES = (".urdf", ".xml", ".xacro", ".mjcf")
"""Endings that make a name without a folder a file's rather than a robot's."""


@dataclass(frozen=True)
class Description:
    """A robot as URDF, and where that is from."""

    urdf: str | Path
    """Text of the URDF; of plain URDF files, the path."""
    format: Format
    """What it was written in."""
    folder: Path = Path()
    """Where its relative file names start."""
    srdf: Path | None = None
    """SRDF that belongs to it, if robot_descriptions names one."""
    tip_link: str | None = None
    """Link to take as the tip where none is named; None: the one without children."""


def read_description(
    source: Source,
    *,
    xacro_args: Mapping[str, str] | None = None,
    packages: Packages | None = None,
    trusted: bool = False,
) -> Description:
    """Read a robot in any format.

    Args:
        source: Name of a built-in robot; path of a URDF, xacro or MJCF file; a name of
            robot_descriptions, as `rd:panda_description`; URDF text, as str or bytes;
            or an object of another library: Pinocchio's Model or RobotWrapper, MuJoCo's
            MjModel, MjSpec or MjData, a URDF of yourdfpy, urchin, urdfpy or
            urdf_parser_py, a robot of the Robotics Toolbox, a Chain of ikpy.
        xacro_args: Values of a xacro file's arguments.
        packages: Folders of ROS packages that xacro's $(find ...) names; others are
            looked for around the file, in $ROS_PACKAGE_PATH and $AMENT_PREFIX_PATH.
        trusted: Whether a xacro file may run whatever Python its expressions contain.

    Returns:
        Its URDF, not checked.

    Raises:
        UnknownNameError: No robot of robot_descriptions, or no such ROS package.
        UrdfError: The package that the format needs is missing, or refuses the file.
        InvalidArgumentError: An object that is no robot, or none that can be read.
    """
    packages = packages or {}
    if not isinstance(source, str | bytes | os.PathLike):
        return _read_object(source, xacro_args)
    if isinstance(source, bytes):
        source = mend_xml(source)
    if isinstance(source, str):
        if is_xml(source):
            _refuse_arguments(xacro_args)
            return Description(_refuse_other_text(source), "URDF")
        if source in manifest():
            _refuse_arguments(xacro_args)
            return Description(urdf_text(manifest()[source]), "URDF")
        if source.startswith(_descriptions.PREFIX):
            found = _descriptions.find_described(source)
            arguments = {**found.arguments, **(xacro_args or {})}
            named = _with_names(packages, found)
            read = _read_file(found.path, arguments, named, trusted=trusted)
            return dataclasses.replace(read, srdf=found.srdf)
    return _read_file(Path(source), xacro_args, packages, trusted=trusted)


def _read_file(
    path: Path,
    xacro_args: Mapping[str, str] | None,
    packages: Packages,
    *,
    trusted: bool,
) -> Description:
    root = _root(path)
    if root is not None and _mjcf.is_mjcf(root):
        tree = _mjcf.read_file(path)
        return Description(tree.urdf, "MJCF", path.parent, tip_link=tree.tip_link)
    if root is not None and _xacro.is_xacro(root, path):
        text = _xacro.expand(path, xacro_args, packages, trusted=trusted)
        return Description(text, "xacro", path.parent)
    if xacro_args and root is not None:
        names = ", ".join(xacro_args)
        raise UrdfError(f"'{path}': xacro_args: {names}, but the file is not xacro")
    return Description(path, "URDF", path.parent)


def _read_object(value: Any, xacro_args: Mapping[str, str] | None) -> Description:
    model = _models.read_model(value)
    _refuse_arguments(xacro_args)
    urdf = mend_xml(model.urdf) if isinstance(model.urdf, bytes) else model.urdf
    return Description(urdf, "object", tip_link=model.tip_link)


def _refuse_arguments(xacro_args: Mapping[str, str] | None) -> None:
    if xacro_args:
        names = ", ".join(xacro_args)
        raise UrdfError(f"xacro_args: {names}, but the robot is no xacro file")


def _root(source: Source) -> ET.Element | None:
    """The root of XML; None if that cannot be read, as UrdfError will say."""
    try:
        return read_xml("", source)[0]
    except UrdfError:
        return None


def _refuse_other_text(text: str) -> str:
    """The text, unless it is MJCF, whose files are relative to its own path."""
    root = _root(text)
    if root is not None and _mjcf.is_mjcf(root):
        raise UrdfError("MJCF text; give the path of its file instead")
    return text


def _with_names(packages: Packages, found: _descriptions.Described) -> Packages:
    """The user's packages, then those that the folders of a description are."""
    return {**{folder.name: folder for folder in found.folders}, **packages}
