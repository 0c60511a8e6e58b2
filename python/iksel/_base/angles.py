# SPDX-License-Identifier: BSD-3-Clause
"""Angles that were meant as degrees."""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING

import numpy as np
from iksel_cpp import AngleUnitWarning

if TYPE_CHECKING:
    import numpy.typing as npt


def look_like_degrees(angles: npt.ArrayLike) -> bool:
    """Whether all angles are whole numbers and some are over a turn of 2 pi."""
    values = np.asarray(angles, dtype=float)
    beyond = np.abs(values) > 2 * math.pi
    whole = np.isfinite(values) & (values == np.rint(values))
    return bool(beyond.any() and whole.all())


def warn_of_degrees(name: str, angles: npt.ArrayLike) -> None:
    """Warn the caller's caller if the angles of an argument look like degrees."""
    if look_like_degrees(angles):
        warnings.warn(
            f"{name}: these angles look like degrees, and are taken as radians "
            "(numpy.radians converts)",
            AngleUnitWarning,
            stacklevel=3,
        )
