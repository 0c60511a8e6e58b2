# SPDX-License-Identifier: BSD-3-Clause
"""The behaviour of every public call, to be compared before and after a change of code.

For every built-in robot, preset, SIMD level of this machine and call: a hash over the
bits of the answers, and the sums of attempts and iterations. A change that only moves
code leaves all of it as it was. The file belongs to the machine and the compiler.
"""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
from typing import TYPE_CHECKING, Any

import iksel_cpp
import numpy as np

import iksel
from bench.arguments import add_before_and_after
from bench.store import write_json

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Iterable, Iterator
    from pathlib import Path

    Calls = Iterator[tuple[str, Callable[[], "Digest"]]]

TARGETS = 40
"""For each call that solves one pose, half of them reachable; four for slow ones."""
SEED = 12
LEVELS = ("scalar", "sse2", "neon", "avx2", "avx512")

TASKS = {
    "position_only": iksel.Task.position_only(),
    "free_spin": iksel.Task.free_spin("z"),
    "upright": iksel.Task.upright("z"),
    "planar": iksel.Task.planar("z"),
    "box": iksel.Task.box((0.01, 0.02, 0.0), (0.0, 0.1, 0.1)),
}
OBJECTIVES = ("limits", "manipulability")


class Digest:
    """A hash over answers, and what they took."""

    def __init__(self) -> None:
        self._hash = hashlib.sha256()
        self.solved = self.attempts = self.iterations = 0

    def bits(self, *values: Any) -> None:
        """Add numbers, or anything that has a text."""
        for value in values:
            data = (
                repr(value).encode()
                if isinstance(value, str | None)
                else np.ascontiguousarray(value, dtype=float).tobytes()
            )
            self._hash.update(data)

    def work(self, answer: Any) -> None:
        """Add the work of a Result or Solutions."""
        self.attempts += int(np.sum(answer.attempts))
        self.iterations += int(np.sum(answer.iterations))

    def row(self) -> str:
        """In a line."""
        return (
            f"{self._hash.hexdigest()[:16]} solved {self.solved} "
            f"attempts {self.attempts} iterations {self.iterations}"
        )


def add(commands: Any) -> None:
    """The command `frozen`."""
    command = commands.add_parser(
        "frozen",
        help="compare the bits of every call's answers before and after a change",
        description="Records what every public call answers, on every built-in robot, "
        "at both presets and every SIMD level of this machine, or compares with that.",
    )
    add_before_and_after(command, "build/frozen.json")


def run(args: argparse.Namespace) -> int:
    """Record or compare; the exit status."""
    return (record if args.action == "record" else compare)(args.file)


def compare(path: Path) -> int:
    """Compare with what `record` wrote; the exit status."""
    before = json.loads(path.read_text(encoding="utf-8"))
    after = _levels()
    names = [*before, *(name for name in after if name not in before)]
    differ = [name for name in names if before.get(name) != after.get(name)]
    for name in differ:
        sys.stdout.write(
            f"{name}\n  before {before.get(name, 'not there')}\n"
            f"  after  {after.get(name, 'not there')}\n"
        )
    sys.stdout.write(f"{len(names) - len(differ)} of {len(names)} calls are the same\n")
    return 1 if differ else 0


def record(path: Path) -> int:
    """Write the behaviour of the installed iksel; the exit status."""
    rows = _levels()
    write_json(path, rows, indent=0)
    sys.stdout.write(f"wrote {path}: {len(rows)} calls\n")
    return 0


def _levels() -> dict[str, str]:
    """Of each SIMD level that there is here, in a process of its own."""
    rows: dict[str, str] = {}
    for level in LEVELS:
        run = subprocess.run(
            [sys.executable, "-m", "bench.frozen"],
            env=os.environ | {"IKSEL_SIMD": level},
            capture_output=True,
            text=True,
            check=False,
        )
        if "not to be had here" in run.stderr:
            continue
        if run.returncode:
            raise RuntimeError(run.stderr)
        rows |= json.loads(run.stdout)
    return rows


def main() -> None:
    """Print the rows of the level that IKSEL_SIMD names."""
    level = iksel.simd_level()
    rows = {}
    for name in iksel.robot_names():
        robot = iksel.load_robot(name)
        for preset, solver in _solvers(robot):
            for call, run in _calls(solver, slow=preset == "paper"):
                rows[f"{name} {preset} {level} {call}"] = run().row()
    json.dump(rows, sys.stdout)


def _solvers(robot: iksel.Robot) -> Iterator[tuple[str, iksel.Solver]]:
    yield "default", iksel.Solver(robot)
    options = iksel.SolverOptions.paper()
    database = options.database.replace(sampling="random", samples=2000)
    yield "paper", iksel.Solver(robot, options.replace(database=database))


def _targets(robot: iksel.Robot) -> np.ndarray:
    """The first half reachable, the others where those are, but turned otherwise."""
    poses = robot.fk(robot.random_configurations(TARGETS, SEED))
    half = TARGETS // 2
    poses[half:, :3, 3] = poses[:half, :3, 3]
    return poses


