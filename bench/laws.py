# SPDX-License-Identifier: BSD-3-Clause
"""Laws that every arm has to keep, on arms drawn at random and on built-in ones.

Poses are those of configurations inside the limits: a third uniform, a third with
joints at multiples of 90 degrees, a third with joints at their limits. The files of the
arms may have their numbers rounded, or off by a little.

lost           a pose that can be reached is not solved, alone or in a batch
stays          near where the arm stands gives another configuration
near_lost      near some other configuration a pose that can be reached is not solved
near_longer    near gives a longer move than to the configuration that is known
near_beside    near gives a longer move than the nearest of solve_all(near=)
all_empty      solve_all finds nothing of such a pose
contradicted   beside a limit, where solve says no: solve_all, near or a batch finds an
               answer, or diagnose has one
false          an answer that is none, by a numpy chain
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench import random_arms
from bench.arguments import add_count, add_names, add_seed
from bench.check import right

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Iterator

    from bench.arms import Arm
    from bench.chain import Array

LAWS = (
    "lost",
    "stays",
    "near_lost",
    "near_longer",
    "near_beside",
    "all_empty",
    "contradicted",
    "false",
)
SAME = 1e-6
"""Moves that differ by less are the same [rad or m]."""
LONGER = 2e-3
"""A move may be longer by so much: where the arm is singular, the tolerances allow
answers so far from each other [rad or m]."""
TOLERANCE = 1e-6 + 1e-9
"""Of answers [m and rad], with the judge's rounding."""
BESIDE = (1e-5, 1e-4, 1e-3, 1e-2)
"""How far a joint is moved out of its limits [rad or m]."""


def postures(arm: Arm, count: int, random: np.random.Generator) -> Array:
    """Configurations inside the limits, (count, dof)."""
    lower, upper = _ends(arm)
    shape = (count, arm.chain.dof)
    q = random.uniform(lower, upper, shape)
    kind = random.integers(3, size=count)[:, None]
    square = np.round(q / random_arms.RIGHT) * random_arms.RIGHT
    use = (random.random(shape) < 0.5) & (kind == 1) & ~arm.chain.prismatic
    q = np.where(use & (square >= lower) & (square <= upper), square, q)
    end = np.where(random.random(shape) < 0.5, lower, upper)
    return np.where((random.random(shape) < 0.3) & (kind == 2), end, q)


def _ends(arm: Arm) -> tuple[Array, Array]:
    """The limits; of a joint that has none, a turn."""
    lower, upper = arm.chain.lower, arm.chain.upper
    return (
        np.where(np.isfinite(lower), lower, -np.pi),
        np.where(np.isfinite(upper), upper, np.pi),
    )


def violations(arm: Arm, count: int, seed: int) -> dict[str, int]:
    """How often each law is broken, of so many poses; `poses` and `noes` as well."""
    random = np.random.default_rng(seed)
    solver = iksel.Solver(arm.robot)
    row = dict.fromkeys(("poses", "noes", *LAWS), 0)
    row["poses"] = count
    q = postures(arm, count, random)
    poses = arm.chain.fk(q)
    row["lost"] += int(np.count_nonzero(~solver.solve_batch(poses).success))
    for known, pose in zip(q, poses, strict=True):
        _of_reachable(arm, solver, (known, pose), random, row)
    _beside_limits(arm, solver, q, random, row)
    return row


def _of_reachable(
    arm: Arm,
    solver: iksel.Solver,
    known_and_pose: tuple[Array, Array],
    random: np.random.Generator,
    row: dict[str, int],
) -> None:
    known, pose = known_and_pose
    there = solver.solve(pose, near=known)
    row["stays"] += not there.success or there.move > SAME
    away = random.uniform(-1, 1, len(known)) * random.choice([1e-3, 0.1, 1.0])
    start = np.clip(known + away, arm.chain.lower, arm.chain.upper)
    near = solver.solve(pose, near=start)
    every = solver.solve_all(pose, near=start)
    plain = solver.solve(pose)
    row["lost"] += not plain.success
    row["near_lost"] += not near.success
    row["all_empty"] += not len(every)
    if near.success:
        row["near_longer"] += near.move > np.linalg.norm(start - known) + LONGER
    if near.success and len(every):
        row["near_beside"] += near.move > min(one.move for one in every) + LONGER
    answers = [one.q for one in (there, near, plain, *every) if one.success]
    _judge(arm, pose, answers, row)


