# SPDX-License-Identifier: BSD-3-Clause
"""Cells on requests: moves of redundant arms beside a solver's, and paths.

Every answer is judged by bench.chain.
"""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import iksel
from bench.arms import load_arm
from bench.branches import LIMIT_S, TURN, near_of
from bench.check import errors, right
from bench.rivals import RIVALS
from bench.rivals.optik import OptIkQuality
from bench.timing import time_calls

if TYPE_CHECKING:
    from collections.abc import Callable

    from bench.arms import Arm
    from bench.chain import Array, Chain
    from bench.store import Settings
    from bench.targets import Targets


def near_moves(arm: Arm, goals: Targets, settings: Settings) -> dict[str, Any]:
    """Largest joint moves of our answers, and of a solver's from the same seed."""
    chain = arm.chain
    near = np.clip(near_of(goals, settings["seed"]), chain.lower, chain.upper)
    make = OptIkQuality if settings.get("quality") else RIVALS[settings["rival"]]
    run = make(arm).run(replace(goals, starts=near))
    done = len(run.answers)
    theirs = np.array([q[0] if q else np.full(chain.dof, np.nan) for q in run.answers])
    result = {
        "count": done,
        "rival": _moves(chain, goals.poses[:done], near[:done], theirs),
        "rival_mean_us": float(np.mean(run.times_ns)) / 1e3,
    }
    solver = iksel.Solver(arm.robot)
    for norm in (iksel.MoveNorm.two, iksel.MoveNorm.max):
        times, answers = time_calls(
            lambda pose, q, norm=norm: solver.solve(pose, near=q, norm=norm),
            list(zip(goals.poses[:done], near[:done], strict=True)),
            LIMIT_S,
        )
        q = np.array([answer.q for answer in answers])
        found = _moves(chain, goals.poses[:done], near[:done], q)
        result[norm.name] = {**found, "mean_us": float(times.mean()) / 1e3}
    return result


def _moves(chain: Chain, poses: Array, near: Array, q: Array) -> dict[str, Any]:
    good = right(chain, poses, q)
    largest = np.abs(q[good] - near[good]).max(axis=1)
    return {
        "right": int(good.sum()),
        "median_largest": float(np.median(largest)),
        "p99_largest": float(np.quantile(largest, 0.99)),
    }


class Path(NamedTuple):
    """A path to follow."""

    poses: Array
    """T_base_tip, (N, 4, 4) [m]."""
    dt: float
    """Time between two [s]."""
    start: Array | None = None
    """Where the arm is before, (dof,) [rad]; None: the solver chooses the branch."""


def panda_line(arm: Arm) -> Path:
    """1 m straight to the left at 1 mm and 0.1 m/s, the hand pointing down."""
    del arm
    poses = np.tile(np.diag([1.0, -1.0, -1.0, 1.0]), (1001, 1, 1))
    poses[:, :3, 3] = [0.45, -0.5, 0.4]
    poses[:, 1, 3] += np.linspace(0.0, 1.0, 1001)
    return Path(poses, 0.01)


WRIST_STRAIGHT = [0.4, -1.2, 1.5, -0.7, 0.0, 0.3]
"""UR3 where joints 4 and 6 are in line: q5 changes its sign there [rad]."""
CIRCLE_RADIUS = 0.08
"""Of the path past it [m]."""
TILT = 0.02
"""Of the tool, which keeps q5 from 0; joints 4 and 6 then turn by half a turn [rad]."""


def _circle(arm: Arm, tilt: float, *, from_there: bool) -> Path:
    """A horizontal circle that comes through the straight wrist half way round."""
    through = arm.chain.fk(np.array([WRIST_STRAIGHT]))[0]
    z = through[:3, 2]
    axis = np.cross(z, [0.0, 0.0, 1.0])
    axis *= tilt / np.linalg.norm(axis)
    rotation = iksel.pose_from_rotation_vector(np.zeros(3), axis)[:3, :3]
    poses = np.tile(through, (401, 1, 1))
    poses[:, :3, :3] = rotation @ through[:3, :3]
    angle = np.linspace(0.0, TURN, 401)
    poses[:, 0, 3] -= CIRCLE_RADIUS * (1.0 + np.cos(angle))
    poses[:, 1, 3] += CIRCLE_RADIUS * np.sin(angle)
    start = iksel.Solver(arm.robot).solve(poses[0], near=WRIST_STRAIGHT).q
    return Path(poses, 0.02, start if from_there else None)


PATHS: dict[str, Callable[[Arm], Path]] = {
    "line": panda_line,
    "flip": lambda arm: _circle(arm, 0.0, from_there=True),
    "flip_beside": lambda arm: _circle(arm, TILT, from_there=True),
    "flip_free": lambda arm: _circle(arm, TILT, from_there=False),
}


def path(settings: Settings) -> dict[str, Any]:
    """A path as a whole, and point by point, each the nearest to the one before."""
    arm = load_arm(settings["robot"])
    poses, dt, from_q = PATHS[settings["path"]](arm)
    solver = iksel.Solver(arm.robot)
    begin = time.perf_counter()
    whole = solver.solve_path(poses, start=from_q, dt=dt)
    middle = time.perf_counter()
    start = whole.q[0] if len(whole.q) else solver.solve(poses[0]).q
    points = [start]
    for pose in poses[1:]:
        answer = solver.solve(pose, near=points[-1])
        if not answer.success:
            break
        points.append(answer.q)
    end = time.perf_counter()
    return {
        "count": len(poses),
        "dt": dt,
        "status": whole.status.name,
        "broken": whole.first_unreachable,
        "path": _smoothness(arm, poses, whole.q, dt),
        "path_s": middle - begin,
        "points": _smoothness(arm, poses, np.array(points), dt),
        "points_s": end - middle,
    }


def _smoothness(arm: Arm, poses: Array, q: Array, dt: float) -> dict[str, Any]:
    """How a sequence of configurations moves; speeds as parts of the limits."""
    steps = np.abs(np.diff(q, axis=0))
    if not len(steps):
        return {"right": 0}
    speed = steps / (dt * arm.robot.velocity_limit)
    return {
        "right": int(right(arm.chain, poses[: len(q)], q).sum()),
        "move": float(np.linalg.norm(steps, axis=1).sum()),
        "largest_step": float(steps.max()),
        "largest_speed": float(speed.max()),
        "too_fast": int(np.count_nonzero((speed > 1.0 + 1e-9).any(axis=1))),
        "position_error": float(errors(arm.chain, poses[: len(q)], q)[0].max()),
    }
