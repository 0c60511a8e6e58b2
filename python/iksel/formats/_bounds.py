# SPDX-License-Identifier: BSD-3-Clause
"""How much work and memory a file of somebody else may ask for."""

from __future__ import annotations

import time
from typing import Any

# Chosen, not tuned: real robots stay far below each.
LARGEST_VALUE = 100_000
"""Characters of a text, or items of a list with all that is inside, in one value."""
LARGEST_INTEGER = 4096
"""Bits of a whole number."""
MOST_STEPS = 10_000_000
"""Characters, items and elements that are made while a file is expanded."""
LONGEST_TIME = 10.0
"""Processor time that a file is expanded for [s]."""


class RefusedError(Exception):
    """A file asks for what files must not have."""


class Budget:
    """What is left of the work that a file may ask for."""

    def __init__(self, steps: int = MOST_STEPS, seconds: float = LONGEST_TIME) -> None:
        """Begin to count."""
        self._left = steps
        self._end = time.thread_time() + seconds

    def spend(self, steps: int) -> None:
        """Take note of work, before it is done where it may be much.

        Raises:
            RefusedError: It is more than there is left.
        """
        self._left -= steps
        if self._left < 0 or time.thread_time() > self._end:
            msg = "it asks for more work than any robot needs; is something repeated?"
            raise RefusedError(msg)


def check_length(length: float) -> None:
    """Refuse a text or list of a length that none needs, before it is made."""
    if length > LARGEST_VALUE:
        msg = f"a text or list longer than {LARGEST_VALUE}"
        raise RefusedError(msg)


def check_bits(bits: float) -> None:
    """Refuse a whole number of so many bits, before it is made."""
    if bits > LARGEST_INTEGER:
        msg = f"a whole number of more than {LARGEST_INTEGER} bits"
        raise RefusedError(msg)


def size_of(value: Any) -> int:
    """Characters and items in a value, each as often as it is written out.

    Raises:
        RefusedError: They are too many.
    """
    total, left = 0, [value]
    while left:
        part = left.pop()
        total += 1
        if isinstance(part, str):
            total += len(part)
        elif isinstance(part, dict):
            left += part.keys()
            left += dict.values(part)
        elif isinstance(part, (list, tuple)):
            left += list.__iter__(part) if isinstance(part, list) else part
        check_length(total)
        check_length(len(left))
    return total
