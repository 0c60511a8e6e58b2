# SPDX-License-Identifier: BSD-3-Clause
"""Pieces of a Markdown text."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

NONE = "\N{EN DASH}"
"""What stands where there is no figure."""


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table; columns after the first are aligned right."""
    lines = [list(header), ["---", *["---:"] * (len(header) - 1)], *map(list, rows)]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def text_table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of words: every column is aligned left."""
    lines = ["| " + " | ".join(line) + " |" for line in (header, *rows)]
    return "\n".join([lines[0], "|---" * len(header) + "|", *lines[1:]])


def anchor(title: str) -> str:
    """What GitHub and MyST call a heading in links."""
    kept = re.sub(r"[^\w\- ]", "", title.strip().lower())
    return kept.replace(" ", "-")


def contents(text: str) -> str:
    """A list of links to the sections of a text."""
    titles = [line[3:] for line in text.splitlines() if line.startswith("## ")]
    return bullets(f"[{title}](#{anchor(title)})" for title in titles)


def bullets(lines: Iterable[str]) -> str:
    """A list."""
    return "\n".join(f"- {line}" for line in lines)


def listed(names: Sequence[str]) -> str:
    """Names in a sentence: a, b and c, or "none"; semicolons where they have commas."""
    *first, last = names or ["none"]
    between = "; " if any("," in name for name in names) else ", "
    return f"{between.join(first)} and {last}" if first else last


def microseconds(value: float | None) -> str:
    """A time [us] with as many digits as mean something."""
    if value is None:
        return NONE
    if value < 10:
        return f"{value:.2f}"
    if value < 100:
        return f"{value:.1f}"
    return f"{value:,.0f}"


def percent(part: float, whole: float, digits: int = 2) -> str:
    """A part in percent; never rounded up to 100."""
    value = 100.0 * part / whole
    shown = f"{value:.{digits}f}"
    if part < whole and float(shown) == 100.0:
        shown = f"{100.0 - 10.0**-digits:.{digits}f}"
    return shown


def signed(value: float, digits: int = 2) -> str:
    """A difference with its sign."""
    return f"{value:+.{digits}f}".replace("-", "\N{MINUS SIGN}")


def mean_median(times: list[float] | None) -> str:
    """Two times as a cell of a table; NONE of none."""
    if times is None:
        return NONE
    return f"{microseconds(times[0])} ({microseconds(times[1])})"
