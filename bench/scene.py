# SPDX-License-Identifier: BSD-3-Clause
"""Answers that are free in a scene: what they cost, and whether coal agrees.

A Panda with its hand, whose collision geometry (cylinders and spheres) is that of
rtb-data, which roboticstoolbox-python brings. Scenes and targets are made from a seed:
the arm alone; 16 boxes on and above a table; 10,000 points on the surfaces of 20 boxes.
Targets are poses of random configurations inside the limits, whether those collide or
not.
"""

from __future__ import annotations

import importlib.util
import json
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import iksel
import iksel.exact
import iksel.spheres
from bench.arguments import add_count, add_max_error, add_seed
from bench.timing import time_calls

if TYPE_CHECKING:
    import argparse

    from bench.chain import Array

LIMIT_S = 60.0
"""No solve of a row is begun after this time."""
RESTARTS = "random restarts with coal"


class Panda(NamedTuple):
    """The arm, its file and its body."""

    robot: iksel.Robot
    path: Path
    spheres: iksel.RobotSpheres
    inner: iksel.RobotSpheres
    """The same, smaller by what they stick out of the geometry at most. As each of its
    shapes is convex, these lie inside them."""


def load_panda(max_error: float) -> Panda:
    """The arm with the geometry of rtb-data."""
    found = importlib.util.find_spec("rtbdata")
    if found is None or found.origin is None:
        raise SystemExit(
            "bench scene: needs rtb-data: pip install iksel[collision,xacro] rtb-data"
        )
    folder = Path(found.origin).parent / "xacro" / "qut_frankie_description" / "robots"
    path = folder / "panda_arm_hand.urdf.xacro"
    robot = iksel.load_robot(path, base_link="panda_link0", tip_link="panda_hand")
    spheres = iksel.spheres.from_urdf(path, robot, max_error=max_error)
    # All shapes are spheres and cylinders.
    less = [0, 0, 0, iksel.spheres.PART_OF_CYLINDER * max_error]
    inner = {name: rows - less for name, rows in spheres.links.items()}
    return Panda(robot, path, spheres, iksel.RobotSpheres(inner, spheres.pairs))


def place(rng: np.random.Generator) -> Array:
    """Somewhere around the arm, in front of it or beside [m]."""
    radius, turn, height = rng.uniform([0.35, -np.pi, 0.0], [0.9, np.pi, 0.9])
    return np.array([radius * np.cos(turn), radius * np.sin(turn), height])


def make_scenes(
    robot: iksel.Robot, spheres: iksel.RobotSpheres, seed: int
) -> dict[str, iksel.Scene]:
    """The scenes by name."""
    rng = np.random.default_rng(seed)
    alone, boxes, points = (iksel.Scene(robot, spheres) for _ in range(3))
    for i in range(16):
        boxes.add_box(f"box {i}", rng.uniform(0.05, 0.25, 3), place(rng))
    parts = []
    for _ in range(20):
        cloud = rng.uniform(-1, 1, (500, 3))
        side = rng.integers(0, 3, 500)
        rows = np.arange(500)
        cloud[rows, side] = np.sign(cloud[rows, side])
        parts.append(place(rng) + cloud * rng.uniform(0.03, 0.12, 3))
    points.add_points("cloud", np.concatenate(parts), radius=0.005)
    return {"arm alone": alone, "16 boxes": boxes, "10,000 points": points}


class Judge(NamedTuple):
    """What is free by the geometry itself.

    Coal is asked only about what the spheres refuse, but not those inside the geometry:
    there is no doubt about the others.
    """

    scene: iksel.Scene
    inner: iksel.Scene
    exact: iksel.exact.ExactCollision

    def is_free(self, q: Array) -> Array:
        """Which of configurations (N, dof) are free, (N,)."""
        free = np.array(self.scene.is_free(q))
        in_doubt = ~free & self.inner.is_free(q)
        if in_doubt.any():
            free[in_doubt] = self.exact.geometry_is_free(q[in_doubt])
        return free


