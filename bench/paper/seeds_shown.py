# SPDX-License-Identifier: BSD-3-Clause
"""What the paper's figures 1 to 3 show, of a database and the first fitting targets.

Figure 1: the nearest sample, Eq. (2), leads away, that of the least adjustment, Eq.
(5), arrives. Figure 2: the first seed ends at a limit, the one that is selected again
arrives. Figure 3: where among the candidates the seeds of several attempts lie.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.arms import load_arm
from bench.chain import chain_from_urdf
from bench.paper.newer import rotation_vector
from bench.settings import make_solver

if TYPE_CHECKING:
    from bench.chain import Array, Chain
    from bench.store import Settings

STEPS = 8
"""Iterations that are shown, as many as the reference code makes."""
SHOWN = 12
"""Candidates drawn in figure 1 beside the two seeds."""
POSITION, ROTATION = 1e-4, 1e-3
"""The paper's tolerances [m, rad]."""
FAST = 4
"""Iterations within which figure 1's good seed arrives."""


def measured(settings: Settings) -> dict[str, Any]:
    """The three figures as plain data."""
    solver = make_solver(settings)
    robot = load_arm(settings["robot"]).robot
    chain = chain_from_urdf(robot.urdf, robot.base_link, robot.tip_link, np.eye(4))
    strategy: Any = solver.options.strategy
    selector = iksel.Selector(solver.database, strategy)
    found: dict[str, Any] = {
        "lower": chain.lower.tolist(),
        "upper": chain.upper.tolist(),
    }
    q = robot.random_configurations(settings["count"], settings["seed"])
    makers = {"first": _first, "second": _second, "third": _third}
    for number, (witness, pose) in enumerate(zip(q, chain.fk(q), strict=True)):
        for name, make in makers.items():
            if name in found:
                continue
            shown = make(chain, selector, pose)
            if shown is not None:
                found[name] = {"target": number, "arm": outline(chain, witness)} | shown
        if all(name in found for name in makers):
            break
    return found


def outline(chain: Chain, q: Array) -> list[list[float]]:
    """Where the joints and the tip are [m], (dof + 2, 3)."""
    pose = chain.offsets[0]
    points = [np.zeros(3), pose[:3, 3]]
    for i, value in enumerate(q):
        move = np.eye(4)
        if chain.prismatic[i]:
            move[2, 3] = value
        else:
            c, s = np.cos(value), np.sin(value)
            move[:2, :2] = [[c, -s], [s, c]]
        pose = pose @ move @ chain.offsets[i + 1]
        points.append(pose[:3, 3])
    return [[float(value) for value in point] for point in points]


def descend(chain: Chain, q: Array, target: Array) -> tuple[list[Array], list[float]]:
    """The configurations of an iteration without any scaling, and their distances."""
    path, errors = [q], []
    for _ in range(STEPS + 1):
        poses, jacobians = chain.fk_jacobian(path[-1][None])
        position = target[:3, 3] - poses[0, :3, 3]
        rotation = rotation_vector(target[:3, :3] @ poses[0, :3, :3].T)
        errors.append(float(np.linalg.norm(position)))
        near = errors[-1] < POSITION and np.linalg.norm(rotation) < ROTATION
        if near or len(path) > STEPS:
            break
        e = np.concatenate([position, rotation])
        path.append(path[-1] + np.linalg.lstsq(jacobians[0], e, rcond=1e-4)[0])
    return path, errors


def arrives(chain: Chain, q: Array, target: Array) -> bool:
    """Whether a configuration is a solution."""
    pose = chain.fk(q[None])[0]
    turned = np.linalg.norm(rotation_vector(target[:3, :3] @ pose[:3, :3].T))
    far = np.linalg.norm(target[:3, 3] - pose[:3, 3])
    inside = bool(chain.within_limits(q[None])[0])
    return bool(far < POSITION and turned < ROTATION and inside)


def _first(
    chain: Chain, selector: iksel.Selector, target: Array
) -> dict[str, Any] | None:
    """The nearest sample fails, that of the least adjustment arrives at once."""
    _, _, _, near = selector.candidates(target, ranking="nearest")
    _, _, _, least = selector.rank("joint_adjustment")
    (far, far_errors), (good, good_errors) = (
        descend(chain, q, target) for q in (near[0], least[0])
    )
    if arrives(chain, far[-1], target) or not arrives(chain, good[-1], target):
        return None
    # As in the picture: worse after the first step, and few steps.
    if far_errors[1] < far_errors[0] or len(good) > FAST + 1:
        return None
    return {
        "candidates": [outline(chain, q) for q in near[:SHOWN]],
        "nearest": {"path": [outline(chain, q) for q in far], "errors": far_errors},
        "least": {"path": [outline(chain, q) for q in good], "errors": good_errors},
    }


def _attempts(
    chain: Chain, selector: iksel.Selector, target: Array, most: int
) -> list[tuple[int, list[Array]]]:
    """Samples in the order of re-selection, and their iterations.

    Empty unless the last of `most` arrives, and none before it.
    """
    failed: list[int] = []
    tried: list[tuple[int, list[Array]]] = []
    while len(tried) < most:
        index = selector.next(failed)
        if index is None:
            break
        path, _ = descend(chain, np.array(selector.database.q(index)), target)
        tried.append((index, path))
        if arrives(chain, path[-1], target):
            break
        failed.append(index)
    return tried if len(tried) == most > len(failed) else []


def _second(
    chain: Chain, selector: iksel.Selector, target: Array
) -> dict[str, Any] | None:
    """The first seed converges outside the limits, the second arrives."""
    _, _, _, q = selector.candidates(target)
    tried = _attempts(chain, selector, target, 2)
    if not tried:
        return None
    _, path = tried[0]
    pose = chain.fk(path[-1][None])[0]
    if np.linalg.norm(pose[:3, 3] - target[:3, 3]) > POSITION:
        return None
    return {
        "candidates": [outline(chain, each) for each in q],
        "attempts": [np.array(steps).tolist() for _, steps in tried],
        "outlines": [outline(chain, steps[0]) for _, steps in tried],
    }


def _third(
    chain: Chain, selector: iksel.Selector, target: Array
) -> dict[str, Any] | None:
    """Three attempts, the last of which arrives."""
    indices, distances, adjustments, q = selector.candidates(target)
    tried = _attempts(chain, selector, target, 3)
    if not tried:
        return None
    places = [int(np.flatnonzero(indices == index)[0]) for index, _ in tried]
    return {
        "distances": distances.tolist(),
        "adjustments": adjustments.tolist(),
        "q": q.tolist(),
        "attempts": places,
    }
