# SPDX-License-Identifier: BSD-3-Clause
"""Poses of all links of a URDF, against a plain reading of its XML and KDL."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np
import pytest
from urdf_text import LIMIT, arm, joint, link, mimic, random_tree, robot

import iksel

TREES = 40


def numbers(element: ET.Element | None, attribute: str, default: str) -> np.ndarray:
    text = default if element is None else element.get(attribute, default)
    return np.array([float(word) for word in text.split()])


def turned(axis: np.ndarray, angle: float) -> np.ndarray:
    """Rodrigues' formula, (3, 3)."""
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


class PlainTree:
    """A URDF's links and joints, asked one by one."""

    def __init__(self, text: str) -> None:
        root = ET.fromstring(text)
        self.links = [element.get("name") for element in root.findall("link")]
        self.joints = {element.get("name"): element for element in root.iter("joint")}
        self.above = {j.find("child").get("link"): j for j in self.joints.values()}

    def value(self, name: str, values: dict[str, float]) -> float:
        """Of a joint: its own, or that of what it mimics."""
        tag = self.joints[name].find("mimic")
        if name in values or tag is None:
            return values.get(name, 0.0)
        factor, offset = (
            numbers(tag, key, default)[0]
            for key, default in (("multiplier", "1"), ("offset", "0"))
        )
        return factor * self.value(tag.get("joint"), values) + offset

    def pose(self, name: str, values: dict[str, float]) -> np.ndarray:
        """Pose of a link in the root's frame."""
        element = self.above.get(name)
        if element is None:
            return np.eye(4)
        origin, motion = np.eye(4), np.eye(4)
        rpy = numbers(element.find("origin"), "rpy", "0 0 0")
        origin[:3, :3] = (
            turned([0, 0, 1], rpy[2])
            @ turned([0, 1, 0], rpy[1])
            @ turned([1, 0, 0], rpy[0])
        )
        origin[:3, 3] = numbers(element.find("origin"), "xyz", "0 0 0")
        axis = numbers(element.find("axis"), "xyz", "1 0 0")
        if element.get("type") in {"revolute", "continuous"}:
            motion[:3, :3] = turned(axis, self.value(element.get("name"), values))
        elif element.get("type") == "prismatic":
            value = self.value(element.get("name"), values)
            motion[:3, 3] = value * axis / np.linalg.norm(axis)
        return self.pose(element.find("parent").get("link"), values) @ origin @ motion


def load(text: str, base: str, tip: str, **options) -> iksel.Robot | None:
    try:
        return iksel.Robot.from_urdf(text, base_link=base, tip_link=tip, **options)
    except iksel.UrdfError:  # nothing moves there, or no range is left
        return None


def check(arm: iksel.Robot, text: str, rng: np.random.Generator) -> None:
    """All links at random values of all joints that follow none."""
    tree = PlainTree(text)
    free = {n for n, j in tree.joints.items() if j.find("mimic") is None}
    held = {n: rng.uniform(-1, 1) for n in sorted(free - set(arm.joint_names))}
    held = {n: v for n, v in held.items() if rng.random() < 0.7}
    q = rng.uniform(-1, 1, (3, arm.dof))
    poses = arm.link_poses(q, other_joints=held)
    assert poses.shape == (3, len(tree.links), 4, 4)
    values = {**arm.locked_joints, **held}
    for one, found in zip(q, poses, strict=True):
        values.update(zip(arm.joint_names, one, strict=True))
        to_base = np.linalg.inv(tree.pose(arm.base_link, values))
        for name, pose in zip(arm.link_names, found, strict=True):
            expected = to_base @ tree.pose(name, values)
            np.testing.assert_allclose(pose, expected, atol=1e-11, err_msg=name)
    np.testing.assert_array_equal(arm.link_poses(q[1], other_joints=held), poses[1])
    if set(held) <= set(arm.locked_joints):
        return
    tip = arm.link_names.index(arm.tip_link)
    still = arm.link_poses(q)[:, tip]
    np.testing.assert_allclose(still, arm.fk(q, "kdl"), atol=1e-11)


@pytest.mark.parametrize("seed", range(TREES))
def test_all_links_of_random_trees(seed: int) -> None:
    rng = np.random.default_rng(seed)
    links = 12
    text = random_tree(rng, links)
    arms = 0
    for tip in range(1, links):
        for base in (0, *rng.integers(0, links, 2)):
            robot = load(text, f"n{base}", f"n{tip}")
            if robot is None:
                continue
            arms += 1
            check(robot, text, rng)
            lock = {robot.joint_names[-1]: 0.3}
            locked = load(text, f"n{base}", f"n{tip}", locked_joints=lock)
            if locked is not None:
                check(locked, text, rng)
    assert arms > 3, f"seed {seed}"


