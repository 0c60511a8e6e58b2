# SPDX-License-Identifier: BSD-3-Clause
"""Whether `near` of seven joints is nearest: beside all arcs of the self-motion.

Arms are drawn at random; their constants of `near` are measured by this. Moves start
at any configuration, or beside an answer.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench import random_arms
from bench.arguments import add_count, add_names, add_seed
from bench.laws import arms

if TYPE_CHECKING:
    import argparse

    from bench.chain import Array

BUILDS = tuple(
    name for name in random_arms.SEVEN if name not in {"right_angles_7", "rail"}
)
SPACING = 0.01
"""Of the configurations along an arc [rad]."""
LONGER = 0.01
"""A move that is longer by more than this is not the shortest [rad]."""
APART = 77777
"""Between the seeds of poses and of where moves start."""


def poses_and_starts(
    robot: iksel.Robot, count: int, seed: int, beside: float | None = None
) -> tuple[Array, Array]:
    """Reachable poses, and where to move to them from.

    That is any configuration, or `beside` away from an answer in each joint [rad], by
    a normal distribution.
    """
    known = robot.random_configurations(count, seed=seed)
    start = robot.random_configurations(count, seed=seed + APART)
    if beside is not None:
        away = np.random.default_rng(seed).standard_normal(known.shape)
        start = np.clip(known + beside * away, robot.lower, robot.upper)
    return robot.fk(known), start


def along_arcs(
    solver: iksel.Solver, pose: Array, start: Array, spacing: float = SPACING
) -> float:
    """The shortest move to what lies on the arcs, infinite if there are none [rad]."""
    robot = solver.robot
    arcs = solver.self_motion(pose, spacing)
    if not len(arcs):
        return np.inf
    turns = robot.upper - robot.lower >= 2 * np.pi
    whole = 2 * np.pi * turns * np.arange(-2, 3)[:, None, None]
    images = np.vstack([arc.q for arc in arcs]) + whole
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
    add_seed(command, 1000)


def run(args: argparse.Namespace) -> int:
    """Count, and print a line of JSON for each build; 1 if a move was longer."""
    bad = 0
    for build in args.builds:
        count = longer = 0
        for i, arm in enumerate(arms(build, args.arms, None, args.seed)):
            if arm.robot.structure.kind != iksel.StructureKind.swept:
                continue
            solver = iksel.Solver(arm.robot)
            drawn = poses_and_starts(arm.robot, args.poses, args.seed + i, args.beside)
            for pose, start in zip(*drawn, strict=True):
                near = solver.solve(pose, near=start)
                least = along_arcs(solver, pose, start)
                count += 1
                longer += not (near.success and near.move <= least + LONGER)
        bad += longer
        line = {"build": build, "seed": args.seed, "arms": args.arms, "moves": count}
        line |= {"beside": args.beside, "longer": longer, "simd": iksel.simd_level()}
        print(json.dumps(line), flush=True)
    return 1 if bad else 0
