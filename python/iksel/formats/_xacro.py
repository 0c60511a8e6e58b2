# SPDX-License-Identifier: BSD-3-Clause
"""Expands xacro by the package xacro, whose evaluation of Python is replaced."""

from __future__ import annotations

import contextlib
import importlib
import io
import re
import sys
import threading
import types
from typing import TYPE_CHECKING, Any

from iksel_cpp import UnknownNameError, UrdfError

from iksel.formats._bounds import RefusedError
from iksel.formats._packages import find_package
from iksel.formats._urdf_xml import read_xml
from iksel.formats._xacro_safe import replaced_parts

if TYPE_CHECKING:
    import xml.etree.ElementTree as ET
    from collections.abc import Callable, Iterator, Mapping
    from pathlib import Path

    from iksel.formats._packages import Packages

_NAMESPACE = "ros.org"  # in all that xacro's has been called
_WIKI = "http://www.ros.org/wiki/xacro"
_DECLARATION = re.compile(r"""\sxmlns:xacro\s*=\s*["']""")
_SHOWN = 40  # characters of an attribute in an error
_KINEMATIC = ("link", "joint")
_TRUST = "if you trust whoever wrote it, load it with trusted=True"
_lock = threading.Lock()  # xacro keeps what it works on in globals


def is_xacro(root: ET.Element, path: Path) -> bool:
    """Whether a file is xacro that has to be expanded.

    It is if it says so, by the namespace of xacro or by its name, and has anything
    that xacro expands.

    Raises:
        UrdfError: It has expressions of xacro, but does not say that it is xacro.
    """
    if any(_is_call(element) for element in root.iter()):
        return True
    parts = (e for tag in _KINEMATIC for e in root.findall(tag))
    joints = (e for joint in root.findall("joint") for e in joint.iter())
    values = (v for part in (*parts, *joints) for v in part.attrib.values())
    found = next((v for v in values if "${" in v or "$(" in v), None)
    if found is None:
        return False
    if path.suffix == ".xacro" or _DECLARATION.search(read_xml("", path)[1]):
        return True
    shown = found if len(found) <= _SHOWN else found[:_SHOWN] + " ..."
    raise UrdfError(
        f"'{path}': an attribute is {shown!r}, which is not evaluated, as the file "
        f'does not say that it is xacro: write <robot xmlns:xacro="{_WIKI}"> if it is'
    )


def expand(
    path: Path,
    arguments: Mapping[str, str] | None,
    packages: Packages,
    *,
    trusted: bool = False,
) -> str:
    """The URDF text that a xacro file stands for.

    Args:
        path: The file.
        arguments: Values of its <xacro:arg>.
        packages: Folders that $(find ...) names; others are looked for.
        trusted: Whether it may run whatever Python it contains.

    Raises:
        UrdfError: The package xacro is missing, the file is refused, or has no links.
        UnknownNameError: A ROS package is nowhere.
    """
    xacro = _import_xacro(path)
    given = {name: str(value) for name, value in (arguments or {}).items()}
    printed = io.StringIO()  # warnings of other people's files
    missing: list[UnknownNameError] = []
    found = _found_packages(packages, path.parent, missing)
    with _lock, found as find:
        try:
            changed = _as_it_is() if trusted else replaced_parts(xacro, find)
            with changed, contextlib.redirect_stderr(printed):
                document = xacro.process_file(str(path), mappings=given)
                text: str = document.toxml()
        except Exception as error:  # noqa: BLE001 (it evaluates the file's own Python)
            if missing:
                raise UnknownNameError(f"'{path}': {missing[0]}") from None
            raise UrdfError(f"'{path}': {_explain(error)}") from None
    if not document.getElementsByTagName("link"):
        raise UrdfError(
            f"'{path}' expands to no link; it may only define macros: give the file "
            "that includes it"
        )
    return text


def _is_call(element: ET.Element) -> bool:
    """Whether an element is one of xacro's own."""
    tag = str(element.tag)
    namespace = tag[1:].partition("}")[0] if tag.startswith("{") else ""
    return _NAMESPACE in namespace and "xacro" in namespace


def _as_it_is() -> contextlib.AbstractContextManager[None]:
    """Leaves the package xacro what it is."""
    return contextlib.nullcontext()


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
) -> Iterator[Callable[[str], str]]:
    """What $(find ...) asks, which looks where find_package looks; misses are added.

    The package xacro asks the module ament_index_python, which only ROS 2 brings.
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
        yield share
    finally:
        for name, module in before.items():
            if module is None:
                del sys.modules[name]
            else:
                sys.modules[name] = module


def _explain(error: Exception) -> str:
    """What is wrong with a file, and what to do about it."""
    reason = " ".join(str(error).split()) or type(error).__name__
    if isinstance(error, RecursionError):
        reason = "its macros or properties are nested too deep"
    if isinstance(error, RefusedError):
        return f"refused: {reason}; {_TRUST}"
    return f"xacro says: {reason}; {_remedy(reason)}"


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
