# SPDX-License-Identifier: BSD-3-Clause
"""Objects that hold a URDF: of yourdfpy, urchin, urdfpy and urdf_parser_py."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from typing import Any

import numpy as np
from iksel_cpp import UrdfError

from iksel.formats._models import Model
from iksel.formats._urdf_writer import UrdfWriter


def read(value: Any) -> Model:
    """The text that the object writes, or else its links and joints.

    urchin and urdfpy have no text to give without writing meshes, too.
    """
    if hasattr(value, "to_xml_string"):  # of urdf_parser_py
        return Model(value.to_xml_string())
    if hasattr(value, "write_xml_string"):
        return Model(_urdf_of_yourdfpy(value))
    return Model(_urdf_of_joints(value))


def _urdf_of_yourdfpy(value: Any) -> str:
    """Its text, with what it does not write: followers, and limits of controllers."""
    root = ET.fromstring(value.write_xml_string())  # noqa: S314 (just written)
    joints = {joint.name: joint for joint in value.robot.joints}
    for element in root.findall("joint"):
        joint = joints[element.get("name", "")]
        mimic, soft = joint.mimic, joint.safety_controller
        if mimic is not None and element.find("mimic") is None:
            numbers = {"multiplier": mimic.multiplier, "offset": mimic.offset}
            given = {k: str(v) for k, v in numbers.items() if v is not None}
            ET.SubElement(element, "mimic", {"joint": mimic.joint, **given})
        if soft is not None and element.find("safety_controller") is None:
            numbers = {"k_velocity": 0.0, **vars(soft)}
            given = {k: str(v) for k, v in numbers.items() if v is not None}
            ET.SubElement(element, "safety_controller", given)
    return ET.tostring(root, "unicode")


def _urdf_of_joints(value: Any) -> str:
    carrying: dict[str, list[Any]] = {link.name: [] for link in value.links}
    for joint in value.joints:
        carrying[joint.parent].append(joint)
    held = {joint.child for joint in value.joints}
    roots = [name for name in carrying if name not in held]
    if len(roots) != 1:
        raise UrdfError(f"links that no joint holds: {', '.join(roots) or 'none'}")
    writer = UrdfWriter(value.name, roots[0])
    links = list(roots)
    for link in links:
        for joint in carrying[link]:
            _add(writer, joint)
            links.append(joint.child)
    return writer.text()


def _add(writer: UrdfWriter, joint: Any) -> None:
    limit, mimic = joint.limit, joint.mimic
    limits = None
    if limit is not None and None not in {limit.lower, limit.upper}:
        limits = (limit.lower, limit.upper)
    if joint.joint_type == "continuous":
        limits = None
    writer.add_joint(
        joint.name,
        joint.joint_type,
        joint.parent,
        joint.child,
        np.asarray(joint.origin),
        axis=joint.axis,
        limits=limits,
        velocity=math.inf if limit is None or not limit.velocity else limit.velocity,
        mimic=None if mimic is None else (mimic.joint, mimic.multiplier, mimic.offset),
    )
