# SPDX-License-Identifier: BSD-3-Clause
"""The paper's figures 1 to 3, drawn from the database: seeds that fail and succeed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bench.paper.choices import shown_cell

if TYPE_CHECKING:
    from bench.view import View

BAD, GOOD, CALM = "#c1121f", "#1f77b4", "0.75"
BEST = 20
"""Candidates among which the paper selects again."""


def _cell(view: View, name: str) -> dict[str, Any] | None:
    cell = view.get(shown_cell(view.size))
    return None if cell is None or name not in cell else cell


def _arm(axes: Any, points: Any, **style: Any) -> None:
    """An arm from the side: how far from the base's axis, and how high."""
    points = np.array(points)
    axes.plot(
        np.hypot(points[:, 0], points[:, 1]), points[:, 2], marker="o", ms=2, **style
    )


def _side(axes: Any, title: str) -> None:
    axes.set_title(title)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("from the base's axis [m]")


def _beside_candidates(plt: Any, shown: dict[str, Any], width: float) -> Any:
    """A figure and its three axes, of which the first has all candidates."""
    figure, axes = plt.subplots(1, 3, figsize=(10, 3.2), layout="constrained")
    for points in shown["candidates"]:
        _arm(axes[0], points, color=CALM, lw=width)
    axes[0].set_ylabel("height [m]")
    return figure, axes


def figure_1(view: View, plt: Any) -> Any:
    """The nearest sample and that of the least adjustment."""
    cell = _cell(view, "first")
    if cell is None:
        return None
    shown = cell["first"]
    figure, (a, b, c) = _beside_candidates(plt, shown, 0.7)
    for axes, name, colour in ((b, "nearest", BAD), (b, "least", GOOD)):
        _arm(a, shown[name]["path"][0], color=colour, lw=1.6)
        for step, points in enumerate(shown[name]["path"][:3]):
            _arm(axes, points, color=colour, lw=1.6, alpha=1.0 - 0.3 * step)
        label = {"nearest": "nearest, Eq. (2)", "least": "least adjustment, Eq. (5)"}
        c.semilogy(shown[name]["errors"], "-o", ms=3, color=colour, label=label[name])
    for axes in (a, b):
        _arm(axes, shown["arm"], color="black", lw=1.2, ls="--")
    _side(a, "seeds near a solution (dashed)")
    _side(b, "two steps from two of them")
    c.set_title("distance after each step [m]")
    c.set_xlabel("steps, without scaling")
    c.legend(frameon=False)
    return figure


def figure_2(view: View, plt: Any) -> Any:
    """A seed that ends outside the limits, and the one selected after it."""
    cell = _cell(view, "second")
    if cell is None:
        return None
    shown = cell["second"]
    figure, (a, b, c) = _beside_candidates(plt, shown, 0.3)
    for points, colour in zip(shown["outlines"], (BAD, GOOD), strict=True):
        _arm(a, points, color=colour, lw=1.6)
    _arm(a, shown["arm"], color="black", lw=1.2, ls="--")
    _side(a, f"{len(shown['candidates'])} candidates")
    lower, upper = np.array(cell["lower"]), np.array(cell["upper"])
    titles = ("the first seed ends outside a limit", "the one selected again arrives")
    for axes, path, title in zip((b, c), shown["attempts"], titles, strict=True):
        # 0 and 1 are the limits.
        q = (np.array(path) - lower) / (upper - lower)
        for i, joint in enumerate(q.T):
            axes.plot(joint, "-o", ms=3, color=f"C{i}", label=f"joint {i + 1}")
        for limit in (0.0, 1.0):
            axes.axhline(limit, color="black", lw=0.8, ls="--")
        axes.set_title(title)
        axes.set_xlabel("steps")
    b.set_ylabel("part of the range")
    c.legend(frameon=False, ncols=2)
    return figure


def figure_3(view: View, plt: Any) -> Any:
    """The order in which candidates are tried: among the best, the farthest apart."""
    cell = _cell(view, "third")
    if cell is None:
        return None
    shown = cell["third"]
    q = np.array(shown["q"])
    # The two directions in which the candidates differ most.
    middle = q - q.mean(axis=0)
    flat = middle @ np.linalg.svd(middle, full_matrices=False)[2][:2].T
    figure, (a, b) = plt.subplots(1, 2, figsize=(8, 3.4), layout="constrained")
    places = (
        (a, np.array(shown["distances"]), np.array(shown["adjustments"])),
        (b, flat[:, 0], flat[:, 1]),
    )
    for axes, x, y in places:
        best = np.arange(len(x)) < BEST
        axes.plot(x[~best], y[~best], ".", color=CALM, label="candidates")
        axes.plot(x[best], y[best], ".", color=GOOD, label=f"best {BEST}, Eq. (5)")
        for number, place in enumerate(shown["attempts"], 1):
            axes.annotate(
                str(number),
                (x[place], y[place]),
                color=BAD,
                fontsize=12,
                ha="center",
                va="center",
            )
    a.set_xlabel("distance of the keys, Eq. (2)")
    a.set_ylabel("joint adjustment [rad]")
    a.legend(frameon=False)
    b.set_title("joint space, the plane of largest spread [rad]")
    a.set_title("attempts 1 to 3, the last arrives")
    return figure
