# SPDX-License-Identifier: BSD-3-Clause
"""What reachability maps cost, and that every engine writes the same ones.

python -m bench.reach PART ... prints figures; the parts:

  cost      what a cell costs, by robot
  fine      a map of ur5e, 1 cm x 100,000 orientations, reduced by symmetry
  time      a map of ur5e, 5 cm x 1,000 orientations, by one process per core: time,
            memory, and what it takes beside solve_batch alone
  speedup   the same by one process and by two
  engines   by processes, a Dask LocalCluster and shares: the same bytes
  killed    workers and the scheduler killed on the way: the same bytes
  full      a disk that is full: an error, and the map still opens
  cells     10,000 random cells against poses solved one by one; with symmetry against
            the same cells turned at random
  place     where a base may stand to reach 30 poses in a shelf
"""

from __future__ import annotations

import argparse
import contextlib
import hashlib
import os
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from iksel import reach
from iksel.reach._errors import need

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from bench.chain import Array
    from iksel._arrays import IntArray
    from iksel.reach._grid import Grid

ROBOT = "ur5e"
SEED = 15
CELLS = 10_000
KILLS = 3
COST_ROBOTS = ("ur5e", "irb120", "cvr038", "xarm6", "panda", "iiwa14", "irb14050")
COST_S = 4.0
"""When the measurement of a robot's cost ends [s]."""
ALL_QUALITIES = ("branches", "manipulability", "limit_distance", "q")
PLAIN_CELLS = 1 << 14
"""Poses that plain solve_batch is given at once, for each thread."""


def large_plan(robot: iksel.Robot, **settings: Any) -> reach.Plan:
    """5 cm x 1,008 orientations, in all dimensions."""
    fixed: dict[str, Any] = {"spacing": 0.05, "orientations": 1000, "symmetry": False}
    return reach.plan(robot, **fixed | settings)


def timed_run(plan: reach.Plan, path: Path, workers: int) -> tuple[float, float]:
    """Seconds and largest resident memory [MiB] of all processes of a run."""
    reach.create(plan, path)
    words = [sys.executable, "-m", "iksel", "reach", "run", str(path)]
    start = time.perf_counter()
    process = subprocess.Popen([*words, "--workers", str(workers)])
    with memory_of(process.pid) as largest:
        code = process.wait()
    elapsed = time.perf_counter() - start
    if code != 0:
        raise SystemExit(f"iksel reach run ended with {code}")
    return elapsed, largest[0] / 2**20


@contextlib.contextmanager
def memory_of(pid: int) -> Iterator[list[float]]:
    """The largest sum of the resident memory of a process and its children [byte]."""
    largest, ended = [0.0], threading.Event()

    def watch() -> None:
        while not ended.wait(0.1):
            largest[0] = max(
                largest[0], sum(map(resident_memory, [pid, *children(pid)]))
            )

    thread = threading.Thread(target=watch)
    thread.start()
    try:
        yield largest
    finally:
        ended.set()
        thread.join()


def resident_memory(pid: int) -> float:
    """Resident memory of a process [byte]; 0 if it has ended."""
    try:
        pages = Path(f"/proc/{pid}/statm").read_text(encoding="ascii").split()[1]
    except OSError:
        return 0.0
    return float(pages) * os.sysconf("SC_PAGE_SIZE")


def processor_time(who: int) -> float:
    """Seconds of processor time, of all cores and in the kernel too."""
    usage = resource.getrusage(who)
    return usage.ru_utime + usage.ru_stime


def children(pid: int) -> list[int]:
    """Processes that a process has started."""
    try:
        text = Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="ascii")
    except OSError:
        return []
    return [int(word) for word in text.split()]


def plain_time(plan: reach.Plan, threads: int) -> float:
    """Seconds of solve_batch alone over all cells; its poses are made beforehand."""
    solver, total = plan.solver(), 0.0
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
        start = time.perf_counter()
        solver.solve_batch(batch, threads=threads)
        total += time.perf_counter() - start
    return total


def show_time(folder: Path) -> None:
    """The part `time`."""
    plan = large_plan(iksel.load_robot(ROBOT))
    cores = os.cpu_count() or 1
    before = processor_time(resource.RUSAGE_CHILDREN)
    elapsed, memory = timed_run(plan, folder / "time.zarr", cores)
    busy = processor_time(resource.RUSAGE_CHILDREN) - before
    before = processor_time(resource.RUSAGE_SELF)
    plain = plain_time(plan, cores)
    plain_busy = processor_time(resource.RUSAGE_SELF) - before
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
        f"processor time  {busy:8.2f} s, solve_batch with what makes its poses "
        f"{plain_busy:.2f} s"
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


def small_plan() -> reach.Plan:
    """A map that takes some seconds, for what need not be large."""
    return large_plan(
        iksel.load_robot(ROBOT),
        spacing=0.1,
        orientations=300,
        qualities=["branches", "q"],
        chunk_cells=1 << 15,
    )


