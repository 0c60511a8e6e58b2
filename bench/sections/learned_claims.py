# SPDX-License-Identifier: BSD-3-Clause
"""What the paper's text says of learned seeds, tested by the rows."""

from __future__ import annotations

import functools
import math
from typing import TYPE_CHECKING

import numpy as np

from bench.arms import PAPER_ARMS
from bench.bounds import TWO_SIDED
from bench.learned.plan import MODELS, OURS, PAPERS, Recipe, learned_cell
from bench.markdown import table
from bench.paper import plan as paper_plan
from bench.paper.bounds import Margin
from bench.paper.claims import (
    ALL,
    C0,
    AbsentError,
    Claim,
    Figures,
    Row,
    longer,
)
from bench.paper.claims import published_row as published_table_row
from bench.paper.learned import LEARNED
from bench.paper.published import ROBOTS
from bench.sections.claims import beside, margins_of, verdict

if TYPE_CHECKING:
    from collections.abc import Callable

    from bench.view import View

    Look = Callable[[str, int], Row]

GENERATIVE = ("flow", "diffusion")
ERRORS = ("position", "rotation")
METHOD = "Eq. (5)"
"""The paper's own method with one re-selection: a row of its tables."""
PUBLISHED_TARGETS = 2_000
FAST_US, SLOW_US = 500.0, 10_000.0
"""Times in the text: an MDN's output takes less, generative models more."""


def _nearer(model: str, others: tuple[str, ...], error: str) -> Callable[..., float]:
    """By how many percent the least of the others' errors is larger."""

    def margin(f: Figures) -> float:
        least = min(f.mean(f"{other} {error}") for other in others)
        return longer(f.mean(f"{model} {error}"), least)

    return margin


def _far_but_for_c0(error: str) -> Callable[..., float]:
    return lambda f: longer(f.on(C0).mean(f"mdn {error}"), f.mean(f"mdn {error}"))


def _best_beyond(model: str, row: str) -> Callable[..., float]:
    return lambda f: f.gain(row, f"{model} best")


def _generative_us(f: Figures) -> float:
    """The shorter of their times for 32 outputs."""
    return min(f.mean(f"{model} time") for model in GENERATIVE)


NEARER = (
    ("flow's outputs are nearer than the MDN's", "flow", ("mdn",), ALL),
    ("on C0 flow's are nearest of the three", "flow", ("mdn", "diffusion"), (C0,)),
    ("diffusion's are nearest, on most robots", "diffusion", ("mdn", "flow"), ALL),
)
"""Text, model, those it is nearer than, robots."""

CLAIMS = (
    *(
        Claim(
            f"the MDN is far off but on C0: {error} error beside C0's",
            "%",
            _far_but_for_c0(error),
            ALL[1:],
        )
        for error in ERRORS
    ),
    *(
        Claim(f"{text}: {error}", "%", _nearer(model, others, error), robots)
        for text, model, others, robots in NEARER
        for error in ERRORS
    ),
    *(
        Claim(f"{model}: best of 32 above {name}", "points", _best_beyond(model, row))
        for model in GENERATIVE
        for name, row in (
            ("the first", f"{model} first"),
            ("the paper's own method", METHOD),
        )
    ),
    Claim(
        "networks' outputs are seldom answers: fewer than half",
        "points",
        lambda f: 50.0 - max(f.rate(f"{model} direct") for model in MODELS),
    ),
    Claim(
        "the MDN takes less time than 32 outputs of the others",
        "%",
        lambda f: longer(f.mean("mdn time"), _generative_us(f)),
    ),
    Claim(
        "the MDN takes less than 0.5 ms", "µs", lambda f: FAST_US - f.mean("mdn time")
    ),
    Claim(
        "generative models take tens of ms: more than 10",
        "µs",
        lambda f: _generative_us(f) - SLOW_US,
    ),
)


def text(view: View) -> str:
    """The table of claims, and whether better outputs are better seeds."""
    rows = []
    for claim in CLAIMS:
        ours = margins_of(claim, _look(view, OURS))
        papers = margins_of(claim, _look(view, PAPERS))
        theirs = margins_of(claim, _published)
        if any(margin is not None for margin in (*ours, *papers)):
            alone = [beside(papers[i], None) for i in _BY_PAPERS]
            verdicts = map(verdict, (ours, papers, theirs))
            shown = map(beside, ours, theirs)
            rows.append([f"{claim.text} [{claim.unit}]", *shown, *alone, *verdicts])
    if not rows:
        return ""
    names = [PAPER_ARMS[robot] for robot in ROBOTS]
    header = [
        "claim",
        *names,
        *(f"{names[i]}, paper's recipe" for i in _BY_PAPERS),
        "here",
        "paper's recipe here",
        "published numbers",
    ]
    parts = ["### What the text says of learned seeds, tested", INTRODUCTION]
    return "\n\n".join([*parts, table(header, rows), *_quality(view)])


