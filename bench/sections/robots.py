# SPDX-License-Identifier: BSD-3-Clause
"""The default preset on every built-in robot, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bench.markdown import NONE, microseconds, table
from bench.plans.robots import all_robots, robot_cell
from bench.plans.shared import BESIDE_LEVEL, at_level
from bench.sections import absent

if TYPE_CHECKING:
    from bench.view import View


def text(view: View) -> str:
    """The whole section."""
    rows = []
    for robot in all_robots():
        cell = view.get(robot_cell(robot, view.size))
        if cell is None:
            continue
        rows.append(
            [
                f"`{robot}`",
                f"{cell['success_percent']:.3f}",
                str(cell["false_success"]),
                *(
                    microseconds(cell[name])
                    for name in ("mean_us", "median_us", "p99_us", "max_us")
                ),
                _beside(view, robot),
                f"{cell['ratio']:.2f}",
                " / ".join(
                    f"{cell[name]:.2f}"
                    for name in ("query_us", "rank_us", "iterate_us")
                ),
            ]
        )
    if not rows:
        return ""
    header = [
        "robot",
        "success %",
        "false",
        "mean µs",
        "median",
        "p99",
        "max",
        f"mean, {BESIDE_LEVEL}",
        "ratio",
        "query / seeds / iterate",
    ]
    conditions = (
        f"{view.size.robots:,} targets per robot, seed 1, 1e-6 m and 1e-6 rad, timed "
        "inside C++ on one thread. *ratio* is the mean over the time of one KDL "
        "forward kinematics plus Jacobian on the same robot in the same run: how "
        f"times compare between machines. {absent.small_robots()}"
    )
    title = "## Every robot, default preset"
    return f"{title}\n\n{conditions}\n\n{table(header, rows)}"


def _beside(view: View, robot: str) -> str:
    """The mean at the other SIMD level."""
    cell = view.get(at_level(robot_cell(robot, view.size), BESIDE_LEVEL))
    return NONE if cell is None else microseconds(cell["mean_us"])
