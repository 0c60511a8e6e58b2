# SPDX-License-Identifier: BSD-3-Clause
"""Results as files keyed by what was measured, so that a report can be gone on with."""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
from pathlib import Path
from typing import Any

Settings = dict[str, Any]
"""What is measured in one cell of a table: plain data, "cell" names the function."""


def key_of(settings: Settings) -> str:
    """Settings as text: the same for the same cell."""
    return json.dumps(settings, sort_keys=True)


class Store:
    """One file per cell in a folder."""

    def __init__(
        self, folder: Path, fingerprint: str, versions: dict[str, str] | None = None
    ) -> None:
        """Results of another fingerprint, or version of the rival, are not found."""
        self.folder = folder
        self.fingerprint = fingerprint
        self.versions = versions or {}

    def path(self, settings: Settings) -> Path:
        """The cell's file."""
        other = settings.get("rival") or settings.get("beside") or ""
        version = self.versions.get(other, "")
        key = json.dumps([self.fingerprint, version, settings], sort_keys=True)
        name = hashlib.sha256(key.encode()).hexdigest()[:20]
        return self.folder / f"{name}.json"

    def load(self, settings: Settings) -> dict[str, Any] | None:
        """The cell's result, or None if it is not there or not readable."""
        try:
            content = json.loads(self.path(settings).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None
        result = content.get("result") if isinstance(content, dict) else None
        return result if isinstance(result, dict) else None

    def has(self, settings: Settings) -> bool:
        """Whether there is a file for the cell."""
        return self.path(settings).exists()

    def save(
        self, settings: Settings, result: dict[str, Any], seconds: float = 0.0
    ) -> None:
        """Keep a result and how long it took.

        An interruption leaves the old file or the new one.
        """
        content = {"settings": settings, "seconds": seconds, "result": result}
        write_json(self.path(settings), content)

    def forget(self, settings: Settings) -> None:
        """Remove a result."""
        self.path(settings).unlink(missing_ok=True)


def write_json(path: Path, content: object, *, indent: int | None = None) -> None:
    """Write beside the file and rename."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile(
        "w", dir=path.parent, suffix=".part", delete=False, encoding="utf-8"
    ) as file:
        json.dump(content, file, indent=indent, allow_nan=False)
        file.write("\n")
    mask = os.umask(0)
    os.umask(mask)
    part = Path(file.name)
    part.chmod(0o666 & ~mask)
    part.replace(path)
