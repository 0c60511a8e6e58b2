# SPDX-License-Identifier: BSD-3-Clause
"""Starts viser where it can listen, for pages of its own alone."""

from __future__ import annotations

import contextlib
import functools
import importlib
import io
import ipaddress
import socket
import threading
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

from iksel_cpp import InvalidArgumentError

from iksel._base.arrays import reject

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

MOST_PORTS = 1000
"""How many ports are tried, from the one that is asked for."""
_LAST_PORT = 65535
_lock = threading.Lock()  # the package websockets is changed for a moment


def start(viser: Any, host: str, port: int, origins: Iterable[str] = ()) -> Any:
    """Start a server of viser, at a port or the next free one.

    Args:
        viser: The module.
        host: Where it listens.
        port: The first port that is tried.
        origins: Of pages that may connect besides its own, as https://lab.example:8443.

    Raises:
        InvalidArgumentError: No address of this machine, no port, or none is free; or
            what is no origin.
    """
    allowed = _checked_origins(origins)
    free = _free_port(host, port)
    with _lock, quietly(), _chosen_pages_alone(host, allowed):
        return viser.ViserServer(host=host, port=free, verbose=False)


def quietly() -> contextlib.AbstractContextManager[Any]:
    """Keep what viser says of its starts and stops off the standard output."""
    return contextlib.redirect_stdout(io.StringIO())


def is_own_page(host: str, origin: str | None, asked: str | None) -> bool:
    """Whether a page may connect that a browser shows.

    Args:
        host: Where the server listens.
        origin: The page's, as browsers send it; None: no browser asks.
        asked: Host and port that are asked for, the header `Host`.
    """
    name = urlsplit(f"//{asked or ''}").hostname or ""
    if origin is not None and urlsplit(origin).netloc != asked:
        return False
    # Of a foreign name that was made to point here, both agree.
    own = {host.lower(), "localhost", socket.gethostname().lower()}
    return origin is None or name in own | {socket.getfqdn().lower()} or _is_ip(name)


def _checked_origins(origins: Iterable[str]) -> frozenset[str]:
    """Origins as browsers send them."""
    if isinstance(origins, str):
        reject("origins", f"expected a list of texts, got {origins!r}")
    found = set()
    for origin in origins:
        parts = urlsplit(str(origin).rstrip("/").lower())
        bare = f"{parts.scheme}://{parts.netloc}"
        if not (parts.scheme and parts.netloc) or parts.geturl() != bare:
            reject("origins", f"{origin!r} is no origin such as https://lab.example")
        found.add(bare)
    return frozenset(found)


def _is_ip(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _free_port(host: str, port: int) -> int:
    """The first free port; viser would look for it without an end."""
    if isinstance(port, bool) or not isinstance(port, int):
        reject("port", f"expected a whole number, got {port!r}")
    if not 0 <= port <= _LAST_PORT:
        reject("port", f"{port} is not from 0 to {_LAST_PORT}")
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    problem = "none"
    for free in range(port, min(port + MOST_PORTS, _LAST_PORT + 1)):
        try:
            with socket.create_server((host, 0), family=family):
                pass
        except (OSError, UnicodeError) as reason:
            reject("host", f"cannot listen at {host!r}: {reason}")
        try:
            with socket.create_server((host, free), family=family):
                return free
        except OSError as reason:
            problem = str(reason)
    msg = f"port: none is free at {host!r} from {port} on: {problem}"
    raise InvalidArgumentError(msg)


@contextlib.contextmanager
def _chosen_pages_alone(host: str, allowed: frozenset[str]) -> Iterator[None]:
    """Let servers of websockets that are started meanwhile refuse foreign pages."""
    module: Any = importlib.import_module("websockets.asyncio.server")
    serve = module.serve

    @functools.wraps(serve)
    def checked(*arguments: Any, process_request: Any = None, **options: Any) -> Any:
        def process(connection: Any, request: Any) -> Any:
            origins = request.headers.get_all("Origin") or [None]
            asked = request.headers.get("Host")
            if not all(
                origin in allowed or is_own_page(host, origin, asked)
                for origin in origins
            ):
                return connection.respond(403, "a page of another site\n")
            return (
                None
                if process_request is None
                else process_request(connection, request)
            )

        return serve(*arguments, process_request=process, **options)

    module.serve = checked
    try:
        yield
    finally:
        module.serve = serve
