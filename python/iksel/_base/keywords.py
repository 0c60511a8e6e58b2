# SPDX-License-Identifier: BSD-3-Clause
"""Why a call does not fit, in a sentence; the core asks for it when one does not."""

from __future__ import annotations

import difflib
import functools
import inspect
from typing import TYPE_CHECKING, ParamSpec, TypeVar

from iksel_cpp import Lanes, Paper, SignatureError, SolverOptions

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

P = ParamSpec("P")
R = TypeVar("R")

# What other libraries, and this one once, call something.
OTHER_NAMES = {
    "seeds": {
        *("seed", "q_init", "q0", "x0", "q_start", "initial_guess", "guess", "init"),
        *("q_seed", "ik_seed", "seed_state", "initial_q"),
    },
    "deadline": {"timeout", "time_out", "timeout_s", "time_limit", "max_time"},
}
HINTS = {
    "seeds": "; write seeds=[q] for where the search begins, or near=q for what the "
    "answer is to be close to",
    "deadline": "; write deadline=... for after how many seconds the search ends",
}


def with_hints(function: Callable[P, R]) -> Callable[P, R]:
    """The function, which answers a keyword that it has not by a sentence."""
    known = list(inspect.signature(function).parameters)

    @functools.wraps(function)
    def call(*args: P.args, **kwargs: P.kwargs) -> R:
        for name in kwargs:
            if name not in known:
                raise SignatureError(f"{function.__name__}() {_unknown(name, known)}")
        return function(*args, **kwargs)

    return call


def misfit(  # noqa: PLR0917 - called by the core
    known: Sequence[str],
    needed: Sequence[str],
    by_position: int,
    name: str,
    count: int,
    given: Sequence[str],
) -> str:
    """What is wrong with a call.

    Args:
        known: Names of the arguments.
        needed: Those without a default.
        by_position: How many may be given by position.
        name: Of the function.
        count: How many are given by position.
        given: Keywords that are given.
    """
    shown = [*known[:by_position], *(["*"] if by_position < len(known) else [])]
    form = f"({', '.join([*shown, *known[by_position:]])})"
    for keyword in given:
        if keyword not in known:
            return f"{name}() {_unknown(keyword, known)}"
    if count > by_position:
        plural = "" if by_position == 1 else "s"
        # solve(pose, q) had a seed there once.
        is_seed = by_position == 1 and "seeds" in known
        seeds = "; write seeds=[q] for where the search begins" if is_seed else ""
        return (
            f"{name}() takes at most {by_position} argument{plural} by position, got "
            f"{count}{seeds}; possible: {form}"
        )
    for each in known[:count]:
        if each in given:
            return f"{name}() is given {each!r} twice"
    for each in known[count:]:
        if each in needed and each not in given:
            return f"{name}() needs {each!r}: {name}{form}"
    return f"{name}() is called with what does not fit"


def no_field(struct: str, name: str, known: Sequence[str]) -> str:
    """That a struct has no such field."""
    hint = did_you_mean(name, known)
    if struct == "SolverOptions" and (name in _fields(Paper) or name in _fields(Lanes)):
        hint = (
            f"; it belongs to the strategy: SolverOptions(strategy=Paper({name}=...))"
            f"{', or Lanes' if name in _fields(Lanes) else ''}"
        )
    return f"{struct}: no field {name!r}{hint}; possible: {', '.join(known)}"


def did_you_mean(name: str, known: Sequence[str]) -> str:
    """A hint, or nothing if none of the names is close, or has that word."""
    # Of tip_link the word tip; two letters are too few to tell.
    close = [one for one in known if len(name) > 2 and f"_{name}" in f"_{one}"]
    close = close or difflib.get_close_matches(name, known, 1)
    return f"; did you mean {' or '.join(map(repr, close))}?" if close else ""


def _fields(options: type[Lanes | Paper | SolverOptions]) -> list[str]:
    return list(options().to_dict())


def _unknown(keyword: str, known: Sequence[str]) -> str:
    hint = did_you_mean(keyword, known)
    for argument, names in OTHER_NAMES.items():
        if argument in known and keyword in names:
            hint = HINTS[argument]
    if not hint and "seeds" in known:  # of what solves
        fields = _fields(SolverOptions)
        meant = did_you_mean(keyword, fields).removeprefix("; did you mean ")
        if meant:
            named = repr(keyword) if keyword in fields else meant.removesuffix("?")
            options = "Solver(robot, SolverOptions(...))"
            hint = f"; the solver's options have {named}: {options}"
    possible = ", ".join(known) or "none"
    return f"has no argument {keyword!r}{hint} (possible: {possible})"
