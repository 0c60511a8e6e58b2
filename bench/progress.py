# SPDX-License-Identifier: BSD-3-Clause
"""How far a report is, as a bar."""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING, TextIO

if TYPE_CHECKING:
    from typing_extensions import Self

    from bench.store import Settings, Store

BAR_WIDTH = 24


class Bar:
    """One line on stderr: how many cells are done, how long it took, what is now."""

    def __init__(self, cells: list[Settings], store: Store, stream: TextIO) -> None:
        """A bar over cells, of which the store has some already."""
        self._missing = [cell for cell in cells if not store.has(cell)]
        self._store = store
        self._stream = stream
        self._begin = time.monotonic()
        self._what = ""
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)

    def __enter__(self) -> Self:
        """Begin to watch the store."""
        self._thread.start()
        return self

    def __exit__(self, *exception: object) -> None:
        """Draw the bar for the last time."""
        self._end.set()
        self._thread.join()
        self._draw()
        if self._stream.isatty():
            self._stream.write("\n")

    def say(self, what: str) -> None:
        """What is being measured now."""
        self._what = what

    def _watch(self) -> None:
        while not self._end.wait(1.0 if self._stream.isatty() else 15.0):
            self._draw()

    def _draw(self) -> None:
        done = sum(map(self._store.has, self._missing))
        part = done / max(len(self._missing), 1)
        bar = "#" * int(part * BAR_WIDTH)
        passed = time.monotonic() - self._begin
        line = f"[{bar:<{BAR_WIDTH}}] {part:4.0%} {passed:5.0f} s  {self._what}"
        before, after = ("\r\033[K", "") if self._stream.isatty() else ("", "\n")
        self._stream.write(f"{before}{line[:100]}{after}")
        self._stream.flush()