def test_a_mimic_of_a_mimic_on_a_side_branch() -> None:
    side = (
        link("finger", "nail")
        + joint("knuckle", "base", "finger", axis="1 0 0", inside=mimic())
        + joint("tip", "finger", "nail", inside=mimic("knuckle", 'multiplier="3"'))
    )
    robot = iksel.Robot.from_urdf(arm(side), tip_link="hand")
    q = np.array([0.2, 0.0])
    poses = dict(zip(robot.link_names, robot.link_poses(q), strict=True))
    angle = -2 * 0.2 + 0.1
    in_base = np.eye(4)
    in_base[:3, :3], in_base[2, 3] = turned([1, 0, 0], angle), 0.5
    np.testing.assert_allclose(poses["finger"], in_base, atol=1e-15)
    in_finger = np.eye(4)
    in_finger[:3, :3], in_finger[2, 3] = turned([0, 0, 1], 3 * angle), 0.5
    np.testing.assert_allclose(poses["nail"], in_base @ in_finger, atol=1e-15)
    np.testing.assert_allclose(poses["hand"], robot.fk(q), atol=1e-15)


def test_mimics_at_any_depth() -> None:
    depth = 26
    names = ["first", *(f"f{i}" for i in range(depth))]
    extra = 'multiplier="2" offset="0.1"'
    side = "".join(
        link(f"l{i}") + joint(f"f{i}", "base", f"l{i}", inside=mimic(names[i], extra))
        for i in range(depth)
    )
    robot = iksel.Robot.from_urdf(arm(side), tip_link="hand")
    angle = 1e-9
    pose = robot.link_poses([angle, 0])[robot.link_names.index(f"l{depth - 1}")]
    for _ in range(depth):
        angle = 2 * angle + 0.1
    np.testing.assert_allclose(pose[:3, :3], turned([0, 0, 1], angle), atol=1e-6)


def test_other_joints_are_where_they_are_held() -> None:
    side = link("drawer") + joint(
        "slide", "base", "drawer", kind="prismatic", axis="1 0 0"
    )
    drawer = [0.0, 0.0, 0.5]
    text = arm(side)
    robot = iksel.Robot.from_urdf(text, tip_link="hand")
    i = robot.link_names.index("drawer")
    np.testing.assert_array_equal(robot.link_poses([0.3, 0.2])[i, :3, 3], drawer)
    moved = robot.link_poses([0.3, 0.2], other_joints={"slide": 0.7})
    np.testing.assert_array_equal(moved[i, :3, 3], [0.7, 0.0, 0.5])
    locked = iksel.Robot.from_urdf(
        text, tip_link="hand", locked_joints={"slide": 0.4, "second": 0.2}
    )
    np.testing.assert_array_equal(locked.link_poses([0.3])[i, :3, 3], [0.4, 0, 0.5])
    np.testing.assert_allclose(
        locked.with_tcp(np.eye(4)).link_poses([0.3])[0],
        robot.link_poses([0.3, 0.2])[0],
    )


def test_bad_arguments_are_named() -> None:
    side = link("finger") + joint("knuckle", "hand", "finger", inside=mimic())
    robot = iksel.Robot.from_urdf(arm(side), tip_link="hand")
    q = [0.1, 0.2]
    with pytest.raises(iksel.UnknownNameError, match="other_joints: 'grip'.*knuckle"):
        robot.link_poses(q, other_joints={"grip": 0.0})
    with pytest.raises(iksel.UnknownNameError, match="other_joints: ''"):
        robot.link_poses(q, other_joints={"": 0.0})
    for name in ("first", "knuckle"):
        match = f"other_joints: '{name}' moves with q's joint 'first'"
        with pytest.raises(iksel.InvalidArgumentError, match=match):
            robot.link_poses(q, other_joints={name: 0.0})
    with pytest.raises(iksel.InvalidArgumentError, match=r"other_joints\['knuckle'\]"):
        robot.link_poses(q, other_joints={"knuckle": "open"})
    with pytest.raises(iksel.InvalidArgumentError, match="other_joints: expected a ma"):
        robot.link_poses(q, other_joints=["knuckle"])
    with pytest.raises(iksel.InvalidArgumentError, match=r"q: .*\(2,\) or \(N, 2\)"):
        robot.link_poses([0.1])
    with pytest.raises(iksel.InvalidArgumentError, match=r"q\[1\]: expected finite"):
        robot.link_poses([q, [0.1, np.nan]])
    assert robot.link_poses(np.zeros((0, 2))).shape == (0, 4, 4, 4)


@pytest.mark.parametrize(
    ("inside", "error", "match"),
    [
        (mimic("knuckle"), iksel.UrdfError, "'knuckle' mimics itself through a circle"),
        (mimic("motor"), iksel.UnknownNameError, "'knuckle' mimics 'motor'.*first"),
        (LIMIT, None, ""),
    ],
)
def test_bad_joints_off_the_chain_are_named_when_asked(inside, error, match) -> None:
    side = link("finger") + joint("knuckle", "base", "finger", inside=inside)
    robot = iksel.Robot.from_urdf(arm(side), tip_link="hand")
    for _ in range(2):
        if error is None:
            assert robot.link_poses([0.1, 0.2]).shape == (4, 4, 4)
            continue
        with pytest.raises(error, match=match):
            robot.link_poses([0.1, 0.2])


def test_floating_joints_stay_at_their_origin() -> None:
    text = robot(
        link("world", "base", "hand"),
        joint("float", "world", "base", kind="floating", inside="", xyz="1 2 3"),
        joint("first", "base", "hand"),
    )
    arm_ = iksel.Robot.from_urdf(text, base_link="base", tip_link="hand")
    world = arm_.link_poses([0.1])[arm_.link_names.index("world")]
    np.testing.assert_allclose(world[:3, 3], [-1, -2, -3], atol=1e-15)
