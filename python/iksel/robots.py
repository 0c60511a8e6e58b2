# SPDX-License-Identifier: BSD-3-Clause
"""Robots by name, and from files of every format."""

from __future__ import annotations

import difflib
import os
from pathlib import Path
from typing import TYPE_CHECKING

from iksel_cpp import (
    InvalidArgumentError,
    LinkTree,
    Robot,
    UnknownNameError,
    UrdfError,
)

from iksel._base.keywords import with_hints
from iksel.description import FILE_SUFFIXES, Description, read_description
from iksel.formats._descriptions import PREFIX
from iksel.formats._manifest import RobotInfo, manifest
from iksel.formats._urdf_xml import is_xml
from iksel.pose import pose_from_euler
from iksel.srdf import Srdf

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import numpy.typing as npt
    from iksel_cpp import CoupledLimit, MimicCurve

    from iksel.description import Source
    from iksel.formats._packages import Packages

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


@with_hints
def load_robot(
    source: Source,
    *,
    tcp: npt.ArrayLike | None = FROM_MANIFEST,
    base_link: str | None = None,
    tip_link: str | None = None,
    tip_links: Sequence[str] | None = None,
    tcps: npt.ArrayLike | None = None,
    locked_joints: Mapping[str, float] | None = None,
    soft_limits: bool = False,
    default_limits: npt.ArrayLike | None = None,
    coupled_limits: Sequence[CoupledLimit] = (),
    mimic_curves: Sequence[MimicCurve] = (),
    srdf: Srdf | str | os.PathLike[str] | None = None,
    group: str | None = None,
    xacro_args: Mapping[str, str] | None = None,
    packages: Packages | None = None,
    trusted: bool = False,
) -> Robot:
    """Load a built-in robot, one from a file, or one that another library holds.

    Args:
        source: One of robot_names(); path of a URDF, xacro or MJCF file; a name of
            robot_descriptions, as `rd:panda_description`; URDF text, as str or bytes;
            or an object of another library: Pinocchio's Model or RobotWrapper, MuJoCo's
            MjModel, MjSpec or MjData, a URDF of yourdfpy, urchin, urdfpy or
            urdf_parser_py, a robot of the Robotics Toolbox, a Chain of ikpy.
        tcp: T_tip_tcp, (4, 4), the tool that poses are of; None: the tip link itself.
            By default the tool of the paper's experiments for its robots and none for
            the others; a tip_link of your own also has none.
        base_link: Link that poses are relative to; None: the group's, the manifest's,
            or a file's root link.
        tip_link: Link that the TCP is fixed to; None: the group's, the manifest's, or a
            file's one link without children; sites of MJCF do not count.
        tip_links: In the place of tip_link, the links of a robot with several tips, 1
            to 8: a torso and its two arms.
        tcps: In the place of tcp, T_tip_tcp of each of the tip_links, (k, 4, 4); None:
            no tip has a tool.
        locked_joints: Joints held at a value [rad or m]; no degrees of freedom.
        soft_limits: Narrow the limits to the soft limits of the URDF, if it has any.
        default_limits: (lower, upper) [rad or m] of joints that the URDF gives none.
        coupled_limits: Limits of sums of joint values, beside those of each joint.
        mimic_curves: How joints follow others where that is no straight line, in the
            place of their mimic tags.
        srdf: The SRDF whose groups `group` names; None: that of robot_descriptions.
        group: Group of the SRDF whose chain is meant; may be left out if it has one.
        xacro_args: Values of a xacro file's arguments.
        packages: Folders of ROS packages that xacro's $(find ...) names; others are
            looked for around the file, in $ROS_PACKAGE_PATH and $AMENT_PREFIX_PATH.
        trusted: Whether a xacro file may run whatever Python its expressions contain.

    Raises:
        UnknownNameError: No such robot, file, link, joint, group or package.
        UrdfError: The file cannot be read, the package for its format is missing, the
            links are not connected, or a joint between them cannot be used. Without
            tip_link, where several links have no children, `available` has them.
        InvalidArgumentError: An object that cannot be read, `tcp` is no rigid 4x4
            matrix, a group without an SRDF, or coupled limits or curves that make no
            sense or leave no configuration.
    """
    name = _checked_name(source)
    info = manifest().get(name)
    read = read_description(
        source, xacro_args=xacro_args, packages=packages, trusted=trusted
    )
    base = tip = None
    groups: list[str] = []
    if group is not None or (srdf is not None and not info and not tip_link):
        given = _given_srdf(read, srdf, group)
        groups = given.groups
        if group is None and len(groups) == 1:
            (group,) = groups
        if group is not None:
            base, tip = given.ends(group, read.urdf, tip_link)
    base, tip = base_link or base, tip_link or tip or read.tip_link
    if info is not None:
        base, tip = base or info.base_link, tip or info.tip_link
    if tip_links is not None:
        tip = tip_link
    if isinstance(tcp, str) and tcp == FROM_MANIFEST:
        tcp = None
        if info is not None and info.tcp_xyz is not None and tip == info.tip_link:
            tcp = pose_from_euler(info.tcp_xyz, info.tcp_rpy)
    try:
        return Robot.from_urdf(
            read.urdf,
            base_link=base,
            tip_link=tip,
            tcp=tcp,
            locked_joints={} if locked_joints is None else locked_joints,
            soft_limits=soft_limits,
            default_limits=default_limits,
            coupled_limits=coupled_limits,
            mimic_curves=mimic_curves,
            tip_links=tip_links,
            tcps=tcps,
        )
    except UrdfError as error:
        if error.available and groups:
            listed = ", ".join(groups)
            error.args = (f"{error}; or of the SRDF's groups (group): {listed}",)
        raise


@with_hints
def load_tree(
    source: Source,
    *,
    link: str | None = None,
    xacro_args: Mapping[str, str] | None = None,
    packages: Packages | None = None,
    trusted: bool = False,
) -> LinkTree:
    """The tree of all links of a robot; arguments and errors are load_robot's.

    Where the links hang in several trees, the one of `link` is meant.
    """
    _checked_name(source)
    read = read_description(
        source, xacro_args=xacro_args, packages=packages, trusted=trusted
    )
    return LinkTree.from_urdf(read.urdf, link)


def _checked_name(source: Source) -> str:
    """The name that a source may be; an error if it is a mistyped one."""
    if not isinstance(source, str):
        return ""
    known = source in manifest() or source.startswith(PREFIX)
    if not (known or is_xml(source) or _looks_like_a_file(source)):
        try:
            robot_info(source)
        except UnknownNameError as error:
            error.args = (f"{error}; or give the path of a URDF, xacro or MJCF file",)
            raise
    return source


def _looks_like_a_file(name: str) -> bool:
    """Whether a name is a path rather than a robot's."""
    path = Path(name)
    if os.sep in name or path.suffix in FILE_SUFFIXES:
        return True
    try:
        return path.exists()
    except OSError:  # longer than a file's name may be
        return False


def _given_srdf(
    read: Description, srdf: Srdf | str | os.PathLike[str] | None, group: str | None
) -> Srdf:
    """The SRDF that groups are of."""
    given = read.srdf if srdf is None else srdf
    if given is None:
        raise InvalidArgumentError(f"group: {group!r} is of an SRDF; give it by srdf")
    return given if isinstance(given, Srdf) else Srdf(given)


def _suggestion(name: str) -> str:
    names = robot_names()
    close = difflib.get_close_matches(str(name).lower(), names)
    hint = f"did you mean {' or '.join(close)}? " if close else ""
    return f"{hint}built-in robots: {', '.join(names)}"
