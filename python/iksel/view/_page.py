# SPDX-License-Identifier: BSD-3-Clause
"""A page that is served until it is closed."""

from __future__ import annotations

import contextlib
import threading
from typing import TYPE_CHECKING, Any

from iksel.view._server import quietly

if TYPE_CHECKING:
    from types import TracebackType

    from typing_extensions import Self


class Page:
    """What a server of viser serves: where it is, and how long."""

    def __init__(self, server: Any, host: str) -> None:
        """Take viser's server, which has started, and where it listens."""
        self._server = server
        self._closed = threading.Event()
        self.host = host

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    @property
    def port(self) -> int:
        """Where it is served."""
        return int(self._server.get_port())

    @property
    def url(self) -> str:
        """What to open in a browser."""
        everywhere = self.host in ("0.0.0.0", "127.0.0.1")  # noqa: S104 (only asked)
        named = f"[{self.host}]" if ":" in self.host else self.host
        host = "localhost" if everywhere else named
        return f"http://{host}:{self.port}"

    def _repr_html_(self) -> str:
        """The page inside a notebook."""
        return f'<iframe src="{self.url}" width="100%" height="600"></iframe>'

    def wait(self) -> None:
        """Serve until close(), from another thread, or Ctrl-C."""
        with contextlib.suppress(KeyboardInterrupt):
            self._closed.wait()

    def close(self) -> None:
        """Stop to serve."""
        if not self._closed.is_set():
            self._closed.set()
            with quietly():
                self._server.stop()
