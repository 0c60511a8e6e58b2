# SPDX-License-Identifier: BSD-3-Clause
"""Maps and places of the base where configurations are refused."""

from __future__ import annotations

import numpy as np
import pytest
from reach_maps import computed, random_cells

import iksel
from iksel import reach
from iksel.reach._scene_data import at_base, scene_data, scene_of_data

SEED = 40
SETTINGS = {"spacing": 0.3, "orientations": 40}


def only_upright(q: np.ndarray) -> np.ndarray:
    return (np.sin(q[:, 1]) < 0) & (np.sin(q[:, 2]) > 0) & (np.cos(q[:, 3]) > 0)


class Fussy:
    """A filter with a state that pickle takes."""

    def __init__(self, most: float) -> None:
        self.most = most

    def __call__(self, q: np.ndarray) -> np.ndarray:
        return np.abs(q).max(axis=1) < self.most


@pytest.fixture(scope="module")
def robot(made):
    return made.robot("ur5e")


@pytest.fixture(scope="module")
def scene(robot) -> iksel.Scene:
    """One of each kind of obstacle, an object in the hand, and what it may touch."""
    links = {
        "upper_arm_link": [[-0.2, 0, 0.14, 0.08], [-0.4, 0, 0.14, 0.07]],
        "forearm_link": [[-0.2, 0, 0, 0.06]],
        "wrist_3_link": [[0, 0, 0, 0.05]],
    }
    pairs = [("upper_arm_link", "wrist_3_link")]
    made = iksel.Scene(robot, iksel.RobotSpheres(links, pairs))
    pose = iksel.pose_from_euler([0.5, 0.1, 0.2], [0.3, 0.2, 0.1])
    made.add_box("table", [0.6, 1.0, 0.1], pose, margin=0.01)
    made.add_sphere("ball", 0.1, [0, 0.5, 0.4])
    made.add_capsule("rod", 0.05, 0.3, [-0.5, 0, 0.3])
    made.add_cylinder("post", 0.06, 0.8, [0, -0.5, 0.3])
    made.add_half_space("floor", [0, 0, -0.1])
    made.add_points("cloud", [[0.3, 0.3, 0.5], [0.3, 0.35, 0.5]], 0.03)
    made.attach("cup", "wrist_3_link", [[0, 0, 0.1, 0.04]], may_touch=["forearm_link"])
    made.attach("lid", "wrist_3_link", [[0, 0, 0.15, 0.03]], may_touch=["cup"])
    return made


def test_a_scene_is_what_its_data_make(robot, scene) -> None:
    again = scene_of_data(robot, scene_data(scene))
    q = robot.random_configurations(5_000, seed=SEED)
    free = scene.is_free(q)
    assert 0.05 < free.mean() < 0.95
    np.testing.assert_array_equal(again.is_free(q), free)
    assert scene_data(again) == scene_data(scene)


def test_a_scene_keeps_the_values_of_other_joints() -> None:
    def joint(name: str, parent: str, child: str) -> str:
        return f"""<joint name="{name}" type="revolute"><parent link="{parent}"/>
        <child link="{child}"/><origin xyz="0.3 0 0"/><axis xyz="0 0 1"/>
        <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>"""

    links = "".join(f'<link name="{name}"/>' for name in ("base", "arm", "lid"))
    joints = joint("turn", "base", "arm") + joint("hinge", "base", "lid")
    urdf = f'<robot name="box">{links}{joints}</robot>'
    robot = iksel.Robot.from_urdf(urdf, base_link="base", tip_link="arm")
    spheres = iksel.RobotSpheres({"arm": [[0, 0, 0, 0.1]], "lid": [[0, 0, 0, 0.1]]})
    scene = iksel.Scene(robot, spheres, {"hinge": 0.5})
    assert scene.other_joints == {"hinge": 0.5}
    assert scene_of_data(robot, scene_data(scene)).other_joints == {"hinge": 0.5}


