# SPDX-License-Identifier: BSD-3-Clause
"""What an unreachable target costs: time and iterations beside those of solved ones.

Three kinds of targets per robot: reachable; positions at 1.05 to 3 times the reach;
reachable positions with a random rotation, of which those that stay unsolved count.
Times are of `solver.solve` from Python.
"""

import argparse
import time
from collections.abc import Callable

import iksel_cpp
import numpy as np

import iksel
from iksel.pose import pose_from_quaternion


def random_rotation(random: np.random.Generator) -> np.ndarray:
    """A rotation, uniform over all."""
    quaternion = random.normal(size=4)
    quaternion /= np.linalg.norm(quaternion)
    return pose_from_quaternion(np.zeros(3), quaternion)[:3, :3]


def beyond_reach(robot: iksel.Robot, random: np.random.Generator) -> np.ndarray:
    """A pose whose position no joint values come near."""
    direction = random.normal(size=3)
    direction *= robot.reach * random.uniform(1.05, 3.0) / np.linalg.norm(direction)
    pose = np.eye(4)
    pose[:3, :3] = random_rotation(random)
    pose[:3, 3] = robot.reach_centre + direction
    return pose


def twisted(robot: iksel.Robot, random: np.random.Generator) -> np.ndarray:
    """A reachable position with a rotation taken at random."""
    pose = robot.fk(robot.random_configurations(1, int(random.integers(2**62)))[0])
    pose[:3, :3] = random_rotation(random)
    return pose


def reachable(robot: iksel.Robot, random: np.random.Generator) -> np.ndarray:
    """FK of joint values inside the limits."""
    return robot.fk(robot.random_configurations(1, int(random.integers(2**62)))[0])


Kind = Callable[[iksel.Robot, np.random.Generator], np.ndarray]
KINDS: dict[str, Kind] = {
    "reachable": reachable,
    "beyond reach": beyond_reach,
    "other rotation": twisted,
}


def main() -> None:
    """Entry point."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("robots", nargs="*", default=["ur3", "panda", "cvr038"])
    parser.add_argument("--targets", type=int, default=5_000)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()

    print(
        f"{args.targets} targets of each kind, seed {args.seed}, from Python, "
        f"SIMD {iksel_cpp.simd_level()}"
    )
    print(
        f"{'robot':24} {'targets':16} {'solved':>8} {'unsolved':>8} {'mean us':>9} "
        f"{'unsolved: mean us':>18} {'max us':>9} {'iterations':>11} {'bound':>7}"
    )
    for name in args.robots:
        robot = iksel.load_robot(name)
        solver = iksel.Solver(robot)
        random = np.random.default_rng(args.seed)
        for kind, make in KINDS.items():
            poses = [make(robot, random) for _ in range(args.targets)]
            times = np.empty(len(poses))
            solved = np.empty(len(poses), bool)
            iterations = 0
            for i, pose in enumerate(poses):
                start = time.perf_counter_ns()
                result = solver.solve(pose)
                times[i] = (time.perf_counter_ns() - start) / 1e3
                solved[i] = result.success
                iterations = max(iterations, result.iterations)
            lost = times[~solved]
            print(
                f"{name:24} {kind:16} {solved.sum():8d} {(~solved).sum():8d} "
                f"{times.mean():9.2f} {lost.mean() if len(lost) else np.nan:18.2f} "
                f"{lost.max() if len(lost) else np.nan:9.1f} {iterations:11d} "
                f"{solver.work_bound:7d}"
            )


if __name__ == "__main__":
    main()
