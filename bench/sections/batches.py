# SPDX-License-Identifier: BSD-3-Clause
"""Many poses in one call, as text: one answer with one, all branches with all."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench.markdown import NONE, microseconds, percent, table
from bench.plans.rivals import BATCH_THREADS, BATCHES, batch_cell, every_cell

if TYPE_CHECKING:
    from bench.view import View

OURS = "IKSel"
OF_ALL = "EAIK"
"""The solver whose batches have all branches."""


def text(view: View) -> str:
    """The table."""
    rows = []
    for robot, name in BATCHES:
        cells = [
            view.get(batch_cell(robot, name, threads, view.size))
            for threads in BATCH_THREADS
        ]
        what = "all branches" if name == OF_ALL else "one answer"
        if any(cells):
            rows.append([f"{name} on `{robot}`, {what}", *_batch_row(cells)])
    robot = BATCHES[0][0]
    every = view.get(every_cell(robot, view.size))
    if every is not None:
        label = f"{OURS} on `{robot}`, all branches, pose by pose"
        rows.append([label, *_batch_row([every, None])])
    header = [f"µs per pose, {view.size.batch:,} poses"]
    header += [f"{threads} thread" + "s" * (threads > 1) for threads in BATCH_THREADS]
    header += ["right %", "branches"]
    return "\n\n".join([table(header, rows), *_batch_verdict(view)])


def _batch_row(cells: list[dict[str, Any] | None]) -> list[str]:
    row = [NONE if c is None else microseconds(c["us_per_pose"]) for c in cells]
    first = next(filter(None, cells))
    branches = first.get("branches")
    row.append(percent(first["right"], first["count"]))
    row.append(NONE if branches is None else f"{branches / first['count']:.2f}")
    return row


def _batch_verdict(view: View) -> list[str]:
    """All branches with all branches: EAIK's batch has no fewer to give."""
    robot, name = BATCHES[0]
    theirs = view.get(batch_cell(robot, name, BATCH_THREADS[0], view.size))
    ours = view.get(every_cell(robot, view.size))
    if ours is None or theirs is None:
        return []
    factor = theirs["us_per_pose"] / ours["us_per_pose"]
    where = f"All branches on `{robot}`, one thread"
    text = f"{where}: {OURS} {factor:.1f} times as fast as {name}"
    return [f"{text}, which gets all poses in one call and leaves the limits out."]
