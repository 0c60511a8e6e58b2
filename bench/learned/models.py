# SPDX-License-Identifier: BSD-3-Clause
"""The three kinds of models by name, and files of their weights."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, fields
from typing import TYPE_CHECKING, Any, Protocol

import equinox as eqx
import jax
import numpy as np

from bench.learned.data import Scaling
from bench.learned.diffusion import Diffusion
from bench.learned.flow import Flow
from bench.learned.mdn import Mdn

if TYPE_CHECKING:
    from pathlib import Path

STEPS = {"cvrb1213": 10}
"""Of the diffusion's sampling, where the paper has other than 5."""
WIDTHS = {"cvr038": 128, "cvrb1213": 128}
"""Of the flow's hidden layers, where they are wider than elsewhere."""


class Model(Protocol):
    """What the three have."""

    name: str
    batch: int
    """Outputs for a pose in the report."""
    dof: int

    def loss(self, q: jax.Array, x: jax.Array, key: jax.Array) -> jax.Array:
        """Of scaled labels (B, dof), given scaled features (B, FEATURES)."""

    def outputs(self, x: jax.Array, key: jax.Array, count: int) -> jax.Array:
        """So many scaled labels for each x, (B, FEATURES): (B, count, dof)."""


@dataclass(frozen=True)
class Facts:
    """How weights came about."""

    robot: str
    model: str
    minutes: float
    """CPU time of training, of one thread."""
    steps: int
    batch: int
    samples: int
    """Poses learned from."""
    seed: int
    parameters: int


def make_model(robot: str, name: str, dof: int, seed: int) -> Any:
    """A model with random weights.

    Raises:
        KeyError: No such model.
    """
    key = jax.random.key(seed)
    if name == "diffusion":
        return Diffusion(dof, key, STEPS.get(robot, 5))
    if name == "flow":
        return Flow(dof, key, WIDTHS.get(robot, 72))
    return {"mdn": Mdn}[name](dof, key)


def parameters(model: Any) -> int:
    """Number of weights."""
    leaves = jax.tree.leaves(eqx.filter(model, eqx.is_array))
    return sum(leaf.size for leaf in leaves)


def save_weights(path: Path, model: Any, scaling: Scaling, facts: Facts) -> None:
    """Write weights in half precision, which is 5e-4 of each, and what goes with them.

    An npz file has arrays only: nothing in it is run when it is read.
    """
    leaves = jax.tree.leaves(eqx.filter(model, eqx.is_array))
    flat = np.concatenate([np.asarray(leaf, np.float16).ravel() for leaf in leaves])
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_suffix(".part.npz")
    np.savez_compressed(
        part, weights=flat, facts=json.dumps(asdict(facts)), **asdict(scaling)
    )
    part.replace(path)


def load_weights(path: Path) -> tuple[Any, Scaling, Facts]:
    """Read what save_weights wrote.

    Raises:
        FileNotFoundError: Not trained.
        ValueError: Weights of another architecture.
    """
    with np.load(path) as file:
        facts = Facts(**json.loads(str(file["facts"])))
        scaling = Scaling(**{field.name: file[field.name] for field in fields(Scaling)})
        flat = file["weights"].astype(np.float32)
    model = make_model(facts.robot, facts.model, len(scaling.q_mean), facts.seed)
    arrays, rest = eqx.partition(model, eqx.is_array)
    leaves, tree = jax.tree.flatten(arrays)
    if sum(leaf.size for leaf in leaves) != len(flat):
        raise ValueError(f"{path} has {len(flat)} weights, not {parameters(model)}")
    ends = np.cumsum([leaf.size for leaf in leaves])[:-1]
    parts = np.split(flat, ends)
    filled = [
        jax.numpy.asarray(part.reshape(leaf.shape))
        for part, leaf in zip(parts, leaves, strict=True)
    ]
    return eqx.combine(jax.tree.unflatten(tree, filled), rest), scaling, facts