@pytest.mark.parametrize("kind", ["scene", "filter", "both"])
def test_cells_are_as_solved_one_by_one(robot, scene, tmp_path, kind: str) -> None:
    request = {"scene": scene, "filter": only_upright}
    request = request if kind == "both" else {kind: request[kind]}
    plan = reach.plan(robot, qualities=["branches"], **SETTINGS, **request)
    assert not plan.first_turn
    assert not plan.last_turn
    reach.create(plan, tmp_path / "map.zarr")
    given = request.get("filter")
    reach.run(tmp_path / "map.zarr", workers=1, filter=given)
    found = reach.open(tmp_path / "map.zarr", filter=given)
    cells = random_cells(found.grid.shape, 600, SEED)
    poses, values = found.poses(cells), found.take(cells)
    solver = iksel.Solver(robot)
    plain = solver.solve_batch(poses)
    alone = solver.solve_batch(poses, **request)
    np.testing.assert_array_equal(values["status"], alone.status)
    assert 0 < alone.solved < plain.solved
    for i in np.flatnonzero(alone.success)[:40]:
        count = len(solver.solve_all(poses[i], **request).q)
        assert values["branches"][i] == max(1, count)
    exact = found.query(poses, exact=True).exact
    np.testing.assert_array_equal(exact.status, alone.status)


def test_other_processes_get_the_filter(robot, tmp_path) -> None:
    settings = {**SETTINGS, "chunk_cells": 4_000, "filter": Fussy(2.0)}
    plan = reach.plan(robot, **settings)
    for name, workers in (("one", 1), ("two", 2)):
        reach.create(plan, tmp_path / name)
        done = reach.run(tmp_path / name, workers=workers, filter=Fussy(2.0))
        assert done.complete
        assert done.chunks > 1
    one, two = (reach.open(tmp_path / name) for name in ("one", "two"))
    np.testing.assert_array_equal(one.array("status"), two.array("status"))
    local = reach.plan(robot, **{**settings, "filter": lambda q: q[:, 0] > 0})
    reach.create(local, tmp_path / "local")
    with pytest.raises(iksel.InvalidArgumentError, match="filter: .*workers=1"):
        reach.run(tmp_path / "local", workers=2, filter=lambda q: q[:, 0] > 0)


def test_a_plan_names_its_filter(robot, tmp_path) -> None:
    plain = reach.plan(robot, **SETTINGS)
    assert "filter" not in plain.to_dict()
    assert "scene" not in plain.to_dict()
    plan = reach.plan(robot, **SETTINGS, filter=only_upright)
    assert plan.to_dict()["filter"] == f"{__name__}.only_upright"
    reach.create(plan, tmp_path / "map")
    reach.create(plain, tmp_path / "plain")
    for path, given, text in (
        ("map", None, "filter is .*only_upright, got none"),
        ("map", Fussy(1.0), "only_upright, got .*Fussy"),
        ("plain", Fussy(1.0), "filter is none, got .*Fussy"),
    ):
        with pytest.raises(reach.PlanMismatchError, match=text):
            reach.run(tmp_path / path, workers=1, filter=given)
    found = reach.open(tmp_path / "map", partial=True)
    with pytest.raises(reach.PlanMismatchError, match="got none"):
        found.query(np.eye(4)[None], exact=True)
    assert not found.query(np.eye(4)[None]).solvable.any()


def test_a_scene_of_another_robot_is_refused(made, scene) -> None:
    with pytest.raises(iksel.InvalidArgumentError, match="scene"):
        reach.plan(made.robot("ur10e"), **SETTINGS, scene=scene)


def test_places_of_the_base_in_a_world(robot, scene, tmp_path) -> None:
    """Obstacles stay where they are in the world, whatever place the base has."""
    found = reach.open(computed(tmp_path / "map", robot, **SETTINGS))
    q = robot.random_configurations(25, seed=SEED)
    poses = robot.fk(q)
    turn = iksel.pose_from_euler([0.1, -0.2, 0.05], [0, 0, 0.7])
    bases = np.stack([np.eye(4), turn])
    solver = iksel.Solver(robot)
    plain = reach.place_base(found, poses, bases=bases)
    for request in ({"scene": scene}, {"filter": only_upright}):
        placements = reach.place_base(found, poses, bases=bases, **request)
        assert len(placements) == 2
        assert sum(p.reached for p in placements) < sum(p.reached for p in plain)
        for placement in placements:
            base = placement.T_world_base
            moved = dict(request)
            if "scene" in moved:
                moved["scene"] = at_base(scene, base)
                for name, obstacle in moved["scene"].obstacles.items():
                    there = base @ obstacle.pose
                    np.testing.assert_allclose(
                        there, scene.obstacles[name].pose, atol=1e-12
                    )
            alone = solver.solve_batch(np.linalg.inv(base) @ poses, **moved)
            assert placement.reached == alone.solved
