# SPDX-License-Identifier: BSD-3-Clause
"""Reachability maps: what inverse kinematics says about a grid of poses.

    import iksel
    from iksel import reach

    robot = iksel.load_robot("ur5e")
    reach.create(reach.plan(robot, spacing=0.05), "ur5e.zarr")
    reach.run("ur5e.zarr")
    ur5e = reach.open("ur5e.zarr")
    ur5e.query(poses).solvable

Needs the extra `pip install iksel[reach]`, and Python 3.11 or later.
"""

from __future__ import annotations

from iksel._base.extras import MissingExtraError
from iksel.reach._cells import QUALITIES, UNKNOWN
from iksel.reach._compare import Comparison, compare
from iksel.reach._errors import (
    ChunkDamagedError,
    IncompleteMapError,
    MapError,
    MapIoError,
    PlanMismatchError,
    WorkerError,
)
from iksel.reach._export import export_npy, export_parquet, export_reuleaux
from iksel.reach._grid import Grid, Orientations, Positions
from iksel.reach._map import Answers, Map, open  # noqa: A004 (as zarr's)
from iksel.reach._pictures import draw_placements, draw_slice, draw_spheres
from iksel.reach._place import Placement, place_base
from iksel.reach._plan import Plan, plan
from iksel.reach._run import Progress, connect, merge, run, status
from iksel.reach._samples import TARGETS, SamplePlan, plan_samples
from iksel.reach._store import Store, create

__all__ = [
    "QUALITIES",
    "TARGETS",
    "UNKNOWN",
    "Answers",
    "ChunkDamagedError",
    "Comparison",
    "Grid",
    "IncompleteMapError",
    "Map",
    "MapError",
    "MapIoError",
    "MissingExtraError",
    "Orientations",
    "Placement",
    "Plan",
    "PlanMismatchError",
    "Positions",
    "Progress",
    "SamplePlan",
    "Store",
    "WorkerError",
    "compare",
    "connect",
    "create",
    "draw_placements",
    "draw_slice",
    "draw_spheres",
    "export_npy",
    "export_parquet",
    "export_reuleaux",
    "merge",
    "open",
    "place_base",
    "plan",
    "plan_samples",
    "run",
    "status",
]
