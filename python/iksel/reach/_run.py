# SPDX-License-Identifier: BSD-3-Clause
"""Computing a map: by processes of this machine, by Dask, or a share of it."""

from __future__ import annotations

import contextlib
import math
import os
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from iksel._base.arrays import reject
from iksel.reach._errors import MapError, PlanMismatchError, WorkerError, need
from iksel.reach._local import Pool, failure
from iksel.reach._location import StrPath, locate
from iksel.reach._store import Store, read_job

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from iksel_cpp import Solver

    from iksel.reach._job import Filter, Job

IN_FLIGHT = 4
"""Chunks that each thread of a Dask cluster has waiting."""


@dataclass(frozen=True)
class Progress:
    """How much of a map, or of a share of it, has been computed."""

    done: int
    """Chunks computed."""
    chunks: int
    """Chunks in all."""
    cells: int
    """Cells in all."""

    @property
    def complete(self) -> bool:
        """Whether nothing is missing."""
        return self.done == self.chunks


def run(
    path: StrPath,
    *,
    workers: int | None = None,
    client: Any = None,
    share: tuple[int, int] | None = None,
    repair: bool = False,
    progress: Callable[[int, int], Any] | None = None,
    filter: Filter | None = None,  # noqa: A002 (as in solve)
) -> Progress:
    """Compute what is missing of a map or a data set.

    Chunks that are there are checked and kept. However many workers there are and
    whichever chunk comes first, every array ends with the same bytes.

    Args:
        path: What create() wrote; for Dask a path or URL that all workers see.
        workers: Processes on this machine, of one thread each; None: one per core; for
            one this process itself.
        client: A distributed.Client: chunks are computed by its cluster instead.
        share: (i, n): only every n-th chunk from i = 0 ... n - 1, for one of n jobs
            that share the work without knowing each other. Of other chunks nothing is
            read.
        repair: Compute damaged chunks again, in the place of refusing the map.
        progress: Called with the numbers of chunks done and in all of the share.
        filter: The one that the plan names, of whose result the plan's promise of the
            same bytes holds if it says the same to the same configurations. Other
            processes get it by pickle.

    Returns:
        How much of the map, or of the share, has been computed.

    Raises:
        ChunkDamagedError: A chunk is damaged or of another plan.
        PlanMismatchError: The map was planned by another version of iksel, for another
            instruction set, or with another filter.
        InvalidArgumentError: A filter for other processes that pickle does not take.
        MapIoError: The store cannot be read or written.
        WorkerError: Workers kept dying over the same chunk, or cannot start.
    """
    with contextlib.ExitStack() as stack:
        pool = None
        if client is None and (count := _processes(path, workers)) > 1:
            # They load while this process looks at what is there.
            pool = Pool(locate(path).address, count, filter)
            stack.callback(pool.close)
        store = Store(path, writable=True)
        store.job.solver()  # in case it cannot be made
        store.job.check_machine()
        store.job.request(filter)
        indices = _share(store.job.chunks, share)
        missing = _missing(store, indices, repair=repair)
        if client is not None:
            finished = _run_dask(client, store, missing, filter)
        elif pool is not None:
            finished = pool.compute(store, missing)
        else:
            finished = _run_here(store, missing, filter)
        report = progress or (lambda _done, _total: None)
        before = len(indices) - len(missing)
        report(before, len(indices))
        for n, _ in enumerate(finished, start=before + 1):
            report(n, len(indices))
    return Progress(len(indices), len(indices), _cells(store.job, indices))


def _cells(job: Job, indices: Sequence[int]) -> int:
    """Cells of chunks."""
    if len(indices) == job.chunks:
        return job.size
    blocks = map(job.block, indices)
    return sum(math.prod(part.stop - part.start for part in b) for b in blocks)


def _processes(path: StrPath, workers: int | None) -> int:
    """How many processes are of use for a map."""
    if workers is not None and workers < 1:
        reject("workers", f"{workers} is less than 1")
    count = os.cpu_count() or 1 if workers is None else workers
    return min(count, read_job(path).chunks)


def status(path: StrPath) -> Progress:
    """How much of a map or a data set has been computed.

    Raises:
        MapIoError: There is none.
        PlanMismatchError: A chunk of it belongs to another plan.
    """
    store = Store(path)
    return Progress(int(store.done().sum()), store.job.chunks, store.job.size)


