# SPDX-License-Identifier: BSD-3-Clause
"""Maps for other programs: NumPy's files, and the HDF5 files of Reuleaux."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from iksel._base.arrays import reject
from iksel.pose import quaternion_from_pose
from iksel.reach._errors import (
    IncompleteMapError,
    MapIoError,
    PlanMismatchError,
    need,
)
from iksel.reach._samples import SamplePlan
from iksel.reach._store import Store

if TYPE_CHECKING:
    from iksel.reach._job import Arrays
    from iksel.reach._location import StrPath
    from iksel.reach._map import Map

FRACTION = "fraction"
"""Name under which the share of orientations is exported."""


def export_npy(reach_map: Map, path: StrPath, name: str = FRACTION) -> None:
    """Write an array of a map as a .npy file, chunk by chunk.

    Args:
        reach_map: The map.
        path: File to write.
        name: One of the map's `names`, of its grid's shape; or "fraction", of the shape
            of its positions.

    Raises:
        InvalidArgumentError: No such array.
        MapIoError: The file cannot be written.
    """
    if name not in (FRACTION, *reach_map.names):
        known = ", ".join((FRACTION, *reach_map.names))
        reject("name", f"{name!r} is none of {known}")
    try:
        if name == FRACTION:
            with Path(path).open("wb") as file:
                np.save(file, reach_map.fraction)
            return
        shape, dtype = reach_map.layout(name)
        whole = np.lib.format.open_memmap(
            Path(path), mode="w+", dtype=dtype, shape=shape
        )
        for block, arrays in reach_map.chunks():
            whole[block] = arrays[name]
        whole.flush()
    except OSError as error:
        raise MapIoError(f"'{path}' cannot be written: {error}") from error


def export_parquet(path: StrPath, folder: StrPath) -> None:
    """Write a data set as Parquet files, part-000000.parquet and so on, one a chunk.

    Columns are the data set's arrays; `q` is a list of as many solutions as there are,
    each a list of joint values. Files that are there already are kept.

    Args:
        path: A store of plan_samples(), computed.
        folder: Where the files are written; made if it is not there.

    Raises:
        PlanMismatchError: The store is no data set.
        IncompleteMapError: Chunks of it are missing.
        MapIoError: A file cannot be written.
    """
    store = Store(path)
    if not isinstance(store.job, SamplePlan):
        raise PlanMismatchError(f"'{path}' is a {store.job.kind}, not a data set")
    missing = int((~store.done()).sum())
    if missing:
        raise IncompleteMapError(
            f"'{path}': {missing} of {store.job.chunks} chunks are missing"
        )
    parquet = need("pyarrow.parquet")
    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
        for index in range(store.job.chunks):
            target = Path(folder) / f"part-{index:06d}.parquet"
            if target.exists():
                continue
            beside = target.with_suffix(".partial")
            parquet.write_table(_table(store.read(index), store.job.id), beside)
            beside.replace(target)
    except OSError as error:
        raise MapIoError(f"'{folder}' cannot be written: {error}") from error


def _table(arrays: Arrays, job_id: str) -> Any:
    """A table of a chunk of a data set."""
    arrow = need("pyarrow")
    columns = {n: arrow.array(list(a)) for n, a in arrays.items() if n != "q"}
    kept = zip(arrays["q"], arrays["count"], strict=True)
    columns["q"] = arrow.array([q[:count].tolist() for q, count in kept])
    return arrow.table(columns).replace_schema_metadata({"iksel_plan": job_id})


def export_reuleaux(
    reach_map: Map, path: StrPath, *, spacing: float | None = None
) -> None:
    """Write a map as the HDF5 file of Reuleaux's map_creator.

    /Spheres/sphere_dataset has a row x, y, z, index for each position that is reached,
    with the index in percent and the attribute Resolution [m]; /Poses/poses_dataset a
    row for each pose: its sphere's x, y, z, its own x, y, z and its quaternion x, y, z,
    w. A map of rings is given over a box, a direction as the one pose of its cell.

    Args:
        reach_map: The map.
        path: File to write.
        spacing: Distance of the spheres [m]; None: the map's.

    Raises:
        MapIoError: The file cannot be written.
    """
    h5py = need("h5py")
    axes, shares = reach_map.box(spacing)
    step = reach_map.grid.positions.spacing if spacing is None else spacing
    places = np.argwhere(shares > 0)
    points = np.stack([a[places[:, i]] for i, a in enumerate(axes)], axis=-1)
    try:
        with h5py.File(Path(path), "w") as file:
            index = 100 * shares[tuple(places.T)][:, None]
            spheres = file.create_dataset(
                "Spheres/sphere_dataset", data=np.concatenate([points, index], axis=1)
            )
            spheres.attrs["Resolution"] = np.float32(step)
            rows = file.create_dataset(
                "Poses/poses_dataset",
                shape=(0, 10),
                maxshape=(None, 10),
                chunks=(4096, 10),
                dtype="f8",
                compression="gzip",
            )
            for point in points:
                some = _poses_at(reach_map, point)
                rows.resize(len(rows) + len(some), axis=0)
                rows[len(rows) - len(some) :] = some
    except OSError as error:
        raise MapIoError(f"'{path}' cannot be written: {error}") from error


def _poses_at(reach_map: Map, point: np.ndarray) -> np.ndarray:
    """Rows of the poses at a point [m] that can be reached, (n, 10)."""
    rotations = reach_map.rotations_at(point)
    rows = np.empty((len(rotations), 10))
    poses = np.tile(np.eye(4), (len(rotations), 1, 1))
    poses[:, :3, :3] = rotations
    rows[:, :3] = rows[:, 3:6] = point
    rows[:, 6:] = np.roll(quaternion_from_pose(poses), -1, axis=-1)
    return rows
