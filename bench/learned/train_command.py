# SPDX-License-Identifier: BSD-3-Clause
"""The command `train`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench.arguments import add_seed
from bench.arms import PAPER_ARMS
from bench.learned.plan import INPUTS, LABELS, MINUTES, MODELS, OURS, Recipe

if TYPE_CHECKING:
    import argparse


def add(commands: Any) -> None:
    """Its arguments."""
    command = commands.add_parser(
        "train",
        help="train one learned model for one robot and write its weights",
        description="Needs jax, optax and equinox (the extra bench-learned). Writes "
        "bench/learned/weights, or build/bench/learned where the report does not "
        "measure what is trained. The state is kept in build/bench: interrupted, the "
        "same command goes on; with more minutes it goes on longer.",
    )
    command.add_argument("robot", choices=PAPER_ARMS)
    command.add_argument("model", choices=MODELS)
    command.add_argument(
        "--minutes",
        type=float,
        default=MINUTES,
        help="in all, of CPU time on one thread (default: %(default)s)",
    )
    command.add_argument(
        "--labels",
        choices=LABELS,
        default=OURS.labels,
        help="of a pose: the answer nearest to the middle of the limits, or the "
        "configuration that the pose was drawn by (default: %(default)s)",
    )
    command.add_argument(
        "--inputs",
        choices=INPUTS,
        default=OURS.inputs,
        help="of a pose beside its position; the paper's models have drawn labels and "
        "quaternions (default: %(default)s)",
    )
    command.add_argument(
        "--gaussians",
        type=int,
        default=OURS.gaussians,
        help="of an MDN's mixture (default: %(default)s)",
    )
    add_seed(command)
    command.add_argument(
        "--fresh", action="store_true", help="begin again, from random weights"
    )


def run(options: argparse.Namespace) -> int:
    """Train as asked; the exit status."""
    from bench.learned.train import train  # noqa: PLC0415 - needs jax

    facts = train(
        options.robot,
        options.model,
        options.minutes,
        options.seed,
        recipe=Recipe(options.labels, options.inputs, options.gaussians),
        fresh=options.fresh,
    )
    print(facts)
    return 0
