# SPDX-License-Identifier: BSD-3-Clause
"""Chains of ikpy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from iksel.formats._models import Model
from iksel.formats._urdf_writer import UrdfWriter
from iksel.pose import pose_from_euler

if TYPE_CHECKING:
    from iksel._base.arrays import FloatArray


def read(chain: Any) -> Model:
    """The URDF of a chain: a joint for each of its links, by the link's name.

    Links that its mask makes inactive move like the others: locked_joints holds them.
    """
    writer = UrdfWriter(chain.name, "base")
    parent = "base"
    for link in chain.links:
        parent = _add(writer, parent, link)
    return Model(writer.text())


def _add(writer: UrdfWriter, parent: str, link: Any) -> str:
    """Add what a link of ikpy is; gives the last link that this needs."""
    name = writer.free_joint(str(link.name))
    child = writer.free_link(f"{name}/link")
    lower, upper = (
        end if given is None else float(given)
        for given, end in zip(link.bounds, (-np.inf, np.inf), strict=True)
    )
    if hasattr(link, "origin_translation"):
        origin = pose_from_euler(link.origin_translation, link.origin_orientation)
        kind = link.joint_type if link.joint_type != "continuous" else "revolute"
        axis = link.translation if kind == "prismatic" else link.rotation
        if axis is None or kind == "fixed":
            writer.add_joint(name, "fixed", parent, child, origin)
            return child
        if kind == "prismatic":  # it moves by the vector as it is, of any length
            length = float(np.linalg.norm(axis))
            lower, upper = lower * length, upper * length
        writer.add_joint(
            name, kind, parent, child, origin, axis=axis, limits=(lower, upper)
        )
        return child
    if hasattr(link, "alpha"):
        ends = child, writer.free_link(f"{name}/end")
        before, after = _dh_places(link)
        writer.add_joint(
            name,
            "revolute",
            parent,
            ends[0],
            before,
            axis=[0.0, 0.0, 1.0],
            limits=(lower, upper),
        )
        writer.add_fixed(*ends, after)
        return ends[1]
    writer.add_fixed(parent, child, np.eye(4))  # ikpy's OriginLink
    return child


def _dh_places(link: Any) -> tuple[FloatArray, FloatArray]:
    """What a row of a DH table has before and behind the joint, (4, 4) each."""
    turn = pose_from_euler([0.0, 0.0, link.d], [0.0, 0.0, link.theta])
    shift = pose_from_euler([link.a, 0.0, 0.0], [link.alpha, 0.0, 0.0])
    if getattr(link, "convention", "classic") == "modified":
        return shift @ turn, np.eye(4)
    return turn, shift
