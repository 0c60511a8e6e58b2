# SPDX-License-Identifier: BSD-3-Clause
"""Robots of the package robot_descriptions by name: rd:panda_description."""

from __future__ import annotations

import contextlib
import difflib
import importlib
import importlib.util
import pkgutil
import sys
from pathlib import Path
from typing import NamedTuple

from iksel_cpp import UnknownNameError, UrdfError

PREFIX = "rd:"
_SUFFIX = "_description"


class Described(NamedTuple):
    """Files of a robot of robot_descriptions."""

    path: Path
    arguments: dict[str, str]  # of xacro
    folders: tuple[Path, ...]  # in which packages are
    srdf: Path | None


def find_described(name: str) -> Described:
    """Find the files of a robot; at its first use the package clones them from GitHub.

    Args:
        name: `rd:` and the name of the description, as `rd:panda_description`; the end
            `_description` may be left out.

    Raises:
        UnknownNameError: There is no description of that name.
        UrdfError: The package is missing, its download failed, or the description has
            no file that can be read.
    """
    short = name.removeprefix(PREFIX)
    module = _load(short)
    srdf = getattr(module, "SRDF_PATH", None)
    arguments: dict[str, str] = {}
    path = getattr(module, "URDF_PATH", None)
    if path is None:
        path = getattr(module, "XACRO_PATH", None)
        arguments = getattr(module, "XACRO_ARGS", {})
    if path is None:
        path = getattr(module, "MJCF_PATH", None)
    if path is None:
        raise UrdfError(f"{name}: robot_descriptions has no URDF, xacro or MJCF of it")
    given = (getattr(module, n, None) for n in ("PACKAGE_PATH", "REPOSITORY_PATH"))
    folders = tuple(Path(folder) for folder in given if folder)
    return Described(
        Path(path), arguments, folders, None if srdf is None else Path(srdf)
    )


def _load(name: str) -> object:
    try:
        package = importlib.import_module("robot_descriptions")
    except ImportError as error:
        raise UrdfError(
            f"{PREFIX}{name}: names of robot_descriptions need that package ({error}): "
            "pip install 'iksel[descriptions]'"
        ) from None
    known = {m.name for m in pkgutil.iter_modules(package.__path__)}
    names = sorted(n for n in known if n.endswith(_SUFFIX) and not n.startswith("_"))
    full = name if name in names else name + _SUFFIX
    if full not in names:
        close = difflib.get_close_matches(full, names)
        hint = f"did you mean {' or '.join(close)}? " if close else ""
        unknown = UnknownNameError(
            f"robot_descriptions has no {name!r}; {hint}it has {len(names)} names that "
            f"end in {_SUFFIX}"
        )
        unknown.available = tuple(names)
        raise unknown
    try:
        # It reports its downloads on stdout, which is for results.
        with contextlib.redirect_stdout(sys.stderr):
            return importlib.import_module(f"robot_descriptions.{full}")
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise UrdfError(
            f"{PREFIX}{full}: robot_descriptions could not fetch it: {reason}; at its "
            "first use it clones the robot from GitHub, which needs git and a network"
        ) from error
