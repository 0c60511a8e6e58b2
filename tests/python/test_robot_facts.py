# SPDX-License-Identifier: BSD-3-Clause
"""The built-in robots' files, judged without the library.

A second forward kinematics, small enough to be read in a minute, checks the
known answers in the manifest; the library's own is tested against them elsewhere.
"""

import json
import math
import sys
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import pytest

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

Array = npt.NDArray[np.float64]

ROOT = Path(__file__).parents[2]
ROBOTS = ROOT / "cpp" / "robots"
# The facts that the files were written from, where a checkout has them beside it.
FACTS = ROOT.parent / "shared" / "robots"

MANIFEST: dict[str, dict[str, Any]] = tomllib.loads(
    (ROBOTS / "robots.toml").read_text(encoding="utf-8")
)["robots"]
# Where the facts name another licence than the LICENSE file of the source has.
LICENCE_BY_SOURCE = {"wx250": "BSD-2-Clause"}
PAPER = [name for name, robot in MANIFEST.items() if robot.get("paper")]
MOVABLE = {"revolute", "continuous", "prismatic"}

each_robot = pytest.mark.parametrize("name", MANIFEST)


class Joint(NamedTuple):
    name: str
    type: str
    parent: str
    child: str
    xyz: Array
    rpy: Array
    axis: Array
    limit: dict[str, float]
    soft_limit: dict[str, float]


class Kinematics(NamedTuple):
    position: Array
    rotation: Array
    jacobian: Array


def vector(text: str) -> Array:
    return np.array([float(word) for word in text.split()])


def attributes(element: ET.Element | None) -> dict[str, float]:
    if element is None:
        return {}
    return {key: float(value) for key, value in element.attrib.items()}


def read_urdf(name: str) -> ET.Element:
    return ET.parse(ROBOTS / MANIFEST[name]["urdf"]).getroot()


def read_joint(element: ET.Element) -> Joint:
    parent, child = element.find("parent"), element.find("child")
    origin, axis = element.find("origin"), element.find("axis")
    assert parent is not None
    assert child is not None
    assert origin is not None
    return Joint(
        name=element.attrib["name"],
        type=element.attrib["type"],
        parent=parent.attrib["link"],
        child=child.attrib["link"],
        xyz=vector(origin.attrib["xyz"]),
        rpy=vector(origin.attrib["rpy"]),
        axis=vector(axis.attrib["xyz"]) if axis is not None else np.zeros(3),
        limit=attributes(element.find("limit")),
        soft_limit=attributes(element.find("safety_controller")),
    )


def read_chain(name: str) -> list[Joint]:
    """The joints from the base link to the tip link, fixed ones included."""
    robot = MANIFEST[name]
    by_child = {j.child: j for j in map(read_joint, read_urdf(name).iter("joint"))}
    chain: list[Joint] = []
    link = robot["tip_link"]
    while link != robot["base_link"]:
        chain.append(by_child[link])
        link = chain[-1].parent
    return chain[::-1]


def movable(chain: list[Joint]) -> list[Joint]:
    return [joint for joint in chain if joint.type in MOVABLE]


def rotation_about(axis: Array, angle: float) -> Array:
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turned: Array = (
        np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross
    )
    return turned


def rotation_from_rpy(rpy: Array) -> Array:
    x, y, z = np.eye(3)
    roll, pitch, yaw = (float(angle) for angle in rpy)
    turned: Array = (
        rotation_about(z, yaw) @ rotation_about(y, pitch) @ rotation_about(x, roll)
    )
    return turned


def rotation_from_wxyz(quaternion: Array) -> Array:
    w, x, y, z = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def forward(name: str, q: list[float]) -> Kinematics:
    """Pose of the tip, tcp included, and its Jacobian in base axes."""
    position, rotation = np.zeros(3), np.eye(3)
    screws: list[tuple[str, Array, Array]] = []
    angles = iter(q)
    for joint in read_chain(name):
        position = position + rotation @ joint.xyz
        rotation = rotation @ rotation_from_rpy(joint.rpy)
        if joint.type not in MOVABLE:
            continue
        screws.append((joint.type, rotation @ joint.axis, position))
        if joint.type == "prismatic":
            position = position + rotation @ joint.axis * next(angles)
        else:
            rotation = rotation @ rotation_about(joint.axis, next(angles))
    tcp = MANIFEST[name].get("tcp", {"xyz": [0.0] * 3, "rpy": [0.0] * 3})
    position = position + rotation @ np.array(tcp["xyz"])
    rotation = rotation @ rotation_from_rpy(np.array(tcp["rpy"]))
    columns = [
        np.concatenate([axis, np.zeros(3)])
        if kind == "prismatic"
        else np.concatenate([np.cross(axis, position - origin), axis])
        for kind, axis, origin in screws
    ]
    return Kinematics(position, rotation, np.array(columns).T)


def test_manifest_lists_every_file_once() -> None:
    listed = sorted(robot["urdf"] for robot in MANIFEST.values())
    assert listed == sorted(path.name for path in ROBOTS.glob("*.urdf"))


def test_manifest_starts_with_the_papers_robots() -> None:
    assert list(MANIFEST)[: len(PAPER)] == PAPER
    assert len(PAPER) == 4


@each_robot
def test_manifest_entry_is_complete(name: str) -> None:
    robot = MANIFEST[name]
    for key in ("urdf", "maker", "base_link", "tip_link", "licence", "source"):
        assert isinstance(robot[key], str)
        assert robot[key].strip()
    assert f"`{name}`" in (ROBOTS / "LICENSES.md").read_text(encoding="utf-8")


