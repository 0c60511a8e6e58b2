# SPDX-License-Identifier: BSD-3-Clause
"""A worker process of _local: a filter and numbers of chunks come in, JSON goes out."""

from __future__ import annotations

import json
import os
import signal
import sys

from iksel.reach._errors import need
from iksel.reach._local import unpack
from iksel.reach._run import compute_chunk
from iksel.reach._store import Store


def main(path: str) -> None:
    """Compute the chunks that standard input names until it ends."""
    # Ctrl-C reaches all processes of a terminal; the one that started this one ends it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    need("zarr")  # which takes a while, until there is something to do
    store = None
    filter = unpack(sys.stdin.readline())  # noqa: A001 (as in solve)
    for line in sys.stdin:
        chunk = int(line)
        answer: dict[str, object] = {"chunk": chunk}
        try:
            store = store or Store(path, writable=True)
            compute_chunk(store, chunk, filter)
        except Exception as error:  # noqa: BLE001 (told to the other process)
            answer["error"] = f"{type(error).__name__}: {error}"
            answer["io"] = isinstance(error, OSError)
        try:
            print(json.dumps(answer), flush=True)  # noqa: T201
        except BrokenPipeError:
            # Nobody listens any more; Python's own end would write there once again.
            os._exit(1)


if __name__ == "__main__":
    main(sys.argv[1])
