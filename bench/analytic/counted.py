# SPDX-License-Identifier: BSD-3-Clause
"""A cell: a solver asked for so many answers of a redundant arm."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from bench.analytic.cells import Asked, Given, ask, judged_answers
from bench.branches import distinct, near_of
from bench.rivals import ENUMERATORS
from bench.timing import mean_median

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.store import Settings
    from bench.targets import Targets

CHOSEN_BY = 200
"""Targets by which a number of samples is chosen."""
ROUNDS = 4
"""Numbers that are tried for it."""


def counted(arm: Arm, goals: Targets, settings: Settings) -> dict[str, Any]:
    """Time and right answers of each number that is asked for.

    Where a solver takes a number of samples, it is one that gives about as many right
    answers in the mean.
    """
    rival = ENUMERATORS[settings["rival"]](arm)
    this = Asked(rival, arm.chain, goals, near_of(goals, settings["seed"]))
    given_for = {}
    for number in settings["numbers"]:
        taken = _samples(this, arm, number) if rival.of_samples else number
        rival.requests[str(number)] = rival.so_many(arm, taken)
        given_for[str(number)] = taken
    given = ask(this, list(given_for), settings["limit_s"])
    return {
        "structure": arm.robot.structure.kind.name,
        **{
            number: {"taken": taken, **_figures(given[number], int(number))}
            for number, taken in given_for.items()
        },
    }


def _figures(given: Given, number: int) -> dict[str, Any]:
    found = [len(distinct(q)) for q in given.right]
    return {
        "count": len(found),
        "us": mean_median(given.times),
        "answers": sum(found),
        "fewer": sum(n < number for n in found),
        "missed": sum(n == 0 for n in found),
        "wrong": given.wrong,
    }


def _samples(this: Asked, arm: Arm, wanted: int) -> int:
    """The number of samples whose right answers are about as many in the mean."""
    few = this.goals.first(CHOSEN_BY)
    this = replace(this, goals=few, near=this.near[:CHOSEN_BY])
    samples = wanted
    for _ in range(ROUNDS):
        request = this.rival.so_many(arm, samples)
        given = [
            request.answers(request.call(*request.prepare(pose, near)))
            for pose, near in zip(few.poses, this.near, strict=True)
        ]
        right, _ = judged_answers(this, "every", given)
        found = sum(len(distinct(q)) for q in right)
        # Answers come in proportion to samples, but for where none were.
        samples = round(samples * wanted * len(few) / max(found, 1))
    return samples
