# SPDX-License-Identifier: BSD-3-Clause
"""Which columns of a file hold poses, by a first line of names."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from iksel_cpp import InvalidArgumentError

from iksel.cli._parser import parse_numbers, split_numbers

if TYPE_CHECKING:
    from collections.abc import Sequence

_FORMS = (
    ("x", "y", "z", "roll", "pitch", "yaw"),
    ("x", "y", "z", "qw", "qx", "qy", "qz"),
)
MOST_NAMES = max(map(len, _FORMS))
"""Numbers of a pose that columns can have names for."""


class Columns(NamedTuple):
    """Where the numbers of poses stand in a line."""

    total: int
    """Number of all columns."""
    chosen: list[int]
    """Which hold a pose, in the order of one of _FORMS; one tip after the other."""
    separator: str | None
    """Between columns; None: white space."""

    def pick(self, where: str, line: str) -> list[float]:
        """The numbers of the poses in a line.

        Raises:
            InvalidArgumentError: Another number of columns, or one is no number.
        """
        cells = line.split(self.separator)
        if len(cells) != self.total:
            cells = split_numbers(line)
        if len(cells) != self.total:
            raise InvalidArgumentError(
                f"{where}: expected {self.total} columns, as many as the first line "
                f"has names, got {len(cells)}"
            )
        return parse_numbers(where, [cells[i] for i in self.chosen])


def form_names(tips: Sequence[str]) -> str:
    """How columns are named, for people."""
    names = " or ".join(" ".join(form) for form in _FORMS)
    if len(tips) == 1:
        return names
    return f"{names}, each behind its tip's link and a point ({tips[0]}.x)"


def read_columns(where: str, line: str, tips: Sequence[str]) -> Columns | None:
    """The columns that a line of names gives; None if it is a line of poses.

    Args:
        where: The line's place, for messages.
        line: Its text.
        tips: Links of the tips.

    Raises:
        InvalidArgumentError: They are names, but not those of a pose for each tip, or
            of two.
    """
    if line[0] in "[{":
        return None
    separator = next((mark for mark in ",;" if mark in line), None)
    names = [word.strip(" \t\"'").lower() for word in line.split(separator)]
    if any(map(_is_number, names)):
        return None
    before = [""] if len(tips) == 1 else [f"{tip.lower()}." for tip in tips]
    forms = [[link + name for link in before for name in form] for form in _FORMS]
    forms = [form for form in forms if set(form) <= set(names)]
    if not forms:
        raise InvalidArgumentError(
            f"{where}: {form_names(tips)} are not among the columns {', '.join(names)}"
        )
    if len(forms) > 1 or any(names.count(name) > 1 for name in forms[0]):
        raise InvalidArgumentError(
            f"{where}: the columns {', '.join(names)} hold more than one pose"
        )
    chosen = [names.index(name) for name in forms[0]]
    return Columns(len(names), chosen, separator)


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
