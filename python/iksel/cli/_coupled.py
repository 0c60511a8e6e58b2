# SPDX-License-Identifier: BSD-3-Clause
"""Coupled limits as text: LOWER <= joint_2 + 0.5 joint_3 <= UPPER."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from iksel_cpp import CoupledLimit, InvalidArgumentError

if TYPE_CHECKING:
    from collections.abc import Callable

FLAG = "--coupled-limit"
FORM = "'LOWER <= JOINT + JOINT <= UPPER'"
SIGNS = {"+": 1.0, "-": -1.0}


def parse_coupled_limit(
    text: str, read_end: Callable[[list[str], float], float]
) -> CoupledLimit:
    """A limit as str(CoupledLimit) writes it; either end may be left out.

    Args:
        text: Ends and terms, with spaces around signs: 'a - 2 b <= 1.5'.
        read_end: Gives an end [rad or m], of its joints' names and its number.

    Raises:
        InvalidArgumentError: The text has another form.
    """
    parts = [part.strip() for part in text.split("<=")]
    if len(parts) not in (2, 3):
        raise _malformed(text)
    has_lower = len(parts) == 3 or _number(parts[0]) is not None
    terms = parts[1] if has_lower else parts[0]
    coefficients = _coefficients(terms, text)
    ends = [-math.inf, math.inf]
    for i, end in [(0, parts[0])] * has_lower + [(1, parts[-1])] * (
        len(parts) == 3 or not has_lower
    ):
        value = _number(end)
        if value is None:
            raise _malformed(text)
        ends[i] = read_end(list(coefficients), value)
    return CoupledLimit(coefficients, lower=ends[0], upper=ends[1])


def _coefficients(terms: str, text: str) -> dict[str, float]:
    """Coefficients by joint; those of a joint that is named twice are added."""
    found: dict[str, float] = {}
    sign: float | None = 1.0
    size: float | None = None
    for token in terms.replace("*", " ").split():
        number = _number(token)
        if token in SIGNS and size is None and (sign is None or not found):
            sign = SIGNS[token]
        elif sign is None:
            raise _malformed(text)
        elif number is not None and size is None:
            size = number
        else:
            has_sign = token[0] in SIGNS and not found
            name = token[1:] if has_sign else token
            factor = SIGNS[token[0]] if has_sign else 1.0
            coefficient = sign * factor * (1.0 if size is None else size)
            found[name] = found.get(name, 0.0) + coefficient
            sign = size = None
    if not found or sign is not None:
        raise _malformed(text)
    return found


def _number(text: str) -> float | None:
    """The number that a text is, if it is one."""
    try:
        return float(text)
    except ValueError:
        return None


def _malformed(text: str) -> InvalidArgumentError:
    return InvalidArgumentError(
        f"{FLAG}: expected {FORM}, with spaces around the signs, or one end of it, "
        f"got {text!r}"
    )
