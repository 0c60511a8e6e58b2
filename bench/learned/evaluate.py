# SPDX-License-Identifier: BSD-3-Clause
"""What a model's outputs are worth: themselves, and as seeds of the paper's iteration.

A seed has one attempt by SolverOptions.paper(), and no other seed follows it.
"""

from __future__ import annotations

import csv
import functools
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import equinox as eqx
import jax
import numpy as np

import iksel
from bench.arms import load_arm
from bench.check import right
from bench.learned.data import labels
from bench.learned.errors import batch_errors
from bench.learned.models import load_weights
from bench.learned.plan import BESIDE, JUMP, OURS, Recipe, weights_path
from bench.settings import make_solver, targets_of
from bench.size import SEED
from bench.timing import time_calls

if TYPE_CHECKING:
    from pathlib import Path

    import numpy.typing as npt

    from bench.arms import Arm
    from bench.chain import Array
    from bench.learned.data import Scaling
    from bench.store import Settings

CHUNK = 500
"""Poses in one call where times do not matter."""
RECIPE = fields(Recipe)
LIMIT_S = 120.0
"""No output is begun after so long [s]."""


@functools.cache
def paper_solver(robot: str) -> iksel.Solver:
    """The paper's iteration; its database is there, but is not asked."""
    overrides = {"reselection": "none"}
    return make_solver({"robot": robot, "preset": "paper", "overrides": overrides})


@functools.cache
def trying_solver(robot: str, count: int) -> iksel.Solver:
    """The same from so many seeds in the paper's ranking, Eq. (5), until one leads."""
    overrides = {"reselection": "next", "candidates": count, "max_attempts": count}
    return make_solver({"robot": robot, "preset": "paper", "overrides": overrides})


def from_seed(solver: iksel.Solver, pose: Array, q: Array) -> Any:
    """From seeds, (dof,) or (n, dof), and no other: from one, one attempt."""
    return solver.solve(pose, seeds=q, database_seeds=False)


@eqx.filter_jit
def sample(model: Any, x: jax.Array, seed: jax.Array, count: int) -> jax.Array:
    """Scaled outputs, (B, count, dof)."""
    return model.outputs(x, jax.random.key(seed), count)


def outputs(
    model: Any, scaling: Scaling, poses: Array, count: int, seed: int = 0
) -> Array:
    """Joint values for poses, (N, 4, 4) -> (N, count, dof) [rad]."""
    x = scaling.inputs(poses)
    parts = [
        np.asarray(sample(model, x[i : i + CHUNK], np.uint32(seed + i), count))
        for i in range(0, len(x), CHUNK)
    ]
    return scaling.joints(np.concatenate(parts))


def distances(reached: Array, target: Array) -> Array:
    """How far poses (..., 4, 4) are apart: of [position (m); quaternion], (...).

    The metric by which the paper picks the best output; the nearer sign is taken.
    """
    positions = np.sum((reached[..., :3, 3] - target[..., :3, 3]) ** 2, axis=-1)
    a, b = iksel.quaternion_from_pose(reached), iksel.quaternion_from_pose(target)
    quaternions = 2.0 - 2.0 * np.abs(np.sum(a * b, axis=-1))
    return np.asarray(np.sqrt(positions + np.maximum(quaternions, 0.0)))


def best(robot: iksel.Robot, q: Array, pose: Array) -> int:
    """Which of the outputs (count, dof) reaches nearest to the pose, (4, 4).

    From where the iteration starts with it, which is inside the limits.
    """
    inside = np.clip(q, robot.lower, robot.upper)
    return int(np.argmin(distances(robot.fk(inside), pose)))


def solved(solver: iksel.Solver, poses: Array, q: Array) -> npt.NDArray[np.bool_]:
    """Which seeds (N, dof) lead to an answer."""
    done = [from_seed(solver, *each).success for each in zip(poses, q, strict=True)]
    return np.array(done)


def seeds_solved(
    robot: str, model: Any, scaling: Scaling, seed: int, count: int
) -> dict[str, float]:
    """Percent that one attempt solves from the first and the best output."""
    arm = load_arm(robot)
    poses = arm.robot.fk(arm.robot.random_configurations(count, seed))
    q = outputs(model, scaling, poses, model.batch)
    solver = paper_solver(robot)
    shares = {"first": 100.0 * float(solved(solver, poses, q[:, 0]).mean())}
    if model.batch > 1:
        chosen = [best(arm.robot, *each) for each in zip(q, poses, strict=True)]
        q = q[np.arange(count), chosen]
        shares["best"] = 100.0 * float(solved(solver, poses, q).mean())
    return shares


def measured(settings: Settings) -> dict[str, Any]:
    """The figures of a cell "learned", from committed weights.

    Outputs are made one pose a call by the jitted model; the best of a batch is picked
    in that call's time. Answers are judged by bench.check at the paper's tolerances.
    """
    recipe = Recipe(*(settings.get(field.name, field.default) for field in RECIPE))
    path = weights_path(settings["robot"], settings["model"], recipe)
    if not path.exists():
        return {"unsupported": f"no {path.name}: not trained"}
    model, scaling, facts = load_weights(path)
    arm = load_arm(settings["robot"])
    poses = targets_of(settings).poses
    result: dict[str, Any] = {
        "count": len(poses),
        "batch": model.batch,
        "minutes": facts.minutes,
        "steps": facts.steps,
        "parameters": facts.parameters,
        "bytes": path.stat().st_size,
        "curve": read_curve(path.with_suffix(".csv")),
        "first": _as_seeds(
            arm, poses, _one_by_one(arm, model, scaling, 1), direct=True
        ),
    }
    if model.batch > 1:
        call = _one_by_one(arm, model, scaling, model.batch)
        result["best"] = _as_seeds(arm, poses, call)
    q = outputs(model, scaling, poses, model.batch)
    if recipe != OURS:
        result["configurations"] = configurations(arm, poses)
    elif model.batch > 1:
        result["why"] = why(arm, poses, q)
    return {**result, **batch_errors(arm, poses, q)}


