# SPDX-License-Identifier: BSD-3-Clause
"""Processes of this machine that compute chunks.

Each is a Python of its own that reads numbers of chunks from its standard input and
answers each by a line of JSON. If this process dies, their input ends and so do they.
"""

from __future__ import annotations

import contextlib
import json
import os
import queue
import subprocess
import sys
import threading
from collections import Counter, deque
from typing import TYPE_CHECKING, Any

from iksel.reach._errors import MapIoError, WorkerError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from iksel.reach._store import Store

TRIES = 3
"""How often a chunk may end a worker before the run gives up."""


class Worker:
    """One process, and the chunk that it computes."""

    def __init__(self, path: Path, answers: queue.Queue[tuple[Worker, Any]]) -> None:
        self.chunk: int | None = None
        environment = dict(os.environ)
        # As this process finds its modules, so does that one; and one thread each.
        environment["PYTHONPATH"] = os.pathsep.join(filter(None, sys.path))
        self.process = subprocess.Popen(  # noqa: S603 (this interpreter)
            [sys.executable, "-m", "iksel.reach._worker", str(path)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=environment,
        )
        self._answers = answers
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._listener.start()

    def send(self, chunk: int) -> None:
        """Have it compute a chunk."""
        self.chunk = chunk
        assert self.process.stdin is not None
        # If it has died, its end is on its way through the other pipe.
        with contextlib.suppress(BrokenPipeError):
            self.process.stdin.write(f"{chunk}\n")
            self.process.stdin.flush()

    def stop(self) -> None:
        """Let it end after its chunk."""
        assert self.process.stdin is not None
        with contextlib.suppress(BrokenPipeError):
            self.process.stdin.close()
        self.process.wait()
        self._listener.join()
        assert self.process.stdout is not None
        self.process.stdout.close()

    def _listen(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self._answers.put((self, json.loads(line)))
        self._answers.put((self, None))


def run_processes(store: Store, chunks: Sequence[int], count: int) -> Iterator[int]:
    """Compute chunks by so many processes; gives each number when it is done.

    Raises:
        MapIoError: A chunk cannot be written.
        WorkerError: Workers died over the same chunk three times, or cannot start.
    """
    waiting, deaths = deque(chunks), Counter[int]()
    answers: queue.Queue[tuple[Worker, Any]] = queue.Queue()
    workers: set[Worker] = set()

    def start() -> None:
        worker = Worker(store.path.absolute(), answers)
        workers.add(worker)
        worker.send(waiting.popleft())

    try:
        while len(workers) < count and waiting:
            start()
        while workers:
            worker, answer = answers.get()
            if answer is None:
                workers.remove(worker)
                _bury(worker, deaths)
                if worker.chunk is not None:
                    waiting.appendleft(worker.chunk)
                if waiting:
                    start()
                continue
            if "error" in answer:
                raise failure(store, answer["chunk"], answer["error"], io=answer["io"])
            worker.chunk = None
            if waiting:
                worker.send(waiting.popleft())
            else:
                workers.remove(worker)
                worker.stop()
            yield answer["chunk"]
    finally:
        for worker in workers:
            worker.stop()


def _bury(worker: Worker, deaths: Counter[int]) -> None:
    """Take note of a worker that ended, unless there was too much of that."""
    worker.stop()
    code = worker.process.returncode
    if worker.chunk is None:
        return
    deaths[worker.chunk] += 1
    if deaths[worker.chunk] >= TRIES:
        how = f"signal {-code}" if code < 0 else f"exit status {code}"
        raise WorkerError(
            f"chunk {worker.chunk}: {TRIES} workers ended over it, the last one by "
            f"{how}; run again to go on"
        )


def failure(
    store: Store, chunk: int, reason: object, *, io: bool = True
) -> MapIoError | WorkerError:
    """The error for a chunk that could not be computed, or not be written."""
    message = (
        f"chunk {chunk} of '{store.path}': {reason}; what is done stays, run again to "
        "go on"
    )
    return MapIoError(message) if io else WorkerError(message)
