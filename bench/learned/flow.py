# SPDX-License-Identifier: BSD-3-Clause
"""A normalizing flow over q, given the pose, in the architecture of IKFlow.

15 affine coupling blocks on 15 numbers: the joints, and noise as padding. A block
changes one half by the other, and then the other by the one: where only one half was
changed, first and best of 32 on C1 were 70.4 and 84.0 % after 4.2 minutes, with both
78.4 and 86.8 % (500 poses; width 72, `python -m bench train`). A share of noise on the
joints, which the blocks are told (SoftFlow), gives the labels a density. Other than in
IKFlow the blocks see the pose through one network that they share, and are narrow:
theirs have three layers of 1024 each.

Sources: Dinh et al., "Density Estimation Using Real NVP", 2017; Kim et al., "SoftFlow",
2020; Ames et al., "IKFlow", 2022.
"""

from __future__ import annotations

from typing import ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from bench.learned.data import FEATURES
from bench.learned.layers import Mlp

LAYERS = 15
WIDTH = 15
"""Numbers that flow."""
KEPT = 7
"""Of them, those that a coupling layer leaves as they are."""
CONTEXT = 64
"""Numbers that the layers see of a pose."""
LARGEST_LOG_SCALE = 2.0
LEAST_NOISE, MOST_NOISE = 0.005, 0.5
"""Deviation of the noise on the joints, in units of the labels' own."""


class Half(eqx.Module):
    """y = x exp(s(a)) + t(a), given the other half a and the context."""

    network: Mlp

    def __init__(self, kept: int, width: int, key: jax.Array) -> None:
        """Random weights."""
        outputs = 2 * (WIDTH - kept)
        self.network = Mlp(kept + CONTEXT, outputs, width=width, depth=2, key=key)

    def scale_shift(self, a: jax.Array, c: jax.Array) -> tuple[jax.Array, jax.Array]:
        """The logarithm of s, and t, (B, WIDTH - kept) each."""
        out = self.network(jnp.concatenate([a, c], axis=-1))
        scale, shift = jnp.split(out, 2, axis=-1)
        return LARGEST_LOG_SCALE * jnp.tanh(scale / LARGEST_LOG_SCALE), shift


class Coupling(eqx.Module):
    """(a, b) -> (a', b'): b by a, and then a by b'."""

    first: Half
    second: Half

    def __init__(self, width: int, key: jax.Array) -> None:
        """Random weights."""
        keys = jax.random.split(key)
        self.first = Half(KEPT, width, keys[0])
        self.second = Half(WIDTH - KEPT, width, keys[1])

    def forward(self, x: jax.Array, c: jax.Array) -> tuple[jax.Array, jax.Array]:
        """y, (B, WIDTH), and log |det dy/dx|, (B,), given the context c."""
        a, b = x[..., :KEPT], x[..., KEPT:]
        scale, shift = self.first.scale_shift(a, c)
        b = b * jnp.exp(scale) + shift
        other, shift = self.second.scale_shift(b, c)
        a = a * jnp.exp(other) + shift
        y = jnp.concatenate([a, b], axis=-1)
        return y, scale.sum(axis=-1) + other.sum(axis=-1)

    def inverse(self, y: jax.Array, c: jax.Array) -> jax.Array:
        """x, (B, WIDTH)."""
        a, b = y[..., :KEPT], y[..., KEPT:]
        scale, shift = self.second.scale_shift(b, c)
        a = (a - shift) * jnp.exp(-scale)
        scale, shift = self.first.scale_shift(a, c)
        b = (b - shift) * jnp.exp(-scale)
        return jnp.concatenate([a, b], axis=-1)


class Flow(eqx.Module):
    """Coupling layers with fixed permutations before them."""

    name: ClassVar[str] = "flow"
    batch: ClassVar[int] = 32

    encoder: Mlp
    couplings: tuple[Coupling, ...]
    dof: int = eqx.field(static=True)

    def __init__(
        self, dof: int, key: jax.Array, width: int, features: int = FEATURES
    ) -> None:
        """Random weights; hidden layers of the blocks are so wide."""
        keys = jax.random.split(key, LAYERS + 1)
        self.dof = dof
        self.encoder = Mlp(features + 1, CONTEXT, width=160, depth=3, key=keys[0])
        self.couplings = tuple(Coupling(width, each) for each in keys[1:])

    def context(self, x: jax.Array, log_noise: jax.Array) -> jax.Array:
        """What the layers see of x, (B, FEATURES), and the noise's log, (B, 1)."""
        middle = 0.5 * np.log(LEAST_NOISE * MOST_NOISE)
        return self.encoder(jnp.concatenate([x, log_noise - middle], axis=-1))

    def forward(self, v: jax.Array, c: jax.Array) -> tuple[jax.Array, jax.Array]:
        """The latent of v, (B, WIDTH), and log |det|, (B,)."""
        log_det = jnp.zeros(v.shape[:-1])
        for order, coupling in zip(ORDERS, self.couplings, strict=True):
            v, part = coupling.forward(v[..., order], c)
            log_det = log_det + part
        return v, log_det

    def inverse(self, z: jax.Array, c: jax.Array) -> jax.Array:
        """Joints and padding of a latent, (B, WIDTH)."""
        for order, coupling in zip(
            reversed(ORDERS), reversed(self.couplings), strict=True
        ):
            z = coupling.inverse(z, c)[..., np.argsort(order)]
        return z

    def loss(self, q: jax.Array, x: jax.Array, key: jax.Array) -> jax.Array:
        """Mean negative log density of noisy joints with padding."""
        keys = jax.random.split(key, 3)
        low, high = np.log(LEAST_NOISE), np.log(MOST_NOISE)
        log_noise = jax.random.uniform(keys[0], (len(q), 1), minval=low, maxval=high)
        noisy = q + jnp.exp(log_noise) * jax.random.normal(keys[1], q.shape)
        padding = jax.random.normal(keys[2], (len(q), WIDTH - self.dof))
        c = self.context(x, log_noise)
        z, log_det = self.forward(jnp.concatenate([noisy, padding], axis=-1), c)
        return (0.5 * (z**2).sum(axis=-1) - log_det).mean()

    def outputs(self, x: jax.Array, key: jax.Array, count: int) -> jax.Array:
        """So many samples for each x: (B, count, dof)."""
        c = self.context(x, jnp.full((*x.shape[:-1], 1), np.log(LEAST_NOISE)))
        c = jnp.repeat(c[..., None, :], count, axis=-2)
        z = jax.random.normal(key, (*c.shape[:-1], WIDTH))
        return self.inverse(z, c)[..., : self.dof]


def _orders() -> tuple[np.ndarray, ...]:
    """What is permuted before each layer: the same for all models."""
    random = np.random.default_rng(1)
    return tuple(random.permutation(WIDTH) for _ in range(LAYERS))


ORDERS = _orders()