def _each(poses: Iterable[np.ndarray], solve: Callable[[int, Any], Any]) -> Digest:
    digest = Digest()
    for i, pose in enumerate(poses):
        answer = solve(i, pose)
        digest.solved += bool(answer)
        digest.bits(answer.status.name, answer.proof.name)
        digest.work(answer)
        if isinstance(answer, iksel.Solutions):
            digest.bits(answer.q, answer.position_error, answer.rotation_error)
            digest.bits(answer.move)
        elif answer.success:
            digest.bits(answer.q, answer.position_error, answer.rotation_error)
            digest.bits(answer.move, answer.cost)
    return digest


def _batch(answer: iksel.BatchResult) -> Digest:
    digest = Digest()
    digest.solved = answer.solved
    digest.bits(answer.q, answer.status, answer.position_error, answer.rotation_error)
    digest.bits(answer.move, answer.proof)
    digest.work(answer)
    return digest


def _path(answer: iksel.PathResult) -> Digest:
    digest = Digest()
    digest.solved = int(answer.success)
    digest.bits(answer.status.name, answer.move)
    digest.bits(*answer.q)
    return digest


def _line(robot: iksel.Robot) -> np.ndarray:
    """Waypoints close to each other."""
    start, end = robot.random_configurations(2, SEED + 1)
    return robot.fk(start + np.linspace(0, 0.2, 10)[:, None] * (end - start))


def _track(solver: iksel.Solver) -> Digest:
    start = solver.robot.random_configurations(2, SEED + 1)[0]
    tracker = solver.tracker(start)
    digest = _each(_line(solver.robot), lambda _, pose: tracker.track(pose, 0.05))
    digest.bits(tracker.q)
    return digest


def _diagnose(solver: iksel.Solver, poses: np.ndarray) -> Digest:
    digest = Digest()
    for pose in poses:
        why = solver.diagnose(pose)
        digest.solved += bool(why)
        digest.bits(why.cause.name, why.message)
        if why.q is not None:
            digest.bits(why.q)
    return digest


def _evaluate(solver: iksel.Solver) -> Digest:
    found = iksel_cpp.evaluate(solver, 200, SEED)
    digest = Digest()
    digest.solved = found.solved
    digest.bits(found.mean_attempts, found.mean_iterations)
    return digest


def _calls(solver: iksel.Solver, *, slow: bool) -> Calls:
    robot = solver.robot
    poses = _targets(robot)
    few = poses[:: TARGETS // 4] if slow else poses[::2]
    home = robot.random_configurations(TARGETS, SEED + 2)
    weights = np.linspace(1, 2, robot.dof)

    def filter_half(q: np.ndarray) -> np.ndarray:
        return np.asarray(q[:, 0] > home[0, 0])

    def solve(poses: np.ndarray, **request: Any) -> Callable[[], Digest]:
        return lambda: _each(poses, lambda _, pose: solver.solve(pose, **request))

    def solve_all(poses: np.ndarray, **request: Any) -> Callable[[], Digest]:
        return lambda: _each(poses, lambda _, pose: solver.solve_all(pose, **request))

    yield "solve", solve(poses)
    yield (
        "solve seed",
        lambda: _each(poses, lambda i, pose: solver.solve(pose, seeds=home[i])),
    )
    yield "solve seeds", solve(poses, seeds=home[:5])
    yield "solve seeds only", solve(poses, seeds=home[:5], database_seeds=False)
    yield "solve near", solve(few, near=home[0])
    yield "solve near max", solve(few, near=home[0], norm="max", weights=weights)
    yield "solve filter", solve(few, filter=filter_half)
    for name, task in TASKS.items():
        yield f"solve {name}", solve(few, task=task)
        yield f"solve_all {name}", solve_all(few[:4], task=task)
    for objective in OBJECTIVES:
        yield f"solve {objective}", solve(few[:4], objective=objective)
    yield "solve_all", solve_all(few)
    yield "solve_all near", solve_all(few[:4], near=home[0], whole_turns=True)
    yield "solve_batch", lambda: _batch(solver.solve_batch(poses, threads=2))
    yield (
        "solve_batch near",
        lambda: _batch(solver.solve_batch(few, near=home[: len(few)], threads=2)),
    )
    yield (
        "solve_batch position_only",
        lambda: _batch(solver.solve_batch(few, task=TASKS["position_only"])),
    )
    line = _line(robot)
    yield "solve_path", lambda: _path(solver.solve_path(line[:4]))
    start = robot.random_configurations(2, SEED + 1)[0]
    yield (
        "solve_path start",
        lambda: _path(solver.solve_path(line, start, dt=0.1)),
    )
    yield "track", lambda: _track(solver)
    if not slow:
        yield "diagnose", lambda: _diagnose(solver, poses[:: TARGETS // 4])
    yield "evaluate", lambda: _evaluate(solver)


if __name__ == "__main__":
    main()
