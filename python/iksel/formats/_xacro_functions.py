# SPDX-License-Identifier: BSD-3-Clause
"""What expressions of xacro files may call: functions of values that make values."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any

from iksel.formats._bounds import RefusedError, check_bits, check_length

if TYPE_CHECKING:
    from collections.abc import Callable

NAMESPACES = ("math", "python", "xacro")
"""Names before the dot of a function's."""

CONSTANTS: dict[str, Any] = {
    **{name: getattr(math, name) for name in ("pi", "e", "tau", "inf", "nan")},
    "True": True,
    "False": False,
    "None": None,
    "true": True,
    "false": False,
}

_MOST_DIGITS = 400  # of numbers that are rounded or written; floats have 309
_FORMAT = re.compile(r"%[-+ #0]*(\d*)(?:\.(\d*))?[diouxXeEfFgGsr%]")


def format_text(text: str, values: Any) -> str:
    """What `text % values` is, of codes without attributes or great widths."""
    left = text
    for code in _FORMAT.finditer(text):
        left = left.replace(code[0], "", 1)
        for number in code.groups():
            if int(number[:9] or 0) if number else 0:
                check_length(int(number[:9]) * len(text))
    if "%" in left:
        msg = f"the format {text!r}"
        raise RefusedError(msg)
    return str(text % values)


def _range(*ends: int) -> list[int]:
    numbers = range(*ends)
    check_length(len(numbers))
    return list(numbers)


def _round(number: float, ndigits: int | None = None) -> float:
    if ndigits is None:
        return round(number)
    if abs(ndigits) > _MOST_DIGITS:
        msg = f"round() to {ndigits} digits"
        raise RefusedError(msg)
    return round(number, ndigits)


def _prod(factors: Any, *, start: Any = 1) -> Any:
    for factor in factors:
        start = start * _number(factor)
        if isinstance(start, int):
            check_bits(start.bit_length())
    return start


def _sum(terms: Any, start: Any = 0) -> Any:
    return sum((_number(term) for term in terms), _number(start))


def _few(function: Callable[..., Any]) -> Callable[..., Any]:
    """A function of whole numbers whose value grows fast, for small ones."""

    def bounded(*numbers: int) -> Any:
        for number in numbers:
            check_bits(number)
        return function(*numbers)

    return bounded


def _number(value: Any) -> Any:
    if isinstance(value, (int, float)):
        return value
    msg = f"expected a number, got {value!r}"
    raise TypeError(msg)


def _replace(text: str, old: str, new: str) -> str:
    check_length(len(text) + (len(text) + 1) * len(new) if not old else 0)
    check_length(len(text) + text.count(old) * len(new))
    return text.replace(old, new)


def _tokenize(text: str, sep: str = ",; ", skip_empty: bool = True) -> list[str]:  # noqa: FBT001, FBT002 (xacro's own)
    parts = re.split("|".join(map(re.escape, sep)), text) if sep else [text]
    return [part for part in parts if part or not skip_empty]


def _fatal(*words: Any) -> None:
    msg = " ".join(map(str, words))
    raise ValueError(msg)


def _silent(*_words: Any, **_options: Any) -> str:
    """Stands for xacro.message() and the like, which print."""
    return ""


_WHOLE = ("factorial", "comb", "perm")  # of math, whose values grow fast
_MATH = {
    name: function
    for name, function in vars(math).items()
    if callable(function) and not name.startswith("_")
}

FUNCTIONS: dict[str, Callable[..., Any]] = {
    **_MATH,
    **{name: _few(_MATH[name]) for name in _WHOLE},
    "prod": _prod,
    "list": list,
    "dict": dict,
    "tuple": tuple,
    "len": len,
    "str": str,
    "float": float,
    "int": int,
    "bool": bool,
    "min": min,
    "max": max,
    "round": _round,
    "abs": abs,
    "all": all,
    "any": any,
    "divmod": divmod,
    "ord": ord,
    "repr": repr,
    "sum": _sum,
    "sorted": sorted,
    "range": _range,
    "reversed": lambda items: list(items)[::-1],
    "enumerate": lambda items, start=0: list(enumerate(items, start)),
    "zip": lambda *lists: list(zip(*lists, strict=False)),
    "dotify": dict,
    "tokenize": _tokenize,
    "fatal": _fatal,
    **dict.fromkeys(("message", "warning", "error", "print_location"), _silent),
}
"""By name; the namespaces math, python and xacro have no two of one name."""

METHODS: dict[tuple[type, str], Callable[..., Any]] = {
    (str, "lower"): str.lower,
    (str, "upper"): str.upper,
    (str, "strip"): str.strip,
    (str, "split"): str.split,
    (str, "startswith"): str.startswith,
    (str, "endswith"): str.endswith,
    (str, "replace"): _replace,
    (dict, "get"): dict.get,
    (dict, "keys"): list,
    (dict, "values"): lambda items: list(dict.values(items)),
    (dict, "items"): lambda items: list(dict.items(items)),
}
"""Methods by the type of what they are of."""
