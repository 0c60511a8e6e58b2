# SPDX-License-Identifier: BSD-3-Clause
"""What the models learn from: poses, and one configuration for each.

The paper draws q uniform inside the limits and lets the model see FK(q) and q; its
first author's code puts the solver's own answer in the place of q. Here too the label
is an answer of the solver: of all that reach the pose, the one nearest to the middle of
the limits. So it is a function of the pose, with jumps only where two answers are
equally near or an answer ends at a limit, and has no whole turns in it. Other points
than the middle have not fewer jumps: beside 3,000 poses of C1 (0.05 rad; evaluate.why)
5.3 % jumped for the best of 350 points, found by chance and then by steps, but 6.9 %
beside 20,000 others, 7.0 % for the middle; by "limits" 8.8 %, "manipulability" 13.7 %.
Nor do labels near a point at which fewer answers are equally near (0.21 of the poses
within 0.2 rad, 0.32 for the middle) make better seeds: first and best of 32 of the flow
for C1 were 78.3 and 86.3 % after 9,000 steps, by the middle 79.2 and 87.5 % (2,000
poses). Of an arm with seven joints that answer may lie on a limit, up to which the
self-motion was followed, and a seed beside it then ends outside; there the label is the
answer that is farthest from all limits. The paper's own labels, "drawn", are there to
compare, with the quaternion that its models see: a model learns all configurations of a
pose then. For C0 and C1 the report has both.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.arms import load_arm
from bench.learned.plan import INPUTS, OURS
from bench.settings import WORK
from bench.size import SEED

if TYPE_CHECKING:
    from pathlib import Path

    import numpy.typing as npt

    from bench.arms import Arm
    from bench.chain import Array
    from bench.learned.plan import Recipe

    Floats = npt.NDArray[np.float32]

FEATURES = 12
"""Numbers that a model is given of a pose: position and rotation."""
QUATERNION_FEATURES = 7
"""The same of position and quaternion."""
TRAIN_SEED = SEED + 1_000
"""Of the poses learned from; the next one is of the curves' poses, and SEED of the
report's."""


@dataclass(frozen=True)
class Scaling:
    """Mean and deviation of features and labels, for inputs and outputs of order 1."""

    x_mean: Floats
    x_std: Floats
    q_mean: Floats
    q_std: Floats

    def inputs(self, poses: Array) -> Floats:
        """What a model is given of poses, (N, 4, 4) -> (N, FEATURES or fewer)."""
        x = features(poses, INPUTS[len(self.x_mean) == QUATERNION_FEATURES])
        return ((x - self.x_mean) / self.x_std).astype(np.float32)

    def joints(self, outputs: Floats) -> Array:
        """Joint values [rad] of a model's outputs, (..., dof)."""
        scaled = np.asarray(outputs, dtype=np.float64) * self.q_std
        return np.asarray(scaled + self.q_mean)


def features(poses: Array, inputs: str = OURS.inputs) -> Floats:
    """Position [m] and rotation, (N, 4, 4) -> (N, FEATURES or QUATERNION_FEATURES).

    The entries of the rotation are smooth in the pose; a quaternion, which the paper
    uses, jumps where its sign is settled.
    """
    if inputs == "quaternion":
        rotations = iksel.quaternion_from_pose(poses)
    else:
        rotations = poses[:, :3, :3].reshape(len(poses), 9)
    return np.concatenate([poses[:, :3, 3], rotations], axis=1).astype(np.float32)


def scaling_of(x: Floats, q: Floats) -> Scaling:
    """Mean and deviation of features and labels, each (N, ...)."""
    x_std, q_std = x.std(axis=0), q.std(axis=0)
    return Scaling(x.mean(axis=0), np.maximum(x_std, 1e-3), q.mean(axis=0), q_std)


def labelled(
    robot: str, count: int, seed: int, recipe: Recipe = OURS
) -> tuple[Floats, Floats]:
    """labelled_now, made once and kept in build/bench."""
    name = f"{robot}-{recipe.labels}-{recipe.inputs}-{count}-{seed}.npz"
    path: Path = WORK / "learned" / name
    if not path.exists():
        x, q = labelled_now(load_arm(robot), count, seed, recipe)
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_suffix(".part.npz")
        np.savez(part, x=x, q=q)
        part.replace(path)
    with np.load(path) as file:
        return file["x"], file["q"]


def labelled_now(
    arm: Arm, count: int, seed: int, recipe: Recipe = OURS
) -> tuple[Floats, Floats]:
    """Features, (N, ...), and labels [rad], (N, dof), of so many random poses.

    The few poses that the solver has no answer for are left out.
    """
    drawn = arm.robot.random_configurations(count, seed)
    poses = arm.robot.fk(drawn)
    q = drawn if recipe.labels == "drawn" else labels(arm, poses)
    known = np.isfinite(q).all(axis=1)
    return features(poses[known], recipe.inputs), q[known].astype(np.float32)


def labels(arm: Arm, poses: Array) -> Array:
    """One configuration for each pose, (N, 4, 4) -> (N, dof) [rad].

    NaN where the solver has none. By one thread, as training is.
    """
    wanted: dict[str, Any] = {"near": arm.chain.middle()}
    if arm.chain.dof > 6:
        wanted = {"objective": "limits"}
    result = iksel.Solver(arm.robot).solve_batch(poses, threads=1, **wanted)
    return np.where(result.success[:, None], result.q, np.nan)
