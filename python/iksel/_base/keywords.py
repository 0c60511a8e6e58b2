# SPDX-License-Identifier: BSD-3-Clause
"""Hints at mistyped keywords of Python's functions, as the core's have them."""

from __future__ import annotations

import functools
import inspect
from typing import TYPE_CHECKING, ParamSpec, TypeVar

from iksel_cpp import SignatureError, _did_you_mean

if TYPE_CHECKING:
    from collections.abc import Callable

P = ParamSpec("P")
R = TypeVar("R")


def with_hints(function: Callable[P, R]) -> Callable[P, R]:
    """The function, which answers a keyword that it has not by a sentence."""
    known = list(inspect.signature(function).parameters)

    @functools.wraps(function)
    def call(*args: P.args, **kwargs: P.kwargs) -> R:
        for name in kwargs:
            if name not in known:
                raise SignatureError(
                    f"{function.__name__}() has no argument {name!r}"
                    f"{_did_you_mean(name, known)} (possible: {', '.join(known)})"
                )
        return function(*args, **kwargs)

    return call
