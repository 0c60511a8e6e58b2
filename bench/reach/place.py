# SPDX-License-Identifier: BSD-3-Clause
"""Where a base may stand to reach the poses of a task."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np

import iksel
from bench.reach.plans import ROBOT
from iksel import reach

if TYPE_CHECKING:
    from pathlib import Path

    from bench.chain import Array


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
