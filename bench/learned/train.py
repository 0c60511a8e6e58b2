# SPDX-License-Identifier: BSD-3-Clause
"""Training: one model for one robot, on one CPU thread, that can be gone on with.

Minutes are CPU time of the process: those of a clock while it has a core by itself.
How many steps they are is measured at the beginning; the learning rate falls as a
cosine over these. A second call with more minutes goes on, on the longer cosine.
"""

from __future__ import annotations

import csv
import json
import sys
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import optax

from bench.learned.data import TRAIN_SEED, Scaling, labelled, scaling_of
from bench.learned.evaluate import seeds_solved
from bench.learned.models import Facts, make_model, parameters, save_weights
from bench.learned.plan import CURVE, OURS, name_of, weights_path
from bench.settings import WORK

if TYPE_CHECKING:
    from pathlib import Path

    from bench.learned.plan import Recipe

BATCH = 1024
PEAK_RATE = 2e-3
WARM_UP = 500
"""Steps over which the learning rate rises."""
DECAY = 0.999
"""Of the running mean of the weights, which is what is evaluated and kept."""
STEPS_A_CALL = 100
SAMPLES = 1_000_000
CURVE_POINTS = 12
SAVED_EVERY_S = 60.0


class State(eqx.Module):
    """All that changes while training."""

    model: Any
    mean: Any
    """Running mean of the model's arrays."""
    moments: Any
    step: jax.Array


def rate(step: jax.Array, total: jax.Array) -> jax.Array:
    """Learning rate at a step of so many."""
    rise = jnp.minimum((step + 1) / WARM_UP, 1.0)
    fall = 0.5 * (1.0 + jnp.cos(jnp.pi * jnp.minimum(step / total, 1)))
    return PEAK_RATE * rise * fall


def optimizer() -> optax.GradientTransformation:
    """Adam without its rate, behind a limit on the gradient's length."""
    return optax.chain(optax.clip_by_global_norm(1.0), optax.scale_by_adam(b2=0.99))


def first_state(robot: str, name: str, dof: int, seed: int, **sizes: int) -> State:
    """Random weights; sizes as make_model has them."""
    model = make_model(robot, name, dof, seed, **sizes)
    arrays = eqx.filter(model, eqx.is_array)
    return State(model, arrays, optimizer().init(arrays), jnp.zeros((), jnp.int32))


@eqx.filter_jit
def train_steps(
    state: State, x: jax.Array, q: jax.Array, total: jax.Array, seed: int
) -> tuple[State, jax.Array]:
    """STEPS_A_CALL steps on random batches; their mean loss.

    What a step draws depends on the seed and its number alone.
    """
    arrays, rest = eqx.partition(state, eqx.is_array)

    def one(arrays: Any, _: None) -> tuple[Any, jax.Array]:
        now: State = eqx.combine(arrays, rest)
        keys = jax.random.split(jax.random.fold_in(jax.random.key(seed), now.step))
        rows = jax.random.randint(keys[0], (BATCH,), 0, len(x))
        loss, gradient = eqx.filter_value_and_grad(
            lambda model: model.loss(q[rows], x[rows], keys[1])
        )(now.model)
        updates, moments = optimizer().update(gradient, now.moments)
        size = rate(now.step, total)
        updates = jax.tree.map(lambda u: -size * u, updates)
        model = eqx.apply_updates(now.model, updates)
        decay = jnp.minimum(DECAY, (1.0 + now.step) / (10.0 + now.step))
        mean = jax.tree.map(
            lambda m, w: decay * m + (1.0 - decay) * w,
            now.mean,
            eqx.filter(model, eqx.is_array),
        )
        after = State(model, mean, moments, now.step + 1)
        return eqx.filter(after, eqx.is_array), loss

    arrays, losses = jax.lax.scan(one, arrays, length=STEPS_A_CALL)
    return eqx.combine(arrays, rest), losses.mean()


def mean_model(state: State) -> Any:
    """The model with the running mean of its weights."""
    return eqx.combine(state.mean, eqx.filter(state.model, eqx.is_array, inverse=True))


def checkpoint_path(robot: str, name: str, recipe: Recipe = OURS) -> Path:
    """Where a training's state is kept."""
    return WORK / "learned" / f"{name_of(robot, name, recipe)}.state.npz"


