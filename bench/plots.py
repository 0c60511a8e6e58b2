# SPDX-License-Identifier: BSD-3-Clause
"""The plots of the report, as SVG files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bench import plots_seeds
from bench.arms import PAPER_ARMS, RIVAL_ARMS
from bench.paper import plan as paper_plan
from bench.paper.published import ROBOTS
from bench.plans.rivals import rival_cell
from bench.rivals import RIVALS
from bench.sections.curves import curve
from bench.timing import QUANTILES

if TYPE_CHECKING:
    from pathlib import Path

    from bench.view import View

STYLE = {
    "svg.hashsalt": "iksel",
    "svg.fonttype": "none",
    "font.size": 8,
    "axes.grid": True,
    "grid.alpha": 0.3,
    "axes.spines.top": False,
    "axes.spines.right": False,
}

COLOURS = {
    "IKSel": "#c1121f",
    "IKSel, paper preset": "#e5989b",
    "EAIK": "#000000",
    "IK-Geo": "#7f7f7f",
    "Robotics Toolbox": "#1f77b4",
    "OptIK": "#2ca02c",
    "TRAC-IK (pytracik)": "#ff7f0e",
    "Pinocchio, Python loop": "#9467bd",
    "Pinocchio, C++ loop": "#5b3a8c",
    "TRAC-IK style": "#bcbd22",
    "KDL Newton + restarts": "#17becf",
    "SLSQP + restarts": "#8c564b",
    "KDL LMA": "#e377c2",
    "KDL NR_JL": "#aec7e8",
}

LINES = {
    "Eq. (5), farthest": "-",
    "Eq. (5), in order": "--",
    "Eq. (2), in order": ":",
}
"""Lines of the paper's three selections, as in the paper."""


def draw_all(view: View, folder: Path) -> list[str]:
    """Draw what there are results for.

    Returns:
        The files, as RESULTS.md names them; none without matplotlib.
    """
    try:
        import matplotlib as mpl  # noqa: PLC0415 - optional
    except ImportError:
        return []
    mpl.use("Agg")
    from matplotlib import pyplot as plt  # noqa: PLC0415

    drawn = []
    with mpl.rc_context(STYLE):
        for name, draw in (
            ("success_over_time", _success_over_time),
            ("latency", _latency),
            ("paper_figure_1", plots_seeds.figure_1),
            ("paper_figure_2", plots_seeds.figure_2),
            ("paper_figure_3", plots_seeds.figure_3),
            ("paper_attempts", _paper_attempts),
            ("paper_times", _paper_times),
        ):
            figure = draw(view, plt)
            if figure is None:
                continue
            folder.mkdir(parents=True, exist_ok=True)
            figure.savefig(
                folder / f"{name}.svg", metadata={"Date": None}, bbox_inches="tight"
            )
            plt.close(figure)
            drawn.append(f"plots/{name}.svg")
    return drawn


def _measured(view: View, kind: str) -> dict[str, dict[str, Any]]:
    """Results by robot and solver."""
    found: dict[str, dict[str, Any]] = {}
    for robot in RIVAL_ARMS:
        for name in RIVALS:
            cell = view.get(rival_cell(robot, name, kind, view.size))
            if cell is not None and cell["right"] > 0:
                found.setdefault(robot, {})[name] = cell
    return found


def _success_over_time(view: View, plt: Any) -> Any:
    found = _measured(view, "uniform")
    if not found:
        return None
    figure, panels = plt.subplots(
        2, 3, figsize=(9, 5.2), sharex=True, sharey=True, layout="constrained"
    )
    for axes, robot in zip(panels.flat, RIVAL_ARMS, strict=True):
        for name, cell in found.get(robot, {}).items():
            share = 100.0 * cell["right"] / cell["count"] * QUANTILES
            axes.plot(
                cell["right_quantiles_us"],
                share,
                color=COLOURS[name],
                linewidth=2.2 if name == "IKSel" else 1.0,
                label=name,
            )
        axes.set_title(robot)
        axes.set_xscale("log")
        axes.set_ylim(0, 102)
    figure.supxlabel("time of one call [µs]")
    figure.supylabel("targets solved [%]")
    _legend(figure, panels)
    return figure


