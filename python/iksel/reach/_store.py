# SPDX-License-Identifier: BSD-3-Clause
"""A job and its results in a Zarr store, version 3, in a folder or at a URL of fsspec.

Each chunk of work is one shard of every array: a file that is written as a whole. Its
receipt is written last: the job's id and a digest of the chunk. What has no receipt has
not been computed, whatever files there are.
"""

from __future__ import annotations

import hashlib
import json
from typing import TYPE_CHECKING, Any

import numpy as np

from iksel.reach._errors import (
    ChunkDamagedError,
    MapIoError,
    PlanMismatchError,
    need,
)
from iksel.reach._job import FORMAT, Arrays, ArraySpec, Job
from iksel.reach._location import StrPath, locate
from iksel.reach._plan import Plan
from iksel.reach._samples import SamplePlan

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

ATTRIBUTE = "iksel"
RECEIPTS = "receipt"
HASH_BYTES = 16
COMPRESSION_LEVEL = 3
KINDS: dict[str, type[Job]] = {job.kind: job for job in (Plan, SamplePlan)}


class Store:
    """A job on disk with what has been computed of it."""

    def __init__(self, path: StrPath, *, writable: bool = False) -> None:
        """Open a store that create() made.

        Raises:
            MapIoError: There is none.
            PlanMismatchError: It is not one of this version's, or its plan was changed.
        """
        self.place = locate(path)
        self.path = self.place.path
        self.job = read_job(path)
        self.specs = self.job.specs()
        zarr = need("zarr")
        try:
            mode = "r+" if writable else "r"
            # Arrays of format 3 alone: those of 2 may be pickles.
            group = zarr.open_group(
                self.path, mode=mode, zarr_format=3, use_consolidated=False
            )
            names = (*(spec.name for spec in self.specs), RECEIPTS)
            self._arrays = {name: group[name] for name in names}
        except (OSError, ValueError, KeyError) as error:
            raise MapIoError(f"'{self.path}' cannot be read: {error}") from error

    def receipts(self, indices: Sequence[int]) -> np.ndarray[Any, Any]:
        """Receipts of chunks, (n, 32); zeros where there is none. Reads no others."""
        chosen = np.asarray(indices, dtype=int)
        if len(chosen) == 0:
            return np.zeros((0, 2 * HASH_BYTES), np.uint8)
        return np.asarray(self._arrays[RECEIPTS].oindex[chosen, slice(None)])

    def done(self, indices: Sequence[int] | None = None) -> np.ndarray[Any, Any]:
        """Which chunks have been computed, (n,); None: of all.

        Raises:
            PlanMismatchError: One belongs to another plan.
        """
        chosen = range(self.job.chunks) if indices is None else indices
        receipts = self.receipts(chosen)
        present = receipts.any(axis=1)
        other = present & (receipts[:, :HASH_BYTES] != _id_bytes(self.job)).any(axis=1)
        if other.any():
            first = int(np.argmax(other))
            raise PlanMismatchError(
                f"{self.chunk_name(chosen[first])} belongs to the plan "
                f"{receipts[first, :HASH_BYTES].tobytes().hex()}, not to this map's "
                f"{self.job.id}"
            )
        return np.asarray(present)

    def read(self, index: int) -> Arrays:
        """A chunk that has been computed.

        Raises:
            ChunkDamagedError: It is not what was written, or of another plan.
        """
        block = self.job.block(index)
        try:
            arrays = {
                s.name: np.asarray(self._arrays[s.name][block]) for s in self.specs
            }
        except Exception as error:  # what the codecs raise is not documented
            raise ChunkDamagedError(
                f"{self.chunk_name(index)} cannot be read: {error}"
            ) from error
        receipt = np.asarray(self._arrays[RECEIPTS][index])
        if receipt.tobytes() != self._receipt(index, arrays):
            raise ChunkDamagedError(
                f"{self.chunk_name(index)} is damaged or belongs to another plan: its "
                "content does not fit its receipt"
            )
        return arrays

    def write(self, index: int, arrays: Arrays) -> None:
        """Write a chunk, its receipt last.

        Raises:
            OSError: The file system refuses; the chunk then is as if never computed.
        """
        self.forget(index)
        block = self.job.block(index)
        for spec in self.specs:
            self._arrays[spec.name][block] = arrays[spec.name]
        receipt = np.frombuffer(self._receipt(index, arrays), np.uint8)
        self._arrays[RECEIPTS][index] = receipt

    def forget(self, index: int) -> None:
        """Remove what there is of a chunk, its receipt first."""
        self.place.remove(_file(RECEIPTS, (index, 0)))
        places = np.unravel_index(index, self.job.chunk_grid)
        for spec in self.specs:
            places_of = (*map(int, places), *(0 for _ in spec.shape))
            self.place.remove(_file(spec.name, places_of))

    def chunk_name(self, index: int) -> str:
        """A chunk for messages: its number and the file of its first array."""
        places = tuple(map(int, np.unravel_index(index, self.job.chunk_grid)))
        return f"chunk {index} ('{self.path}/{_file(self.specs[0].name, places)}')"

    def damaged(
        self, indices: Sequence[int]
    ) -> Iterator[tuple[int, ChunkDamagedError]]:
        """Those of the chunks that cannot be used, with the reason."""
        for index in indices:
            try:
                self.read(index)
            except ChunkDamagedError as error:
                yield index, error

    def _receipt(self, index: int, arrays: Arrays) -> bytes:
        digest = hashlib.blake2b(digest_size=HASH_BYTES)
        digest.update(_id_bytes(self.job).tobytes() + index.to_bytes(8, "little"))
        for spec in self.specs:
            digest.update(np.ascontiguousarray(arrays[spec.name]).data)
        return _id_bytes(self.job).tobytes() + digest.digest()


