# SPDX-License-Identifier: BSD-3-Clause
"""Errors of maps and data sets."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from iksel_cpp import Error

from iksel._base import extras
from iksel._base.arrays import reject

if TYPE_CHECKING:
    from iksel_cpp import Robot


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


def check_tips(robot: Robot) -> None:
    """Refuse a robot with several tips.

    Raises:
        InvalidArgumentError: It has several.
    """
    if robot.tips > 1:
        links = ", ".join(robot.tip_links)
        reject(
            "robot",
            f"maps and data sets are of one tip, and this has {links}: choose one",
        )


def need(module: str) -> Any:
    """A module of the extra iksel[reach].

    Raises:
        MissingExtraError: It is not installed.
    """
    extra = "'iksel[reach]', with Python 3.11 or later"
    return extras.need(module, user="iksel.reach", extra=extra)
