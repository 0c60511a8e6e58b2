# SPDX-License-Identifier: BSD-3-Clause
"""Joints that follow others by a curve: a cylinder at a hinge, a four-bar linkage."""

import pickle

import curve_arms
import numpy as np
import pytest

import iksel
from iksel import reach

CLOSE = 1e-9


@pytest.fixture(scope="module")
def robot() -> iksel.Robot:
    return curve_arms.load()


@pytest.fixture(scope="module")
def plain() -> iksel.Robot:
    return iksel.load_robot(curve_arms.description(followers=False), tip_link="flange")


@pytest.fixture(scope="module")
def solver(robot: iksel.Robot) -> iksel.Solver:
    return iksel.Solver(robot)


def test_drives_are_the_degrees_of_freedom(robot: iksel.Robot) -> None:
    assert robot.joint_names[:3] == ["joint_1", "cylinder", "crank"]
    assert robot.joint_types[2].name == "revolute"
    np.testing.assert_allclose(
        (robot.lower[1:3], robot.upper[1:3]),
        np.transpose([curve_arms.CYLINDER, curve_arms.CRANK]),
    )


def test_fk_is_that_of_the_linkages_in_closed_form(
    robot: iksel.Robot, plain: iksel.Robot
) -> None:
    for q in robot.random_configurations(1000, seed=1):
        expected = plain.fk(curve_arms.joints_of(q))
        np.testing.assert_allclose(robot.fk(q), expected, atol=CLOSE)


def test_jacobian_is_the_derivative(robot: iksel.Robot) -> None:
    h = 1e-6
    for q in robot.random_configurations(100, seed=2):
        jacobian = robot.jacobian(q)
        pose = robot.fk(q)
        for j in range(robot.dof):
            step = np.zeros(robot.dof)
            step[j] = h
            change = (robot.fk(q + step) - robot.fk(q - step)) / (2 * h)
            turn = change[:3, :3] @ pose[:3, :3].T
            spin = [turn[2, 1], turn[0, 2], turn[1, 0]]
            np.testing.assert_allclose(jacobian[:3, j], change[:3, 3], atol=1e-5)
            np.testing.assert_allclose(jacobian[3:, j], spin, atol=1e-5)


def test_links_are_where_the_linkages_put_them(
    robot: iksel.Robot, plain: iksel.Robot
) -> None:
    for q in robot.random_configurations(20, seed=3):
        poses = dict(zip(robot.link_names, robot.link_poses(q), strict=True))
        expected = plain.link_poses(curve_arms.joints_of(q))
        for link, pose in zip(plain.link_names, expected, strict=True):
            np.testing.assert_allclose(poses[link], pose, atol=CLOSE)


def test_every_pose_is_solved(robot: iksel.Robot, solver: iksel.Solver) -> None:
    q = robot.random_configurations(1000, seed=4)
    targets = robot.fk(q)
    results = solver.solve_batch(targets)
    assert results.success.all()
    assert robot.within_limits(results.q).all()
    np.testing.assert_allclose(robot.fk(results.q), targets, atol=2e-6)
    q = [solver.solve(target).q for target in targets[:50]]
    assert robot.within_limits(q).all()
    np.testing.assert_allclose(robot.fk(q), targets[:50], atol=2e-6)


def test_near_a_configuration_is_that_configuration(
    robot: iksel.Robot, solver: iksel.Solver
) -> None:
    for q in robot.random_configurations(100, seed=5):
        np.testing.assert_allclose(solver.solve(robot.fk(q), near=q).q, q, atol=1e-4)


def test_all_solutions_are_those_of_the_arms_own_joints(
    robot: iksel.Robot, solver: iksel.Solver, plain: iksel.Robot
) -> None:
    """The curves rise, so that each angle belongs to one value of its drive."""
    every = iksel.Solver(plain)
    ends = [curve_arms.joints_of(end) for end in (robot.lower, robot.upper)]
    for q in robot.random_configurations(60, seed=6):
        target = robot.fk(q)
        joints = every.solve_all(target).q
        inside = np.all(
            (joints >= ends[0] - CLOSE) & (joints <= ends[1] + CLOSE), axis=1
        )
        found = solver.solve_all(target).q
        got = np.array([curve_arms.joints_of(each) for each in found])
        for each in joints[inside]:
            assert np.abs(got - each).max(axis=1).min() < 1e-3
        assert len(found) == inside.sum()


def test_paths_are_followed(robot: iksel.Robot, solver: iksel.Solver) -> None:
    a, b = robot.random_configurations(2, seed=7)
    b = a + 0.05 * (b - a)
    joints = np.linspace(a, b, 40)
    path = solver.solve_path(robot.fk(joints))
    assert path.success
    np.testing.assert_allclose(robot.fk(path.q), robot.fk(joints), atol=2e-6)


