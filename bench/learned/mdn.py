# SPDX-License-Identifier: BSD-3-Clause
"""A mixture density network: a mixture of Gaussians over q, given the pose.

Source: Bishop, "Mixture Density Networks", 1994.
"""

from __future__ import annotations

from typing import ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp

from bench.learned.data import FEATURES
from bench.learned.layers import Mlp
from bench.learned.plan import GAUSSIANS

LEAST_DEVIATION = 0.01
"""Of a component, in units of the labels' own: what is nearer is all the same to the
iteration, and a mixture of spikes does not train."""


class Mdn(eqx.Module):
    """Gaussians with independent joints."""

    name: ClassVar[str] = "mdn"
    batch: ClassVar[int] = 1
    """Outputs for a pose: as in the paper, the mean of the likeliest component."""

    network: Mlp
    dof: int = eqx.field(static=True)
    components: int = eqx.field(static=True)

    def __init__(
        self,
        dof: int,
        key: jax.Array,
        features: int = FEATURES,
        components: int = GAUSSIANS,
    ) -> None:
        """Random weights."""
        self.dof = dof
        self.components = components
        outputs = self.components * (1 + 2 * dof)
        self.network = Mlp(features, outputs, width=208, depth=6, key=key)

    def mixture(self, x: jax.Array) -> tuple[jax.Array, jax.Array, jax.Array]:
        """Log weights (B, K), means (B, K, dof) and deviations (B, K, dof)."""
        out = self.network(x).reshape(*x.shape[:-1], self.components, -1)
        log_weights = jax.nn.log_softmax(out[..., 0])
        means = out[..., 1 : 1 + self.dof]
        deviations = LEAST_DEVIATION + jax.nn.softplus(out[..., 1 + self.dof :])
        return log_weights, means, deviations

    def log_density(self, q: jax.Array, x: jax.Array) -> jax.Array:
        """Log of the density at q, (B, dof), given x, (B, FEATURES): (B,)."""
        log_weights, means, deviations = self.mixture(x)
        z = (q[..., None, :] - means) / deviations
        logs = -0.5 * z**2 - jnp.log(deviations) - 0.5 * jnp.log(2.0 * jnp.pi)
        return jax.scipy.special.logsumexp(log_weights + logs.sum(axis=-1), axis=-1)

    def loss(self, q: jax.Array, x: jax.Array, key: jax.Array) -> jax.Array:
        """Mean negative log density."""
        del key
        return -self.log_density(q, x).mean()

    def outputs(self, x: jax.Array, key: jax.Array, count: int) -> jax.Array:
        """The likeliest component's mean, count times: (B, count, dof)."""
        del key
        log_weights, means, _ = self.mixture(x)
        best = jnp.argmax(log_weights, axis=-1)[..., None, None]
        mean = jnp.take_along_axis(means, best, axis=-2)
        return jnp.repeat(mean, count, axis=-2)
