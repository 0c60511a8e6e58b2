# SPDX-License-Identifier: BSD-3-Clause
"""Paths of both hands that carry a box: do the hands stay where they hold it?"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.check import rotation_distance

if TYPE_CHECKING:
    from bench.chain import Array
    from bench.whole_body.robots import Body

WAYPOINTS = 200
SIDEWAYS, UP, TURN = 0.1, 0.1, 0.3
"""How far the box goes and comes back [m], and turns meanwhile [rad]."""
JUMP = 0.3
"""A step of a joint that is larger is no motion [rad]: others have some hundredths."""
IN_FRAME_OF = [None, 0]
"""The right hand is told where the left one sees it."""
PARTS = (0.25, 0.5, 0.75)
"""Of the way between two waypoints, joints on straight lines."""


def box_path(hands: Array) -> Array:
    """The left hand's poses and the right one's as that sees it, (N, 2, 4, 4).

    Args:
        hands: T_base_tip of both where they grasp the box, (2, 4, 4).
    """
    t = np.linspace(0.0, 1.0, WAYPOINTS)
    path = np.repeat(hands[None], WAYPOINTS, axis=0)
    path[:, 1] = np.linalg.inv(hands[0]) @ hands[1]
    path[:, 0, 0, 3] += SIDEWAYS * (1.0 - np.cos(2.0 * np.pi * t)) / 2.0
    path[:, 0, 2, 3] += UP * np.sin(np.pi * t)
    for i, yaw in enumerate(TURN * np.sin(np.pi * t)):
        turn = np.asarray(iksel.pose_from_euler([0, 0, 0], [0, 0, yaw]))[:3, :3]
        path[i, 0, :3, :3] = turn @ hands[0, :3, :3]
    return path


def apart(body: Body, q: Array, between: Array) -> tuple[float, float]:
    """How far the hands ever are from where they hold the box [m], [rad]."""
    left, right = np.moveaxis(body.fk(q), 1, 0)
    seen = np.linalg.inv(left) @ right
    held = np.repeat(between[None, :3, :3], len(q), axis=0)
    position = np.linalg.norm(seen[:, :3, 3] - between[:3, 3], axis=1)
    return float(position.max()), float(rotation_distance(seen[:, :3, :3], held).max())


def carried(body: Body, count: int, seed: int) -> dict[str, Any]:
    """What paths from random configurations come to, on one robot."""
    solver = iksel.Solver(body.robot)
    starts = body.random_configurations(count, seed)
    spent, wrong, ended, at, amid = 0.0, 0, 0, [], []
    jumps, needless, lost = [], [], []
    for i, (start, hands) in enumerate(zip(starts, body.fk(starts), strict=True)):
        path = box_path(hands)
        begun = time.perf_counter()
        result = solver.solve_path(path, start=start, in_frame_of=IN_FRAME_OF)
        spent += time.perf_counter() - begun
        if not result:
            ended += 1
            there = path[result.first_unreachable]
            if solver.solve(there, in_frame_of=IN_FRAME_OF):
                lost.append(i)
            continue
        goals = path.copy()
        goals[:, 1] = path[:, 0] @ path[:, 1]
        wrong += not body.right(goals, result.q).all()
        at.append(apart(body, result.q, path[0, 1]))
        if result.largest_step > JUMP:
            jumps.append(i)
            if largest_step_by_near(solver, path, start) <= JUMP:
                needless.append(i)
            continue
        steps = np.diff(result.q, axis=0)
        q = np.concatenate([result.q[:-1] + part * steps for part in PARTS])
        amid.append(apart(body, q, path[0, 1]))
    return {
        "paths": count,
        "ended": ended,
        "lost": lost,
        "wrong": wrong,
        "apart": np.max(at, axis=0, initial=0.0).tolist() if at else [0.0, 0.0],
        "apart_between": np.max(amid, axis=0).tolist() if amid else [0.0, 0.0],
        "jumps": jumps,
        "needless": needless,
        "s_each": spent / count,
    }


def largest_step_by_near(solver: iksel.Solver, path: Array, start: Array) -> float:
    """The same path, each waypoint from the one before; infinite where that ends."""
    largest, q = 0.0, start
    for waypoint in path:
        result = solver.solve(waypoint, near=q, in_frame_of=IN_FRAME_OF)
        if not result:
            return np.inf
        largest = max(largest, float(np.abs(result.q - q).max()))
        q = result.q
    return largest
