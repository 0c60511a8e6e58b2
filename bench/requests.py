# SPDX-License-Identifier: BSD-3-Clause
"""Cells on requests: nearest, all solutions, paths; beside a solver or brute force.

Every answer is judged by bench.chain. A branch is a solution without its whole turns.
"""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import iksel
from bench.arms import load_arm
from bench.check import LIMIT_SLACK, errors, right
from bench.rivals import RIVALS
from bench.rivals.optik import OptIkQuality
from bench.timing import time_calls

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from bench.arms import Arm
    from bench.chain import Array, Chain
    from bench.store import Settings
    from bench.targets import Targets

NOISE = 0.3
"""Deviation of `near` from a solution, every joint [rad]."""
SAME_MOVE = 1e-3
"""Moves that differ by less are the same [rad]: near a singularity answers within the
tolerances of the pose are that far apart."""
APART = 0.01
"""Branches differ by at least this in some joint [rad]: `min_distance`."""
RESTARTS = 1_000
"""Random restarts that a branch count is compared with."""
LIMIT_S = 300.0
"""No further call is timed after this [s]."""
TURN = 2.0 * np.pi


def near_of(goals: Targets, seed: int) -> Array:
    """A solution of each pose with normal noise on every joint, (N, dof) [rad]."""
    noise = np.random.default_rng(seed).normal(0.0, NOISE, goals.witnesses.shape)
    return goals.witnesses + noise


def nearest_turns(chain: Chain, q: Array, near: Array) -> Array:
    """Each row of q, (n, dof), at the whole turns nearest to `near` inside the limits.

    Returns:
        Those rows that have one, (m, dof).
    """
    least = np.ceil((chain.lower - LIMIT_SLACK - q) / TURN)
    most = np.floor((chain.upper + LIMIT_SLACK - q) / TURN)
    turned = q + TURN * np.clip(np.round((near - q) / TURN), least, most)
    return np.asarray(turned[(least <= most).all(axis=1)])


def gap(a: Array, b: Array) -> Array:
    """Largest joint difference without whole turns, (n, dof), (m, dof) -> (n, m)."""
    difference = a[:, None, :] - b[None, :, :]
    difference -= TURN * np.round(difference / TURN)
    return np.asarray(np.abs(difference).max(axis=2))


def distinct(q: Array) -> Array:
    """One of each group of rows that lie nearer than APART, (n, dof) -> (m, dof)."""
    kept: list[Array] = []
    for row in q:
        if not kept or gap(row[None], np.array(kept)).min() >= APART:
            kept.append(row)
    return np.array(kept).reshape(-1, q.shape[1])


def branches_inside(arm: Arm, pose: Array, q: Sequence[Array]) -> Array:
    """What of a solver's branches is right, at a turn inside the limits, (n, dof)."""
    chain = arm.chain
    middle = (chain.lower + chain.upper) / 2.0
    turned = nearest_turns(chain, np.array(q).reshape(-1, chain.dof), middle)
    poses = np.broadcast_to(pose, (len(turned), 4, 4))
    return np.asarray(turned[right(chain, poses, turned)])


def near_branches(arm: Arm, goals: Targets, settings: Settings) -> dict[str, Any]:
    """How often the nearest of all branches of an analytic solver is found."""
    near = near_of(goals, settings["seed"])
    solver = iksel.Solver(arm.robot)
    rival = RIVALS[settings["rival"]](arm).run(goals)
    times, results = time_calls(
        lambda pose, q: solver.solve(pose, near=q),
        list(zip(goals.poses, near, strict=True)),
        LIMIT_S,
    )
    smallest, solved, excess = 0, 0, []
    for pose, q, result, given in zip(
        goals.poses, near, results, rival.answers, strict=True
    ):
        truth = nearest_turns(arm.chain, branches_inside(arm, pose, given), q)
        least = np.linalg.norm(truth - q, axis=1).min(initial=np.inf)
        if not result.success or not right(arm.chain, pose[None], result.q[None])[0]:
            excess.append(np.inf)
            continue
        solved += 1
        excess.append(float(np.linalg.norm(result.q - q)) - least)
        smallest += excess[-1] <= SAME_MOVE
    return {
        "count": len(goals),
        "solved": solved,
        "smallest": int(smallest),
        "shorter": int(np.count_nonzero(np.array(excess) < -SAME_MOVE)),
        "mean_us": float(times.mean()) / 1e3,
        "p99_us": float(np.quantile(times, 0.99)) / 1e3,
        "rival_mean_us": float(rival.times_ns.mean()) / 1e3,
        "missed": [int(i) for i in np.flatnonzero(np.array(excess) > SAME_MOVE)[:50]],
    }


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


