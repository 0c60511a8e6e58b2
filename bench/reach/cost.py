# SPDX-License-Identifier: BSD-3-Clause
"""What a map costs: time, memory, and by robot."""

from __future__ import annotations

import os
import resource
import time
from typing import TYPE_CHECKING

import numpy as np

import iksel
from bench.reach.plans import ROBOT, SEED, large_plan
from bench.reach.processes import processor_time, timed_run
from iksel import reach

if TYPE_CHECKING:
    from pathlib import Path

COST_ROBOTS = ("ur5e", "irb120", "cvr038", "xarm6", "panda", "iiwa14", "irb14050")
COST_S = 4.0
"""When the measurement of a robot's cost ends [s]."""
ALL_QUALITIES = ("branches", "manipulability", "limit_distance", "q")
PLAIN_CELLS = 1 << 14
"""Poses that plain solve_batch is given at once, for each thread."""


def plain_time(plan: reach.Plan, threads: int) -> tuple[float, float]:
    """Seconds of solve_batch alone over all cells, and its processor time.

    Its poses are made beforehand.
    """
    solver, total, busy = plan.solver(), 0.0, 0.0
    at = len(plan.grid.positions.counts)
    turns = plan.grid.orientations.rotations
    points = plan.grid.positions.points([slice(None)] * at)
    rows = max(1, threads * PLAIN_CELLS // len(turns))
    poses = np.zeros((rows, len(turns), 4, 4))
    poses[..., :3, :3], poses[..., 3, 3] = turns, 1
    for i in range(0, len(points), rows):
        some = points[i : i + rows]
        poses[: len(some), :, :3, 3] = some[:, None]
        batch = poses[: len(some)].reshape(-1, 4, 4)
        start, began = time.perf_counter(), time.process_time()
        solver.solve_batch(batch, threads=threads)
        total += time.perf_counter() - start
        busy += time.process_time() - began
    return total, busy


def show_time(folder: Path) -> None:
    """The part `time`."""
    plan = large_plan(iksel.load_robot(ROBOT))
    cores = os.cpu_count() or 1
    before = processor_time(resource.RUSAGE_CHILDREN)
    elapsed, memory = timed_run(plan, folder / "time.zarr", cores)
    busy = processor_time(resource.RUSAGE_CHILDREN) - before
    plain, plain_busy = plain_time(plan, cores)
    stored = sum(f.stat().st_size for f in (folder / "time.zarr").rglob("*"))
    found = reach.open(folder / "time.zarr")
    status, proof = found.array("status"), found.array("proof")
    noes = status != iksel.Status.solved
    proven = proof[noes] == iksel.Proof.closed_form
    proven |= proof[noes] == iksel.Proof.reach
    print(f"{ROBOT}, {plan.size:,} cells, {plan.chunks} chunks, {cores} processes")
    print(
        f"run             {elapsed:8.2f} s, {plan.size / elapsed / 1e6:.2f} M cells/s"
    )
    print(f"a cell a core   {elapsed * cores / plan.size * 1e6:8.3f} us")
    print(f"solve_batch     {plain:8.2f} s with {cores} threads")
    print(f"overhead        {100 * (elapsed / plain - 1):8.1f} %")
    print(
        f"processor time  {busy:8.2f} s, {100 * (busy / plain_busy - 1):.1f} % more "
        f"than the {plain_busy:.2f} s of solve_batch"
    )
    print(f"memory          {memory:8.0f} MiB, all processes")
    print(f"store           {stored / 1e6:8.1f} MB")
    print(f"solvable        {100 * (1 - noes.mean()):8.2f} %")
    print(f"noes proven     {100 * proven.mean():8.3f} %")


def show_speedup(folder: Path) -> None:
    """The part `speedup`."""
    plan = large_plan(iksel.load_robot(ROBOT))
    one, _ = timed_run(plan, folder / "one.zarr", 1)
    two, _ = timed_run(plan, folder / "two.zarr", 2)
    print(f"one process {one:.2f} s, two {two:.2f} s: {one / two:.2f} times as fast")


def show_cost(_folder: Path) -> None:
    """The part `cost`: random chunks of a map, on one core, without the store."""
    print("robot        status and proof  with all qualities  [us a cell]")
    for name in COST_ROBOTS:
        robot = iksel.load_robot(name)
        figures = []
        for qualities in ((), ALL_QUALITIES if robot.dof == 6 else ALL_QUALITIES[1:]):
            plan = large_plan(
                robot,
                spacing=0.1,
                orientations=300,
                chunk_cells=1 << 12,
                qualities=qualities,
            )
            solver = plan.solver()
            chosen = np.random.default_rng(SEED).permutation(plan.chunks)
            start = time.perf_counter()
            cells = 0
            for index in chosen:
                cells += plan.compute(int(index), solver)["status"].size
                if time.perf_counter() - start > COST_S:
                    break
            figures.append((time.perf_counter() - start) / cells * 1e6)
        print(f"{name:<12} {figures[0]:16.2f} {figures[1]:19.2f}", flush=True)


def show_fine(folder: Path) -> None:
    """The part `fine`: what stands for 10^12 cells, by symmetry."""
    robot = iksel.load_robot(ROBOT)
    settings = {"spacing": 0.01, "orientations": 100_000}
    plan = large_plan(robot, **settings, symmetry=True)
    whole = large_plan(robot, **settings)
    elapsed, memory = timed_run(plan, folder / "fine.zarr", os.cpu_count() or 1)
    print(
        f"{plan.size:,} cells for {whole.size:.3e}: {elapsed:.2f} s, {memory:.0f} MiB"
    )
