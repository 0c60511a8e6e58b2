# SPDX-License-Identifier: BSD-3-Clause
"""The targets: one seeded generator, the same targets for every solver.

Kinds (KINDS), with the law that each keeps:

uniform        q uniform inside the limits, as `iksel evaluate` draws it.
near_limits    at least one joint within 2 % of its range of a limit.
near_singular  the Jacobian's smallest singular value is in the lowest 1 % (linear rows
               in metres, angular in radians).
lines          runs of poses on straight Cartesian lines, the rotation held; each pose
               has a configuration inside the limits.
any_rotation   positions as in uniform, rotations uniform over all; some have no
               solution.
unreachable    farther from the first joint than the arm is long.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

import iksel
from bench.check import errors

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from bench.arms import Arm
    from bench.chain import Array, Chain

NEAR_LIMIT_PART = 0.02
"""Part of a joint's range that counts as near a limit."""
SINGULAR_PART = 0.01
"""Part of all configurations that counts as near singular."""
LINE_STEPS = 50
"""Poses on one line."""
LINE_LENGTH = 0.1
"""Length of a line [m]."""

_THRESHOLD_SAMPLES = 20_000
_CHUNK = 20_000


@dataclass(frozen=True)
class Targets:
    """Targets of one kind for one robot."""

    kind: str
    robot: str
    seed: int
    poses: Array
    """T_base_tcp, (N, 4, 4)."""
    starts: Array
    """Where a solver that needs a start begins, uniform in the limits, (N, dof)."""
    witnesses: Array
    """A configuration inside the limits that reaches each pose, (N, dof); NaN where
    none is known. No solver sees it."""

    def __len__(self) -> int:
        return len(self.poses)

    def first(self, count: int) -> Targets:
        """The first so many of them."""
        return Targets(
            self.kind,
            self.robot,
            self.seed,
            self.poses[:count],
            self.starts[:count],
            self.witnesses[:count],
        )

    def save(self, path: Path) -> None:
        """Write them with their seed."""
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_suffix(".part.npz")
        np.savez(
            part,
            kind=self.kind,
            robot=self.robot,
            seed=self.seed,
            poses=self.poses,
            starts=self.starts,
            witnesses=self.witnesses,
        )
        part.replace(path)

    @staticmethod
    def load(path: Path) -> Targets:
        """Read what save wrote."""
        with np.load(path) as file:
            return Targets(
                str(file["kind"]),
                str(file["robot"]),
                int(file["seed"]),
                file["poses"],
                file["starts"],
                file["witnesses"],
            )


def make_targets(arm: Arm, kind: str, count: int, seed: int) -> Targets:
    """So many targets of a kind for a robot; the same arguments, the same targets.

    Raises:
        KeyError: No such kind.
    """
    poses, witnesses = KINDS[kind](arm, count, seed)
    # Another stream than the targets', so that no start is an answer.
    starts = arm.robot.random_configurations(count, seed + 1_000_003)
    return Targets(kind, arm.name, seed, poses, starts, witnesses)


def cached_targets(folder: Path, arm: Arm, kind: str, count: int, seed: int) -> Targets:
    """make_targets, kept in a file."""
    path = folder / f"{arm.name}-{kind}-{count}-{seed}.npz"
    if path.exists():
        return Targets.load(path)
    targets = make_targets(arm, kind, count, seed)
    targets.save(path)
    return targets


def smallest_singular_values(chain: Chain, q: Array) -> Array:
    """Smallest singular value of the Jacobian (of its 6 rows) at each row of q."""
    _, jacobian = chain.fk_jacobian(q)
    squares = np.linalg.eigvalsh(jacobian @ jacobian.transpose(0, 2, 1))[:, 0]
    return np.asarray(np.sqrt(np.maximum(squares, 0.0)))


def singular_threshold(arm: Arm, seed: int) -> float:
    """The value that the smallest singular value is below in 1 % of configurations."""
    q = arm.robot.random_configurations(_THRESHOLD_SAMPLES, seed + 2_000_003)
    return float(np.quantile(smallest_singular_values(arm.chain, q), SINGULAR_PART))


def length_bound(chain: Chain) -> float:
    """Largest distance that the tip can have from the first joint's frame [m]."""
    slides = np.maximum(np.abs(chain.lower), np.abs(chain.upper))[chain.prismatic]
    links = np.linalg.norm(chain.offsets[1:, :3, 3], axis=1)
    return float(links.sum() + slides.sum())


def _uniform(arm: Arm, count: int, seed: int) -> tuple[Array, Array]:
    q = arm.robot.random_configurations(count, seed)
    return arm.chain.fk(q), q


