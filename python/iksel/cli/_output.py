# SPDX-License-Identifier: BSD-3-Clause
"""What the commands print: JSON, aligned columns, numbers, a progress bar."""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from iksel._base.arrays import FloatArray

BAR_WIDTH = 30
SECONDS_BETWEEN_UPDATES = 0.1


def add_json(parser: argparse._ActionsContainer) -> None:
    """Add --json."""
    parser.add_argument(
        "--json", action="store_true", help="print one JSON object instead of text"
    )


def add_progress(parser: argparse._ActionsContainer) -> None:
    """Add --progress."""
    parser.add_argument(
        "--progress",
        action=argparse.BooleanOptionalAction,
        default=None,
        help="show a progress bar on stderr (default: if stderr is a terminal)",
    )


def print_json(value: object) -> None:
    """Print plain data and arrays as JSON; numbers that are not finite become null."""
    print(json.dumps(plain(value), indent=2, allow_nan=False))


def print_matrix(matrix: FloatArray) -> None:
    """Print a matrix (n, m), one row a line, such that no digit is lost."""
    for row in matrix.tolist():
        print(" ".join(map(repr, row)))


def print_pairs(pairs: Iterable[tuple[str, str]]) -> None:
    """Print names and values in two columns; later lines of a value are indented."""
    pairs = list(pairs)
    width = max(len(name) for name, _ in pairs)
    for name, value in pairs:
        text = value.replace("\n", "\n" + " " * (width + 2))
        print(f"{name:<{width}}  {text}".rstrip())


def print_table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """Print rows under a header; columns of numbers are aligned right."""
    table = [list(header), *map(list, rows)]
    columns = list(zip(*table, strict=True))
    widths = [max(map(len, column)) for column in columns]
    right = [all(map(_is_number, column[1:])) for column in columns]
    for row in table:
        cells = (
            cell.rjust(width) if on_right else cell.ljust(width)
            for cell, width, on_right in zip(row, widths, right, strict=True)
        )
        print("  ".join(cells).rstrip())


def number(value: float, digits: int = 6) -> str:
    """A number with that many decimals; infinities as such, and no -0."""
    if not math.isfinite(value):
        return str(value)
    return f"{round(value, digits) + 0.0:.{digits}f}"


def numbers(values: Iterable[float], digits: int = 6) -> str:
    """Numbers with that many decimals, separated by spaces."""
    return " ".join(number(value, digits) for value in values)


class Progress:
    """A progress bar on stderr; as a context, the callback for the core, or None."""

    def __init__(self, label: str, *, show: bool | None) -> None:
        """Show the bar, or not; None: if stderr is a terminal."""
        self._label = label
        self._show = sys.stderr.isatty() if show is None else show
        self._drawn_at = -math.inf

    def __call__(self, done: int, total: int) -> None:
        """Draw the bar, if it is time."""
        now = time.monotonic()
        if now - self._drawn_at < SECONDS_BETWEEN_UPDATES and done < total:
            return
        self._drawn_at = now
        part = done / total if total else 1.0
        bar = "#" * int(part * BAR_WIDTH)
        self._write(f"\r{self._label} [{bar:<{BAR_WIDTH}}] {part:4.0%}")

    def __enter__(self) -> Callable[[int, int], None] | None:
        """Begin; None where nothing is to be shown."""
        return self if self._show else None

    def __exit__(self, *exception: object) -> None:
        """End the bar's line."""
        if self._drawn_at > -math.inf:
            self._write("\n")

    def _write(self, text: str) -> None:
        sys.stderr.write(text)
        sys.stderr.flush()


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return text in ("", "-")
    return True


def plain(value: Any) -> Any:
    """Data that JSON has: arrays as lists, null for NaN and infinities."""
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value
