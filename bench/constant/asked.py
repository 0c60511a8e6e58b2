# SPDX-License-Identifier: BSD-3-Clause
"""What a core with another constant is asked, of arms drawn at random.

Run as a program, it prints a line of JSON: of each kind of question the answers that
failed, a hash of all of them, and the least processor time.
"""

from __future__ import annotations

import hashlib
import json
import sys
import time
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench import random_arms
from bench.branches import TOLERANCE
from bench.laws import postures
from bench.lost import moved
from bench.targets import make_targets
from bench.whole_body.pairs import random_pair

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from bench.chain import Array

UNIFORM, ODD, OFF = 9000, 2500, 2500
"""Reachable poses of an arm: any, at limits and right angles, rounded."""
NOES = 250
"""Reachable positions with any rotation."""
MOVES, SETS, ARCS = 90, 50, 20
FEW = 12
"""Of what takes long."""
PATHS, WAYPOINTS = 2, 40
PAIRS, OF_PAIRS = 3, 6
ROUNDED = 0.7
"""Of the tolerances."""
FARTHER = 1.6
"""Times as far from the base, so that most are out of reach."""
DT = 0.02
"""Of a tracker [s]."""
SPACING = 0.1
"""Of self-motions [rad]."""
Asked = tuple[str, "Callable[[], list[Any]]", "Callable[[Any], tuple[bool, Any]]"]
"""A kind, its answers, and of each whether it failed and what is compared."""


def _of(what: str) -> Callable[[Any], tuple[bool, Any]]:
    """Judge results by success, and compare something of them."""

    def judge(result: Any) -> tuple[bool, Any]:
        if not result.success:
            return True, None
        return False, np.asarray(getattr(result, what)).tobytes()

    return judge


def _count(found: Any) -> tuple[bool, Any]:
    return len(found) == 0, len(found)


def of_arm(build: str, seed: int) -> list[Asked]:
    """The questions to one arm."""
    arm = random_arms.random_arm(build, seed)
    robot = arm.robot
    solver = iksel.Solver(robot)
    odd = postures(arm, ODD, np.random.default_rng(seed))
    known = robot.random_configurations(UNIFORM, seed)
    rounded = robot.fk(robot.random_configurations(OFF, seed + 5))
    poses = np.concatenate(
        [robot.fk(known), robot.fk(odd), moved(rounded, ROUNDED * TOLERANCE, seed)]
    )
    some = np.concatenate([poses[:SETS], poses[UNIFORM : UNIFORM + SETS]])
    starts = robot.random_configurations(len(some), seed + 9)
    noes = make_targets(arm, "any_rotation", NOES, seed + 7).poses
    far = noes[:FEW].copy()
    far[:, :3, 3] *= FARTHER
    spin = iksel.Task.free_spin()
    paths = [_path(robot, seed + 11 + i) for i in range(PATHS)]
    has_arcs = robot.dof == 7 and robot.structure.kind == iksel.StructureKind.swept

    def near(poses: Array, **more: Any) -> list[Any]:
        return [
            solver.solve(p, near=q, **more) for p, q in zip(poses, starts, strict=False)
        ]

    def tracked() -> list[Any]:
        results = []
        for path in paths:
            tracker = solver.tracker(path[0])
            results += [tracker.track(pose, DT) for pose in robot.fk(path)]
        return results

    asked: list[Asked] = [
        ("batch", lambda: _batch(solver, poses), lambda r: (r[0], r[1])),
        ("any rotation", lambda: [solver.solve(p) for p in noes], _of("q")),
        ("near", lambda: near(some[:MOVES]), _of("move")),
        ("solve_all", lambda: [solver.solve_all(p) for p in some], _count),
        (
            "closest",
            lambda: [solver.solve(p, closest=True) for p in far],
            lambda r: (False, (r.position_error, r.rotation_error)),
        ),
        ("task", lambda: [solver.solve(p, task=spin) for p in noes[:FEW]], _of("q")),
        ("task, near", lambda: near(noes[:FEW], task=spin), _of("move")),
        (
            "path",
            lambda: [solver.solve_path(robot.fk(q), q[0]) for q in paths],
            _of("q"),
        ),
        ("tracker", tracked, _of("q")),
    ]
    if has_arcs:
        goal = iksel.Objective.far_from_limits()
        asked += [
            (
                "self_motion",
                lambda: [solver.self_motion(p, SPACING) for p in some[:ARCS]],
                _count,
            ),
            (
                "objective",
                lambda: [solver.solve(p, objective=goal) for p in some[:ARCS]],
                _of("cost"),
            ),
        ]
    joints = "7" if robot.dof > 6 else "6"
    return [(f"{kind}, {joints}", answer, judge) for kind, answer, judge in asked]


def of_pair(seed: int) -> list[Asked]:
    """The questions to two arms on a joint."""
    body = random_pair(seed)
    solver = iksel.Solver(body.robot)
    poses = solver.robot.fk(body.random_configurations(UNIFORM // 100, seed))
    starts = body.random_configurations(OF_PAIRS, seed + 1)
    return [
        ("two tips", lambda: [solver.solve(p) for p in poses], _of("q")),
        (
            "two tips, near",
            lambda: [
                solver.solve(p, near=q) for p, q in zip(poses, starts, strict=False)
            ],
            _of("move"),
        ),
    ]


def _batch(solver: iksel.Solver, poses: Array) -> list[Any]:
    batch = solver.solve_batch(poses, threads=1)
    return [
        (not good, q.tobytes()) for good, q in zip(batch.success, batch.q, strict=True)
    ]


def _path(robot: iksel.Robot, seed: int) -> Array:
    """Joint values on a straight line, (WAYPOINTS, dof)."""
    first, last = robot.random_configurations(2, seed)
    return np.linspace(first, first + 0.4 * (last - first), WAYPOINTS)


def measured(
    builds: Sequence[str], arms: int, seed: int, rounds: int
) -> dict[str, dict[str, Any]]:
    """Of each kind the failed, a hash of all answers, and the least time of rounds."""
    asked = [
        question
        for build in builds
        for i in range(seed, seed + arms)
        for question in of_arm(build, i)
    ]
    asked += [question for i in range(PAIRS) for question in of_pair(seed + i)]
    kinds: dict[str, dict[str, Any]] = {}
    for number in range(rounds):
        spent: dict[str, float] = {}
        for kind, answer, judge in asked:
            row = kinds.setdefault(kind, {"asked": 0, "failed": 0, "hash": ""})
            begin = time.process_time()
            answers = answer()
            spent[kind] = spent.get(kind, 0.0) + time.process_time() - begin
            if number:
                continue
            judged = [judge(one) for one in answers]
            row["asked"] += len(judged)
            row["failed"] += sum(failed for failed, _ in judged)
            text = row["hash"] + repr([value for _, value in judged])
            row["hash"] = hashlib.sha256(text.encode()).hexdigest()
        for kind, time_s in spent.items():
            kinds[kind]["cpu_s"] = min(time_s, kinds[kind].get("cpu_s", np.inf))
    return kinds


def main(arms: str, seed: str, rounds: str, *builds: str) -> None:
    """Print what is measured."""
    kinds = measured(
        builds or tuple(random_arms.BUILDS), int(arms), int(seed), int(rounds)
    )
    sys.stdout.write(json.dumps(kinds) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
