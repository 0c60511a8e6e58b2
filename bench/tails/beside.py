# SPDX-License-Identifier: BSD-3-Clause
"""Calls whose caches, or whose processor, others use as well."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.arms import load_arm
from bench.cold import LINE, MEGABYTE, times_after
from bench.timing import WARM_UP, tail, time_calls

if TYPE_CHECKING:
    from collections.abc import Callable

    from typing_extensions import Self

    from bench.chain import Array
    from bench.store import Settings

TOUCHED_MB = 96
"""Other memory that is touched between calls: more than the caches of most machines."""
BATCH = 1_000
"""Targets of another robot between two calls."""
CONDITIONS = ("alone", "in_turn", "another", "touched")
THREADS = ("alone", "single", "batch")


def beside(settings: Settings) -> dict[str, Any]:
    """Times of calls alone; after one each of other robots'; after a batch of one's.

    Then after so much memory was touched.
    """
    count = settings["count"] + WARM_UP
    solver, poses = _prepared(settings["robot"], count, settings["seed"])
    others = [
        _prepared(name, max(BATCH, settings["count"]), settings["seed"])
        for name in settings["others"]
    ]
    memory = np.zeros(TOUCHED_MB * MEGABYTE, dtype=np.uint8)[::LINE]
    turn = iter(range(settings["count"]))

    def in_turn() -> None:
        i = next(turn)
        for other, its_poses in others:
            other.solve(its_poses[i])

    def another() -> None:
        other, its_poses = others[0]
        other.solve_batch(its_poses[:BATCH], threads=1)

    def touched() -> None:
        np.add(memory, 1, out=memory)

    for pose in poses[:WARM_UP]:
        solver.solve(pose)
    before: dict[str, Callable[[], object]] = dict(
        zip(CONDITIONS, (lambda: None, in_turn, another, touched), strict=True)
    )
    return {
        name: tail(times_after(solver.solve, list(poses[WARM_UP:]), act))
        for name, act in before.items()
    }


def threads(settings: Settings) -> dict[str, Any]:
    """Times of calls alone, and while another thread solves: one by one, in batches."""
    solver, poses = _prepared(settings["robot"], settings["count"], settings["seed"])
    asked = [(pose,) for pose in poses]
    work: dict[str, Callable[[], object]] = {
        "single": lambda: solver.solve(poses[0]),
        "batch": lambda: solver.solve_batch(poses, threads=1),
    }
    row: dict[str, Any] = {}
    for name in THREADS:
        with _Busy(work.get(name)) as other:
            times = time_calls(solver.solve, asked, settings["limit_s"])[0]
        row[name] = tail(times) | {"calls": len(times), "others": other.done}
    return row


class _Busy:
    """A thread that does the same again and again."""

    def __init__(self, work: Callable[[], object] | None) -> None:
        self.done = 0
        self._work = work
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self) -> Self:
        if self._work is not None:
            self._thread.start()
        return self

    def __exit__(self, *exception: object) -> None:
        self._end.set()
        if self._work is not None:
            self._thread.join()

    def _run(self) -> None:
        assert self._work is not None
        while not self._end.is_set():
            self._work()
            self.done += 1


def _prepared(robot: str, count: int, seed: int) -> tuple[iksel.Solver, Array]:
    """A robot's solver and so many reachable poses."""
    arm = load_arm(robot).robot
    return iksel.Solver(arm), arm.fk(arm.random_configurations(count, seed))
