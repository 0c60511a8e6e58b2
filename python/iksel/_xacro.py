# SPDX-License-Identifier: BSD-3-Clause
"""Expands xacro by the package xacro."""

from __future__ import annotations

import contextlib
import importlib
import io
import sys
import threading
import types
from typing import TYPE_CHECKING, Any

from iksel_cpp import UnknownNameError, UrdfError

from iksel._packages import find_package

if TYPE_CHECKING:
    import xml.etree.ElementTree as ET
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from iksel._packages import Packages

_NAMESPACE = "ros.org"  # in all that xacro's has been called
_KINEMATIC = ("link", "joint")
_lock = threading.Lock()  # xacro keeps what it works on in globals


def is_xacro(root: ET.Element) -> bool:
    """Whether XML has to be expanded before its links and joints are known."""
    if any(_is_call(element) for element in root.iter()):
        return True
    parts = (e for tag in _KINEMATIC for e in root.findall(tag))
    joints = (e for joint in root.findall("joint") for e in joint.iter())
    values = (v for part in (*parts, *joints) for v in part.attrib.values())
    return any("${" in value or "$(" in value for value in values)


def expand(path: Path, arguments: Mapping[str, str] | None, packages: Packages) -> str:
    """The URDF text that a xacro file stands for.

    Args:
        path: The file.
        arguments: Values of its <xacro:arg>.
        packages: Folders that $(find ...) names; others are looked for.

    Raises:
        UrdfError: The package xacro is missing, it refuses the file, or the file has
            no links.
        UnknownNameError: A ROS package is nowhere.
    """
    xacro = _import_xacro(path)
    given = {name: str(value) for name, value in (arguments or {}).items()}
    printed = io.StringIO()  # warnings of other people's files
    missing: list[UnknownNameError] = []
    with _lock, _found_packages(packages, path.parent, missing):
        try:
            with contextlib.redirect_stderr(printed):
                document = xacro.process_file(str(path), mappings=given)
        except Exception as error:  # noqa: BLE001 (it evaluates the file's own Python)
            if missing:
                raise UnknownNameError(f"'{path}': {missing[0]}") from None
            reason = " ".join(str(error).split()) or type(error).__name__
            remedy = _remedy(reason)
            raise UrdfError(f"'{path}': xacro says: {reason}; {remedy}") from None
    if not document.getElementsByTagName("link"):
        raise UrdfError(
            f"'{path}' expands to no link; it may only define macros: give the file "
            "that includes it"
        )
    text: str = document.toxml()
    return text


def _is_call(element: ET.Element) -> bool:
    """Whether an element is one of xacro's own."""
    tag = str(element.tag)
    namespace = tag[1:].partition("}")[0] if tag.startswith("{") else ""
    return _NAMESPACE in namespace and "xacro" in namespace


def _import_xacro(path: Path) -> Any:
    try:
        return importlib.import_module("xacro")
    except ImportError as error:
        raise UrdfError(
            f"'{path}' is xacro, which needs the package xacro ({error}): pip install "
            "'iksel[xacro]', or expand it yourself: xacro FILE > robot.urdf"
        ) from None


@contextlib.contextmanager
def _found_packages(
    packages: Packages, near: Path, missing: list[UnknownNameError]
) -> Iterator[None]:
    """Let $(find ...) look where find_package looks; what it misses is added.

    xacro asks the module ament_index_python for it, which only ROS 2 brings.
    """

    def share(name: str) -> str:
        try:
            return str(find_package(name, packages, near))
        except UnknownNameError as error:
            missing.append(error)
            raise

    stand_in: Any = types.ModuleType("ament_index_python.packages")
    stand_in.get_package_share_directory = share
    parent: Any = types.ModuleType("ament_index_python")
    parent.packages = stand_in
    modules = {parent.__name__: parent, stand_in.__name__: stand_in}
    before = {name: sys.modules.get(name) for name in modules}
    sys.modules.update(modules)
    try:
        yield
    finally:
        for name, module in before.items():
            if module is None:
                del sys.modules[name]
            else:
                sys.modules[name] = module


def _remedy(reason: str) -> str:
    """What to do about a file that xacro refuses for a reason."""
    small = reason.lower()
    if "undefined" in small or "arg " in small:
        return "values are given by xacro_args"
    if "no such file" in small and "package://" in small:
        return "xacro includes files by $(find PACKAGE)/..., not by package://"
    if "no such file" in small:
        return "put that file where the xacro file names it"
    return "mend that in the file"
