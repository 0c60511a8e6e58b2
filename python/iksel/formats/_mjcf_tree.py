# SPDX-License-Identifier: BSD-3-Clause
"""Writes the bodies, joints and sites of a model of MuJoCo as URDF."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from iksel.formats._urdf_writer import UrdfWriter
from iksel.pose import pose_from_quaternion, pose_from_rotation_vector

if TYPE_CHECKING:
    from iksel._base.arrays import FloatArray

# Kinds of joints: mjtJoint.
_FREE, _BALL, _SLIDE, _HINGE = range(4)


class MjcfTree:
    """Writes URDF, body by body.

    Attributes:
        links: Names of the links that the bodies are.
    """

    def __init__(self, model: Any) -> None:
        self._model = model
        self.links = [model.body(i).name or f"body{i}" for i in range(model.nbody)]
        self._writer = UrdfWriter(_model_name(model), self.links[0])

    def text(self) -> str:
        """The URDF."""
        for body in range(1, self._model.nbody):
            self._add_body(body)
        for site in range(self._model.nsite):
            self._add_site(site)
        return self._writer.text()

    def _add_body(self, body: int) -> None:
        model, name = self._model, self.links[body]
        first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
        parent = self.links[int(model.body_parentid[body])]
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
        self._writer.add_fixed(parent, name, origin)

    def _add_site(self, site: int) -> None:
        """Add a site as a link; those of the world move with nothing."""
        model, body = self._model, int(self._model.site_bodyid[site])
        name = model.site(site).name
        if body == 0 or not name:
            return
        if name in self._writer.links:
            name = self._writer.free_link(f"{name}/site")
        origin = pose_from_quaternion(
            model.site_pos[site], _unit(model.site_quat[site]), order="wxyz"
        )
        self._writer.add_fixed(self.links[body], name, origin)

    def _add_joint(
        self, joint: int, parent: str, child: str, origin: FloatArray
    ) -> None:
        """Add a joint whose frame at its reference is `origin`."""
        model, kind = self._model, self._kind(joint)
        axis = _unit(model.jnt_axis[joint])
        back = -float(model.qpos0[model.jnt_qposadr[joint]]) * axis
        body = self.links[int(model.jnt_bodyid[joint])]
        name = model.joint(joint).name or f"{body}/joint{joint}"
        if kind == _HINGE:
            urdf_kind = "revolute"
            origin = origin @ pose_from_rotation_vector(np.zeros(3), back)
        elif kind == _SLIDE:
            urdf_kind, origin = "prismatic", origin @ _shift(back)
        else:
            word = "free" if kind == _FREE else "ball"
            name = f"{word} joint of body {body}"
            self._writer.add_joint(name, "floating", parent, child, origin)
            return
        lower, upper = model.jnt_range[joint]
        limits = (float(lower), float(upper)) if model.jnt_limited[joint] else None
        self._writer.add_joint(
            name, urdf_kind, parent, child, origin, axis=axis, limits=limits
        )

    def _kind(self, joint: int) -> int:
        return int(self._model.jnt_type[joint])

    def _anchor(self, joint: int) -> FloatArray:
        """The point in the body that a joint turns about; 0 where that is no matter."""
        if self._kind(joint) not in {_HINGE, _BALL}:
            return np.zeros(3)
        anchor: FloatArray = self._model.jnt_pos[joint]
        return anchor

    def _between(self, body: str, joint: int) -> str:
        """Name of the link behind a joint that is not the body's last."""
        name = f"{body}/{self._model.joint(joint).name or f'joint{joint}'}"
        while name in self.links or name in self._writer.links:
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
