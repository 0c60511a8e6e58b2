# SPDX-License-Identifier: BSD-3-Clause
"""Files that other people made, and those that are made for them."""

from __future__ import annotations

import contextlib
import errno
import os
import zipfile
from typing import IO, TYPE_CHECKING

from iksel_cpp import InvalidArgumentError, UrdfError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

LARGEST = 1 << 28
"""Bytes; text that is longer is no robot and no path, but a device without an end."""


def read_bytes(path: Path, largest: int = LARGEST) -> bytes:
    """What a file of at most so many bytes holds.

    Raises:
        OSError: It cannot be read.
        ValueError: It is too long.
    """
    with path.open("rb") as file:
        data = file.read(largest + 1)
    if len(data) > largest:
        msg = f"'{path}' is larger than {largest >> 20} MiB"
        raise ValueError(msg)
    return data


def read_text(path: Path) -> str:
    """The UTF-8 text of a file.

    Raises:
        OSError: It cannot be read.
        ValueError: It is too long, or not UTF-8.
    """
    return read_bytes(path).decode("utf-8")


def check_regular(path: Path) -> None:
    """Refuse a pipe or device that a file names, which may have no end.

    Raises:
        UrdfError: It is there, and no regular file.
    """
    if path.exists() and not path.is_file():
        raise UrdfError(f"'{path}' is no regular file")


def check_unpacked(path: Path) -> None:
    """Refuse an archive that is too large when it is unpacked.

    Raises:
        OSError, zipfile.BadZipFile: It cannot be read.
        ValueError: It is too large.
    """
    with zipfile.ZipFile(path) as archive:
        size = sum(member.file_size for member in archive.infolist())
    if size > LARGEST:
        msg = f"it unpacks to {size >> 20} MiB, and at most {LARGEST >> 20} are read"
        raise ValueError(msg)


def write_file(path: Path, content: bytes) -> None:
    """Write a file as a whole or not at all.

    Raises:
        InvalidArgumentError: It cannot be written.
    """
    with replaced(path) as file:
        file.write(content)


@contextlib.contextmanager
def replaced(path: Path) -> Iterator[IO[bytes]]:
    """A file beside `path` to write to, which takes its place when all is written.

    After an exception it is gone, and `path` is what it was.

    Raises:
        InvalidArgumentError: It cannot be written.
    """
    beside = path.parent / f".{path.name}.{os.getpid()}.part"
    try:
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        if path.exists() and not path.is_file():  # a pipe or a device is written to
            with path.open("wb") as file:
                yield file
            return
        try:
            with beside.open("xb") as file:
                yield file
            beside.replace(path)
        finally:
            beside.unlink(missing_ok=True)
    except OSError as error:
        raise InvalidArgumentError(
            f"'{path}' cannot be written: {error.strerror}"
        ) from error
