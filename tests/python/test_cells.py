# SPDX-License-Identifier: BSD-3-Clause
"""Two arms as one chain, and arms on rails and at turntables, made by attach."""

from __future__ import annotations

import numpy as np
import pytest

import iksel

RAIL = """<robot name="rail"><link name="floor"/><link name="carriage"/>
<joint name="rail" type="prismatic"><parent link="floor"/><child link="carriage"/>
<axis xyz="0 1 0"/><limit lower="0" upper="3" velocity="1" effort="1"/></joint>
</robot>"""
TABLE = """<robot name="table"><link name="pedestal"/><link name="plate"/>
<joint name="turntable" type="continuous"><parent link="pedestal"/>
<child link="plate"/><axis xyz="0 0 1"/></joint></robot>"""
BEFORE = iksel.pose_from_euler([0.7, 0.1, 0.2], [0.1, 0.0, 0.4])
BESIDE = iksel.pose_from_euler([0.0, -0.6, 0.0], [0.3, 0.0, -0.5])


def two_arms(name: str) -> iksel.Robot:
    tip = iksel.robot_info(name).tip_link
    urdf = iksel.attach(name, name, pose=BESIDE, prefixes=("left_", "right_"))
    return iksel.Robot.from_urdf(urdf, base_link=f"left_{tip}", tip_link=f"right_{tip}")


def on_rail(name: str, rail: str = RAIL) -> iksel.Robot:
    urdf = iksel.attach(rail, name, at="carriage")
    tip = iksel.robot_info(name).tip_link
    return iksel.Robot.from_urdf(urdf, base_link="floor", tip_link=tip)


def at_table(name: str) -> iksel.Robot:
    urdf = iksel.attach(name, TABLE, pose=BEFORE)
    tip = iksel.robot_info(name).tip_link
    return iksel.Robot.from_urdf(urdf, base_link="plate", tip_link=tip)


def rail_shift(value: float) -> np.ndarray:
    """T_floor_carriage."""
    return iksel.pose_from_euler([0, value, 0], [0, 0, 0])


def table_turn(value: float) -> np.ndarray:
    """T_plate_base: the way from the plate up to the arm's base."""
    turned = BEFORE @ iksel.pose_from_euler([0, 0, 0], [0, 0, value])
    return np.linalg.inv(turned)


@pytest.mark.parametrize("name", ["panda", "iiwa14", "ur5e"])
class TestTwoArms:
    """12 and 14 joints from tool to tool."""

    def test_poses_are_of_one_tool_seen_from_the_other(self, name: str) -> None:
        pair = two_arms(name)
        one = iksel.load_robot(name, tcp=None)
        assert pair.dof == 2 * one.dof
        q = pair.random_configurations(200, seed=1)
        left = one.fk(q[:, : one.dof][:, ::-1])
        right = one.fk(q[:, one.dof :])
        expected = np.linalg.inv(left) @ BESIDE @ right
        np.testing.assert_allclose(pair.fk(q), expected, atol=1e-12)

    def test_every_relative_pose_is_solved(self, name: str) -> None:
        pair = two_arms(name)
        solver = iksel.Solver(pair)
        poses = pair.fk(pair.random_configurations(2_000, seed=1))
        batch = solver.solve_batch(poses)
        assert batch.success.all()
        assert pair.within_limits(batch.q).all()
        for pose, q in zip(poses, pair.fk(batch.q), strict=True):
            position, rotation = iksel.pose_error(pose, q)
            assert np.linalg.norm(position) <= 1e-6
            assert np.linalg.norm(rotation) <= 1e-6

    def test_self_motions_of_more_than_one_dimension_are_refused(
        self, name: str
    ) -> None:
        pair = two_arms(name)
        with pytest.raises(iksel.InvalidArgumentError, match="seven joints"):
            iksel.Solver(pair).self_motion(pair.fk(np.zeros(pair.dof)))


EXTERNAL = [
    pytest.param("ur5e", on_rail, rail_shift, 1.2, id="ur5e on a rail"),
    pytest.param("irb120", on_rail, rail_shift, 0.2, id="irb120 on a rail"),
    pytest.param("ur5e", at_table, table_turn, 0.5, id="ur5e at a turntable"),
]


