# SPDX-License-Identifier: BSD-3-Clause
"""The least move to the poses of both hands, by brute force and without `near`.

The shared joints are put at many values, and behind each of them both arms at all that
solve_all gives. Of the combinations the nearest of each value, and answers from random
seeds beside them, then slide, in numpy, to where the move is locally least.
"""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import numpy as np

import iksel
from bench.branches import nearest_turns
from bench.chain import chain_from_urdf, chain_joints
from bench.paper.paired import rotation_vectors

if TYPE_CHECKING:
    from bench.chain import Array
    from bench.whole_body.robots import Body

VALUES = 256
"""Of the shared joints: half of them anywhere, half about where the move begins."""
SOLUTIONS = 64
"""Asked for of each arm behind a value."""
NEAREST = 2
"""Of these, so many of an arm are combined with as many of the other."""
RESTARTS = 64
"""Random seeds, iterated in all joints together."""
SLIDE, SETTLE = 50, 5
"""Steps towards where the move begins, and then to the poses alone."""
SHORTER = 8
"""Steps after which they go half the way."""
LONGEST = 0.3
"""Step of all joints together [rad or m]."""


class Brute:
    """Brute force on one robot, whose shared joints come before all others."""

    def __init__(self, body: Body) -> None:
        """Take the arms apart."""
        robot = body.robot
        self._body = body
        self._shared = np.array(robot.shared_joints)
        self._own = [np.setdiff1d(columns, self._shared) for columns in body.columns]
        link = _last_shared_link(body)
        self._stem = chain_from_urdf(body.urdf, robot.base_link, link, np.eye(4))
        self._arms = [
            chain_from_urdf(body.urdf, link, tip, np.eye(4)) for tip in robot.tip_links
        ]
        text = body.urdf.encode()
        self._solvers = [
            iksel.Solver(iksel.Robot.from_urdf(text, base_link=link, tip_link=tip))
            for tip in robot.tip_links
        ]
        self._whole = iksel.Solver(robot)

    def least_move(self, poses: Array, near: Array, seed: int) -> float:
        """The least move that is found to poses (k, 4, 4), infinite if there is none.

        That is the norm of the differences in all joints [rad or m].
        """
        rng = np.random.default_rng(seed)
        starts = [*self._combined(poses, near, rng), *self._restarted(poses, rng)]
        if not starts:
            return np.inf
        q = self.slid(poses, near, np.array(starts))
        right = self._body.right(np.repeat(poses[None], len(q), axis=0), q)
        moves = np.linalg.norm(q[right] - near, axis=1)
        return float(moves.min(initial=np.inf))

    def slid(self, poses: Array, near: Array, q: Array) -> Array:
        """Configurations (m, dof), each moved towards the least move beside it."""
        lower, upper = (
            np.array(self._body.robot.lower),
            np.array(self._body.robot.upper),
        )
        for step in range(SLIDE + SETTLE):
            errors, jacobian = self._errors(poses, q)
            # Where the answers are bent, the way that the tangent shows is too long.
            part = 1.0 / (1.0 + step / SHORTER) if step < SLIDE else 0.0
            pull = part * (near - q)
            free = np.ones_like(q)
            for _ in range(3):  # joints at a limit that the step would leave are held
                move = _step(jacobian * free[:, None], errors, pull * free)
                out = ((q <= lower) & (move < 0)) | ((q >= upper) & (move > 0))
                if not out.any():
                    break
                free[out] = 0.0
            length = np.linalg.norm(move, axis=1, keepdims=True)
            move *= LONGEST / np.maximum(length, LONGEST)
            q = np.clip(q + move, lower, upper)
        return q

    def _errors(self, poses: Array, q: Array) -> tuple[Array, Array]:
        """Of all tips, (m, 6 k), and their Jacobian, (m, 6 k, dof)."""
        body = self._body
        errors = np.zeros((len(q), 6 * len(poses)))
        jacobian = np.zeros((*errors.shape, q.shape[1]))
        for i, (chain, pose) in enumerate(zip(body.chains, poses, strict=True)):
            tip, of_chain = chain.fk_jacobian(q[:, body.columns[i]])
            rows = np.arange(6 * i, 6 * i + 6)
            jacobian[:, rows[:, None], body.columns[i]] = of_chain
            errors[:, rows[:3]] = pose[:3, 3] - tip[:, :3, 3]
            turn = pose[:3, :3] @ tip[:, :3, :3].transpose(0, 2, 1)
            errors[:, rows[3:]] = rotation_vectors(turn)
        return errors, jacobian

    def _combined(
        self, poses: Array, near: Array, rng: np.random.Generator
    ) -> list[Array]:
        """The nearest of both arms behind each value of the shared joints."""
        lower, upper = (ends[self._shared] for ends in self._body.search_limits())
        values = rng.uniform(lower, upper, (VALUES, len(lower)))
        away = rng.normal(0.0, 0.1, values[1::2].shape) * (upper - lower)
        values[1::2] = np.clip(near[self._shared] + away, lower, upper)
        found = []
        for value, stem in zip(values, self._stem.fk(values), strict=True):
            behind = np.linalg.inv(stem) @ poses
            sides = [self._of_arm(i, behind[i], near) for i in range(len(poses))]
            for picked in product(*sides):
                q = near.copy()
                q[self._shared] = value
                for own, part in zip(self._own, picked, strict=True):
                    q[own] = part
                found.append(q)
        return found

    def _of_arm(self, tip: int, pose: Array, near: Array) -> Array:
        """Of an arm the solutions that are nearest, (n, its joints)."""
        there = near[self._own[tip]]
        all_of_it = self._solvers[tip].solve_all(pose, SOLUTIONS).q
        q = np.array(all_of_it).reshape(-1, len(there))
        q = nearest_turns(self._arms[tip], q, there)
        q = q[np.isfinite(q).all(axis=1)]
        order = np.argsort(np.linalg.norm(q - there, axis=1))
        return np.asarray(q[order[:NEAREST]])

    def _restarted(self, poses: Array, rng: np.random.Generator) -> list[Array]:
        """Answers from random seeds."""
        lower, upper = self._body.search_limits()
        seeds = rng.uniform(lower, upper, (RESTARTS, len(lower)))
        results = [
            self._whole.solve(poses, seeds=seed[None], database_seeds=False)
            for seed in seeds
        ]
        return [np.asarray(result.q) for result in results if result]


def _last_shared_link(body: Body) -> str:
    """The link that the last shared joint moves."""
    robot = body.robot
    shared = {robot.joint_names[j] for j in robot.shared_joints}
    joints = chain_joints(body.urdf, robot.base_link, robot.tip_links[0])
    last = [joint for joint in joints if joint.attrib["name"] in shared][-1]
    child = last.find("child")
    assert child is not None
    return child.attrib["link"]


def _step(jacobian: Array, errors: Array, pull: Array) -> Array:
    """The step next to `pull` that takes the errors away, as far as it goes."""
    left = errors - np.einsum("mij,mj->mi", jacobian, pull)
    square = jacobian @ jacobian.transpose(0, 2, 1) + 1e-10 * np.eye(errors.shape[1])
    solved = np.linalg.solve(square, left[..., None])
    return np.asarray(pull + (jacobian.transpose(0, 2, 1) @ solved)[..., 0])