def _near_limits(arm: Arm, count: int, seed: int) -> tuple[Array, Array]:
    q = arm.robot.random_configurations(count, seed)
    chain = arm.chain
    random = np.random.default_rng(seed)
    limited = np.flatnonzero(np.isfinite(chain.lower))
    if limited.size == 0:
        raise ValueError(f"{arm.name} has no joint limits to be near to")
    # One joint always, each other one a time in four.
    near = random.random((count, chain.dof)) < 0.25
    near[np.arange(count), random.choice(limited, count)] = True
    near[:, ~np.isfinite(chain.lower)] = False
    ranges = np.where(np.isfinite(chain.lower), chain.upper - chain.lower, 0.0)
    depth = random.random((count, chain.dof)) * NEAR_LIMIT_PART * ranges
    at_lower = random.random((count, chain.dof)) < 0.5
    pushed = np.where(at_lower, chain.lower + depth, chain.upper - depth)
    q = np.where(near, pushed, q)
    return chain.fk(q), q


def _near_singular(arm: Arm, count: int, seed: int) -> tuple[Array, Array]:
    threshold = singular_threshold(arm, seed)
    found: list[Array] = []
    missing = count
    stream = seed
    while missing > 0:
        q = arm.robot.random_configurations(_CHUNK, stream)
        singular = q[smallest_singular_values(arm.chain, q) < threshold][:missing]
        found.append(singular)
        missing -= len(singular)
        stream += 10_000_019
    q = np.concatenate(found)
    return arm.chain.fk(q), q


def _lines(arm: Arm, count: int, seed: int) -> tuple[Array, Array]:
    random = np.random.default_rng(seed)
    lines = -(-count // LINE_STEPS)
    poses: list[Array] = []
    witnesses: list[Array] = []
    stream = seed
    while len(poses) < lines:
        q = arm.robot.random_configurations(2 * lines, stream)
        direction = random.normal(size=(len(q), 3))
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        line_poses, line_q, whole = _follow(arm.chain, q, direction)
        poses += list(line_poses[whole])
        witnesses += list(line_q[whole])
        stream += 10_000_019
    return (
        np.concatenate(poses[:lines])[:count],
        np.concatenate(witnesses[:lines])[:count],
    )


def _follow(chain: Chain, q: Array, direction: Array) -> tuple[Array, Array, Array]:
    """Walk along a line from each configuration, by damped least squares.

    Returns the poses, (L, LINE_STEPS, 4, 4), configurations that reach them,
    (L, LINE_STEPS, dof), and which lines could be walked to their end, (L,).
    """
    start = chain.fk(q)
    poses = np.repeat(start[:, None], LINE_STEPS, axis=1)
    along = np.linspace(0.0, LINE_LENGTH, LINE_STEPS)
    poses[:, :, :3, 3] += along[:, None] * direction[:, None, :]
    walked = np.empty((len(q), LINE_STEPS, chain.dof))
    whole = np.ones(len(q), dtype=bool)
    for step in range(LINE_STEPS):
        for _ in range(4):
            reached, jacobian = chain.fk_jacobian(q)
            error = _twist(poses[:, step], reached)
            gram = jacobian @ jacobian.transpose(0, 2, 1) + 1e-10 * np.eye(6)
            solved = np.linalg.solve(gram, error[:, :, None])
            q = q + (jacobian.transpose(0, 2, 1) @ solved)[:, :, 0]
        position, rotation = errors(chain, poses[:, step], q)
        whole &= (position < 1e-9) & (rotation < 1e-9) & chain.within_limits(q)
        walked[:, step] = q
    return poses, walked, whole


def _twist(target: Array, reached: Array) -> Array:
    """Small difference of poses as [linear; angular] in base axes, (N, 6)."""
    turn = target[:, :3, :3] @ reached[:, :3, :3].transpose(0, 2, 1)
    skew = 0.5 * (turn - turn.transpose(0, 2, 1))
    angular = np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], axis=1)
    return np.concatenate([target[:, :3, 3] - reached[:, :3, 3], angular], axis=1)


def _unreachable(arm: Arm, count: int, seed: int) -> tuple[Array, Array]:
    chain = arm.chain
    random = np.random.default_rng(seed)
    # Rotations as the arm has them, positions moved out.
    poses = chain.fk(arm.robot.random_configurations(count, seed))
    direction = random.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    distance = length_bound(chain) * random.uniform(1.001, 1.2, (count, 1))
    poses[:, :3, 3] = chain.offsets[0, :3, 3] + distance * direction
    return poses, np.full((count, chain.dof), np.nan)


def _any_rotation(arm: Arm, count: int, seed: int) -> tuple[Array, Array]:
    poses = arm.chain.fk(arm.robot.random_configurations(count, seed))
    quaternions = np.random.default_rng(seed).normal(size=(count, 4))
    quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
    poses = iksel.pose_from_quaternion(poses[:, :3, 3], quaternions)
    return poses, np.full((count, arm.chain.dof), np.nan)


KINDS: dict[str, Callable[[Arm, int, int], tuple[Array, Array]]] = {
    "uniform": _uniform,
    "near_limits": _near_limits,
    "near_singular": _near_singular,
    "lines": _lines,
    "any_rotation": _any_rotation,
    "unreachable": _unreachable,
}
"""How the poses and witnesses of each kind are made."""
