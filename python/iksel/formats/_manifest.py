# SPDX-License-Identifier: BSD-3-Clause
"""The manifest of the built-in robots, robots/robots.toml in the installed package."""

from __future__ import annotations

import functools
import sys
from dataclasses import dataclass
from importlib import resources
from typing import TYPE_CHECKING, Any

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

if TYPE_CHECKING:
    from importlib.abc import Traversable

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class RobotInfo:
    """What the manifest says about one built-in robot."""

    name: str
    """Name that load_robot takes."""
    maker: str
    dof: int
    base_link: str
    """Link that poses are relative to."""
    tip_link: str
    """Link that the TCP is fixed to."""
    urdf: str
    """File name of the URDF inside the package."""
    licence: str
    """Licence of the source that the numbers are from."""
    source: str
    """Where the numbers are from: repository, file and commit."""
    note: str = ""
    tcp_xyz: Triple | None = None
    """Origin of the TCP in the tip link's frame [m]; None: the TCP is the tip link."""
    tcp_rpy: Triple = (0.0, 0.0, 0.0)
    """Roll, pitch, yaw of the TCP in the tip link's frame [rad]."""
    paper: bool = False
    """Whether it is one of the four robots of the paper's experiments."""
    sample_q: tuple[float, ...] = ()
    """A configuration inside all limits [rad or m] whose pose is known."""
    sample_position: tuple[float, ...] = ()
    """Origin of the TCP at sample_q in the base link's frame [m]."""
    sample_quaternion: tuple[float, ...] = ()
    """Rotation of the TCP at sample_q as (w, x, y, z)."""


@functools.cache
def manifest() -> dict[str, RobotInfo]:
    """All built-in robots by name, in the order of the file."""
    text = _folder().joinpath("robots.toml").read_text(encoding="utf-8")
    rows = tomllib.loads(text)["robots"]
    return {name: _info(name, row) for name, row in rows.items()}


def urdf_text(info: RobotInfo) -> str:
    """The URDF of a built-in robot."""
    return _folder().joinpath(info.urdf).read_text(encoding="utf-8")


def _folder() -> Traversable:
    return resources.files("iksel").joinpath("robots")


def _info(name: str, row: dict[str, Any]) -> RobotInfo:
    fields = dict(row)
    tcp = fields.pop("tcp", None)
    if tcp is not None:
        fields["tcp_xyz"] = tuple(tcp["xyz"])
        fields["tcp_rpy"] = tuple(tcp["rpy"])
    for key in ("sample_q", "sample_position", "sample_quaternion"):
        fields[key] = tuple(fields.get(key, ()))
    return RobotInfo(name=name, **fields)
