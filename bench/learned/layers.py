# SPDX-License-Identifier: BSD-3-Clause
"""The one network that all models are made of."""

from __future__ import annotations

import equinox as eqx
import jax
import jax.numpy as jnp


class Mlp(eqx.Module):
    """Fully connected layers, of which those between the same widths are residual.

    Source of the residual form: He et al., "Deep Residual Learning for Image
    Recognition", 2016.
    """

    first: eqx.nn.Linear
    middle: tuple[eqx.nn.Linear, ...]
    last: eqx.nn.Linear

    def __init__(
        self, inputs: int, outputs: int, width: int, depth: int, key: jax.Array
    ) -> None:
        """Random weights; the last layer begins at a tenth of the usual ones.

        Args:
            inputs: Size of the input.
            outputs: Size of the output.
            width: Of the hidden layers.
            depth: How many of them, >= 1.
            key: For the weights.
        """
        keys = jax.random.split(key, depth + 1)
        self.first = eqx.nn.Linear(inputs, width, key=keys[0])
        self.middle = tuple(
            eqx.nn.Linear(width, width, key=each) for each in keys[1:-1]
        )
        last = eqx.nn.Linear(width, outputs, key=keys[-1])
        self.last = eqx.tree_at(lambda layer: layer.weight, last, 0.1 * last.weight)

    def __call__(self, x: jax.Array) -> jax.Array:
        """(..., inputs) -> (..., outputs)."""
        h = jax.nn.silu(_apply(self.first, x))
        for layer in self.middle:
            h = h + jax.nn.silu(_apply(layer, h))
        return _apply(self.last, h)


def _apply(layer: eqx.nn.Linear, x: jax.Array) -> jax.Array:
    """A linear layer on a batch, as one product of matrices."""
    assert layer.bias is not None
    return jnp.matmul(x, layer.weight.T) + layer.bias
