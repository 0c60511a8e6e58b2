# SPDX-License-Identifier: BSD-3-Clause
"""Models of Pinocchio, and its RobotWrapper."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from iksel.formats._models import Model
from iksel.formats._urdf_writer import UrdfWriter

if TYPE_CHECKING:
    from iksel._base.arrays import FloatArray

_LINKS = ("BODY", "OP_FRAME", "SENSOR")  # kinds of frames that become links


def read(value: Any) -> Model:
    """The URDF of a model: its joints by their names, its frames as links.

    Joints of more than one degree of freedom, and helical ones, become `floating` ones
    with their kind before the name: no chain goes through them.
    """
    return Model(_Tree(getattr(value, "model", value)).text())


class _Tree:
    """Writes URDF, joint by joint, each followed by the frames on it."""

    def __init__(self, model: Any) -> None:
        self._model = model
        self._on: list[list[int]] = [[] for _ in range(model.njoints)]
        for i, frame in enumerate(model.frames):
            if frame.type.name in _LINKS:
                self._on[frame.parentJoint].append(i)
        self._carriers = [self._carrier(joint) for joint in range(model.njoints)]
        root = self._name(0, str(model.names[0]))
        self._writer = UrdfWriter(str(model.name), root)
        # Of joints and of frames: the link, and its place in the joint's frame.
        self._joint_links = [(root, np.eye(4))]
        self._frame_links: dict[int, tuple[str, FloatArray]] = {}

    def text(self) -> str:
        """The URDF."""
        for joint in range(self._model.njoints):
            if joint > 0:
                self._add_joint(joint)
            for frame in self._on[joint]:
                self._add_frame(joint, frame)
        return self._writer.text()

    def _carrier(self, joint: int) -> int | None:
        """The frame that is the link that a joint carries, if there is one."""
        frames = self._model.frames
        for i in self._on[joint]:
            is_at_joint = np.array_equal(frames[i].placement.homogeneous, np.eye(4))
            if is_at_joint and frames[i].type.name == "BODY":
                return i
        return None

    def _name(self, joint: int, default: str) -> str:
        """Name of the link that a joint carries."""
        carrier = self._carriers[joint]
        return default if carrier is None else str(self._model.frames[carrier].name)

    def _add_joint(self, joint: int) -> None:
        model = self._model
        parent, place = self._link_above(joint)
        origin = np.linalg.solve(place, model.jointPlacements[joint].homogeneous)
        name = str(model.names[joint])
        child = self._writer.free_link(self._name(joint, f"{name}/link"))
        kind, axis = self._motion(joint)
        mimic = self._mimic(joint)
        if kind == "floating":
            name = f"{model.joints[joint].shortname()} {name}"
        if kind == "fixed":
            origin, mimic = origin @ self._data(joint).M.homogeneous, None
        self._writer.add_joint(
            self._writer.free_joint(name),
            kind,
            parent,
            child,
            origin,
            axis=axis,
            limits=self._limits(joint),
            velocity=self._velocity(joint),
            mimic=mimic,
        )
        self._joint_links.append((child, np.eye(4)))

    def _add_frame(self, joint: int, index: int) -> None:
        frame = self._model.frames[index]
        if index == self._carriers[joint]:
            self._frame_links[index] = self._joint_links[joint]
            return
        parent, place = self._link_of(joint, frame.parentFrame)
        own = frame.placement.homogeneous
        name = self._writer.free_link(str(frame.name))
        self._writer.add_fixed(parent, name, np.linalg.solve(place, own))
        self._frame_links[index] = name, own

    def _link_above(self, joint: int) -> tuple[str, FloatArray]:
        """The link that carries a joint, and its place in its own joint's frame."""
        parent = int(self._model.parents[joint])
        for frame in self._model.frames:
            if frame.type.name == "JOINT" and frame.parentJoint == joint:
                return self._link_of(parent, frame.parentFrame)
        return self._joint_links[parent]

    def _link_of(self, joint: int, frame: int) -> tuple[str, FloatArray]:
        """The link that is nearest above a frame, without leaving a joint."""
        frames = self._model.frames
        while frame not in self._frame_links:
            above = frames[frame].parentFrame
            if above == frame or frames[frame].parentJoint != joint:
                return self._joint_links[joint]
            frame = above
        if frames[frame].parentJoint != joint:
            return self._joint_links[joint]
        return self._frame_links[frame]

    def _motion(self, joint: int) -> tuple[str, FloatArray | None]:
        """Type of a joint in a URDF, and its axis."""
        model = self._model.joints[joint]
        if model.nv != 1 and self._mimic(joint) is None:
            return "floating", None
        mimic = self._mimic(joint)
        if mimic is not None and mimic[1] == 0:  # it stays at its offset
            return "fixed", None
        twist = np.asarray(self._data(joint).S).reshape(-1)
        if mimic is not None:
            twist /= mimic[1]
        linear, angular = twist[:3], twist[3:]
        if linear.any() and angular.any():
            return "floating", None  # a screw
        return ("prismatic", linear) if linear.any() else ("revolute", angular)

    def _data(self, joint: int) -> Any:
        """Where a joint is at the neutral configuration, and how it moves."""
        model = self._model.joints[joint]
        data = model.createData()
        model.calc(data, _neutral(self._model))
        return data

    def _limits(self, joint: int) -> tuple[float, float] | None:
        model, kind = self._model, self._model.joints[joint]
        if kind.nq != 1:  # none, or a point of the circle
            return None
        lower, upper = model.lowerPositionLimit, model.upperPositionLimit
        return float(lower[kind.idx_q]), float(upper[kind.idx_q])

    def _velocity(self, joint: int) -> float:
        kind = self._model.joints[joint]
        if kind.nv != 1:
            return math.inf
        return float(self._model.velocityLimit[kind.idx_v])

    def _mimic(self, joint: int) -> tuple[str, float, float] | None:
        """Joint that a joint follows, factor and offset."""
        kind = self._model.joints[joint]
        if kind.shortname() != "JointModelMimic":
            return None
        followed = next(
            i
            for i in range(1, self._model.njoints)
            if i != joint and self._model.joints[i].idx_q == kind.idx_q
        )
        inner = kind.extract()
        name = str(self._model.names[followed])
        return name, float(inner.scaling), float(inner.offset)


def _neutral(model: Any) -> FloatArray:
    """Values at which every joint's kind can be computed."""
    values = np.zeros(model.nq)
    for joint in list(model.joints)[1:]:
        if joint.nq > joint.nv:  # the cosine, or the scalar of a quaternion
            index = joint.idx_q + (0 if joint.nq == 2 else joint.nq - 1)
            values[index] = 1.0
    return values
