# SPDX-License-Identifier: BSD-3-Clause
"""Where a store lies: a folder of this machine, or a URL that fsspec opens."""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
import uuid
from pathlib import Path
from typing import TYPE_CHECKING, Any

from iksel.reach._errors import MapIoError, need

if TYPE_CHECKING:
    from collections.abc import Callable

StrPath = str | os.PathLike[str]
"""A path, or a URL such as s3://bucket/map.zarr."""

_ROOT = "zarr.json"  # written last, so that there is no store without the rest


def locate(path: StrPath) -> Location:
    """Where a path or a URL leads.

    Raises:
        MapIoError: fsspec has no such kind of URL, or lacks a package for it.
    """
    text = os.fspath(path)
    scheme, mark, rest = text.partition("://")
    if not mark or scheme == "file":
        return Location(Path(rest if mark else text))
    return Remote(text)


class Location:
    """A folder of this machine."""

    def __init__(self, path: Path) -> None:
        self.path: Path | str = path
        """As zarr opens it, and for messages."""

    @property
    def address(self) -> str:
        """By which other processes find it."""
        return str(Path(self.path).absolute())

    def exists(self) -> bool:
        """Whether there is anything."""
        return Path(self.path).exists()

    def read_text(self, name: str) -> str:
        """The UTF-8 text of a file in it.

        Raises:
            FileNotFoundError: There is none.
            OSError: It cannot be read.
        """
        return Path(self.path, name).read_text(encoding="utf-8")

    def remove(self, name: str) -> None:
        """Remove a file in it, if it is there."""
        Path(self.path, name).unlink(missing_ok=True)

    def make(self, fill: Callable[[Path], Any]) -> None:
        """Make it, complete or not at all, also if two do it at once.

        Args:
            fill: Writes what is in it into a folder that is not there yet.

        Raises:
            OSError: It cannot be written.
        """
        target = Path(self.path)
        beside = target.with_name(f"{target.name}.{uuid.uuid4().hex}.partial")
        try:
            fill(beside)
            beside.rename(target)
        finally:
            shutil.rmtree(beside, ignore_errors=True)

    def __str__(self) -> str:
        return str(self.path)


class Remote(Location):
    """What a URL leads to; files are written as a whole there, as in object stores."""

    def __init__(self, url: str) -> None:
        self.path = url
        fsspec = need("fsspec")
        try:
            self._files, root = fsspec.core.url_to_fs(url)
        except (ValueError, ImportError) as error:
            raise MapIoError(f"'{url}' cannot be opened: {error}") from None
        self._root = root.rstrip("/")

    @property
    def address(self) -> str:
        """The URL."""
        return str(self.path)

    def exists(self) -> bool:
        """Whether there is anything."""
        return bool(self._files.exists(self._root))

    def read_text(self, name: str) -> str:
        """The UTF-8 text of a file in it."""
        return str(self._files.cat_file(f"{self._root}/{name}").decode("utf-8"))

    def remove(self, name: str) -> None:
        """Remove a file in it, if it is there."""
        with contextlib.suppress(FileNotFoundError):
            self._files.rm_file(f"{self._root}/{name}")

    def make(self, fill: Callable[[Path], Any]) -> None:
        """Make it; the file without which there is no store is written last."""
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder, "store")
            fill(source)
            files = sorted(f for f in source.rglob("*") if f.is_file())
            files.sort(key=lambda file: file == source / _ROOT)
            for file in files:
                name = f"{self._root}/{file.relative_to(source).as_posix()}"
                self._files.makedirs(name.rpartition("/")[0], exist_ok=True)
                self._files.put_file(str(file), name)
