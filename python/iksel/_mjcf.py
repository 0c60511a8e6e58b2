# SPDX-License-Identifier: BSD-3-Clause
"""The kinematic tree of MuJoCo's MJCF as URDF, read by the package mujoco."""

from __future__ import annotations

import importlib
import warnings
import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import UrdfError

from iksel._mjcf_bounds import check_size
from iksel._urdf_xml import read_xml
from iksel.pose import euler_from_pose, pose_from_quaternion, pose_from_rotation_vector

if TYPE_CHECKING:
    from pathlib import Path

    from iksel._arrays import FloatArray

# Lists of a specification that forward kinematics does without. Among them are those
# that name files, so that a model is read without its meshes and pictures.
_NEEDLESS = (
    "keys",
    "sensors",
    "actuators",
    "tendons",
    "equalities",
    "excludes",
    "pairs",
    "tuples",
    "skins",
    "flexes",
    "cameras",
    "lights",
    "sites",
    "geoms",
    "meshes",
    "hfields",
    "materials",
    "textures",
    "plugins",
)


def is_mjcf(root: ET.Element) -> bool:
    """Whether XML is MuJoCo's."""
    return root.tag in {"mujoco", "mujocoinclude"}


def urdf_of_mjcf(path: Path) -> str:
    """The URDF text with the bodies and joints of an MJCF file.

    Each body is a link of its name, without a name `body` and its number, the root
    `world`. A joint is at its place in the body, moved back by its `ref`: joint
    values are MuJoCo's `qpos`. Between several joints of a body, and where the last is
    not at its origin, are links `BODY/JOINT`. Joints without a range have no limits.
    Free and ball joints become `floating` ones, whose names end in the body's: no chain
    goes through them. Equality constraints are left out, as in MuJoCo's forward
    kinematics.

    Raises:
        UrdfError: The package mujoco is missing, or it refuses the file.
    """
    mujoco = _import_mujoco(path)
    check_size(path)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of what the file is made of
            model = _compile(mujoco, path)
        return _Tree(mujoco, model).text()
    except (ValueError, TypeError, RuntimeError, mujoco.FatalError) as error:
        reason = " ".join(str(error).split())
        remedy = _remedy(reason, path, mujoco.__version__)
        raise UrdfError(f"'{path}': mujoco says: {reason}; {remedy}") from None


def _import_mujoco(path: Path) -> Any:
    try:
        mujoco = importlib.import_module("mujoco")
    except ImportError as error:
        raise UrdfError(
            f"'{path}' is MJCF, which needs the package mujoco ({error}): pip install "
            "'iksel[mjcf]'"
        ) from None
    return mujoco


def _compile(mujoco: Any, path: Path) -> Any:
    """MuJoCo's model of the bodies and joints alone."""
    spec = mujoco.MjSpec.from_file(str(path))
    for name in _NEEDLESS:
        for element in list(getattr(spec, name, ())):
            spec.delete(element)
    # Bodies that had their mass from what is gone still need some.
    spec.compiler.boundmass = 1.0
    spec.compiler.boundinertia = 1.0
    spec.compiler.balanceinertia = True
    spec.compiler.settotalmass = -1.0  # not set; it warns in a file of its own
    spec.compiler.fusestatic = False
    return spec.compile()


def _remedy(reason: str, path: Path, version: str) -> str:
    """What to do about a file that MuJoCo refuses for a reason."""
    root = read_xml("mjcf", path)[0]
    bodies = {"worldbody", "include", "attach"}
    if root.tag == "mujocoinclude" or not any(e.tag in bodies for e in root):
        return "it is a part of a model: give the file that includes it"
    if "invalid keyword: 'fixed'" in reason:
        return "leave that joint out: a body without joints is fixed to its parent"
    if "Error opening file" in reason:
        return "put that file where the model names it"
    if "global coordinates" in reason:
        return "save the converted model, and give that"
    return (
        f"mend that element, or take it out; MuJoCo {version} is installed, and files "
        "of other versions may have what it does not know"
    )