@dataclass
class Training:
    """A training that goes on: what it learns from, and how far it is."""

    robot: str
    model: str
    seed: int
    scaling: Scaling
    x: jax.Array
    q: jax.Array
    state: State
    seconds: float = 0.0
    """CPU time spent."""
    minutes: float = 0.0
    """Asked for, in all."""
    total: int = 0
    """Steps that these are."""
    curve: list[dict[str, float]] = field(default_factory=list)
    recipe: Recipe = OURS

    @property
    def title(self) -> str:
        """What is trained."""
        return f"{self.robot} {self.model}"

    @property
    def step(self) -> int:
        """How many steps are done."""
        return int(self.state.step)

    def save(self, path: Path) -> None:
        """Write all that changes; an interruption leaves the old file."""
        leaves = jax.tree.leaves(eqx.filter(self.state, eqx.is_array))
        progress = {name: getattr(self, name) for name in PROGRESS}
        part = path.with_suffix(".part.npz")
        path.parent.mkdir(parents=True, exist_ok=True)
        np.savez(part, *map(np.asarray, leaves), progress=json.dumps(progress))
        part.replace(path)

    def load(self, path: Path) -> None:
        """Go on from what save wrote."""
        arrays, rest = eqx.partition(self.state, eqx.is_array)
        leaves, tree = jax.tree.flatten(arrays)
        with np.load(path) as file:
            for name, value in json.loads(str(file["progress"])).items():
                setattr(self, name, value)
            read = [jnp.asarray(file[f"arr_{i}"]) for i in range(len(leaves))]
        self.state = eqx.combine(jax.tree.unflatten(tree, read), rest)

    def advance(self) -> float:
        """STEPS_A_CALL more steps; their mean loss."""
        begin = time.process_time()
        total = jnp.asarray(self.total)
        self.state, loss = train_steps(self.state, self.x, self.q, total, self.seed)
        mean = float(loss)
        self.seconds += time.process_time() - begin
        return mean

    def plan(self, minutes: float) -> None:
        """Turn minutes in all into steps, by the time of a call that is thrown away."""
        if minutes == self.minutes:
            return
        for _ in range(2):  # the first one compiles
            begin = time.process_time()
            total = jnp.asarray(STEPS_A_CALL)
            done = train_steps(self.state, self.x, self.q, total, self.seed)
            jax.block_until_ready(done)
            each = (time.process_time() - begin) / STEPS_A_CALL
        left = max(60.0 * minutes - self.seconds, 0.0)
        self.minutes = minutes
        self.total = max(self.step + int(left / each), STEPS_A_CALL)

    def point(self, loss: float) -> None:
        """Add to the curve, by poses that are neither learned from nor reported."""
        model = mean_model(self.state)
        solved = seeds_solved(self.robot, model, self.scaling, TRAIN_SEED + 1, CURVE)
        point = {"minutes": round(self.seconds / 60.0, 2), "steps": self.step}
        shares = {name: round(value, 1) for name, value in solved.items()}
        self.curve.append({**point, "loss": round(loss, 4), **shares})


PROGRESS = ("seconds", "minutes", "total", "curve")
"""Of a Training, what a checkpoint has beside the state."""


def begin_training(
    robot: str, model: str, seed: int, samples: int, recipe: Recipe = OURS
) -> Training:
    """From random weights."""
    say(f"{robot} {model}: {samples:,} labels, made now unless they are there")
    x, q = labelled(robot, samples, TRAIN_SEED, recipe)
    scaling = scaling_of(x, q)
    sizes = {"features": x.shape[1], "gaussians": recipe.gaussians}
    return Training(
        robot,
        model,
        seed,
        scaling,
        jnp.asarray((x - scaling.x_mean) / scaling.x_std),
        jnp.asarray((q - scaling.q_mean) / scaling.q_std),
        first_state(robot, model, q.shape[1], seed, **sizes),
        recipe=recipe,
    )


def train(
    robot: str,
    model: str,
    minutes: float,
    seed: int,
    *,
    fresh: bool = False,
    samples: int = SAMPLES,
    recipe: Recipe = OURS,
) -> Facts:
    """Train up to so many minutes in all, and write weights and curve.

    Goes on from what an earlier call left in build/bench, unless it is to be fresh.
    """
    training = begin_training(robot, model, seed, samples, recipe)
    path = checkpoint_path(robot, model, recipe)
    if path.exists() and not fresh:
        training.load(path)
        say(f"{training.title}: goes on from step {training.step:,}")
    training.plan(minutes)
    points = np.linspace(0, training.total, CURVE_POINTS + 1)[1:]
    saved = time.monotonic()
    while training.step < training.total:
        before = training.step
        loss = training.advance()
        say(_bar(training, loss))
        if np.any((points > before) & (points <= training.step)):
            training.point(loss)
            say(f"{training.title}: {training.curve[-1]}")
        if time.monotonic() - saved > SAVED_EVERY_S:
            training.save(path)
            saved = time.monotonic()
    training.save(path)
    return _write(training)


def _write(training: Training) -> Facts:
    """The weights and the curve, beside each other."""
    mean = mean_model(training.state)
    facts = Facts(
        robot=training.robot,
        model=training.model,
        minutes=round(training.seconds / 60.0, 2),
        steps=training.step,
        batch=BATCH,
        samples=len(training.x),
        seed=training.seed,
        parameters=parameters(mean),
        gaussians=training.recipe.gaussians,
    )
    path = weights_path(training.robot, training.model, training.recipe)
    save_weights(path, mean, training.scaling, facts)
    with path.with_suffix(".csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, training.curve[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(training.curve)
    return facts


def _bar(training: Training, loss: float) -> str:
    part = min(training.step / max(training.total, 1), 1.0)
    return (
        f"\r\033[K[{'#' * int(24 * part):<24}] {part:4.0%} "
        f"{training.seconds / 60:5.1f} min  {training.title}  "
        f"step {training.step} of {training.total}, loss {loss:.3f}"
    )


def say(text: str) -> None:
    """A line on stderr; one that begins with a return is the bar, for a terminal."""
    if text.startswith("\r"):
        if sys.stderr.isatty():
            sys.stderr.write(text)
    else:
        sys.stderr.write(("\r\033[K" if sys.stderr.isatty() else "") + text + "\n")
    sys.stderr.flush()
