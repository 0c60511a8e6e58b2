# SPDX-License-Identifier: BSD-3-Clause
"""Files that other people made."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

LARGEST = 1 << 28
"""Bytes; text that is longer is no robot and no path, but a device without an end."""


def read_text(path: Path) -> str:
    """The UTF-8 text of a file.

    Raises:
        OSError: It cannot be read.
        ValueError: It is too long, or not UTF-8.
    """
    with path.open("rb") as file:
        data = file.read(LARGEST + 1)
    if len(data) > LARGEST:
        msg = f"'{path}' is larger than {LARGEST >> 20} MiB"
        raise ValueError(msg)
    return data.decode("utf-8")
