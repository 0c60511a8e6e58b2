# SPDX-License-Identifier: BSD-3-Clause
"""Robots that other libraries hold: their forward kinematics are the judge."""

from __future__ import annotations

import os
import pathlib
import re
import types
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from mjcf_reference import MjcfFile
from test_mjcf import random_mjcf
from urdf_text import LIMIT, arm, limits, random_tree

import iksel
from iksel.formats._models import KNOWN

SEED = int(os.environ.get("IKSEL_TEST_SEED", "1"))
TREES = 15


def chains(source, count: int = 5):
    """A robot to each tip that can be reached, and configurations of it."""
    for tip, _ in iksel.load_tree(source).tips:
        try:
            robot = iksel.load_robot(source, tip_link=tip)
        except iksel.UrdfError as error:
            message = str(error)
            assert "no movable joint" in message or "limits" in message, message
            continue
        yield robot, robot.random_configurations(count, seed=SEED)


def same(ours, theirs, where) -> None:
    np.testing.assert_allclose(
        ours, theirs, rtol=0, atol=1e-9, err_msg=f"{where}, seed {SEED}"
    )


def urdfs():
    """Random trees of links, in the first half of which joints follow others.

    Axes are of unit length: without that slides are other libraries' own affair.
    """

    def unit(match):
        axis = np.array(match[1].split(), dtype=float)
        return f'axis xyz="{" ".join(map(str, axis / np.linalg.norm(axis)))}"'

    rng = np.random.default_rng(SEED)
    trees = [random_tree(rng, 9) for _ in range(TREES)]
    trees = [re.sub('axis xyz="(.*?)"', unit, tree) for tree in trees]
    half = TREES // 2
    return trees[:half] + [re.sub("<mimic.*?/>", "", tree) for tree in trees[half:]]


def with_plain_followers(text: str) -> str:
    """The tree with followers as Pinocchio knows them.

    They follow no followers, and no joint is continuous, whose values are two numbers.
    """
    root = ET.fromstring(text.replace("continuous", "revolute"))
    followers = set()
    for joint in root.iter("joint"):
        for mimic in joint.findall("mimic"):
            if mimic.get("joint") in followers:
                joint.remove(mimic)
            else:
                followers.add(joint.get("name"))
    return ET.tostring(root, "unicode")


def pinocchio_poses(pin, model, robot, q):
    data = model.createData()
    frame = model.getFrameId(robot.tip_link)
    poses = []
    for row in q:
        values = pin.neutral(model)
        for name, value in zip(robot.joint_names, row, strict=True):
            joint = model.joints[model.getJointId(name)]
            circle = [np.cos(value), np.sin(value)]
            part = slice(joint.idx_q, joint.idx_q + joint.nq)
            values[part] = value if joint.nq == 1 else circle
        pin.forwardKinematics(model, data, values)
        poses.append(pin.updateFramePlacement(model, data, frame).homogeneous)
    return np.array(poses)


@pytest.mark.parametrize("mimic", [False, True])
def test_pinocchio_models(mimic) -> None:
    pin = pytest.importorskip("pinocchio")
    found = 0
    for text in urdfs():
        if mimic:
            text = with_plain_followers(text)  # noqa: PLW2901
        try:
            model = pin.buildModelFromXML(text, mimic=mimic)
        except ValueError as error:  # what is followed stands on another branch
            assert "not in the kinematic tree" in str(error)  # noqa: PT017
            continue
        for robot, q in chains(model):
            same(robot.fk(q), pinocchio_poses(pin, model, robot, q), text)
            found += 1
            if mimic:  # the very chain of the file
                own = iksel.load_robot(text, tip_link=robot.tip_link)
                assert robot.joint_names == own.joint_names
                same(robot.fk(q), own.fk(q), text)
    assert found > TREES


def test_pinocchio_models_made_by_hand() -> None:
    pin = pytest.importorskip("pinocchio")
    rng = np.random.default_rng(SEED)
    kinds = [pin.JointModelRX, pin.JointModelRUBY, pin.JointModelPZ, pin.JointModelPX]
    for _ in range(TREES):
        model, parent = pin.Model(), 0
        for i in range(5):
            axis = rng.normal(size=3)
            kind = [
                *kinds,
                lambda a=axis: pin.JointModelRevoluteUnaligned(*a),
                lambda a=axis: pin.JointModelPrismaticUnaligned(*a),
            ][rng.integers(6)]()
            ends = np.sort(rng.uniform(-2, 2, 2))
            if kind.nq == 2:
                ends = np.array([[-1.01, -1.01], [1.01, 1.01]])
            ends = ends.reshape(2, -1)
            parent = model.addJoint(
                parent, kind, pin.SE3.Random(), f"j{i}", np.ones(1), np.ones(1), *ends
            )
        model.addFrame(
            pin.Frame("hand", parent, pin.SE3.Random(), pin.FrameType.OP_FRAME)
        )
        robot = iksel.load_robot(model)
        assert robot.tip_link == "hand"
        q = robot.random_configurations(5, seed=SEED)
        same(robot.fk(q), pinocchio_poses(pin, model, robot, q), model)


