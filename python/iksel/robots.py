# SPDX-License-Identifier: BSD-3-Clause
"""The built-in robots by name."""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING

from iksel_cpp import Robot, UnknownNameError

from iksel._manifest import RobotInfo, manifest, urdf_text
from iksel.pose import pose_from_euler

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy.typing as npt

FROM_MANIFEST = "manifest"
"""Value of `tcp` that takes the manifest's tool."""


def robot_names() -> list[str]:
    """Names of the built-in robots."""
    return list(manifest())


def robot_info(name: str) -> RobotInfo:
    """Maker, links, source, licence and tool of a built-in robot.

    Args:
        name: One of robot_names().

    Raises:
        UnknownNameError: No built-in robot has that name.
    """
    robots = manifest()
    if name not in robots:
        error = UnknownNameError(f"no built-in robot {name!r}; {_suggestion(name)}")
        error.available = tuple(robots)
        raise error
    return robots[name]


def load_robot(
    name: str,
    *,
    tcp: npt.ArrayLike | None = FROM_MANIFEST,
    base_link: str | None = None,
    tip_link: str | None = None,
    locked_joints: Mapping[str, float] | None = None,
    soft_limits: bool = False,
    default_limits: npt.ArrayLike | None = None,
) -> Robot:
    """Load a built-in robot.

    Args:
        name: One of robot_names().
        tcp: T_tip_tcp, (4, 4), the tool that poses are of; None: the tip link itself.
            By default the tool of the paper's experiments for its robots and none for
            the others; a tip_link of your own also has none.
        base_link: Link that poses are relative to; None: the manifest's.
        tip_link: Link that the TCP is fixed to; None: the manifest's.
        locked_joints: Joints held at a value [rad or m]; no degrees of freedom.
        soft_limits: Narrow the limits to the soft limits of the URDF, if it has any.
        default_limits: (lower, upper) [rad or m] of joints that the URDF gives none.

    Raises:
        UnknownNameError: No built-in robot, link or joint has that name.
        UrdfError: The links are not connected, or a joint between them cannot be used.
        InvalidArgumentError: `tcp` is no rigid 4x4 matrix.
    """
    info = robot_info(name)
    tip = info.tip_link if tip_link is None else tip_link
    if isinstance(tcp, str) and tcp == FROM_MANIFEST:
        tcp = None
        if info.tcp_xyz is not None and tip == info.tip_link:
            tcp = pose_from_euler(info.tcp_xyz, info.tcp_rpy)
    return Robot.from_urdf(
        urdf_text(info),
        base_link=info.base_link if base_link is None else base_link,
        tip_link=tip,
        tcp=tcp,
        locked_joints={} if locked_joints is None else locked_joints,
        soft_limits=soft_limits,
        default_limits=default_limits,
    )


def _suggestion(name: str) -> str:
    names = robot_names()
    close = difflib.get_close_matches(str(name).lower(), names)
    hint = f"did you mean {' or '.join(close)}? " if close else ""
    if str(name).endswith((".urdf", ".xml", ".xacro")):
        hint = "Robot.from_urdf reads files. "
    return f"{hint}built-in robots: {', '.join(names)}"