def digests(path: Path) -> dict[str, str]:
    """A hash of every file of a store."""
    return {
        str(file.relative_to(path)): hashlib.sha256(file.read_bytes()).hexdigest()
        for file in path.rglob("*")
        if file.is_file() and file.suffix != ".partial"
    }


def reference(plan: reach.Plan, folder: Path) -> dict[str, str]:
    """Hashes of the plan's store as one process writes it."""
    path = folder / "reference.zarr"
    reach.create(plan, path)
    reach.run(path, workers=1)
    return digests(path)


def show_engines(folder: Path) -> None:
    """The part `engines`."""
    distributed = need("distributed")

    plan = small_plan()
    expected = reference(plan, folder)
    engines: dict[str, Callable[[Path], object]] = {
        "two processes": lambda path: reach.run(path, workers=2),
        "shares i/7": lambda path: [
            reach.run(path, workers=1, share=(i, 7)) for i in range(7)
        ],
    }
    for name, run in engines.items():
        path = folder / f"{name.replace('/', '_')}.zarr"
        reach.create(plan, path)
        run(path)
        print(f"{name:<16} the same bytes: {digests(path) == expected}")
    path = folder / "dask.zarr"
    reach.create(plan, path)
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        reach.run(path, client=client)
    print(f"{'Dask, 2 x 1':<16} the same bytes: {digests(path) == expected}")
    print(f"{len(expected)} files, {plan.size:,} cells, {plan.chunks} chunks")


def show_killed(folder: Path) -> None:
    """The part `killed`."""
    plan = small_plan()
    expected = reference(plan, folder)
    path = folder / "killed.zarr"
    reach.create(plan, path)
    words = [sys.executable, "-m", "iksel", "reach", "run", str(path), "--workers", "2"]
    process = subprocess.Popen(words)
    for n in range(KILLS):
        while reach.status(path).done <= 3 * n or not children(process.pid):
            if process.poll() is not None:
                raise SystemExit("the run ended before it was killed")
            time.sleep(0.02)
        victim = children(process.pid)[0]
        os.kill(victim, signal.SIGKILL)
        print(f"killed worker {victim} after {reach.status(path).done} chunks")
    before = reach.status(path).done
    while reach.status(path).done == before and process.poll() is None:
        time.sleep(0.02)
    process.kill()
    process.wait()
    store = reach.Store(path)
    done = np.flatnonzero(store.done())
    damaged = len(list(store.damaged(done.tolist())))
    print(
        f"killed the scheduler after {len(done)} of {plan.chunks}, damaged: {damaged}"
    )
    reach.run(path, workers=2)
    print(f"run again: the same bytes: {digests(path) == expected}")


def show_full(folder: Path) -> None:
    """The part `full`; needs root, for a tmpfs."""
    plan = small_plan()
    expected = reference(plan, folder)
    place = folder / "small"
    place.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=600k", "tmpfs", str(place)]
    subprocess.run(mount, check=True)
    try:
        path = place / "map.zarr"
        reach.create(plan, path)
        try:
            reach.run(path, workers=2)
        except reach.MapIoError as error:
            print(f"MapIoError: {error}")
        found = reach.open(path, partial=True)
        known = found.array("status") != reach.UNKNOWN
        print(f"{reach.status(path).done} chunks done, {known.sum():,} cells known")
        shutil.copytree(path, folder / "rescued.zarr")
    finally:
        subprocess.run(["umount", str(place)], check=True)
    reach.run(folder / "rescued.zarr", workers=2)
    same = digests(folder / "rescued.zarr") == expected
    print(f"run again elsewhere: the same bytes: {same}")


def show_cells(folder: Path) -> None:
    """The part `cells`."""
    robot = iksel.load_robot(ROBOT)
    rng = np.random.default_rng(SEED)
    for symmetry in (False, True):
        plan = large_plan(robot, symmetry=symmetry, spacing=0.1)
        path = folder / f"cells{symmetry:d}.zarr"
        reach.create(plan, path)
        reach.run(path)
        found = reach.open(path)
        cells = np.stack([rng.integers(0, n, CELLS) for n in plan.shape], axis=-1)
        first, last = rng.uniform(-np.pi, np.pi, (2, CELLS)) * symmetry
        poses = independent_poses(plan.grid, cells, first, last)
        solver = iksel.Solver(robot)
        answers = [solver.solve(pose) for pose in poses]
        success = np.array([a.success for a in answers])
        stored = found.take(cells)
        same = (stored["status"] == [a.status for a in answers]).sum()
        proofs = (stored["proof"] == [a.proof for a in answers]).sum()
        reached = robot.fk(np.array([a.q for a in answers if a.success]))
        off = np.abs(reached - poses[success]).max()
        print(
            f"symmetry {symmetry}: of {CELLS:,} cells {success.sum():,} solved; equal "
            f"status {same:,}, equal proof {proofs:,}; answers off by {off:.1e} at most"
        )


