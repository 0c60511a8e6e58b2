# SPDX-License-Identifier: BSD-3-Clause
"""Whether `near` of seven joints is nearest: beside all arcs of the self-motion.

Arms are drawn at random; their constants of `near` are measured by this. Moves start
at any configuration, or beside an answer. With --odd, poses have joints at limits and
right angles, where arms are singular; then the configuration that the pose was made of,
and solve_all, are beside them as well. With --task, axes are left free, of arms of any
build; then these two alone are beside them.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench import random_arms
from bench.arguments import add_count, add_names, add_seed
from bench.laws import arms, postures

if TYPE_CHECKING:
    import argparse

    from bench.arms import Arm
    from bench.chain import Array

BUILDS = tuple(
    name for name in random_arms.SEVEN if name not in {"right_angles_7", "rail"}
)
SPACING = 0.01
"""Of the configurations along an arc [rad]."""
LONGER = 0.01
"""A move that is longer by more than this is not the shortest [rad]."""
TASKS = {
    "pose": iksel.Task.pose(),
    "spin": iksel.Task.free_spin("z"),
    "position": iksel.Task.position_only(),
}
MOST = 256
"""Solutions of a task that are beside a move."""
APART = 77777
"""Between the seeds of poses and of where moves start."""


def known_and_starts(
    arm: Arm,
    count: int,
    seed: int,
    beside: float | None = None,
    *,
    odd: bool = False,
) -> tuple[Array, Array]:
    """Configurations, and where to move to their poses from.

    That is any configuration, or `beside` away from an answer in each joint [rad], by
    a normal distribution.
    """
    robot = arm.robot
    known = robot.random_configurations(count, seed=seed)
    if odd:
        known = postures(arm, count, np.random.default_rng(seed))
    start = robot.random_configurations(count, seed=seed + APART)
    if beside is not None:
        away = np.random.default_rng(seed).standard_normal(known.shape)
        start = np.clip(known + beside * away, robot.lower, robot.upper)
    return known, start


def along_arcs(
    solver: iksel.Solver, pose: Array, start: Array, spacing: float = SPACING
) -> float:
    """The shortest move to what lies on the arcs, infinite if there are none [rad]."""
    robot = solver.robot
    arcs = solver.self_motion(pose, spacing)
    if not len(arcs):
        return np.inf
    return shortest(robot, np.vstack([arc.q for arc in arcs]), start)


def shortest(robot: iksel.Robot, q: Array, start: Array) -> float:
    """The shortest move to images of configurations, (N, dof), inside the limits."""
    turns = robot.upper - robot.lower >= 2 * np.pi
    whole = 2 * np.pi * turns * np.arange(-2, 3)[:, None, None]
    images = q + whole
    # Of joints without an end, at whichever turn the start is.
    endless = ~np.isfinite(robot.upper)
    near = np.round((start - images) / (2 * np.pi))
    images = images + np.where(endless, 2 * np.pi * near, 0)
    inside = (images >= robot.lower - 1e-9) & (images <= robot.upper + 1e-9)
    moves = np.where(inside, np.abs(images - start), np.inf).min(axis=0)
    return float(np.linalg.norm(moves, axis=1).min())


def add(commands: Any) -> None:
    """The command `moves`."""
    command = commands.add_parser(
        "moves",
        help="whether near of seven joints is nearest, on arms drawn at random",
        description=__doc__.splitlines()[0],
    )
    add_names(command, "builds", BUILDS)
    add_count(command, "--arms", 40, "random arms of each build")
    add_count(command, "--poses", 200, "poses of each arm")
    command.add_argument(
        "--beside",
        type=float,
        metavar="RAD",
        help="start so far from an answer, else from any configuration",
    )
    command.add_argument(
        "--odd", action="store_true", help="poses with joints at limits, right angles"
    )
    command.add_argument("--task", choices=TASKS, default="pose", help="what is asked")
    add_seed(command, 1000)


def least_known(
    solver: iksel.Solver, pose: Array, known: Array, start: Array, *, odd: bool
) -> float:
    """The shortest move that anything else finds [rad]."""
    is_task = solver.options.task != TASKS["pose"]
    least = np.inf if is_task else along_arcs(solver, pose, start)
    if not odd and not is_task:
        return least
    every = solver.solve_all(pose, near=start, max=MOST if is_task else 64)
    others = [one.move for one in every]
    return min(least, shortest(solver.robot, known[None], start), *others)


def run(args: argparse.Namespace) -> int:
    """Count, and print a line of JSON for each build; 1 if a move was longer."""
    bad = 0
    for build in args.builds:
        count = longer = 0
        for i, arm in enumerate(arms(build, args.arms, None, args.seed)):
            kind = arm.robot.structure.kind
            if args.task == "pose" and kind != iksel.StructureKind.swept:
                continue
            solver = iksel.Solver(arm.robot, iksel.SolverOptions(task=TASKS[args.task]))
            drawn = known_and_starts(
                arm, args.poses, args.seed + i, args.beside, odd=args.odd
            )
            for known, start in zip(*drawn, strict=True):
                pose = arm.robot.fk(known)
                near = solver.solve(pose, near=start)
                least = least_known(solver, pose, known, start, odd=args.odd)
                count += 1
                longer += not (near.success and near.move <= least + LONGER)
        bad += longer
        line = {"build": build, "seed": args.seed, "arms": args.arms, "moves": count}
        line |= {
            "beside": args.beside,
            "odd": args.odd,
            "task": args.task,
            "longer": longer,
            "simd": iksel.simd_level(),
        }
        print(json.dumps(line), flush=True)
    return 1 if bad else 0
