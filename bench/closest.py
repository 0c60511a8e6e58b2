# SPDX-License-Identifier: BSD-3-Clause
"""What is closest to poses without an answer: its time, and how near brute force comes.

Brute force goes downhill from configurations at random, uniform inside the limits, and
keeps the least of what is missing, weighed by the same weights. Targets are of two
kinds, in turn (bench.targets): `any_rotation`, reachable positions with rotations at
random, of which those without an answer are taken; and `unreachable`, farther away than
the arm is long. What is missing is measured here, from the poses.
"""

from __future__ import annotations

import json
import sys
import time
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.arguments import add_count, add_robots, add_seed
from bench.arms import load_arm
from bench.machine import fingerprint
from bench.settings import WORK
from bench.store import Store
from bench.targets import make_targets
from bench.timing import least_times, time_calls

if TYPE_CHECKING:
    import argparse

    from bench.arms import Arm
    from bench.chain import Array
    from bench.store import Settings

ROBOTS = ("ur5e", "panda", "iiwa14", "xarm5")
KINDS = ("any_rotation", "unreachable")
CHUNK = 50
"""Targets that are measured and kept at a time."""
PASSES = 3
"""Of each target the least time of so many passes counts."""
LIMIT_S = 600.0
WITHIN = 1.01
"""Part of the best value that counts as the same."""


def targets_of(arm: Arm, solver: iksel.Solver, count: int, seed: int) -> Array:
    """So many poses without an answer, of both kinds in turn, (count, 4, 4)."""
    kinds = []
    for kind in KINDS:
        found: list[Array] = []
        stream = seed
        while len(found) < count:
            poses = make_targets(arm, kind, 4 * count, stream).poses
            found += [pose for pose in poses if not solver.solve(pose)]
            stream += 1_000_003
        kinds.append(found)
    return np.array([kinds[i % len(KINDS)][i // len(KINDS)] for i in range(count)])


def missing(arm: Arm, poses: Array, q: Array, weights: Array) -> Array:
    """What is missing of poses, (N, 4, 4), at q, (N, dof): weighed along their axes."""
    reached = arm.chain.fk(q)
    deviation = np.linalg.inv(poses) @ reached
    rotation = iksel.rotation_vector_from_pose(deviation)
    parts = np.concatenate([deviation[:, :3, 3], rotation], axis=1)
    return np.asarray(np.linalg.norm(parts * weights, axis=1))


def measured(settings: Settings) -> dict[str, Any]:
    """One chunk of targets: times, what is missing, and what brute force has left."""
    arm = load_arm(settings["robot"])
    solver = iksel.Solver(arm.robot)
    first = settings["first"]
    last = first + settings["count"]
    poses = targets_of(arm, solver, last, settings["seed"])[first:]
    weights = np.array(settings["weights"])
    calls = [(pose,) for pose in poses]
    plain = [time_calls(solver.solve, calls, LIMIT_S)[0] for _ in range(PASSES)]
    runs = [
        time_calls(lambda pose: solver.solve(pose, closest=weights), calls, LIMIT_S)
        for _ in range(PASSES)
    ]
    q = np.array([result.q for result in runs[0][1]])
    patient = iksel.Solver(
        arm.robot, iksel.SolverOptions(max_attempts=settings["restarts"])
    )
    random = np.random.default_rng([settings["seed"], first])
    best = []
    begin = time.perf_counter()
    for pose in poses:
        seeds = arm.robot.random_configurations(
            settings["restarts"], seed=int(random.integers(1 << 31))
        )
        result = patient.solve(pose, seeds=seeds, database_seeds=False, closest=weights)
        best.append(result.q)
    return {
        "plain_ns": least_times(plain).tolist(),
        "closest_ns": least_times([times for times, _ in runs]).tolist(),
        "missing": missing(arm, poses, q, weights).tolist(),
        "brute": missing(arm, poses, np.array(best), weights).tolist(),
        "brute_s": time.perf_counter() - begin,
    }


def summary(chunks: list[dict[str, Any]]) -> dict[str, Any]:
    """A robot's row."""
    joined = {
        name: np.concatenate([chunk[name] for chunk in chunks])
        for name in ("plain_ns", "closest_ns", "missing", "brute")
    }
    ratio = joined["missing"] / joined["brute"]
    worse = ratio > WITHIN
    row: dict[str, Any] = {
        "targets": len(ratio),
        "worse": int(worse.sum()),
        "within_1_percent": float(1 - worse.mean()),
        "worst_ratio": float(ratio.max()),
        "better_than_brute_force": int(np.count_nonzero(ratio < 1 / WITHIN)),
        "brute_force_s_each": sum(chunk["brute_s"] for chunk in chunks) / len(ratio),
    }
    for kind, name in enumerate(("all", *KINDS)):
        some = slice(None) if kind == 0 else slice(kind - 1, None, len(KINDS))
        row[name] = {
            "plain_us": float(joined["plain_ns"][some].mean()) / 1e3,
            "closest_us": float(joined["closest_ns"][some].mean()) / 1e3,
            "p99_us": float(np.percentile(joined["closest_ns"][some], 99)) / 1e3,
        }
    return row


def add(commands: Any) -> None:
    """The command `closest`."""
    command = commands.add_parser(
        "closest",
        help="what is closest to poses without an answer, beside brute force",
        description=__doc__,
    )
    add_robots(command, ROBOTS)
    add_count(command, "--targets", 2_000, "targets")
    add_count(command, "--restarts", 10_000, "random seeds of brute force")
    add_seed(command, 0)
    command.add_argument(
        "--weights",
        nargs=6,
        type=float,
        metavar="W",
        help="of position [1/m] and rotation [1/rad] along the target's axes; default: "
        "1 and a quarter of the reach",
    )
    command.add_argument(
        "--seconds",
        type=float,
        default=float("inf"),
        help="begin no more targets after this time; the same command goes on from "
        "there",
    )


def run(args: argparse.Namespace) -> int:
    """Measure, and print JSON."""
    store = Store(WORK / "closest", fingerprint())
    end = time.monotonic() + args.seconds
    rows: dict[str, Any] = {"simd": iksel.simd_level()}
    for name in args.robots:
        chunks = []
        for first in range(0, args.targets, CHUNK):
            settings: Settings = {
                "cell": "closest",
                "robot": name,
                "weights": args.weights or default_weights(name),
                "seed": args.seed,
                "restarts": args.restarts,
                "first": first,
                "count": min(CHUNK, args.targets - first),
            }
            result = store.load(settings)
            if result is None and time.monotonic() < end:
                begin = time.monotonic()
                result = measured(settings)
                store.save(settings, result, time.monotonic() - begin)
            if result is None:
                sys.stderr.write(f"bench: {name}: {first} of {args.targets} targets\n")
                break
            chunks.append(result)
        if chunks:
            rows[name] = summary(chunks)
    print(json.dumps(rows, indent=2))
    return 0


def default_weights(robot: str) -> list[float]:
    """Those of closest=True."""
    length = load_arm(robot).robot.reach / 4
    return [1.0, 1.0, 1.0, length, length, length]
