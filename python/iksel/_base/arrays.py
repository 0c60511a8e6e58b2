# SPDX-License-Identifier: BSD-3-Clause
"""Checks of array arguments; every error names the argument and what it should be."""

from __future__ import annotations

from typing import TYPE_CHECKING, NoReturn

import numpy as np
import numpy.typing as npt
from iksel_cpp import InvalidArgumentError

if TYPE_CHECKING:
    from collections.abc import Sequence

BoolArray = npt.NDArray[np.bool_]
FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

_NUMBER_KINDS = "iuf"


def reject(name: str, problem: str) -> NoReturn:
    """Raise an InvalidArgumentError about the argument `name`."""
    raise InvalidArgumentError(f"{name}: {problem}")


def as_floats(
    name: str, value: npt.ArrayLike, tail: tuple[int, ...], *, finite: bool = True
) -> FloatArray:
    """Turn `value` into float64 numbers whose last axes are `tail`.

    Args:
        name: Name of the argument, for the error message.
        value: Numbers of shape (..., *tail).
        tail: Lengths of the last axes.
        finite: Whether to refuse NaN and infinities.

    Returns:
        An array of shape (..., *tail); a copy only where one is needed.

    Raises:
        InvalidArgumentError: Not numbers, another shape, or not finite.
    """
    expected = _shape_text(tail)
    try:
        array = np.asarray(value)
    except (ValueError, TypeError):
        reject(name, f"expected numbers of shape {expected}, got a ragged sequence")
    except RuntimeError as error:  # a tensor that numpy does not take as it is
        reject(name, f"expected numbers of shape {expected}, got a tensor: {error}")
    shape = array.shape
    if shape[len(shape) - len(tail) :] != tail or len(shape) < len(tail):
        reject(name, f"expected shape {expected}, got {shape}")
    if array.dtype.kind not in _NUMBER_KINDS:
        reject(name, f"expected real numbers, got an array of {array.dtype}")
    numbers = array.astype(np.float64, copy=False)
    bad = ~np.isfinite(numbers)
    if finite and bad.any():
        index = first_index(bad)
        where = f" at index {index_text(index)}" if index else ""
        reject(name, f"not finite: {numbers[index]}{where}")
    return numbers


def broadcast_leading(
    names: Sequence[str], arrays: Sequence[FloatArray], tails: Sequence[int]
) -> list[FloatArray]:
    """Broadcast the leading axes of `arrays` against each other.

    Args:
        names: Names of the arguments, for the error message.
        arrays: Numbers of shape (..., tail of that array).
        tails: Number of trailing axes of each array that stay as they are.

    Returns:
        The arrays with equal leading axes; read-only views where they were stretched.

    Raises:
        InvalidArgumentError: The leading axes do not fit each other.
    """
    leads = [a.shape[: a.ndim - t] for a, t in zip(arrays, tails, strict=True)]
    try:
        lead = np.broadcast_shapes(*leads)
    except ValueError:
        got = " and ".join(map(str, leads))
        reject(" and ".join(names), f"the leading axes {got} do not match")
    return [
        np.broadcast_to(a, lead + a.shape[a.ndim - t :])
        for a, t in zip(arrays, tails, strict=True)
    ]


def first_index(mask: BoolArray) -> tuple[int, ...]:
    """Index of the first true element of `mask`."""
    flat = int(np.argmax(mask))
    return tuple(int(i) for i in np.unravel_index(flat, mask.shape))


def index_text(index: tuple[int, ...]) -> str:
    """An index as the user would write it: 3, or (3, 1)."""
    return str(index[0]) if len(index) == 1 else str(index)


def _shape_text(tail: tuple[int, ...]) -> str:
    return "(..., " + ", ".join(map(str, tail)) + ")"