@pytest.mark.parametrize(("name", "make", "place", "preferred"), EXTERNAL)
class TestPreferred:
    """The external axis at the place preferred, or as near to it as may be."""

    def test_it_is_no_farther_from_it_than_brute_force(
        self, name, make, place, preferred
    ) -> None:
        cell = make(name)
        solver = iksel.Solver(cell)
        arm = iksel.Solver(iksel.load_robot(name, tcp=None))
        objective = iksel.Objective.preferred(cell, {cell.joint_names[0]: preferred})
        turns = cell.joint_types[0] is not iksel.JointType.prismatic
        grid = np.linspace(0, np.pi if turns else 3, 601 if turns else 1201)
        poses = cell.fk(cell.random_configurations(60, seed=2))
        moved = 0
        for i, pose in enumerate(poses):
            result = solver.solve(pose, objective=objective)
            assert result, i
            away = abs(result.q[0] - preferred)
            moved += away > 1e-6
            assert cell.within_limits(result.q)
            nearer = [
                v
                for d in grid
                if d < away - 1e-6
                for v in (preferred + d, preferred - d)
            ]
            if not turns:
                nearer = [v for v in nearer if 0 <= v <= 3]
            inner = np.array([np.linalg.inv(place(v)) @ pose for v in nearer])
            if len(inner):
                found = arm.solve_batch(inner).success
                assert not found.any(), (i, away, np.array(nearer)[found])
        assert moved > 0

    def test_near_decides_between_branches(self, name, make, place, preferred) -> None:
        cell = make(name)
        solver = iksel.Solver(cell)
        arm = iksel.Solver(iksel.load_robot(name, tcp=None))
        objective = iksel.Objective.preferred(cell, {cell.joint_names[0]: preferred})
        rng = np.random.default_rng(3)
        for _ in range(60):
            here = cell.random_configurations(1, seed=int(rng.integers(1 << 31)))[0]
            q = here.copy()
            q[0] = preferred
            q[1:] += rng.normal(0, 0.3, 6)
            q = np.clip(q, cell.lower + 1e-3, cell.upper - 1e-3)
            pose = cell.fk(q)
            result = solver.solve(pose, objective=objective, near=here)
            assert result
            assert abs(result.q[0] - preferred) <= 1e-6
            best = arm.solve(np.linalg.inv(place(preferred)) @ pose, near=here[1:])
            move = np.linalg.norm(result.q[1:] - here[1:])
            assert move <= best.move + 1e-4


class TestRail:
    """Seven joints of which the first slides are solved as those that turn."""

    def test_it_is_swept(self) -> None:
        structure = on_rail("ur5e").structure
        assert structure.kind is iksel.StructureKind.swept
        assert "each place of slide 1" in structure.description

    def test_a_no_is_proven(self) -> None:
        cell = on_rail("ur5e")
        solver = iksel.Solver(cell)
        arm = iksel.Solver(iksel.load_robot("ur5e", tcp=None))
        places = np.linspace(0, 3, 601)
        q = cell.random_configurations(100, seed=4)
        poses = cell.fk(q)
        poses[:, :3, :3] = np.roll(poses[:, :3, :3], 1, axis=0)
        noes = 0
        for i, pose in enumerate(poses):
            result = solver.solve(pose)
            inner = np.array([np.linalg.inv(rail_shift(v)) @ pose for v in places])
            if result:
                continue
            noes += 1
            assert not arm.solve_batch(inner).success.any(), i
            assert result.proof is iksel.Proof.intervals
        assert noes > 0

    def test_its_self_motion_reaches_the_pose_all_along(self) -> None:
        cell = on_rail("ur5e")
        solver = iksel.Solver(cell)
        for pose in cell.fk(cell.random_configurations(20, seed=5)):
            motion = solver.self_motion(pose, spacing=0.05)
            assert motion
            for arc in motion:
                for q in arc.q:
                    position, rotation = iksel.pose_error(pose, cell.fk(q))
                    assert np.linalg.norm(position) <= 1e-6
                    assert np.linalg.norm(rotation) <= 1e-6
                    assert cell.within_limits(q)

    def test_near_is_no_farther_than_the_nearest_over_a_fine_grid(self) -> None:
        cell = on_rail("ur5e")
        solver = iksel.Solver(cell)
        arm = iksel.Solver(iksel.load_robot("ur5e", tcp=None))
        q = cell.random_configurations(15, seed=6)
        near = cell.random_configurations(15, seed=7)
        for i, (pose, here) in enumerate(zip(cell.fk(q), near, strict=True)):
            result = solver.solve(pose, near=here)
            best = np.inf
            for v in np.linspace(0, 3, 301):
                inner = np.linalg.inv(rail_shift(v)) @ pose
                answer = arm.solve(inner, near=here[1:])
                if answer:
                    best = min(best, np.hypot(answer.move, v - here[0]))
            assert result.move <= best + 1e-6, i

    def test_a_long_one_is_swept_where_the_arm_can_reach(self) -> None:
        cell = on_rail("ur5e", RAIL.replace('upper="3"', 'upper="300"'))
        solver = iksel.Solver(cell)
        poses = cell.fk(cell.random_configurations(500, seed=8))
        assert all(solver.solve(pose) for pose in poses)


