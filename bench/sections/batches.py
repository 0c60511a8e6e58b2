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
    every = _every(view)
    if any(every):
        label = f"{OURS} on `{BATCHES[0][0]}`, all branches, pose by pose"
        rows.append([label, *_batch_row(every)])
    header = [f"µs per pose, {view.size.batch:,} poses"]
    header += [_threads(count) for count in BATCH_THREADS]
    header += ["right %", "branches"]
    return "\n\n".join([table(header, rows), *_batch_verdict(view)])


def _batch_row(cells: list[dict[str, Any] | None]) -> list[str]:
    row = [NONE if c is None else microseconds(c["us_per_pose"]) for c in cells]
    first = next(filter(None, cells))
    branches = first.get("branches")
    row.append(percent(first["right"], first["count"]))
    row.append(NONE if branches is None else f"{branches / first['count']:.2f}")
    return row


def _every(view: View) -> list[dict[str, Any] | None]:
    """All branches by IKSel, by threads."""
    robot = BATCHES[0][0]
    return [view.get(every_cell(robot, n, view.size)) for n in BATCH_THREADS]


def _batch_verdict(view: View) -> list[str]:
    """All branches with all branches: EAIK's batch has no fewer to give."""
    robot, name = BATCHES[0]
    factors = []
    for threads, ours in zip(BATCH_THREADS, _every(view), strict=True):
        theirs = view.get(batch_cell(robot, name, threads, view.size))
        if ours is not None and theirs is not None:
            factor = theirs["us_per_pose"] / ours["us_per_pose"]
            factors.append(f"{factor:.2f} ({_threads(threads)})")
    if not factors:
        return []
    compared = f"{OURS} is {', '.join(factors)} times as fast as {name}"
    note = (
        f"All branches on `{robot}`: {compared}, which gets all poses in one call and "
        f"leaves the limits out. {OURS} has no batch of `solve_all`: it is called pose "
        "by pose from Python, on two threads each half of the poses."
    )
    return [note]


def _threads(count: int) -> str:
    return f"{count} thread" + "s" * (count > 1)
