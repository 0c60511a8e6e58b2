# SPDX-License-Identifier: BSD-3-Clause
"""Cells on what the paper's text says of its choices: one choice beside the preset's.

Both settings get the same targets, so what counts is the targets that only one solves.
"""

from __future__ import annotations

import functools
import importlib
import json
import pickle
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.arms import load_arm
from bench.settings import make_solver
from bench.store import key_of

if TYPE_CHECKING:
    import numpy.typing as npt

    from bench.chain import Array
    from bench.store import Settings


def paired(settings: Settings) -> dict[str, Any]:
    """Targets that the settings solve, those "against" them, and only one of both."""
    alone = {name: value for name, value in settings.items() if name != "against"}
    ours, others = (
        _solved(key_of({**alone, "overrides": overrides}))
        for overrides in (settings["overrides"], settings["against"])
    )
    return {
        "count": len(ours),
        "solved": int(ours.sum()),
        "against_solved": int(others.sum()),
        "won": int(np.count_nonzero(ours & ~others)),
        "lost": int(np.count_nonzero(~ours & others)),
    }


@functools.cache
def _solved(key: str) -> npt.NDArray[np.bool_]:
    """Which targets of iksel.evaluate, to the last bit, are solved.

    A choice stands beside many others: a job solves its targets once.
    """
    settings: Settings = json.loads(key)
    solver = make_solver(settings)
    robot = load_arm(settings["robot"]).robot
    q = robot.random_configurations(settings["count"], settings["seed"])
    poses = robot.fk(q, iksel.Kinematics.kdl)
    return np.asarray(solver.solve_batch(poses).success)


def tree_file(settings: Settings) -> dict[str, Any]:
    """Bytes of SciPy's KD-tree of a database's keys as a pickle, without the samples.

    The cell says so where SciPy is not installed.
    """
    try:
        spatial = importlib.import_module("scipy.spatial")
    except ModuleNotFoundError:
        return {"unsupported": "scipy is not installed"}
    database = make_solver(settings).database
    poses = np.array([database.pose(i) for i in range(len(database))])
    keys = np.hstack([poses[:, :3, 3], rotation_vectors(poses[:, :3, :3])])
    return {"samples": len(keys), "bytes": len(pickle.dumps(spatial.KDTree(keys)))}


def rotation_vectors(turns: Array) -> Array:
    """Of rotation matrices, (N, 3, 3) -> (N, 3) [rad]; half turns too."""
    sine = 0.5 * np.stack(
        [
            turns[:, 2, 1] - turns[:, 1, 2],
            turns[:, 0, 2] - turns[:, 2, 0],
            turns[:, 1, 0] - turns[:, 0, 1],
        ],
        axis=1,
    )
    length = np.linalg.norm(sine, axis=1, keepdims=True)
    cosine = 0.5 * (np.trace(turns, axis1=1, axis2=2)[:, None] - 1.0)
    angle = np.arctan2(length, cosine)
    # (R + 1) / 2 is then axis axis^T: its longest column has the axis' direction.
    halves = turns + np.eye(3)
    column = np.argmax(np.einsum("nij,nij->nj", halves, halves), axis=1)
    axis = halves[np.arange(len(turns)), :, column]
    axis = axis / np.maximum(np.linalg.norm(axis, axis=1, keepdims=True), 1e-12)
    exact = angle * sine / np.maximum(length, 1e-12)
    half = (length < 1e-9) & (cosine < 0)
    return np.asarray(np.where(half, np.pi * axis, exact))