def all_branches(arm: Arm, goals: Targets, settings: Settings) -> dict[str, Any]:
    """Whether solve_all has every branch of an analytic solver; how long both take."""
    rival = RIVALS[settings["rival"]](arm).run(goals)
    solver = iksel.Solver(arm.robot)
    times, found = time_calls(solver.solve_all, [(p,) for p in goals.poses], LIMIT_S)
    # The other way round too: what the machine does meanwhile is then in both.
    times_again, _ = time_calls(solver.solve_all, [(p,) for p in goals.poses], LIMIT_S)
    rival_again = RIVALS[settings["rival"]](arm).run(goals)
    same, more, wrong = 0, 0, 0
    missed = []
    for i, (pose, ours, given) in enumerate(
        zip(goals.poses, found, rival.answers, strict=True)
    ):
        q = ours.q
        truth = branches_inside(arm, pose, given)
        wrong += int(
            np.count_nonzero(
                ~right(arm.chain, np.broadcast_to(pose, (len(q), 4, 4)), q)
            )
        )
        # Two that lie APART or nearer may be one to either.
        between = gap(truth, q) if len(q) else np.full((len(truth), 1), np.inf)
        if (between.min(axis=1, initial=np.inf) < 2 * APART).all():
            same += 1
        else:
            missed.append(i)
        if len(q) and len(truth):
            more += bool((between.min(axis=0) >= 2 * APART).any())
    our_us = (times.mean() + times_again.mean()) / 2e3
    their_us = (rival.times_ns.mean() + rival_again.times_ns.mean()) / 2e3
    return {
        "count": len(goals),
        "same": same,
        "more": more,
        "wrong": wrong,
        "branches": sum(len(ours) for ours in found),
        "mean_us": float(our_us),
        "p99_us": float(np.quantile(times, 0.99)) / 1e3,
        "rival_mean_us": float(their_us),
        "missed": missed[:50],
    }


def restarts(arm: Arm, goals: Targets, settings: Settings) -> dict[str, Any]:
    """Branches by solve_all, and by many random restarts of the iteration alone."""
    solver = iksel.Solver(arm.robot)
    times, found = time_calls(solver.solve_all, [(p,) for p in goals.poses], LIMIT_S)
    counts = {"agrees": 0, "more": 0, "fewer": 0, "wrong": 0}
    missed = []
    for i, (pose, ours) in enumerate(zip(goals.poses, found, strict=True)):
        starts = arm.robot.random_configurations(RESTARTS, settings["seed"] + 1 + i)
        single = (
            solver.solve(pose, seeds=q[None], database_seeds=False) for q in starts
        )
        q = np.array([answer.q for answer in single if answer.success])
        truth = len(distinct(q.reshape(-1, arm.chain.dof)))
        verdict = (
            "agrees" if len(ours) == truth else "more" if len(ours) > truth else "fewer"
        )
        counts[verdict] += 1
        if verdict != "agrees":
            missed.append([i, len(ours), truth])
        poses = np.broadcast_to(pose, (len(ours), 4, 4))
        counts["wrong"] += int(np.count_nonzero(~right(arm.chain, poses, ours.q)))
    return {
        "count": len(goals),
        **counts,
        "branches": sum(len(ours) for ours in found),
        "mean_us": float(times.mean()) / 1e3,
        "missed": missed[:50],
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


ON_TARGETS: dict[str, Callable[[Arm, Targets, Settings], dict[str, Any]]] = {
    "near_branches": near_branches,
    "near_moves": near_moves,
    "all_branches": all_branches,
    "restarts": restarts,
}
"""The functions by the names that settings have under "cell"."""