def independent_poses(grid: Grid, cells: IntArray, first: Array, last: Array) -> Array:
    """Poses of cells, turned by angles [rad], from what the grid's fields say alone.

    For a grid whose frame is the base's, and whose axis is the tool's z.
    """
    place, turns = grid.positions, grid.orientations
    at = len(place.counts)
    centres = np.array(place.lower) + place.spacing * (cells[:, :at] + 0.5)
    if place.rings:
        centres = np.insert(centres, 1, 0.0, axis=1)
    x, y, z = turns.directions[cells[:, at]].T
    spin = last + (2 * np.pi / turns.spins * cells[:, at + 1] if turns.spins else 0)
    azimuth = np.arctan2(y, x)
    rotation = about_z(azimuth) @ about_y(np.arccos(z)) @ about_z(spin - azimuth)
    poses = np.tile(np.eye(4), (len(cells), 1, 1))
    poses[:, :3, :3] = rotation
    poses[:, :3, 3] = centres
    return np.asarray(about_z(first, 4) @ poses)


def about_z(angle: Array, size: int = 3) -> Array:
    """Rotations about z, (n, size, size)."""
    return np.array([iksel.pose_from_euler([0, 0, 0], [0, 0, a]) for a in angle])[
        :, :size, :size
    ]


def about_y(angle: Array) -> Array:
    """Rotations about y, (n, 3, 3)."""
    return np.array([iksel.pose_from_euler([0, 0, 0], [0, a, 0]) for a in angle])[
        :, :3, :3
    ]


def shelf() -> Array:
    """30 poses of a gripper that reaches into three boards of a shelf, (30, 4, 4)."""
    tool = iksel.pose_from_matrix([0, 0, 0], [[1, 0, 0], [0, 0, 1], [0, -1, 0]])
    poses = np.tile(tool, (30, 1, 1))
    places = np.meshgrid(np.linspace(-0.4, 0.4, 10), [0.4, 0.75, 1.1], indexing="ij")
    poses[:, 0, 3], poses[:, 2, 3] = (p.ravel() for p in places)
    poses[:, 1, 3] = 0.9
    return poses


def show_place(folder: Path, picture: Path | None) -> None:
    """The part `place`: the base stands before the shelf, on a column of 0.6 m."""
    gripper = iksel.pose_from_euler([0, 0, 0.15], [0, 0, 0])
    plan = reach.plan(iksel.load_robot(ROBOT, tcp=gripper), spacing=0.05)
    path = folder / "place.zarr"
    reach.create(plan, path)
    reach.run(path)
    found = reach.open(path)
    poses = shelf()
    mesh = np.meshgrid(
        np.arange(-1, 1.001, 0.05), np.arange(-0.3, 0.601, 0.05), indexing="ij"
    )
    bases = np.tile(np.eye(4), (mesh[0].size, 1, 1))
    bases[:, 0, 3], bases[:, 1, 3] = (m.ravel() for m in mesh)
    bases[:, 2, 3] = 0.6
    start = time.perf_counter()
    placements = reach.place_base(found, poses, bases=bases, checked=20)
    elapsed = time.perf_counter() - start
    best = placements[0]
    off = np.abs(
        best.T_world_base @ found.robot.fk(best.q[best.reachable])
        - poses[best.reachable]
    ).max()
    print(
        f"{len(bases)} bases x {len(poses)} poses in {elapsed:.3f} s; the best at "
        f"{best.T_world_base[:3, 3]} reaches {best.reached}, by the map {best.by_map}; "
        f"answers off by {off:.1e} at most"
    )
    print("reached by exact IK:", [p.reached for p in placements])
    print("       by the map  :", [p.by_map for p in placements])
    if picture is not None:
        reach.draw_placements(placements, poses, picture)


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


PARTS = {
    "cost": show_cost,
    "fine": show_fine,
    "time": show_time,
    "speedup": show_speedup,
    "engines": show_engines,
    "killed": show_killed,
    "full": show_full,
    "cells": show_cells,
}


def main() -> None:
    """Print the figures of the parts that the command line names."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("parts", nargs="+", choices=[*PARTS, "place"], metavar="PART")
    parser.add_argument(
        "--folder", type=Path, help="where maps are written (default: a temporary one)"
    )
    parser.add_argument("--picture", type=Path, help="of the part place, to write")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(dir=arguments.folder) as name:
        for part in arguments.parts:
            folder = Path(name) / part
            folder.mkdir()
            print(f"-- {part}", flush=True)
            if part == "place":
                show_place(folder, arguments.picture)
            else:
                PARTS[part](folder)


if __name__ == "__main__":
    main()