def measure(
    panda: Panda, scene: iksel.Scene, inner: iksel.Scene, args: argparse.Namespace
) -> dict[str, Any]:
    """A row: solves in one scene beside solves without one."""
    targets = panda.robot.fk(
        panda.robot.random_configurations(args.targets, seed=args.seed)
    )
    solver = iksel.Solver(panda.robot)
    plain, _ = time_calls(solver.solve, [(pose,) for pose in targets], LIMIT_S)
    times, results = time_calls(
        lambda pose: solver.solve(pose, scene=scene),
        [(pose,) for pose in targets],
        LIMIT_S,
    )
    solved = np.array([bool(result) for result in results])
    exact = iksel.exact.ExactCollision(scene, panda.path)
    q = np.array([result.q for result in results if result])
    row: dict[str, Any] = {
        "targets": len(results),
        "plain_us": float(plain.mean()) / 1e3,
        "mean_us": float(times.mean()) / 1e3,
        "p99_us": float(np.percentile(times, 99)) / 1e3,
        "solved_us": float(times[solved].mean()) / 1e3,
        "none_us": float(times[~solved].mean()) / 1e3 if not solved.all() else None,
        "solved": int(solved.sum()),
        "false": int(np.count_nonzero(~exact.geometry_is_free(q))),
    }
    some = targets[: args.filtered]
    by_coal, _ = time_calls(
        lambda pose: solver.solve(pose, filter=exact.geometry_is_free),
        [(pose,) for pose in some],
        LIMIT_S,
    )
    row["coal_filter_us"] = float(by_coal.mean()) / 1e3
    judge = Judge(scene, inner, exact)
    row["missed"] = missed(solver, judge, targets[: len(results)][~solved], args)
    lost = row["missed"]["free"] / max(row["missed"]["looked_at"], 1)
    row["found_share"] = len(q) / (len(q) + lost * np.count_nonzero(~solved))
    return row


def missed(
    solver: iksel.Solver,
    judge: Judge,
    targets: Array,
    args: argparse.Namespace,
) -> dict[str, Any]:
    """What random restarts find for targets that were given up.

    An answer counts as found by spheres too where these let it through: what they
    refuse and coal does not is the price of spheres, what both let through is the
    search's.
    """
    rng = np.random.default_rng(args.seed)
    free = by_spheres = by_exact = 0
    begun = time.perf_counter()
    some = targets[: args.missed]
    for pose in some:
        seeds = solver.robot.random_configurations(
            args.restarts, seed=int(rng.integers(1 << 31))
        )
        results = [solver.solve(pose, seeds=s, database_seeds=False) for s in seeds]
        q = np.array([result.q for result in results if result])
        if len(q) and judge.is_free(q).any():
            free += 1
            by_spheres += bool(np.any(judge.scene.is_free(q)))
            by_exact += bool(solver.solve(pose, scene=judge.scene, exact=judge.exact))
    spent = time.perf_counter() - begun
    return {
        "looked_at": len(some),
        "restarts": args.restarts,
        "free": free,
        "free_by_spheres": by_spheres,
        "found_with_exact": by_exact,
        "seconds_each": spent / max(len(some), 1),
    }


def add(commands: Any) -> None:
    """The command `scene`."""
    command = commands.add_parser(
        "scene", help="solves in scenes, judged by coal", description=__doc__
    )
    add_count(command, "--targets", 10_000, "targets")
    add_seed(command, 0)
    add_max_error(command, 0.002)
    add_count(command, "--filtered", 200, "targets with a coal filter")
    add_count(command, "--missed", 50, f"targets for {RESTARTS}")
    add_count(command, "--restarts", 1_000, "random restarts of each of these")
    command.add_argument("--only", metavar="SCENE", help="one scene")


def run(args: argparse.Namespace) -> int:
    """Measure, and print JSON."""
    panda = load_panda(args.max_error)
    rows: dict[str, Any] = {
        "spheres": sum(map(len, panda.spheres.links.values())),
        "simd": iksel.simd_level(),
    }
    inner = make_scenes(panda.robot, panda.inner, args.seed)
    for name, scene in make_scenes(panda.robot, panda.spheres, args.seed).items():
        if args.only in {None, name}:
            rows[name] = measure(panda, scene, inner[name], args)
    print(json.dumps(rows, indent=2))
    return 0