_BY_PAPERS = ALL[:2]
"""Robots whose models are trained by the paper's recipe too."""

INTRODUCTION = (
    "By how much each claim holds (below 0: does not) [and an interval of 95 %], with "
    "our labels and, in round brackets, by the published numbers; then with the "
    "paper's labels and inputs. It *holds* where the whole interval is above 0, is "
    "*undecided* where 0 is in it. Times are JAX's on one thread here, of a machine "
    "with an RTX 4090 there, and have no interval; nor has what is published. Not "
    "tested: that outputs are diverse, and what the text expects of other networks."
)


def _look(view: View, recipe: Recipe) -> Look:
    @functools.cache  # bounds ask again and again
    def row(label: str, i: int) -> Row:
        if label == METHOD:
            return _method(view, i)
        model, what = label.split()
        cell = view.get(learned_cell(ROBOTS[i], model, view.size, recipe))
        if cell is None:
            raise AbsentError(label)
        count, first = cell["count"], cell["first"]
        best = cell.get("best", first)
        if what == "time":
            return _row(count, mean=best["output_us"])
        if what in ERRORS:
            unit = {"position": "position_mm", "rotation": "rotation_deg"}[what]
            return _row(count, mean=cell[unit]["mean"], std=cell[unit]["deviation"])
        solved = {
            "direct": first["direct_right"],
            "first": first["right"],
            "best": best["right"],
        }
        return _row(count, success=100.0 * solved[what] / count)

    return row


def _row(count: int, success: float = 0.0, mean: float = 0.0, std: float = 0.0) -> Row:
    return Row(success=success, mean=mean, std=std, most=0.0, count=count)


def _method(view: View, i: int) -> Row:
    cell = view.get(paper_plan.paper_cell(ROBOTS[i], view.size, {}))
    if cell is None:
        raise AbsentError(METHOD)
    return _row(view.size.paper, success=cell["success_percent"])


def _published(label: str, i: int) -> Row:
    if label == METHOD:
        return published_table_row(label, i)
    model, what = label.split()
    row = LEARNED[model][ROBOTS[i]]
    if what in ("first", "best"):
        success = row.first if what == "first" else row.best
        assert success is not None
        return _row(PUBLISHED_TARGETS, success=success)
    means = {
        "position": row.position_mm,
        "rotation": row.rotation_deg,
        "time": 1e3 * row.direct_ms,
    }
    if what not in means:
        raise AbsentError(label)
    return _row(PUBLISHED_TARGETS, mean=means[what])


def _quality(view: View) -> list[str]:
    """Whether success as a seed falls with the error, over all models and robots."""
    found = []
    for name, look in (
        ("ours", _look(view, OURS)),
        ("the paper's recipe", _look(view, PAPERS)),
        ("published", _published),
    ):
        pairs = []
        for model in MODELS:
            for i in ALL:
                try:
                    error = look(f"{model} position", i).mean
                    pairs.append((error, look(f"{model} first", i).success))
                except AbsentError:
                    continue
        if len(pairs) > FEWEST:
            margin = falls(np.array(pairs))
            found.append(f"{name} {beside(margin, None)}, {len(pairs)} rows")
    if not found:
        return []
    return [
        (
            "That success as a seed depends on how near the outputs are: rank "
            "correlation of the first output's success with the position error, its "
            "sign changed so that the claim holds above 0 [95 %, by Fisher's z]: "
            f"{'; '.join(found)}."
        )
    ]


FEWEST = 5
"""Rows, of which a correlation says nothing."""


def falls(pairs: np.ndarray) -> Margin:
    """Spearman's correlation of (N, 2) with its sign changed."""
    ranks = np.argsort(np.argsort(pairs, axis=0), axis=0)
    r = -float(np.corrcoef(ranks.T)[0, 1])
    z = math.atanh(min(max(r, -0.999), 0.999))
    half = TWO_SIDED / math.sqrt(len(pairs) - 3)
    return Margin(r, math.tanh(z - half), math.tanh(z + half))
