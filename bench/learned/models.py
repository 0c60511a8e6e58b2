# SPDX-License-Identifier: BSD-3-Clause
"""The three kinds of models by name, and files of their weights."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, fields
from typing import TYPE_CHECKING, Any, Protocol

import equinox as eqx
import jax
import numpy as np

from bench.learned.data import FEATURES, Scaling
from bench.learned.diffusion import Diffusion
from bench.learned.flow import Flow
from bench.learned.mdn import Mdn
from bench.learned.plan import GAUSSIANS

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
    gaussians: int = GAUSSIANS
    """Of an MDN."""


def make_model(
    robot: str,
    name: str,
    dof: int,
    seed: int,
    *,
    features: int = FEATURES,
    gaussians: int = GAUSSIANS,
) -> Any:
    """A model with random weights, which is given so many numbers of a pose.

    Raises:
        KeyError: No such model.
    """
    key = jax.random.key(seed)
    if name == "diffusion":
        return Diffusion(dof, key, STEPS.get(robot, 5), features)
    if name == "flow":
        return Flow(dof, key, WIDTHS.get(robot, 72), features)
    return {"mdn": Mdn}[name](dof, key, features, gaussians)


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
    dof, features = len(scaling.q_mean), len(scaling.x_mean)
    # Shapes alone: to draw random weights first would take seconds of compiling.
    model = eqx.filter_eval_shape(
        make_model,
        facts.robot,
        facts.model,
        dof,
        facts.seed,
        features=features,
        gaussians=facts.gaussians,
    )
    shapes, rest = eqx.partition(model, lambda x: isinstance(x, jax.ShapeDtypeStruct))
    leaves, tree = jax.tree.flatten(shapes)
    size = sum(leaf.size for leaf in leaves)
    if size != len(flat):
        raise ValueError(f"{path} has {len(flat)} weights, not {size}")
    ends = np.cumsum([leaf.size for leaf in leaves])[:-1]
    parts = np.split(flat, ends)
    filled = [
        jax.numpy.asarray(part.reshape(leaf.shape))
        for part, leaf in zip(parts, leaves, strict=True)
    ]
    return eqx.combine(jax.tree.unflatten(tree, filled), rest), scaling, facts