@each_robot
def test_urdf_is_one_tree_of_bare_links(name: str) -> None:
    root = read_urdf(name)
    assert root.tag == "robot"
    assert root.attrib["name"] == name
    links = [link.attrib["name"] for link in root.iter("link")]
    children = [joint.child for joint in map(read_joint, root.iter("joint"))]
    assert len(set(links)) == len(links)
    assert sorted([MANIFEST[name]["base_link"], *children]) == sorted(links)
    for tag in ("geometry", "visual", "collision", "inertial", "mesh"):
        assert root.find(f".//{tag}") is None


@each_robot
def test_chain_has_the_stated_joints_and_limits(name: str) -> None:
    joints = movable(read_chain(name))
    assert len(joints) == MANIFEST[name]["dof"]
    for joint in joints:
        assert np.linalg.norm(joint.axis) == pytest.approx(1.0, abs=1e-12)
        assert joint.limit["velocity"] >= 0.0
        assert joint.limit["effort"] >= 0.0
        if joint.type == "continuous":
            assert joint.limit.keys() == {"velocity", "effort"}
            assert not joint.soft_limit
            continue
        assert joint.limit["lower"] < joint.limit["upper"]
        if joint.soft_limit:
            soft_lower = joint.soft_limit["soft_lower_limit"]
            soft_upper = joint.soft_limit["soft_upper_limit"]
            assert joint.limit["lower"] <= soft_lower < soft_upper
            assert soft_upper <= joint.limit["upper"]


@each_robot
def test_sample_is_inside_the_limits_and_regular(name: str) -> None:
    q = MANIFEST[name]["sample_q"]
    joints = movable(read_chain(name))
    assert len(q) == len(joints)
    for value, joint in zip(q, joints, strict=True):
        lower = joint.limit.get("lower", -math.inf)
        upper = joint.limit.get("upper", math.inf)
        assert joint.soft_limit.get("soft_lower_limit", lower) < value
        assert value < joint.soft_limit.get("soft_upper_limit", upper)
    singular_values = np.linalg.svd(forward(name, q).jacobian, compute_uv=False)
    assert singular_values[-1] > 0.02 * singular_values[0]


@each_robot
def test_sample_pose_is_the_forward_kinematics(name: str) -> None:
    robot = MANIFEST[name]
    tip = forward(name, robot["sample_q"])
    quaternion = np.array(robot["sample_quaternion"])
    np.testing.assert_allclose(
        tip.position, robot["sample_position"], rtol=0.0, atol=1e-12
    )
    np.testing.assert_allclose(
        tip.rotation, rotation_from_wxyz(quaternion), rtol=0.0, atol=1e-12
    )
    assert np.linalg.norm(quaternion) == pytest.approx(1.0, abs=1e-12)
    assert quaternion[0] > 0.0


needs_facts = pytest.mark.skipif(
    not FACTS.is_dir(), reason="the shared robot facts are not beside this checkout"
)


def limits_of_fact(fact: dict[str, Any]) -> tuple[dict[str, float], dict[str, float]]:
    """The limits and soft limits that a URDF joint has for this fact."""
    if fact["type"] == "fixed":
        return {}, {}
    limit = {"velocity": fact["velocity"] or 0.0, "effort": 0.0}
    if fact["type"] == "continuous":
        return limit, {}
    limit |= {"lower": fact["lower"], "upper": fact["upper"]}
    if "soft_lower" not in fact:
        return limit, {}
    return limit, {
        "soft_lower_limit": fact["soft_lower"],
        "soft_upper_limit": fact["soft_upper"],
        "k_velocity": 0.0,
    }


@needs_facts
def test_every_robot_of_the_facts_is_here() -> None:
    assert sorted(MANIFEST) == sorted(path.stem for path in FACTS.glob("*.json"))


@needs_facts
@each_robot
def test_urdf_has_the_facts_to_the_last_bit(name: str) -> None:
    facts = json.loads((FACTS / f"{name}.json").read_text(encoding="utf-8"))
    robot = MANIFEST[name]
    for key in ("dof", "base_link", "tip_link"):
        assert robot[key] == facts[key]
    joints = [read_joint(element) for element in read_urdf(name).iter("joint")]
    expected = [*facts["joints"], *facts.get("extra_tip_joints", [])]
    assert read_chain(name)[-1].name == facts["joints"][-1]["name"]
    for joint, fact in zip(joints, expected, strict=True):
        assert joint.name == fact["name"]
        assert joint.type == fact["type"]
        assert joint.parent == fact["parent"]
        assert joint.child == fact["child"]
        assert joint.xyz.tolist() == fact["xyz"]
        assert joint.rpy.tolist() == fact["rpy"]
        assert joint.axis.tolist() == fact.get("axis", [0.0, 0.0, 0.0])
        assert (joint.limit, joint.soft_limit) == limits_of_fact(fact)


@needs_facts
@each_robot
def test_manifest_names_the_source_of_the_facts(name: str) -> None:
    facts = json.loads((FACTS / f"{name}.json").read_text(encoding="utf-8"))
    robot, source = MANIFEST[name], facts["source"]
    if not source["commit"]:
        pytest.skip("made up for tests: has no source elsewhere")
    assert robot["maker"] == facts["maker"]
    licence = LICENCE_BY_SOURCE.get(name, facts["license"].split()[0])
    assert robot["licence"] == licence
    where, _, when = robot["source"].partition(" @ ")
    assert where == f"{source['repo']}:{source['path']}"
    assert when == f"{source['commit'][:10]} ({source['date']})"
    assert source["commit"] in (ROBOTS / robot["urdf"]).read_text(encoding="utf-8")
    tools = {joint["xyz"][2] for joint in facts.get("extra_tip_joints", [])}
    if "tcp" in robot:
        assert robot["tcp"]["xyz"][2] in tools