def _beside_limits(
    arm: Arm,
    solver: iksel.Solver,
    q: Array,
    random: np.random.Generator,
    row: dict[str, int],
) -> None:
    limited = np.flatnonzero(np.isfinite(arm.chain.lower))
    if not limited.size:
        return
    for one in q[::4]:
        outside = one.copy()
        joint, by = random.choice(limited), random.choice(BESIDE)
        outside[joint] = (
            arm.chain.upper[joint] + by
            if random.random() < 0.5
            else arm.chain.lower[joint] - by
        )
        pose = arm.chain.fk(outside[None])[0]
        if solver.solve(pose).success:
            continue
        row["noes"] += 1
        every = solver.solve_all(pose)
        near = solver.solve(pose, near=one)
        batch = solver.solve_batch(pose[None])
        why = solver.diagnose(pose)
        row["contradicted"] += bool(
            len(every) or near.success or batch.success[0] or why.q_is_solution
        )


def _judge(arm: Arm, pose: Array, answers: list[Array], row: dict[str, int]) -> None:
    if not answers:
        return
    poses = np.broadcast_to(pose, (len(answers), 4, 4))
    good = right(arm.chain, poses, np.array(answers), TOLERANCE, TOLERANCE)
    row["false"] += int(np.count_nonzero(~good))


def writing(text: str | None, seed: int) -> Callable[[float], str]:
    """How numbers are written: "5" with five decimals, "1e-6" off by up to that.

    Raises:
        ValueError: It is neither.
    """
    if text is None:
        return repr
    if text.isdigit():
        return lambda value: f"{value:.{text}f}"
    size = float(text)
    random = np.random.default_rng(seed)
    return lambda value: repr(value + float(random.uniform(-size, size)))


def arms(name: str, count: int, written: str | None, seed: int) -> Iterator[Arm]:
    """So many random arms of a build, or a built-in robot."""
    if name not in random_arms.BUILDS:
        yield random_arms.written_anew(name, writing(written, seed))
        return
    for i in range(seed, seed + count):
        yield random_arms.random_arm(name, i, writing(written, i))


def add(commands: Any) -> None:
    """The command `laws`."""
    command = commands.add_parser(
        "laws",
        help="laws that every arm has to keep, on arms drawn at random",
        description=__doc__.splitlines()[0],
    )
    add_names(command, "builds", random_arms.BUILDS, "; or built-in robots")
    add_count(command, "--arms", 200, "random arms of each build")
    add_count(command, "--poses", 100, "poses of each arm")
    command.add_argument(
        "--written",
        metavar="HOW",
        help="numbers of the files: 4 for four decimals, 1e-6 for off by up to that",
    )
    add_seed(command)


def run(args: argparse.Namespace) -> int:
    """Count, and print a line of JSON for each build; 1 if a law was broken."""
    bad = 0
    conditions = {"simd": iksel.simd_level(), "seed": args.seed}
    for name in args.builds:
        total: dict[str, int] = {}
        for i, arm in enumerate(arms(name, args.arms, args.written, args.seed)):
            row = violations(arm, args.poses, args.seed + i)
            for key, value in {"arms": 1, **row}.items():
                total[key] = total.get(key, 0) + int(value)
        bad += sum(total[law] for law in LAWS)
        line = {**conditions, "build": name, "written": args.written, **total}
        print(json.dumps(line), flush=True)
    return 1 if bad else 0
