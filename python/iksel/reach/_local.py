# SPDX-License-Identifier: BSD-3-Clause
"""Processes of this machine that compute chunks.

Each is a Python of its own that reads the filter, if there is one, and then numbers of
chunks from its standard input, and answers each of these by a line of JSON. If this
process dies, their input ends and so do they.
"""

from __future__ import annotations

import base64
import contextlib
import json
import os
import pickle
import queue
import subprocess
import sys
import threading
from collections import Counter, deque
from typing import TYPE_CHECKING, Any

from iksel_cpp import InvalidArgumentError

from iksel.reach._errors import MapIoError, WorkerError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from iksel.reach._job import Filter
    from iksel.reach._store import Store

TRIES = 3
"""How often a chunk may end a worker before the run gives up."""


class Worker:
    """One process, and the chunk that it computes."""

    def __init__(
        self, path: str, beginning: str, answers: queue.Queue[tuple[Worker, Any]]
    ) -> None:
        self.chunk: int | None = None
        environment = dict(os.environ)
        # As this process finds its modules, so does that one; and one thread each.
        environment["PYTHONPATH"] = os.pathsep.join(filter(None, sys.path))
        self.process = subprocess.Popen(  # noqa: S603 (this interpreter)
            [sys.executable, "-m", "iksel.reach._worker", path],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=environment,
        )
        self._write(beginning)
        self._answers = answers
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._listener.start()

    def send(self, chunk: int) -> None:
        """Have it compute a chunk."""
        self.chunk = chunk
        self._write(str(chunk))

    def _write(self, line: str) -> None:
        assert self.process.stdin is not None
        # If it has died, its end is on its way through the other pipe.
        with contextlib.suppress(BrokenPipeError):
            self.process.stdin.write(f"{line}\n")
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


class Pool:
    """So many processes, which load what they need as soon as they are made."""

    def __init__(
        self,
        path: str,
        count: int,
        filter: Filter | None = None,  # noqa: A002 (as in solve)
    ) -> None:
        self._path = path
        self._beginning = pack(filter)
        self._answers: queue.Queue[tuple[Worker, Any]] = queue.Queue()
        self._workers = {self._start() for _ in range(count)}

    def compute(self, store: Store, chunks: Sequence[int]) -> Iterator[int]:
        """Compute chunks; gives the number of each when it is done.

        Raises:
            MapIoError: A chunk cannot be written.
            WorkerError: Workers died over the same chunk three times, or cannot start.
        """
        waiting, deaths = deque(chunks), Counter[int]()
        for worker in list(self._workers):
            self._go_on(worker, waiting)
        while self._workers:
            worker, answer = self._answers.get()
            if worker not in self._workers:
                continue  # it has ended because there was nothing left for it
            if answer is None:
                self._workers.remove(worker)
                _bury(worker, deaths)
                if worker.chunk is not None:
                    waiting.appendleft(worker.chunk)
                if waiting:
                    self._workers.add(another := self._start())
                    self._go_on(another, waiting)
                continue
            if "error" in answer:
                raise failure(store, answer["chunk"], answer["error"], io=answer["io"])
            self._go_on(worker, waiting)
            yield answer["chunk"]

    def close(self) -> None:
        """End the processes at once, whatever they are at."""
        for worker in self._workers:
            worker.process.kill()
            worker.stop()
        self._workers.clear()

    def _start(self) -> Worker:
        return Worker(self._path, self._beginning, self._answers)

    def _go_on(self, worker: Worker, waiting: deque[int]) -> None:
        """Give a worker the next chunk, or let it end."""
        worker.chunk = None
        if waiting:
            worker.send(waiting.popleft())
        else:
            self._workers.remove(worker)
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


def pack(filter: Filter | None) -> str:  # noqa: A002 (as in solve)
    """A filter as a line of text for unpack(), in a worker.

    Raises:
        InvalidArgumentError: pickle does not take it.
    """
    try:
        return base64.b64encode(pickle.dumps(filter)).decode()
    except Exception as error:  # noqa: BLE001 (what objects raise is theirs)
        raise InvalidArgumentError(
            f"filter: other processes cannot have it, as pickle says: {error}; use "
            "workers=1"
        ) from None


def unpack(line: str) -> Filter | None:
    """The filter of pack(), which comes from the process that started this one."""
    found: Filter | None = pickle.loads(base64.b64decode(line))  # noqa: S301
    return found


def failure(
    store: Store, chunk: int, reason: object, *, io: bool = True
) -> MapIoError | WorkerError:
    """The error for a chunk that could not be computed, or not be written."""
    message = (
        f"chunk {chunk} of '{store.path}': {reason}; what is done stays, run again to "
        "go on"
    )
    return MapIoError(message) if io else WorkerError(message)
