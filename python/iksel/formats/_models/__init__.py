# SPDX-License-Identifier: BSD-3-Clause
"""Robots of other libraries, as objects, and the URDF that each stands for.

They are told by the names of their classes, so that none of the libraries is imported.
"""

from __future__ import annotations

import importlib
from typing import Any, NamedTuple

from iksel_cpp import InvalidArgumentError


class Model(NamedTuple):
    """What an object of another library is."""

    urdf: str | bytes
    """Text of its URDF."""
    tip_link: str | None = None
    """Link to take where none is named; None: the one without children."""


# By the package that a class is of and its name: which module here reads its objects.
_READERS = {
    ("pinocchio", "Model"): "pinocchio",
    ("pinocchio", "RobotWrapper"): "pinocchio",
    ("mujoco", "MjModel"): "mujoco",
    ("mujoco", "MjSpec"): "mujoco",
    ("mujoco", "MjData"): "mujoco",
    ("yourdfpy", "URDF"): "urdf_objects",
    ("urchin", "URDF"): "urdf_objects",
    ("urdfpy", "URDF"): "urdf_objects",
    ("urdf_parser_py", "Robot"): "urdf_objects",
    ("roboticstoolbox", "BaseRobot"): "toolbox",
    ("ikpy", "Chain"): "ikpy",
}

# What objects that hold no model of their own are, and what to give in their place.
_REMEDIES = {
    ("iksel_cpp", "Robot"): "it is a robot already; its `urdf` can be given",
    ("roboticstoolbox", "PoERobot"): "give a DHRobot or a Robot of links",
}

KNOWN = (
    "Pinocchio's Model and RobotWrapper, MuJoCo's MjModel, MjSpec and MjData, URDF of "
    "yourdfpy, urchin, urdfpy and urdf_parser_py, robots of the Robotics Toolbox, and "
    "ikpy's Chain"
)


def read_model(value: Any) -> Model:
    """The URDF of a robot that another library holds.

    Raises:
        InvalidArgumentError: It is no such robot; the message says what to give.
        UrdfError: It has what a URDF cannot have.
    """
    for package, name in _classes(value):
        if (package, name) in _REMEDIES:
            break
        if (package, name) in _READERS:
            module = importlib.import_module(f"{__name__}.{_READERS[package, name]}")
            read: Model = module.read(value)
            return read
    remedies = (_REMEDIES[key] for key in _classes(value) if key in _REMEDIES)
    remedy = next(remedies, "give the URDF, xacro or MJCF file that it was made of")
    package, name = _classes(value)[0]
    what = name if package in {"builtins", "iksel_cpp"} else f"{name} of {package}"
    raise InvalidArgumentError(
        f"source: an object of the class {what} cannot be read: {remedy}; objects that "
        f"can be are {KNOWN}"
    )


def _classes(value: Any) -> list[tuple[str, str]]:
    """Package and name of the class of an object, and of those it is derived from."""
    return [(c.__module__.partition(".")[0], c.__name__) for c in type(value).__mro__]
