# SPDX-License-Identifier: BSD-3-Clause
"""Laws of closest=True on random arms: no step inside the limits lowers it, and of
what many descents find nothing is nearer; with coupled limits, and of tasks."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import CASES

import iksel

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench.closest import missing as missing_by_weights
from bench.random_arms import BUILDS, random_arm, sketch

DESCENTS = 100


def random_limits(
    robot: iksel.Robot, count: int, rng: np.random.Generator
) -> list[iksel.CoupledLimit]:
    """Sums of two or three joints, each of which the limits of the joints overrun."""
    ends = np.isfinite(robot.lower)
    limits = []
    for _ in range(count):
        joints = rng.permutation(np.flatnonzero(ends))[: int(rng.integers(2, 4))]
        factors = rng.choice([1.0, -1.0, 0.5, -0.7], len(joints))
        lower, upper = robot.lower[joints], robot.upper[joints]
        half = float(np.abs(factors) @ (upper - lower)) / 2
        middle = float(factors @ (upper + lower)) / 2
        names = [robot.joint_names[j] for j in joints]
        low, high = half * rng.uniform(0.1, 0.6, 2)
        coefficients = dict(zip(names, factors.tolist(), strict=True))
        limits.append(iksel.CoupledLimit(coefficients, middle - low, middle + high))
    return limits


def bound_arm(build: str, seed: int, rows: int) -> iksel.Robot:
    """A random arm with so many random coupled limits."""
    urdf = sketch(build, seed).urdf()
    robot = iksel.Robot.from_urdf(urdf, "l0", "tip")
    if not rows:
        return robot
    limits = random_limits(robot, rows, np.random.default_rng(seed))
    return iksel.Robot.from_urdf(urdf, "l0", "tip", coupled_limits=limits)


def strange_poses(robot: iksel.Robot, count: int, seed: int) -> list[np.ndarray]:
    """Positions of some configurations with rotations of others, farther or nearer."""
    q = robot.random_configurations(2 * count, seed=seed)
    poses = robot.fk(q[::2])
    poses[:, :3, :3] = robot.fk(q[1::2])[:, :3, :3]
    poses[:, :3, 3] *= (1.2 + 0.4 * np.sin(np.arange(count)))[:, None]
    return list(poses)


def rows_of(robot: iksel.Robot) -> tuple[np.ndarray, np.ndarray]:
    """All limits as rows . q <= ends: of joints, and of sums."""
    sums = [
        [limit.coefficients.get(name, 0.0) for name in robot.joint_names]
        for limit in robot.coupled_limits
    ]
    upper = [limit.upper for limit in robot.coupled_limits]
    lower = [limit.lower for limit in robot.coupled_limits]
    one = np.vstack([np.eye(robot.dof), *(np.array([row]) for row in sums)])
    ends = np.concatenate([robot.upper, upper, -robot.lower, -np.array(lower)])
    is_limited = np.isfinite(ends)
    return np.vstack([one, -one])[is_limited], ends[is_limited]


def missing(
    robot: iksel.Robot, pose: np.ndarray, q: np.ndarray
) -> tuple[float, np.ndarray]:
    """Half the square of what is missing by the default weights, and its gradient."""
    reached = robot.fk(q)
    turn = np.eye(4)
    turn[:3, :3] = reached[:3, :3] @ pose[:3, :3].T
    weight2 = (robot.reach / 4) ** 2
    away = reached[:3, 3] - pose[:3, 3]
    turned = iksel.rotation_vector_from_pose(turn)
    jacobian = robot.jacobian(q)
    value = 0.5 * (away @ away + weight2 * turned @ turned)
    return float(value), jacobian.T @ np.concatenate([away, weight2 * turned])


def steepest(rows: np.ndarray, gradient: np.ndarray) -> np.ndarray:
    """The steepest direction downhill that no row of limits forbids: by its dual."""
    unit = rows / np.linalg.norm(rows, axis=1, keepdims=True)
    y = np.zeros(len(unit))
    for _ in range(500):
        for i in range(len(unit)):
            y[i] = max(0.0, y[i] - unit[i] @ (gradient + unit.T @ y))
    return -(gradient + unit.T @ y)


def lowest_along(
    robot: iksel.Robot, pose: np.ndarray, q: np.ndarray
) -> tuple[float, float]:
    """What is missing at q, and the least of it downhill inside the limits."""
    rows, ends = rows_of(robot)
    value, gradient = missing(robot, pose, q)
    way = steepest(rows[rows @ q > ends - 1e-9], gradient)
    least = value
    for length in np.geomspace(1e-4, 1, 20):
        beside = q + length * way / max(np.linalg.norm(way), 1e-12)
        if (rows @ beside <= ends + 1e-9).all():
            least = min(least, missing(robot, pose, beside)[0])
    return float(np.sqrt(2 * value)), float(np.sqrt(2 * least))


@pytest.mark.parametrize("rows", [0, 1, 3])
def test_no_step_inside_the_limits_lowers_it(rows: int) -> None:
    tried = 0
    for seed in range(max(1, CASES // 100)):
        for build in BUILDS:
            robot = bound_arm(build, seed, rows)
            solver = iksel.Solver(robot)
            for i, pose in enumerate(strange_poses(robot, 15, seed)):
                result = solver.solve(pose, closest=True)
                if result.status != iksel.Status.closest:
                    continue
                assert robot.within_limits(result.q)
                here, beside = lowest_along(robot, pose, result.q)
                assert beside > (1 - 1e-3) * here, f"{build}, seed {seed}, pose {i}"
                tried += 1
    assert tried > 30


def farther(robot: iksel.Robot, seed: int, **wish: object) -> tuple[int, int]:
    """Of how many targets many descents come nearer, and of how many there were."""
    solver = iksel.Solver(robot)
    patient = iksel.Solver(robot, iksel.SolverOptions(max_attempts=DESCENTS))
    seeds = robot.random_configurations(DESCENTS, seed=seed + 1)
    worse = tried = 0
    weight = robot.reach / 4
    for pose in strange_poses(robot, 10, seed):
        one = solver.solve(pose, closest=True, **wish)
        if one.status != iksel.Status.closest:
            continue
        many = patient.solve(
            pose, closest=True, seeds=seeds, database_seeds=False, **wish
        )
        errors = [
            np.hypot(result.position_error, weight * result.rotation_error)
            for result in (one, many)
        ]
        worse += errors[0] > 1.01 * errors[1] + 1e-6
        tried += 1
    return worse, tried


ASKED = {
    "pose": (0, None),
    "two sums": (2, None),
    "four sums": (4, None),
    "planar": (0, iksel.Task.planar()),
    "twist": (0, iksel.Task.box((0, 0, 0), (np.pi, np.pi, 0))),
    "box": (0, iksel.Task.box((0.05, 0.05, 0), (0.1, 1.5, np.pi))),
}


@pytest.mark.parametrize("name", ASKED)
def test_it_comes_as_near_as_many_descents(name: str) -> None:
    rows, task = ASKED[name]
    wish = {} if task is None else {"task": task}
    worse = tried = 0
    for seed in range(max(1, CASES // 100)):
        for build in BUILDS:
            counts = farther(bound_arm(build, seed, rows), seed, **wish)
            worse, tried = worse + counts[0], tried + counts[1]
    assert tried > 20
    assert worse <= 1 + 0.015 * tried, f"{worse} of {tried}"


SHARES = [(1, 0.3, 0.1), (3, 1, 0.3), (0.05, 1, 1), (0, 1, 1)]
"""Of the default weight, by which rotations about the target's axes count."""


def test_it_comes_as_near_where_rotations_weigh_unlike() -> None:
    worse = tried = 0
    for seed in range(max(1, CASES // 200)):
        for build in BUILDS:
            arm = random_arm(build, seed)
            solver = iksel.Solver(arm.robot)
            options = iksel.SolverOptions(max_attempts=DESCENTS)
            patient = iksel.Solver(arm.robot, options, solver.database)
            seeds = arm.robot.random_configurations(DESCENTS, seed=seed + 1)
            for i, pose in enumerate(strange_poses(arm.robot, 10, seed)):
                turned = np.array(SHARES[i % len(SHARES)]) * arm.robot.reach / 4
                weights = np.concatenate([np.ones(3), turned])
                one = solver.solve(pose, closest=weights)
                if one.status != iksel.Status.closest:
                    continue
                many = patient.solve(
                    pose, closest=weights, seeds=seeds, database_seeds=False
                )
                q = np.array([one.q, many.q])
                left = missing_by_weights(arm, np.array([pose, pose]), q, weights)
                worse += left[0] > 1.01 * left[1] + 1e-6
                tried += 1
    assert tried > 20
    assert worse <= 0.01 * tried, f"{worse} of {tried}"