def test_scenes_see_the_links_where_they_are(robot: iksel.Robot) -> None:
    """Of random answers those that touch are those whose spheres do."""
    spheres = iksel.RobotSpheres({"link_3": [[0.3, 0.0, 0.0, 0.1]]})
    scene = iksel.Scene(robot, spheres)
    ball = np.eye(4)
    ball[:3, 3] = (0.9, 0.0, 1.2)
    scene.add_sphere("ball", 0.35, ball)
    link = robot.link_names.index("link_3")
    touched = 0
    for q in robot.random_configurations(300, seed=8):
        centre = (robot.link_poses(q)[link] @ [0.3, 0, 0, 1])[:3]
        expected = np.linalg.norm(centre - ball[:3, 3]) < 0.45
        assert bool(scene.contacts(q)) == expected
        touched += expected
    assert 10 < touched < 290


def test_the_closest_pose_is_inside_the_ends(
    robot: iksel.Robot, solver: iksel.Solver
) -> None:
    target = robot.fk(robot.random_configurations(1, seed=9)[0])
    target[:3, 3] *= 3
    result = solver.solve(target, closest=True)
    assert result.status.name == "closest"
    assert robot.within_limits(result.q)


def test_a_locked_drive_holds_its_joint(plain: iksel.Robot) -> None:
    held = curve_arms.load(locked_joints={"crank": 0.4})
    assert held.dof == 5
    q = held.random_configurations(1, seed=10)[0]
    joints = curve_arms.joints_of(np.insert(q, 2, 0.4))
    np.testing.assert_allclose(held.fk(q), plain.fk(joints), atol=CLOSE)
    with pytest.raises(iksel.InvalidArgumentError, match="'crank': 2 is beyond the"):
        curve_arms.load(locked_joints={"crank": 2.0})


def test_limits_of_the_follower_narrow_the_drive() -> None:
    text = curve_arms.description().replace(
        '<limit lower="-3.1" upper="3.1"', '<limit lower="-0.2" upper="0.3"', 2
    )
    curves = [curve_arms.curve(name) for name in ("joint_2", "joint_3")]
    robot = iksel.load_robot(text, tip_link="flange", mimic_curves=curves)
    for end, expected in [(robot.lower, -0.2), (robot.upper, 0.3)]:
        np.testing.assert_allclose(curve_arms.joints_of(end)[1:3], expected, atol=1e-8)


def test_splines_come_near_the_function() -> None:
    length = np.linspace(*curve_arms.CYLINDER, 60)
    points = iksel.MimicCurve(
        "joint_2", "cylinder", length, curve_arms.shoulder(length)[0]
    )
    curves = [points, curve_arms.curve("joint_3")]
    splined = iksel.load_robot(
        curve_arms.description(), tip_link="flange", mimic_curves=curves
    )
    robot = curve_arms.load()
    for q in robot.random_configurations(200, seed=11):
        np.testing.assert_allclose(splined.fk(q), robot.fk(q), atol=1e-5)


def test_straight_curves_are_mimic_tags() -> None:
    tag = '<mimic joint="joint_2" multiplier="0.7" offset="0.1"/>'
    marker = '<axis xyz="0 1 0"/>'
    text = curve_arms.description(followers=False)
    head, third = text.split('<joint name="joint_3"')
    tagged = head + '<joint name="joint_3"' + third.replace(marker, marker + tag, 1)
    by_tag = iksel.load_robot(tagged, tip_link="flange")
    ends = np.array([by_tag.lower[1], by_tag.upper[1]])
    line = iksel.MimicCurve("joint_3", "joint_2", ends, 0.7 * ends + 0.1)
    by_curve = iksel.load_robot(text, tip_link="flange", mimic_curves=[line])
    # A curve takes the place of the tag.
    both = iksel.load_robot(tagged, tip_link="flange", mimic_curves=[line])
    for robot in (by_curve, both):
        np.testing.assert_allclose(robot.lower, by_tag.lower)
        q = by_tag.random_configurations(100, seed=12)
        np.testing.assert_allclose(robot.fk(q), by_tag.fk(q), atol=1e-12)


def test_joints_may_mimic_one_that_follows_a_curve(plain: iksel.Robot) -> None:
    """The hand is held level by a second linkage."""
    head, fifth = curve_arms.description().split('<joint name="joint_5"')
    axis = '<axis xyz="0 1 0"/>'
    tag = '<mimic joint="joint_2" multiplier="-0.5" offset="0.2"/>'
    text = head + '<joint name="joint_5"' + fifth.replace(axis, axis + tag, 1)
    curves = [curve_arms.curve(name) for name in ("joint_2", "joint_3")]
    robot = iksel.load_robot(text, tip_link="flange", mimic_curves=curves)
    assert robot.dof == 5
    for q in robot.random_configurations(100, seed=13):
        joints = curve_arms.joints_of(np.insert(q, 4, 0.0))
        joints[4] = -0.5 * joints[1] + 0.2
        np.testing.assert_allclose(robot.fk(q), plain.fk(joints), atol=CLOSE)


def test_robots_and_curves_are_pickled(robot: iksel.Robot) -> None:
    again = pickle.loads(pickle.dumps(robot))
    assert again.chain_hash == robot.chain_hash
    assert again.mimic_curves == robot.mimic_curves
    q = robot.random_configurations(10, seed=14)
    np.testing.assert_array_equal(again.fk(q), robot.fk(q))