def test_pinocchio_joints_that_a_urdf_has_not() -> None:
    pin = pytest.importorskip("pinocchio")
    model = pin.Model()
    base = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "root")
    screw = model.addJoint(base, pin.JointModelHX(0.2), pin.SE3.Identity(), "screw")
    model.addJoint(screw, pin.JointModelRZ(), pin.SE3.Identity(), "turn")
    for first, message in (
        (None, "JointModelFreeFlyer root"),
        ("root/link", "HX screw"),
    ):
        with pytest.raises(iksel.UrdfError, match=message + ".* is floating"):
            iksel.load_robot(model, base_link=first)
    assert iksel.load_robot(model, base_link="screw/link").joint_names == ["turn"]


def test_followers_of_pinocchio_that_stay() -> None:
    pin = pytest.importorskip("pinocchio")
    stay = '<mimic joint="first" multiplier="0" offset="0.2"/>'
    text = arm(inside=LIMIT + stay)
    robot = iksel.load_robot(pin.buildModelFromXML(text, mimic=True))
    assert robot.joint_names == ["first"]
    q = robot.random_configurations(5, seed=SEED)
    same(robot.fk(q), iksel.load_robot(text).fk(q), text)


@pytest.mark.parametrize("library", ["pinocchio", "mujoco", "urchin"])
def test_a_missing_limit_off_the_chain_is_no_matter(tmp_path, library) -> None:
    module = pytest.importorskip(library)
    grip = {"kind": "prismatic", "inside": limits(0, "1e9")}
    path = tmp_path / "arm.urdf"
    path.write_text(arm(**grip), encoding="utf-8")
    if library == "urchin":
        source = module.URDF.load(str(path))
    elif library == "pinocchio":
        source = module.buildModelFromXML(arm(**grip))
    else:
        source = tmp_path / "arm.xml"
        source.write_text(
            """<mujoco><worldbody><body name="elbow">
              <joint name="first" range="-57 114" limited="true"/><geom size="0.1"/>
              <body name="hand"><joint name="second" type="slide" range="0 1e9"
                limited="true"/><geom size="0.1"/></body>
            </body></worldbody></mujoco>""",
            encoding="utf-8",
        )
    assert iksel.load_robot(source, tip_link="elbow").joint_names == ["first"]
    with pytest.raises(iksel.UrdfError, match="'second' has no upper.*default_limits"):
        iksel.load_robot(source, tip_link="hand")
    made = iksel.load_robot(source, tip_link="hand", default_limits=(-1, 0.1))
    assert (made.lower[1], made.upper[1]) == (0, 0.1)


def test_a_wrapper_of_pinocchio(made) -> None:
    pin = pytest.importorskip("pinocchio")
    arm = made.robot("panda")
    model = pin.buildModelFromXML(arm.urdf)
    wrapper = pin.RobotWrapper(model)
    robot = iksel.load_robot(wrapper, tip_link=arm.tip_link)
    assert robot.joint_names == arm.joint_names
    q = arm.random_configurations(20, seed=SEED)
    same(robot.fk(q), arm.with_tcp(np.eye(4)).fk(q), "panda")
    np.testing.assert_array_equal(robot.lower, arm.lower)
    np.testing.assert_array_equal(robot.velocity_limit, arm.velocity_limit)
    assert robot.structure.kind == arm.structure.kind


def test_models_of_mujoco(tmp_path, monkeypatch) -> None:
    mujoco = pytest.importorskip("mujoco")
    monkeypatch.chdir(tmp_path)  # where MuJoCo writes its warnings
    rng = np.random.default_rng(SEED)
    found = 0
    for _ in range(TREES):
        path = tmp_path / "arm.xml"
        path.write_text(random_mjcf(rng, 8), encoding="utf-8")
        file = MjcfFile(path)
        if not file.whole:
            continue
        model = mujoco.MjModel.from_xml_path(str(path))
        spec = mujoco.MjSpec.from_file(str(path))
        for source in (model, mujoco.MjData(model), spec):
            for tip in file.tips:
                try:
                    robot = iksel.load_robot(source, tip_link=tip)
                except iksel.UrdfError as error:
                    assert file.cause(tip, str(error)), error  # noqa: PT017
                else:
                    file.compare(robot, SEED)
                    found += 1
        assert len(spec.geoms) > 0  # the user's is left as it is
    assert found > TREES


