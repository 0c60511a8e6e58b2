# SPDX-License-Identifier: BSD-3-Clause
"""The arguments of python -m bench learned."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench.arguments import add_fresh, add_quick
from bench.arms import PAPER_ARMS
from bench.learned.plan import LABELS, MODELS

if TYPE_CHECKING:
    import argparse


def add(commands: Any) -> None:
    """Add the command to those of the benchmarks."""
    learned = commands.add_parser(
        "learned",
        help="train the learned seeds, or measure the committed ones",
        description="Seeds from models that are learned: a mixture density network, a "
        "normalizing flow, a diffusion. Needs jax, optax and equinox (the extra "
        "bench-learned).",
    )
    actions = learned.add_subparsers(dest="action", required=True, metavar="ACTION")
    _add_train(actions)
    evaluate = actions.add_parser(
        "evaluate", help="measure the committed weights and print the section"
    )
    evaluate.add_argument(
        "robots", nargs="*", metavar="ROBOT", help=f"of {', '.join(PAPER_ARMS)}"
    )
    evaluate.add_argument(
        "--models", nargs="+", choices=MODELS, default=MODELS, help="only these"
    )
    add_quick(evaluate, "half the targets")
    add_fresh(evaluate)
    actions.add_parser("table", help="print the section of the report that is there")


def _add_train(actions: Any) -> None:
    train = actions.add_parser(
        "train",
        help="train one model for one robot and write its weights",
        description="Writes bench/learned/weights, or build/bench/learned with other "
        "labels than the report's. The state is kept in build/bench: interrupted, the "
        "same command goes on; with more minutes it goes on longer.",
    )
    train.add_argument("robot", choices=PAPER_ARMS)
    train.add_argument("model", choices=MODELS)
    train.add_argument(
        "--minutes",
        type=float,
        default=45.0,
        help="in all, of CPU time on one thread (default: %(default)s)",
    )
    train.add_argument(
        "--labels",
        choices=LABELS,
        default=LABELS[0],
        help="of a pose: the answer nearest to the middle of the limits, or the "
        "configuration that the pose was drawn by (default: %(default)s)",
    )
    train.add_argument("--seed", type=int, default=1)
    train.add_argument(
        "--fresh", action="store_true", help="begin again, from random weights"
    )


def train(options: argparse.Namespace) -> int:
    """Train as asked; the exit status."""
    from bench.learned.train import train as run  # noqa: PLC0415 - needs jax

    facts = run(
        options.robot,
        options.model,
        options.minutes,
        options.seed,
        labels=options.labels,
        fresh=options.fresh,
    )
    print(facts)
    return 0