def merge(path: StrPath, parts: Sequence[StrPath]) -> Progress:
    """Collect chunks of the same plan that were computed in other stores.

    Args:
        path: A store of the plan, which takes what it lacks.
        parts: Stores of the same plan.

    Raises:
        PlanMismatchError: A part has another plan.
        ChunkDamagedError: A chunk is damaged or of another plan.
    """
    store = Store(path, writable=True)
    done = store.done()
    for part_path in parts:
        part = Store(part_path)
        if part.job.id != store.job.id:
            raise PlanMismatchError(
                f"'{part.path}' has another plan ({part.job.id}) than '{store.path}' "
                f"({store.job.id})"
            )
        for index in (part.done() & ~done).nonzero()[0].tolist():
            store.write(index, part.read(index))
            done[index] = True
    return status(path)


def connect(address: str) -> Any:
    """A distributed.Client of the Dask cluster at an address, tcp://host:port.

    Raises:
        WorkerError: No scheduler answers there.
    """
    distributed = need("distributed")
    try:
        return distributed.Client(address)
    except (OSError, ValueError) as error:
        raise WorkerError(f"no Dask scheduler at {address}: {error}") from error


def compute_chunk(
    store: Store,
    index: int,
    filter: Filter | None = None,  # noqa: A002 (as in solve)
) -> int:
    """Compute and write a chunk; returns its number."""
    request = store.job.request(filter)
    store.write(index, store.job.compute(index, _solver(store), request))
    return index


def _solver(store: Store) -> Solver:
    return _solvers(store.place.address, store.job.id)


@lru_cache(maxsize=4)
def _solvers(path: str, _id: str) -> Solver:
    job = Store(path).job
    job.check_machine()
    return job.solver()


@lru_cache(maxsize=4)
def _stores(path: str, _id: str) -> Store:
    return Store(path, writable=True)


def _share(chunks: int, share: tuple[int, int] | None) -> range:
    if share is None:
        return range(chunks)
    i, n = share
    if not 0 <= i < n:
        reject("share", f"{i}/{n} is no i/n with i = 0 ... n - 1")
    return range(i, chunks, n)


def _missing(store: Store, indices: Sequence[int], *, repair: bool) -> list[int]:
    """The chunks that have to be computed, after a check of the others."""
    done = store.done(indices)
    missing = [i for i, known in zip(indices, done, strict=True) if not known]
    there = [i for i, known in zip(indices, done, strict=True) if known]
    for index, error in store.damaged(there):
        if not repair:
            raise error
        store.forget(index)
        missing.append(index)
    return sorted(missing)


def _run_here(
    store: Store,
    indices: Sequence[int],
    filter: Filter | None,  # noqa: A002 (as in solve)
) -> Iterator[int]:
    """Compute chunks in this process."""
    for index in indices:
        try:
            yield compute_chunk(store, index, filter)
        except OSError as error:
            raise failure(store, index, error) from error


def _run_dask(
    client: Any,
    store: Store,
    indices: Sequence[int],
    filter: Filter | None,  # noqa: A002 (as in solve)
) -> Iterator[int]:
    """Compute chunks on a Dask cluster, a few for each of its threads at a time."""
    as_completed = need("distributed").as_completed
    path, waiting = store.place.address, iter(indices)
    threads = max(1, sum(client.nthreads().values()))

    def submit(index: int) -> Any:
        return client.submit(_on_worker, path, store.job.id, index, filter, pure=False)

    first = [
        submit(i) for _, i in zip(range(IN_FLIGHT * threads), waiting, strict=False)
    ]
    futures = as_completed(first)
    for future in futures:
        try:
            index = future.result()
        except MapError:
            raise
        except Exception as error:
            raise WorkerError(
                f"the cluster could not compute a chunk of '{store.path}': {error}; "
                "run again to go on"
            ) from error
        following = next(waiting, None)
        if following is not None:
            futures.add(submit(following))
        yield index


def _on_worker(
    path: str,
    job_id: str,
    index: int,
    filter: Filter | None,  # noqa: A002 (as in solve)
) -> int:
    """What a Dask worker does for a chunk."""
    return compute_chunk(_stores(path, job_id), index, filter)
