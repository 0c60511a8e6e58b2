# SPDX-License-Identifier: BSD-3-Clause
"""What is lost of what is known to be there.

Targets that can be reached, as poses of configurations inside the limits
(bench.targets): uniform ones, ones at limits and ones near singularities. Each is
solved one at a time and in a batch, and every answer is judged by numpy. For arms whose
solutions are isolated, the branches of solve_all beside those that random restarts of
the iteration find.
"""

from __future__ import annotations

import json
import time
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.arms import load_arm
from bench.branches import (
    ROUNDING,
    TOLERANCE,
    branches_by_restarts,
    judged,
    without,
)
from bench.check import right
from bench.targets import make_targets

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator

    from bench.arms import Arm
    from bench.targets import Targets

ROBOTS = (
    "ur3",
    "ur10e",
    "irb120",
    "vs060",
    "cvr038",
    "cvrb1213",
    "gen3_6dof",
    "xarm6",
    "panda",
    "iiwa14",
    "xarm7",
    "pr2_right_arm",
)
KINDS = ("near_limits", "near_singular")
CHUNK = 100_000
"""Targets at a time."""
SHOWN = 20
"""Poses with fewer branches that are named."""


def chunks(arm: Arm, kind: str, count: int, seed: int) -> Iterator[Targets]:
    """So many targets of a kind, some at a time."""
    for first in range(0, count, CHUNK):
        yield make_targets(arm, kind, min(CHUNK, count - first), seed + first)


def reached(arm: Arm, kind: str, count: int, seed: int) -> dict[str, Any]:
    """How many of the targets are solved, and how many answers are false."""
    solver = iksel.Solver(arm.robot)
    row = {
        "targets": 0,
        "lost": 0,
        "lost_by_batch": 0,
        "called_a_proven_no": 0,
        "false": 0,
        "false_by_batch": 0,
    }
    tolerance = TOLERANCE + ROUNDING
    for targets in chunks(arm, kind, count, seed):
        poses = targets.poses
        results = [solver.solve(pose) for pose in poses]
        batch = solver.solve_batch(poses)
        found = np.array([result.success for result in results])
        q = np.array([result.q for result in results if result.success], dtype=float)
        q = q.reshape(-1, arm.chain.dof)
        row["targets"] += len(poses)
        row["called_a_proven_no"] += sum(
            not result.success and result.proven for result in results
        )
        for way, solved, answers in (
            ("", found, q),
            ("_by_batch", batch.success, batch.q[batch.success]),
        ):
            good = right(arm.chain, poses[solved], answers, tolerance, tolerance)
            row["lost" + way] += int(np.count_nonzero(~solved))
            row["false" + way] += int(np.count_nonzero(~good))
    return row


def beside_restarts(arm: Arm, count: int, restarts: int, seed: int) -> dict[str, Any]:
    """The branches of solve_all beside those of random restarts, pose by pose."""
    solver = iksel.Solver(arm.robot)
    poses = make_targets(arm, "uniform", count, seed).poses
    ours = judged(arm.chain, poses, [list(solver.solve_all(pose).q) for pose in poses])
    begin = time.perf_counter()
    fewer, more, all_of_them = [], 0, 0
    for i, (pose, known) in enumerate(zip(poses, ours.right, strict=True)):
        q = branches_by_restarts(solver, pose, restarts, seed + 1 + i)
        theirs = judged(arm.chain, pose[None], [list(q)]).right[0]
        all_of_them += len(theirs)
        if len(without(theirs, known)):
            fewer.append(i)
        more += bool(len(without(known, theirs)))
    return {
        "poses": count,
        "restarts": restarts,
        "branches": sum(map(len, ours.right)),
        "branches_by_restarts": all_of_them,
        "wrong": ours.wrong,
        "fewer": len(fewer),
        "more": more,
        "poses_with_fewer": fewer[:SHOWN],
        "restarts_s": time.perf_counter() - begin,
    }


def add(commands: Any) -> None:
    """The command `lost`."""
    command = commands.add_parser(
        "lost",
        help="reachable targets and branches that are not found",
        description=__doc__,
    )
    command.add_argument(
        "robots",
        nargs="*",
        metavar="ROBOT",
        default=ROBOTS,
        help=f"default: {' '.join(ROBOTS)}",
    )
    command.add_argument(
        "--targets", type=int, default=1_000_000, metavar="N", help="uniform ones"
    )
    command.add_argument(
        "--hard",
        type=int,
        default=100_000,
        metavar="N",
        help="targets at limits, and as many near singularities",
    )
    command.add_argument(
        "--poses",
        type=int,
        default=0,
        metavar="N",
        help="poses whose branches are compared with those of restarts; only of arms "
        "of which no joint is redundant",
    )
    command.add_argument("--restarts", type=int, default=10_000, metavar="N")
    command.add_argument("--seed", type=int, default=1)


def run(args: argparse.Namespace) -> int:
    """Measure, and print JSON; the exit status is 1 if anything is lost or false."""
    rows: dict[str, Any] = {"simd": iksel.simd_level(), "seed": args.seed}
    bad = 0
    for name in args.robots:
        arm = load_arm(name)
        row: dict[str, Any] = {}
        counts = {"uniform": args.targets, **dict.fromkeys(KINDS, args.hard)}
        for kind, count in counts.items():
            if count > 0:
                row[kind] = reached(arm, kind, count, args.seed)
                bad += sum(row[kind].values()) - row[kind]["targets"]
        if args.poses > 0 and arm.robot.dof <= 6:
            row["restarts"] = beside_restarts(arm, args.poses, args.restarts, args.seed)
            bad += row["restarts"]["fewer"] + row["restarts"]["wrong"]
        rows[name] = row
        print(json.dumps({name: row}), flush=True)
    return 1 if bad else 0