def configurations(arm: Arm, poses: Array) -> float:
    """How many reach a pose inside the limits, in the mean, whole turns counted."""
    solver = iksel.Solver(arm.robot)
    turn = 2.0 * np.pi
    count = 0
    for pose in poses:
        # Of those that differ by whole turns one stands for all.
        q = np.asarray(solver.solve_all(pose).q) % turn
        once = np.unique(np.round(np.exp(1j * q), 3), axis=0, return_index=True)[1]
        highest = np.floor((arm.robot.upper - q[once]) / turn)
        lowest = np.ceil((arm.robot.lower - q[once]) / turn)
        count += int(np.prod(highest - lowest + 1.0, axis=1).sum())
    return count / len(poses)


def why(arm: Arm, poses: Array, q: Array) -> dict[str, float]:
    """Percent of targets whose best of a batch, (N, count, dof), fails, and where.

    The best is the one whose pose is nearest. Where the label jumps some outputs lie
    between two answers, and near a singular configuration, where poses change least,
    such a one may be nearer than those beside an answer.
    """
    label = labels(arm, poses)
    known = np.isfinite(label).all(axis=1)
    label, poses, q = label[known], poses[known], q[known]
    q = np.clip(q, arm.robot.lower, arm.robot.upper)
    chosen = [best(arm.robot, *each) for each in zip(q, poses, strict=True)]
    seeds = q[np.arange(len(q)), chosen]
    solver = paper_solver(arm.name)
    good = solved(solver, poses, seeds)
    jacobians = arm.chain.fk_jacobian(seeds)[1]
    least = np.linalg.svd(jacobians, compute_uv=False)[:, -1]
    singular = least <= np.quantile(least, 0.25)
    beside = label + np.random.default_rng(SEED).normal(0.0, BESIDE, label.shape)
    beside = np.clip(beside, arm.robot.lower, arm.robot.upper)
    moved = np.abs(labels(arm, arm.robot.fk(beside)) - beside).max(axis=1)
    jumps = moved > JUMP
    trying = trying_solver(arm.name, q.shape[1])
    tried = [from_seed(trying, *each) for each in zip(poses, q, strict=True)]
    shares = {
        "jumps": jumps,
        "at_jumps": good[jumps],
        "elsewhere": good[~jumps],
        "singular": good[singular],
        "regular": good[~singular],
        "ranked": np.array([r.success and r.attempts == 1 for r in tried]),
        "any": np.array([r.success for r in tried]),
        "beside_label": solved(solver, poses, beside),
    }
    return {name: 100.0 * float(each.mean()) for name, each in shares.items()}


def _one_by_one(arm: Arm, model: Any, scaling: Scaling, count: int) -> Any:
    """A function of a pose and a seed: the best of so many outputs, (dof,) [rad]."""

    @jax.jit
    def scaled(x: jax.Array, seed: jax.Array) -> jax.Array:
        return model.outputs(x, jax.random.key(seed), count)

    def call(pose: Array, seed: np.uint32) -> Array:
        q = scaling.joints(np.asarray(scaled(scaling.inputs(pose[None]), seed)))[0]
        return q[best(arm.robot, q, pose) if count > 1 else 0]

    return call


def _as_seeds(
    arm: Arm, poses: Array, call: Any, *, direct: bool = False
) -> dict[str, Any]:
    """Success and mean times of outputs as seeds, and, if asked for, as they are."""
    arguments = [(pose, np.uint32(i)) for i, pose in enumerate(poses)]
    output_ns, seeds = time_calls(call, arguments, LIMIT_S)
    if len(seeds) < len(poses):
        raise RuntimeError(f"{len(seeds)} of {len(poses)} outputs in {LIMIT_S} s")
    solver = paper_solver(arm.name)
    solve_ns, results = time_calls(
        functools.partial(from_seed, solver),
        list(zip(poses, seeds, strict=True)),
        LIMIT_S,
    )
    options = solver.options
    tolerances = options.position_tolerance, options.rotation_tolerance
    q = np.array(
        [r.q if r.success else np.full(arm.chain.dof, np.nan) for r in results]
    )
    figures = {
        "right": int(right(arm.chain, poses, q, *tolerances).sum()),
        "most_attempts": max(result.attempts for result in results),
        "iterations": float(np.mean([result.iterations for result in results])),
        "output_us": float(output_ns.mean()) / 1e3,
        "solve_us": float(solve_ns.mean()) / 1e3,
    }
    if direct:
        good = right(arm.chain, poses, np.array(seeds), *tolerances)
        figures["direct_right"] = int(good.sum())
    return figures


def read_curve(path: Path) -> list[dict[str, float]]:
    """What train wrote beside the weights."""
    with path.open(encoding="utf-8", newline="") as file:
        return [
            {name: float(value) for name, value in row.items()}
            for row in csv.DictReader(file)
        ]