class _Tree:
    """Writes URDF, body by body."""

    def __init__(self, mujoco: Any, model: Any) -> None:
        self._kinds = mujoco.mjtJoint
        self._model = model
        self._bodies = [model.body(i).name or f"body{i}" for i in range(model.nbody)]
        self._root = ET.Element("robot", name=_model_name(model))

    def text(self) -> str:
        """The URDF."""
        ET.SubElement(self._root, "link", name=self._bodies[0])
        for body in range(1, self._model.nbody):
            self._add_body(body)
        ET.indent(self._root)
        return ET.tostring(self._root, "unicode")

    def _add_body(self, body: int) -> None:
        model, name = self._model, self._bodies[body]
        first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
        parent = self._bodies[int(model.body_parentid[body])]
        # From the parent's frame to that of the body, all joints at their reference.
        origin = pose_from_quaternion(
            model.body_pos[body], _unit(model.body_quat[body]), order="wxyz"
        )
        for joint in range(first, first + count):
            anchor = self._anchor(joint)
            last = joint == first + count - 1 and not anchor.any()
            child = name if last else self._between(name, joint)
            self._add_joint(joint, parent, child, origin @ _shift(anchor))
            if last:
                return
            parent, origin = child, _shift(-anchor)
        self._write_joint(f"{name}/fixed", "fixed", parent, name, origin)

    def _add_joint(
        self, joint: int, parent: str, child: str, origin: FloatArray
    ) -> None:
        """Add a joint whose frame at its reference is `origin`."""
        model, kind = self._model, self._kind(joint)
        axis = _unit(model.jnt_axis[joint])
        back = -float(model.qpos0[model.jnt_qposadr[joint]]) * axis
        limited = bool(model.jnt_limited[joint])
        body = self._bodies[int(model.jnt_bodyid[joint])]
        name = model.joint(joint).name or f"{body}/joint{joint}"
        write = self._write_joint
        if kind == self._kinds.mjJNT_HINGE:
            turned = origin @ pose_from_rotation_vector(np.zeros(3), back)
            urdf_kind = "revolute" if limited else "continuous"
            element = write(name, urdf_kind, parent, child, turned)
        elif kind == self._kinds.mjJNT_SLIDE:
            element = write(name, "prismatic", parent, child, origin @ _shift(back))
        else:
            word = "free" if kind == self._kinds.mjJNT_FREE else "ball"
            write(f"{word} joint of body {body}", "floating", parent, child, origin)
            return
        ET.SubElement(element, "axis", xyz=_words(axis))
        if limited:
            lower, upper = (repr(float(end)) for end in model.jnt_range[joint])
            limit = {"lower": lower, "upper": upper, "effort": "0", "velocity": "0"}
            ET.SubElement(element, "limit", limit)

    def _write_joint(
        self, name: str, kind: str, parent: str, child: str, origin: FloatArray
    ) -> ET.Element:
        """Write a joint and the link that it carries."""
        ET.SubElement(self._root, "link", name=child)
        element = ET.SubElement(self._root, "joint", name=name, type=kind)
        ET.SubElement(element, "parent", link=parent)
        ET.SubElement(element, "child", link=child)
        rpy = _words(euler_from_pose(origin))
        ET.SubElement(element, "origin", xyz=_words(origin[:3, 3]), rpy=rpy)
        return element

    def _kind(self, joint: int) -> Any:
        return self._kinds(int(self._model.jnt_type[joint]))

    def _anchor(self, joint: int) -> FloatArray:
        """The point in the body that a joint turns about; 0 where that is no matter."""
        turns = (self._kinds.mjJNT_HINGE, self._kinds.mjJNT_BALL)
        if self._kind(joint) not in turns:
            return np.zeros(3)
        anchor: FloatArray = self._model.jnt_pos[joint]
        return anchor

    def _between(self, body: str, joint: int) -> str:
        """Name of the link behind a joint that is not the body's last."""
        name = f"{body}/{self._model.joint(joint).name or f'joint{joint}'}"
        while name in self._bodies:
            name += "'"
        return name


def _model_name(model: Any) -> str:
    return bytes(model.names).split(b"\0")[0].decode("utf-8", "replace") or "mujoco"


def _unit(vector: FloatArray) -> FloatArray:
    unit: FloatArray = vector / np.linalg.norm(vector)
    return unit


def _shift(position: FloatArray) -> FloatArray:
    pose = np.eye(4)
    pose[:3, 3] = position
    return pose


def _words(values: FloatArray) -> str:
    """Numbers that are read back as the same."""
    return " ".join(repr(float(value) + 0.0) for value in values)