def _file(array: str, places: tuple[int, ...]) -> str:
    """The file of a chunk of an array, in its store."""
    return "/".join((array, "c", *map(str, places)))


def read_job(path: StrPath) -> Job:
    """The job of a store.

    Raises:
        MapIoError: There is none.
        PlanMismatchError: It is not one of this version's, or was changed.
    """
    try:
        text = locate(path).read_text("zarr.json")
        stored = json.loads(text).get("attributes", {}).get(ATTRIBUTE)
    except FileNotFoundError:
        raise MapIoError(f"'{path}' is no map: it has no zarr.json") from None
    except (OSError, ValueError, AttributeError, RecursionError) as error:
        raise MapIoError(f"'{path}' cannot be read: {error}") from error
    if not isinstance(stored, dict) or not isinstance(stored.get("plan"), dict):
        raise PlanMismatchError(f"'{path}' is a Zarr group, but no map of iksel")
    data = dict(stored["plan"])
    kind, version = data.pop("kind", None), data.get("format")
    if kind not in KINDS or version != FORMAT:
        raise PlanMismatchError(
            f"'{path}' has a {kind!r} of format {version!r}; this version of iksel "
            f"reads {', '.join(KINDS)} of format {FORMAT}"
        )
    job = KINDS[kind](data)
    if job.id != stored.get("id"):
        raise PlanMismatchError(
            f"'{path}': the plan was changed: its hash is {job.id}, but "
            f"{stored.get('id')} is stored"
        )
    return job


def create(job: Job, path: StrPath) -> Store:
    """Write a job's plan to a new store; one of the same plan that is there stays.

    Raises:
        MapIoError: There is something else, or it cannot be written.
        PlanMismatchError: There is a map of another plan.
    """
    target = locate(path)
    try:
        if not target.exists():
            target.make(lambda folder: _make_group(job, folder))
            return Store(path, writable=True)
    except OSError as error:
        raise MapIoError(f"'{target}' cannot be written: {error}") from error
    try:
        target.read_text("zarr.json")
    except OSError:
        raise MapIoError(f"'{target}' is there already, and is no map") from None
    store = Store(path, writable=True)
    if store.job.id != job.id:
        raise PlanMismatchError(
            f"'{target}' is there already, with another plan ({store.job.id}, not "
            f"{job.id})"
        )
    return store


def _make_group(job: Job, path: Path) -> None:
    zarr = need("zarr")
    beginning = {ATTRIBUTE: {"id": job.id, "plan": job.to_dict()}}
    group = zarr.create_group(path, zarr_format=3, attributes=beginning)
    for spec in job.specs():
        _make_array(group, job, spec)
    for name, (dims, values) in job.coordinates().items():
        array = group.create_array(
            name, data=values, dimension_names=dims, chunks=values.shape
        )
        array.update_attributes({"units": _unit(name)})
    group.create_array(
        RECEIPTS,
        shape=(job.chunks, 2 * HASH_BYTES),
        chunks=(1, 2 * HASH_BYTES),
        dtype="uint8",
        fill_value=0,
        compressors=None,
        dimension_names=("chunk", "byte"),
    )


def _make_array(group: Any, job: Job, spec: ArraySpec) -> None:
    codecs = need("zarr.codecs")
    array = group.create_array(
        spec.name,
        shape=job.shape + spec.shape,
        chunks=job.inner + spec.shape,
        shards=job.chunk + spec.shape,
        dtype=spec.dtype,
        fill_value=spec.fill,
        compressors=codecs.ZstdCodec(level=COMPRESSION_LEVEL),
        dimension_names=job.dims + spec.dims,
    )
    array.update_attributes(dict(spec.attributes))


def _unit(name: str) -> str:
    if name == "spin":
        return "rad"
    return "1" if name.startswith("direction") else "m"


def _id_bytes(job: Job) -> np.ndarray[Any, Any]:
    return np.frombuffer(bytes.fromhex(job.id), np.uint8)
