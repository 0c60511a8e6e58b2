# SPDX-License-Identifier: BSD-3-Clause
"""The kinematic tree of MuJoCo's MJCF as URDF, read by the package mujoco."""

from __future__ import annotations

import contextlib
import importlib
import warnings
from typing import TYPE_CHECKING, Any, NamedTuple

from iksel_cpp import UrdfError

from iksel.formats._mjcf_bounds import check_size
from iksel.formats._mjcf_tree import MjcfTree
from iksel.formats._urdf_xml import read_xml

if TYPE_CHECKING:
    import xml.etree.ElementTree as ET
    from collections.abc import Iterator
    from pathlib import Path

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
    "geoms",
    "meshes",
    "hfields",
    "materials",
    "textures",
    "plugins",
)

# Numbers of what forward kinematics does without, set to MuJoCo's own defaults: a file
# can ask by one of them for more memory than there is.
_SIZES = {
    "memory": -1,
    "nconmax": -1,
    "nemax": 0,
    "njmax": -1,
    "nkey": 0,
    "nstack": -1,
    "nuser_actuator": -1,
    "nuser_body": -1,
    "nuser_cam": -1,
    "nuser_geom": -1,
    "nuser_jnt": -1,
    "nuser_sensor": -1,
    "nuser_site": -1,
    "nuser_tendon": -1,
    "nuserdata": 0,
}


def is_mjcf(root: ET.Element) -> bool:
    """Whether XML is MuJoCo's."""
    return root.tag in {"mujoco", "mujocoinclude"}


class Tree(NamedTuple):
    """The bodies and joints of a model of MuJoCo."""

    urdf: str
    """Their URDF."""
    tip_link: str | None
    """The one body that holds no other; None: there are several."""


def read_file(path: Path) -> Tree:
    """The bodies and joints of an MJCF file.

    Each body is a link of its name, without a name `body` and its number, the root
    `world`. A joint is at its place in the body, moved back by its `ref`: joint
    values are MuJoCo's `qpos`. Between several joints of a body, and where the last is
    not at its origin, are links `BODY/JOINT`. Joints without a range have no limits.
    Sites of bodies are links of their names, `SITE/site` where that name is taken.
    Free and ball joints become `floating` ones, whose names end in the body's: no chain
    goes through them. Equality constraints are left out, as in MuJoCo's forward
    kinematics.

    Raises:
        UrdfError: The package mujoco is missing, or it refuses the file.
    """
    mujoco = _import_mujoco(path)
    check_size(path)
    try:
        with _without_warnings(mujoco):
            model = compile_bare(mujoco.MjSpec.from_file(str(path)))
        return read_model(model)
    except (ValueError, TypeError, RuntimeError, mujoco.FatalError) as error:
        reason = " ".join(str(error).split())
        remedy = _remedy(reason, path, mujoco.__version__)
        raise UrdfError(f"'{path}': mujoco says: {reason}; {remedy}") from None


@contextlib.contextmanager
def _without_warnings(mujoco: Any) -> Iterator[None]:
    """Take no notice of what MuJoCo warns of in a file.

    It would print some of that, and write it to MUJOCO_LOG.TXT in the working folder.
    """
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda _message: None)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        mujoco.set_mju_user_warning(before)


def _import_mujoco(path: Path) -> Any:
    try:
        mujoco = importlib.import_module("mujoco")
    except ImportError as error:
        raise UrdfError(
            f"'{path}' is MJCF, which needs the package mujoco ({error}): pip install "
            "'iksel[mjcf]'"
        ) from None
    return mujoco


def read_spec(spec: Any) -> Tree:
    """The bodies and joints of an MjSpec, which stays as it is.

    Raises:
        UrdfError: MuJoCo refuses them.
    """
    try:
        model = compile_bare(spec.copy())
    except (ValueError, TypeError, RuntimeError) as error:
        reason = " ".join(str(error).split())
        raise UrdfError(f"MjSpec: mujoco says: {reason}; mend that element") from None
    return read_model(model)


def read_model(model: Any) -> Tree:
    """The bodies and joints of an MjModel."""
    holding = set(model.body_parentid[1:].tolist())
    tips = [i for i in range(1, model.nbody) if i not in holding]
    tree = MjcfTree(model)
    return Tree(tree.text(), tree.links[tips[0]] if len(tips) == 1 else None)


def compile_bare(spec: Any) -> Any:
    """MuJoCo's model of bodies, joints and sites; all else leaves the specification."""
    for name in _NEEDLESS:
        for element in list(getattr(spec, name, ())):
            spec.delete(element)
    for site in spec.sites:
        site.material = ""
    for name, size in _SIZES.items():
        setattr(spec, name, size)
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