def test_databases_are_of_one_curve(robot: iksel.Robot, plain: iksel.Robot) -> None:
    line = iksel.MimicCurve("joint_2", "cylinder", [0.42, 0.72], [-0.4, 0.8])
    other = iksel.load_robot(
        curve_arms.description(),
        tip_link="flange",
        mimic_curves=[line, curve_arms.curve("joint_3")],
    )
    assert len({robot.chain_hash, plain.chain_hash, other.chain_hash}) == 3


def test_maps_keep_the_curves(robot: iksel.Robot) -> None:
    plan = reach.plan(robot, spacing=0.5)
    assert plan.robot().mimic_curves == robot.mimic_curves


BENT = ([0.42, 0.6, 0.72], [0.1, 0.5, 0.2])


@pytest.mark.parametrize(
    ("curves", "message"),
    [
        (curve_arms.CRANK, r"mimic_curves\[0\]: expected a MimicCurve"),
        ("curves", "mimic_curves: expected a sequence of MimicCurve"),
        (
            [iksel.MimicCurve("joint_9", "cylinder", *BENT)],
            r"mimic_curves\[0\] .*'joint_9' is not in the URDF",
        ),
        (
            [iksel.MimicCurve("joint_2", "cylinder_1", *BENT)],
            "'cylinder_1' is not in the URDF.*cylinder",
        ),
        (
            [iksel.MimicCurve("flange_joint", "cylinder", *BENT)],
            "'flange_joint' is fixed",
        ),
        (
            [iksel.MimicCurve("joint_2", "flange_joint", *BENT)],
            "'flange_joint', which is fixed",
        ),
        ([iksel.MimicCurve("joint_2", "cylinder", [0.5], [0])], "q: expected 2 to"),
        (
            [iksel.MimicCurve("joint_2", "cylinder", [0.5, 0.4], [0, 1])],
            r"q\[1\] is 0.4 after 0.5",
        ),
        (
            [iksel.MimicCurve("joint_2", "cylinder", [0.4, 0.5], [0, 1, 2])],
            "values: expected 2 numbers, as there are of q, got 3",
        ),
        (
            [iksel.MimicCurve("joint_2", "cylinder", [0.4, 0.5], [0, np.nan])],
            r"values\[1\] is",
        ),
        (
            [iksel.MimicCurve("joint_2", "cylinder", *BENT, [1, 2])],
            "slopes: expected 3 numbers",
        ),
        (
            [iksel.MimicCurve("joint_2", "cylinder", *BENT)] * 2,
            r"mimic_curves\[1\].*has another curve",
        ),
        (
            [
                iksel.MimicCurve("joint_3", "joint_2", *BENT),
                iksel.MimicCurve("joint_2", "cylinder", *BENT),
            ],
            "'joint_2' follows a joint itself",
        ),
        (
            [iksel.MimicCurve("joint_2", "cylinder", [0.8, 0.9], [0, 1])],
            "'cylinder' has no usable limits",
        ),
        (
            [iksel.MimicCurve("joint_2", "cylinder", [0.42, 0.72], [4, 5])],
            "'joint_2': its limits.*leave no part of its curve",
        ),
        (
            [
                iksel.MimicCurve(
                    "joint_2", "cylinder", [0.42, 0.5, 0.6, 0.72], [0, 4, 4, 0]
                )
            ],
            "'joint_2': its limits.*or several",
        ),
    ],
)
def test_bad_curves_name_what_is_wrong(curves: object, message: str) -> None:
    with pytest.raises(iksel.Error, match=message):
        iksel.load_robot(
            curve_arms.description(),
            tip_link="flange",
            mimic_curves=curves,  # type: ignore[arg-type]
        )


def test_coupled_limits_are_not_of_followers() -> None:
    limit = iksel.CoupledLimit({"joint_2": 1, "joint_4": 1}, lower=-1)
    with pytest.raises(iksel.InvalidArgumentError, match="'cylinder' by a curve"):
        curve_arms.load(coupled_limits=[limit])


def test_a_slope_of_another_function_is_refused() -> None:
    with pytest.raises(iksel.InvalidArgumentError, match="slope is not its derivative"):
        iksel.MimicCurve.sampled("a", "b", 0, 1, np.sin, np.sin)
    with pytest.raises(iksel.InvalidArgumentError, match="value nan"):
        iksel.MimicCurve.sampled("a", "b", 0, 1, lambda _: np.nan, np.cos)
    with pytest.raises(iksel.InvalidArgumentError, match="lower 1, upper 0"):
        iksel.MimicCurve.sampled("a", "b", 1, 0, np.sin, np.cos)
    with pytest.raises(ZeroDivisionError):
        iksel.MimicCurve.sampled("a", "b", 0, 1, lambda q: 1 / q, np.cos)
    with pytest.raises(iksel.InvalidArgumentError, match="function: expected a call"):
        iksel.MimicCurve.sampled("a", "b", 0, 1, 3, np.cos)  # type: ignore[arg-type]
