# SPDX-License-Identifier: BSD-3-Clause
"""Limits of sums of joint values: what they cost, and whether an answer is missed.

A six-joint arm with a spherical wrist (fanuc_like.urdf) whose joints 2 and 3 share a
limit, and once more with joint 3 of more than a whole turn and a cable through the
wrist. Targets are poses of random configurations inside all limits, so that each can be
reached; they are solved one at a time and as a batch, with the coupled limits and by
the arm that has none. Answers are judged in numpy.
"""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.arguments import add_count, add_seed

if TYPE_CHECKING:
    import argparse

    import numpy.typing as npt

    from bench.chain import Array

URDF = Path(__file__).with_name("fanuc_like.urdf")
ELBOW = iksel.CoupledLimit({"joint_2": 1, "joint_3": 1}, lower=-1.2, upper=2.0)
CABLE = iksel.CoupledLimit({"joint_4": 1, "joint_6": 1}, lower=-5.0, upper=5.0)
TURNING = 'lower="-2.4" upper="4.9"'
"""Limits of joint 3 of more than a whole turn."""


def arms() -> dict[str, tuple[str, list[iksel.CoupledLimit]]]:
    """URDF text and coupled limits by name."""
    text = URDF.read_text(encoding="utf-8")
    wide = text.replace('lower="-2.4" upper="3.6"', TURNING)
    if wide == text:
        raise SystemExit(f"bench coupled: {URDF} has no joint with the limits expected")
    return {
        "joints 2 and 3": (text, [ELBOW]),
        "turning joint 3, and a cable": (wide, [ELBOW, CABLE]),
    }


def is_inside(
    robot: iksel.Robot, limits: list[iksel.CoupledLimit], q: Array
) -> npt.NDArray[np.bool_]:
    """Whether each row of q lies inside all limits."""
    inside: npt.NDArray[np.bool_] = np.all(
        (q >= robot.lower) & (q <= robot.upper), axis=1
    )
    for limit in limits:
        c = np.array([limit.coefficients.get(name, 0.0) for name in robot.joint_names])
        inside &= (q @ c >= limit.lower) & (q @ c <= limit.upper)
    return inside


def measure(
    solver: iksel.Solver, limits: list[iksel.CoupledLimit], targets: Array
) -> dict[str, Any]:
    """What a solver makes of targets that can be reached inside the limits."""
    robot = solver.robot
    begun = time.perf_counter()
    results = [solver.solve(pose) for pose in targets]
    single = time.perf_counter() - begun
    begun = time.perf_counter()
    batch = solver.solve_batch(targets)
    together = time.perf_counter() - begun
    found = np.array([bool(result) for result in results])
    q = np.array([result.q for result in results if result])
    off = np.linalg.norm(robot.fk(q)[:, :3, 3] - targets[found, :3, 3], axis=1)
    return {
        "targets": len(targets),
        "missed": int(np.count_nonzero(~found)),
        "missed_by_batch": int(np.count_nonzero(~batch.success)),
        "violating": int(np.count_nonzero(~is_inside(robot, limits, q))),
        "violating_by_batch": int(
            np.count_nonzero(~is_inside(robot, limits, batch.q[batch.success]))
        ),
        "largest_position_error_m": float(off.max(initial=0)),
        "solve_us": single / len(targets) * 1e6,
        "batch_us": together / len(targets) * 1e6,
    }


def add(commands: Any) -> None:
    """The command `coupled`."""
    command = commands.add_parser(
        "coupled", help="coupled limits: what is missed, time", description=__doc__
    )
    add_count(command, "--targets", 100_000, "targets")
    add_seed(command)


def run(args: argparse.Namespace) -> int:
    """Measure, and print JSON; the exit status is 1 if an answer is missed or wrong."""
    rows: dict[str, Any] = {"simd": iksel.simd_level(), "seed": args.seed}
    wrong = 0
    for name, (text, limits) in arms().items():
        robot = iksel.Robot.from_urdf(text, coupled_limits=limits)
        targets = robot.fk(robot.random_configurations(args.targets, seed=args.seed))
        bound = measure(iksel.Solver(robot), limits, targets)
        # Without the limits the arm is free to answer outside of them.
        free = measure(iksel.Solver(iksel.Robot.from_urdf(text)), [], targets)
        rows[name] = {"with": bound, "without": free}
        wrong += sum(v for k, v in bound.items() if k.startswith(("missed", "viol")))
    print(json.dumps(rows, indent=2))
    return 1 if wrong else 0
