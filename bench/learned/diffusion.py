# SPDX-License-Identifier: BSD-3-Clause
"""A diffusion model over q, given the pose, sampled in a few steps as IKDP is.

q_t = cos(pi t / 2) q + sin(pi t / 2) noise; the network says its velocity
v = cos(pi t / 2) noise - sin(pi t / 2) q, from which both follow.

Sources: Song et al., "Denoising Diffusion Implicit Models", 2021; Salimans and Ho,
"Progressive Distillation", 2022 (the velocity); Tsui et al., "IKDP", 2024.
"""

from __future__ import annotations

import itertools
from typing import ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp

from bench.learned.data import FEATURES
from bench.learned.layers import Mlp

FREQUENCIES = 4
"""Of the sines and cosines by which the network sees the time."""


def schedule(t: jax.Array) -> tuple[jax.Array, jax.Array]:
    """Shares of q and of noise at a time in [0, 1]; their squares sum up to 1."""
    return jnp.cos(0.5 * jnp.pi * t), jnp.sin(0.5 * jnp.pi * t)


class Diffusion(eqx.Module):
    """A network for the velocity."""

    name: ClassVar[str] = "diffusion"
    batch: ClassVar[int] = 32

    network: Mlp
    dof: int = eqx.field(static=True)
    steps: int = eqx.field(static=True)

    def __init__(
        self, dof: int, key: jax.Array, steps: int = 5, features: int = FEATURES
    ) -> None:
        """Random weights; steps of sampling, as the paper has them."""
        self.dof = dof
        self.steps = steps
        inputs = dof + features + 2 * FREQUENCIES
        self.network = Mlp(inputs, dof, width=216, depth=6, key=key)

    def velocity(self, q_t: jax.Array, x: jax.Array, t: jax.Array) -> jax.Array:
        """(..., dof) of noisy joints (..., dof), x (..., FEATURES) and t (..., 1)."""
        angles = 0.5 * jnp.pi * t * jnp.arange(1, FREQUENCIES + 1)
        seen = [q_t, x, jnp.sin(angles), jnp.cos(angles)]
        return self.network(jnp.concatenate(seen, axis=-1))

    def loss(self, q: jax.Array, x: jax.Array, key: jax.Array) -> jax.Array:
        """Mean squared error of the velocity."""
        keys = jax.random.split(key)
        t = jax.random.uniform(keys[0], (len(q), 1))
        noise = jax.random.normal(keys[1], q.shape)
        share, noise_share = schedule(t)
        predicted = self.velocity(share * q + noise_share * noise, x, t)
        return ((predicted - (share * noise - noise_share * q)) ** 2).mean()

    def outputs(self, x: jax.Array, key: jax.Array, count: int) -> jax.Array:
        """So many samples for each x by DDIM: (B, count, dof)."""
        x = jnp.repeat(x[..., None, :], count, axis=-2)
        q_t = jax.random.normal(key, (*x.shape[:-1], self.dof))
        times = jnp.linspace(1.0, 0.0, self.steps + 1)
        for now, after in itertools.pairwise(times):
            share, noise_share = schedule(now)
            v = self.velocity(q_t, x, jnp.broadcast_to(now, (*x.shape[:-1], 1)))
            q = share * q_t - noise_share * v
            noise = noise_share * q_t + share * v
            share, noise_share = schedule(after)
            q_t = share * q + noise_share * noise
        return q_t
