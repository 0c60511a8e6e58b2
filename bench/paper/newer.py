# SPDX-License-Identifier: BSD-3-Clause
"""The authors' newer selection of seeds in numpy, written from its description.

Source of the figures: https://github.com/wanweiwei07/one at commit 96c863f1,
numik_sel.py and numik.py in one/robots/base/kine. An oracle for
SolverOptions.paper(2026): nothing but joint values of samples is taken from IKSel.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from bench.arms import load_arm
from bench.chain import chain_from_urdf
from bench.settings import make_solver

if TYPE_CHECKING:
    from bench.chain import Array, Chain
    from bench.store import Settings


class Answer(NamedTuple):
    """What became of one target."""

    q: Array | None
    """The solution, (dof,); None without."""
    attempts: int
    """Seeds tried."""
    steps: int
    """Steps of all attempts."""


class NewerSelection:
    """Seeds from given samples, and the iteration from them."""

    def __init__(self, chain: Chain, samples: Array) -> None:
        """Take a chain to its tip link, without a tool, and samples, (N, dof)."""
        self.chain, self.samples = chain, samples
        poses, jacobians = chain.fk_jacobian(samples)
        self._features = np.array([_feature(pose) for pose in poses])
        self._inverses = np.linalg.pinv(jacobians, rcond=1e-4)

    def seeds(self, target: Array) -> Array:
        """Numbers of the 16 samples that are tried, in that order."""
        e = _feature(target) - self._features
        near = np.argsort(np.linalg.norm(e, axis=1))[:200]
        adjustments = np.einsum("kij,kj->ki", self._inverses[near], e[near])
        return np.asarray(near[np.argsort(np.linalg.norm(adjustments, axis=1))[:16]])

    def solve(self, target: Array) -> Answer:
        """The first seed that leads to a solution."""
        steps = 0
        seeds = self.seeds(target)
        for attempt, seed in enumerate(seeds, 1):
            q, taken = self._attempt(self.samples[seed], target)
            steps += taken
            if q is not None:
                return Answer(q, attempt, steps)
        return Answer(None, len(seeds), steps)

    def _attempt(self, q: Array, target: Array) -> tuple[Array | None, int]:
        """12 configurations: a solution, and the steps that were of use."""
        for step in range(12):
            poses, jacobians = self.chain.fk_jacobian(q[None])
            pose, jacobian = poses[0], jacobians[0]
            position = target[:3, 3] - pose[:3, 3]
            rotation = rotation_vector(target[:3, :3] @ pose[:3, :3].T)
            far, turned = np.linalg.norm(position), np.linalg.norm(rotation)
            if far <= 1e-4 and turned <= 1e-3:
                return (q if self.chain.within_limits(q[None])[0] else None), step
            e = np.concatenate(
                [position * min(1.0, 0.1 / far), rotation * min(1.0, 0.3 / turned)]
            )
            change = np.linalg.lstsq(jacobian, e, rcond=1e-4)[0]
            if len(q) > 6:
                aside = 0.2 * (self.chain.middle() - q)
                inverse = np.linalg.pinv(jacobian, rcond=1e-4)
                change += aside - inverse @ (jacobian @ aside)
            q = q + change
        return None, 11


def measured(settings: Settings) -> dict[str, Any]:
    """Success and cost over the samples of a cell's solver, on the paper's targets."""
    solver = make_solver(settings)
    robot = load_arm(settings["robot"]).robot
    chain = chain_from_urdf(robot.urdf, robot.base_link, robot.tip_link, np.eye(4))
    database = solver.database
    samples = np.array([database.q(i) for i in range(len(database))])
    selection = NewerSelection(chain, samples)
    q = robot.random_configurations(settings["count"], settings["seed"])
    targets = chain.fk(q)
    begin = time.perf_counter()
    answers = [selection.solve(target) for target in targets]
    seconds = time.perf_counter() - begin
    return {
        "success_percent": 100.0 * float(np.mean([a.q is not None for a in answers])),
        "mean_us": 1e6 * seconds / len(targets),
        "mean_attempts": float(np.mean([a.attempts for a in answers])),
        "mean_iterations": float(np.mean([a.steps for a in answers])),
        "count": len(targets),
    }


def rotation_vector(R: Array) -> Array:  # noqa: N803
    """Of a rotation matrix; turns of exactly pi are not met at random."""
    sine = 0.5 * np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    length = np.linalg.norm(sine)
    angle = np.arctan2(length, 0.5 * (np.trace(R) - 1.0))
    return sine if length < 1e-12 else np.asarray(angle / length * sine)


def _feature(pose: Array) -> Array:
    """[position; rotation vector]."""
    return np.concatenate([pose[:3, 3], rotation_vector(pose[:3, :3])])
