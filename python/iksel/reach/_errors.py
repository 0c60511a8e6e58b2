# SPDX-License-Identifier: BSD-3-Clause
"""Errors of maps and data sets."""

from __future__ import annotations

import importlib
from typing import Any

from iksel_cpp import Error


class MapError(Error):
    """A map, or a plan of one, that cannot be written, read or used."""


class MapIoError(MapError):
    """The file system refuses: no such map, no space, no permission."""


class PlanMismatchError(MapError):
    """A map, or a chunk of it, that belongs to another plan or version."""


class ChunkDamagedError(MapError):
    """A chunk whose content is not what was written."""


class IncompleteMapError(MapError):
    """A map of which chunks are missing."""


class WorkerError(MapError):
    """A process that computes chunks ended before its work was done."""


class MissingExtraError(Error, ImportError):
    """A package of the extra iksel[reach] is not installed."""


def need(module: str) -> Any:
    """A module of the extra iksel[reach].

    Raises:
        MissingExtraError: It is not installed.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.partition(".")[0]
        raise MissingExtraError(
            f"iksel.reach needs {package}, which cannot be imported ({error}): "
            "pip install 'iksel[reach]', with Python 3.11 or later"
        ) from error