def _legend(figure: Any, panels: Any) -> None:
    """One legend for all panels."""
    entries: dict[str, Any] = {}
    for axes in panels.flat:
        handles, labels = axes.get_legend_handles_labels()
        entries.update(zip(labels, handles, strict=True))
    figure.legend(
        entries.values(),
        entries.keys(),
        loc="outside upper center",
        ncols=5,
        frameon=False,
    )


def _latency(view: View, plt: Any) -> Any:
    found = _measured(view, "uniform")
    if not found:
        return None
    figure, panels = plt.subplots(
        2, 3, figsize=(9, 6), sharex=True, sharey=True, layout="constrained"
    )
    names = [name for name in RIVALS if any(name in cells for cells in found.values())]
    for axes, robot in zip(panels.flat, RIVAL_ARMS, strict=True):
        for row, name in enumerate(names):
            cell = found.get(robot, {}).get(name)
            if cell is None:
                continue
            colour = COLOURS[name]
            axes.plot(
                [cell["min_us"], cell["max_us"]], [row, row], color=colour, lw=0.6
            )
            low, high = np.interp([0.25, 0.75], QUANTILES, cell["quantiles_us"])
            axes.plot(
                [low, high], [row, row], color=colour, lw=5, solid_capstyle="butt"
            )
            axes.plot(cell["median_us"], row, "|", color="white", markersize=5)
            axes.plot(cell["p99_us"], row, "|", color=colour, markersize=8)
        axes.set_title(robot)
        axes.set_xscale("log")
        axes.set_yticks(range(len(names)), names)
        axes.set_ylim(len(names) - 0.5, -0.5)
    figure.supxlabel(
        "time of one call [µs]: least to most, quartiles, median, p99 (tick)"
    )
    return figure


def _paper_attempts(view: View, plt: Any) -> Any:
    if not any(curve(view, robot, "grid", next(iter(LINES))) for robot in ROBOTS):
        return None
    figure, panels = plt.subplots(
        2, 4, figsize=(10, 5), sharex=True, layout="constrained"
    )
    attempts = np.arange(1, 21)
    for column, robot in enumerate(ROBOTS):
        upper, lower = panels[0, column], panels[1, column]
        for selection, style in LINES.items():
            success = curve(view, robot, "grid", selection)
            if success is not None:
                upper.plot(attempts, success[1:21], style, color="C0", label=selection)
            x, mean, _ = _times(view, robot, selection)
            lower.plot(x, mean, style, color="C0")
        ceiling = view.get(
            paper_plan.ceiling_cell(robot, view.size, paper_plan.sampling_of("grid"))
        )
        if ceiling is not None:
            value = 100.0 * ceiling["solved"][-1] / ceiling["count"]
            upper.axhline(value, color="grey", ls=":", label="100 attempts")
        upper.set_title(PAPER_ARMS[robot])
    panels[0, 0].set_ylabel("success [%]")
    panels[1, 0].set_ylabel("mean time [µs]")
    figure.supxlabel("re-selections allowed (#ReA)")
    _legend(figure, panels)
    return figure


def _times(view: View, robot: str, selection: str) -> tuple[list[int], Any, Any]:
    """#ReA, mean and standard deviation of the time [us]."""
    x, mean, std = [], [], []
    for rea in view.size.figure_attempts:
        cell = view.get(paper_plan.figure_cell(robot, view.size, selection, rea))
        if cell is not None:
            x.append(rea)
            mean.append(cell["mean_us"])
            std.append(cell["std_us"])
    return x, np.array(mean), np.array(std)


def _paper_times(view: View, plt: Any) -> Any:
    figure, panels = plt.subplots(
        1, 4, figsize=(10, 3), sharex=True, layout="constrained"
    )
    empty = True
    for axes, robot in zip(panels, ROBOTS, strict=True):
        for i, (selection, style) in enumerate(LINES.items()):
            x, mean, std = _times(view, robot, selection)
            empty = empty and not x
            axes.plot(x, mean, style, color=f"C{i}", label=selection)
            axes.fill_between(x, mean - std, mean + std, color=f"C{i}", alpha=0.15)
        axes.set_title(PAPER_ARMS[robot])
        axes.set_ylim(bottom=0)
    panels[0].set_ylabel("time [µs]")
    figure.supxlabel("re-selections allowed (#ReA)")
    _legend(figure, panels)
    return None if empty else figure