def test_what_mujoco_refuses_of_a_specification() -> None:
    mujoco = pytest.importorskip("mujoco")
    spec = mujoco.MjSpec()
    spec.worldbody.add_body(name="arm").add_joint(name="bent", axis=[0, 0, 0])
    with pytest.raises(iksel.UrdfError, match=r"MjSpec: mujoco says: .*bent"):
        iksel.load_robot(spec)


def yourdfpy_pose(theirs, robot, values):
    names = theirs.actuated_joint_names
    theirs.update_cfg({name: values.get(name, 0.0) for name in names})
    return theirs.get_transform(robot.tip_link, robot.base_link)


def urchin_pose(theirs, robot, values):
    return theirs.link_fk(values, link=robot.tip_link)


@pytest.mark.parametrize(
    ("library", "pose_of"), [("yourdfpy", yourdfpy_pose), ("urchin", urchin_pose)]
)
def test_objects_of_a_urdf(tmp_path, library, pose_of) -> None:
    module = pytest.importorskip(library)
    found = 0
    for text in urdfs():
        path = tmp_path / "tree.urdf"
        path.write_text(text, encoding="utf-8")
        theirs = module.URDF.load(str(path))
        for robot, q in chains(theirs):
            own = iksel.load_robot(text, tip_link=robot.tip_link)
            assert robot.joint_names == own.joint_names
            np.testing.assert_array_equal(robot.lower, own.lower)
            np.testing.assert_array_equal(robot.velocity_limit, own.velocity_limit)
            same(robot.fk(q), own.fk(q), text)
            for row in q if "<mimic" not in text else ():
                values = dict(zip(robot.joint_names, row.tolist(), strict=True))
                same(robot.fk(row), pose_of(theirs, robot, values), text)
                found += 1
    assert found > TREES


@pytest.mark.parametrize("name", ["Puma560", "UR5", "Stanford", "Panda", "Jaco"])
def test_tables_of_the_robotics_toolbox(name) -> None:
    toolbox = pytest.importorskip("roboticstoolbox")
    from spatialmath import SE3  # noqa: PLC0415 (comes with the toolbox)

    theirs = getattr(toolbox.models.DH, name)()
    for place in (None, SE3.Rand()):
        if place is not None:
            theirs.base, theirs.tool = place, SE3.Rand()
        robot = iksel.load_robot(theirs)
        assert robot.dof == theirs.n
        q = robot.random_configurations(20, seed=SEED)
        same(robot.fk(q), [theirs.fkine(row).A for row in q], name)


def test_random_tables_of_the_robotics_toolbox() -> None:
    toolbox = pytest.importorskip("roboticstoolbox")
    rng = np.random.default_rng(SEED)
    kinds = {
        (False, False): toolbox.RevoluteDH,
        (False, True): toolbox.PrismaticDH,
        (True, False): toolbox.RevoluteMDH,
        (True, True): toolbox.PrismaticMDH,
    }
    for _ in range(TREES):
        modified = bool(rng.random() < 0.5)
        links = []
        for _ in range(5):
            slides = bool(rng.random() < 0.3)
            numbers = dict(
                zip(["a", "alpha", "offset"], rng.normal(size=3), strict=True)
            )
            numbers["theta" if slides else "d"] = rng.normal()
            qlim = np.sort(rng.uniform(-2, 2, 2))
            flip = bool(rng.random() < 0.3)
            links.append(kinds[modified, slides](**numbers, qlim=qlim, flip=flip))
        theirs = toolbox.DHRobot(links, name="random")
        robot = iksel.load_robot(theirs)
        np.testing.assert_array_equal([robot.lower, robot.upper], theirs.qlim)
        q = robot.random_configurations(20, seed=SEED)
        same(robot.fk(q), [theirs.fkine(row).A for row in q], str(theirs))


@pytest.mark.parametrize("name", ["Panda", "Puma560", "GenericSeven", "Frankie"])
def test_elementary_transforms_of_the_robotics_toolbox(name) -> None:
    toolbox = pytest.importorskip("roboticstoolbox")
    theirs = getattr(toolbox.models.ETS, name)()
    limits = (-2, 2)
    robot = iksel.load_robot(theirs, default_limits=limits)
    q = robot.random_configurations(20, seed=SEED)
    same(robot.fk(q), [theirs.fkine(row).A for row in q], name)