class TestAttach:
    """One URDF of two descriptions."""

    def test_equal_names_are_refused_by_name(self) -> None:
        with pytest.raises(iksel.InvalidArgumentError, match="panda_link0.*prefixes"):
            iksel.attach("panda", "panda")

    def test_an_unknown_link_is_named_with_those_there_are(self) -> None:
        with pytest.raises(iksel.UnknownNameError, match="waggon") as caught:
            iksel.attach(RAIL, "ur5e", at="waggon")
        assert caught.value.available == ("carriage", "floor")

    def test_a_pose_that_is_none_is_refused(self) -> None:
        with pytest.raises(iksel.InvalidArgumentError):
            iksel.attach(RAIL, "ur5e", pose=np.ones((4, 4)))

    def test_meshes_are_found_from_anywhere(self, tmp_path) -> None:
        box = '<visual><geometry><mesh filename="{}"/></geometry></visual>'
        arm = tmp_path / "arm.urdf"
        arm.write_text(
            '<robot name="arm"><link name="a">'
            + box.format("meshes/a.stl")
            + '</link><link name="b">'
            + box.format("package://robot/b.stl")
            + '</link><joint name="j" type="fixed"><parent link="a"/>'
            '<child link="b"/></joint></robot>'
        )
        urdf = iksel.attach(RAIL, arm, at="carriage")
        assert f'filename="{tmp_path}/meshes/a.stl"' in urdf
        assert 'filename="package://robot/b.stl"' in urdf

    def test_mimic_joints_follow_by_their_new_names(self) -> None:
        hand = """<robot name="hand"><link name="palm"/><link name="one"/>
        <link name="two"/><joint name="first" type="prismatic"><parent link="palm"/>
        <child link="one"/><axis xyz="1 0 0"/><limit lower="0" upper="1"/></joint>
        <joint name="second" type="prismatic"><parent link="palm"/><child link="two"/>
        <axis xyz="1 0 0"/><limit lower="-2" upper="0"/>
        <mimic joint="first" multiplier="-2"/></joint></robot>"""
        urdf = iksel.attach(RAIL, hand, at="carriage", prefixes=("", "my_"))
        robot = iksel.Robot.from_urdf(urdf, base_link="my_one", tip_link="my_two")
        assert list(robot.joint_names) == ["my_first"]


class TestPreferredArguments:
    """What Objective.preferred refuses."""

    @pytest.mark.parametrize(
        ("values", "weights", "error", "said"),
        [
            ({"rial": 1.0}, None, iksel.UnknownNameError, "rial"),
            ({}, None, iksel.InvalidArgumentError, "name no joint"),
            ({"rail": 1.0}, {"rail": 0.0}, iksel.InvalidArgumentError, "rail"),
            (
                {"rail": 1.0},
                {"elbow_joint": 2.0},
                iksel.InvalidArgumentError,
                "no preferred value",
            ),
        ],
    )
    def test_it_names_what_is_wrong(self, values, weights, error, said) -> None:
        with pytest.raises(error, match=said):
            iksel.Objective.preferred(on_rail("ur5e"), values, weights)
