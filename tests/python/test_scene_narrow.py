# SPDX-License-Identifier: BSD-3-Clause
"""Scenes that leave of an arm's self-motion only a little: it is found all the same."""

from __future__ import annotations

import numpy as np
import pytest

import iksel

SEED = 1
CASES = 40
RADIUS = 0.04
"""Of the one ball on the arm, at its elbow [m]."""
GAP = 0.001
"""How much farther away the nearest point is [m]."""
ARMS = {"panda": "panda_link4", "iiwa14": "link_4", "xarm7": "link4"}


def crowded(
    robot: iksel.Robot, solver: iksel.Solver, link: str, q: np.ndarray
) -> iksel.Scene:
    """Points at the elbows of all solutions of q's pose but those that q is near to."""
    scene = iksel.Scene(robot, iksel.RobotSpheres({link: [[0, 0, 0, RADIUS]]}))
    at = robot.link_names.index(link)
    elbow = robot.link_poses(q)[at][:3, 3]
    solutions = solver.solve_all(robot.fk(q), max=1000).q
    others = np.array([robot.link_poses(each)[at][:3, 3] for each in solutions])
    far = np.linalg.norm(others - elbow, axis=1) > RADIUS + GAP
    if far.any():
        scene.add_points("others", others[far], radius=1e-6)
    return scene


def known(robot: iksel.Robot, solver: iksel.Solver, where: str) -> np.ndarray:
    """Configurations in the middle of arcs, or at ends of them, at a limit or fold."""
    some = robot.random_configurations(CASES, seed=SEED)
    if where == "middle":
        beside = np.minimum(some - robot.lower, robot.upper - some).min(axis=1)
        return some[beside > 0.05]
    longest = [
        max(solver.self_motion(robot.fk(q)), key=lambda arc: arc.length) for q in some
    ]
    return np.array([arc.q[0] for arc in longest if not arc.is_closed])


@pytest.mark.parametrize(("where", "least"), [("middle", 0.85), ("end", 0.9)])
def test_what_little_is_free_is_found(where, least) -> None:
    """Of samples alone, 81 and 63 % led there."""
    found = cases = 0
    for name, link in ARMS.items():
        robot = iksel.load_robot(name)
        solver = iksel.Solver(robot)
        for q in known(robot, solver, where):
            scene = crowded(robot, solver, link, q)
            if not scene.is_free(q):
                continue
            result = solver.solve(robot.fk(q), scene=scene)
            assert not result or scene.is_free(result.q)
            cases += 1
            found += result.success
    assert cases > 80
    assert found >= least * cases, f"{found} of {cases}, seed {SEED}"


def test_what_is_free_between_points_of_the_curve_is_found() -> None:
    """Of 3 mm of the elbow's way, where the arm is, or beside it.

    Of 29 poses 13 had been lost where it is and something else is preferred.
    """
    robot = iksel.load_robot("iiwa14")
    solver = iksel.Solver(robot)
    at = robot.link_names.index(ARMS["iiwa14"])
    random = np.random.default_rng(SEED)
    for q in 0.6 * robot.random_configurations(CASES, SEED):
        pose = robot.fk(q)
        arcs = solver.self_motion(pose, spacing=0.02)
        every = np.concatenate([np.array(arc.q) for arc in arcs])
        elbows = np.array([robot.link_poses(each)[at][:3, 3] for each in every])
        away = np.linalg.norm(elbows - robot.link_poses(q)[at][:3, 3], axis=1)
        radius = 0.9 * away[away > 0.003].min()
        spheres = iksel.RobotSpheres({ARMS["iiwa14"]: [[0, 0, 0, radius]]})
        scene = iksel.Scene(robot, spheres)
        scene.add_points("others", elbows[away > 0.003], radius=1e-6)
        if away.max() < 0.1 or not scene.is_free(q):
            continue
        posture = np.clip(q + random.uniform(-1, 1, 7), robot.lower, robot.upper)
        preferred = iksel.Objective.near_posture(posture)
        assert solver.solve(pose, near=q, scene=scene, objective=preferred)
        if solver.solve(pose, scene=scene):
            beside = np.clip(
                q + random.uniform(-0.02, 0.02, 7), robot.lower, robot.upper
            )
            assert solver.solve(pose, near=beside, scene=scene)