def test_a_urdf_with_a_gripper_of_the_robotics_toolbox(tmp_path, made) -> None:
    toolbox = pytest.importorskip("roboticstoolbox")
    pytest.importorskip("rtbdata")
    theirs = toolbox.models.URDF.Panda()
    robot = iksel.load_robot(theirs)
    assert robot.joint_names == made.robot("panda").joint_names
    q = robot.random_configurations(20, seed=SEED)
    same(robot.fk(q), [theirs.fkine(row).A for row in q], "Panda")
    finger = iksel.load_robot(theirs, tip_link="panda_leftfinger")
    assert finger.dof == 8


def test_chains_of_ikpy(tmp_path) -> None:
    chain = pytest.importorskip("ikpy.chain")
    link = pytest.importorskip("ikpy.link")
    rng = np.random.default_rng(SEED)
    for _ in range(TREES):
        links = [link.OriginLink()]
        moves = [False]
        for i in range(6):
            kind = rng.choice(["revolute", "continuous", "prismatic", "fixed"])
            axis = rng.normal(size=3)
            turns = kind in {"revolute", "continuous"}
            if turns:
                axis /= np.linalg.norm(axis)
            moves.append(kind != "fixed")
            links.append(
                link.URDFLink(
                    name=f"j{i}",
                    origin_translation=rng.normal(size=3),
                    origin_orientation=rng.normal(size=3),
                    rotation=axis if turns else None,
                    translation=axis if kind == "prismatic" else None,
                    bounds=(-1.5, 2.0) if kind != "continuous" else None,
                    use_symbolic_matrix=False,
                    joint_type=kind,
                )
            )
        for convention in ("classic", "modified"):
            a, alpha, d, theta = rng.normal(size=4)
            numbers = {"a": a, "alpha": alpha, "d": d, "theta": theta}
            links.append(
                link.DHLink(
                    convention, **numbers, bounds=(-1, 1), convention=convention
                )
            )
            moves.append(True)
        theirs = chain.Chain(links, active_links_mask=[*moves[:-1], False], name="made")
        robot = iksel.load_robot(theirs)
        assert robot.name == "made"
        assert robot.dof == sum(moves)
        for row in robot.random_configurations(10, seed=SEED):
            values = np.zeros(len(moves))
            values[moves] = row * _lengths(links, moves)
            same(robot.fk(row), theirs.forward_kinematics(values), theirs)


def _lengths(links, moves):
    """Metres of a slide for each unit of its value in ikpy, inverted."""
    slides = [getattr(link, "translation", None) for link in links]
    lengths = np.array([1.0 if s is None else 1 / np.linalg.norm(s) for s in slides])
    return lengths[moves]


class Held:
    """A robot of a library that nobody knows."""

    def __repr__(self) -> str:
        return "x" * 10_000


@pytest.mark.parametrize(
    "value", [Held(), 3, None, ["panda"], {"robot": 1}, types.SimpleNamespace(model=1)]
)
def test_other_objects_are_refused_in_words(value) -> None:
    for read in (iksel.load_robot, iksel.load_tree):
        with pytest.raises(
            iksel.InvalidArgumentError, match="cannot be read: give"
        ) as e:
            read(value)
        assert KNOWN in str(e.value)
        assert type(value).__name__ in str(e.value)
        assert len(str(e.value)) < 500
    with pytest.raises(iksel.InvalidArgumentError, match="load_robot"):
        iksel.Robot.from_urdf(value)


def test_a_robot_of_ones_own_is_told_apart(robot) -> None:
    with pytest.raises(iksel.InvalidArgumentError, match="a robot already; its `urdf`"):
        iksel.load_robot(robot)


def test_bytes_are_the_text_of_a_urdf(made, tmp_path: pathlib.Path) -> None:
    arm = made.robot("ur3")
    data = arm.urdf.encode()
    links = {"base_link": arm.base_link, "tip_link": arm.tip_link}
    expected = iksel.Robot.from_urdf(arm.urdf, **links)
    for given in (data, b"\xef\xbb\xbf" + data, arm.urdf.encode("utf-16")):
        assert iksel.Robot.from_urdf(given, **links).chain_hash == expected.chain_hash
        assert iksel.load_robot(given, **links).chain_hash == expected.chain_hash
        assert iksel.load_tree(given).links == iksel.LinkTree.from_urdf(data).links
    path = bytes(tmp_path / "arm.urdf")
    for read in (iksel.Robot.from_urdf, iksel.load_robot):
        with pytest.raises(iksel.UrdfError):
            read(path)
