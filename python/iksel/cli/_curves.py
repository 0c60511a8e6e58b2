# SPDX-License-Identifier: BSD-3-Clause
"""Curves by which joints follow others, as files of points."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
from iksel_cpp import InvalidArgumentError, MimicCurve

FLAG = "--mimic-curve"
FORM = "JOINT=SOURCE:FILE"


def read_mimic_curve(text: str) -> MimicCurve:
    """The curve of one JOINT=SOURCE:FILE.

    The file has a point a line, q of SOURCE and the value of JOINT [rad or m], and if
    there is a third column the curve's slope, separated by commas; # begins a comment.

    Raises:
        InvalidArgumentError: The text has another form, or the file cannot be read.
    """
    joint, equals, rest = text.partition("=")
    source, colon, path = rest.partition(":")
    if not (joint and equals and source and colon and path):
        raise InvalidArgumentError(f"{FLAG}: expected {FORM}, got {text!r}")
    try:
        with warnings.catch_warnings(), Path(path).open(encoding="utf-8") as file:
            # Of a file without points: the columns say it.
            warnings.simplefilter("ignore", UserWarning)
            points = np.loadtxt(file, delimiter=",", ndmin=2)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InvalidArgumentError(f"{FLAG}: {path}: {reason}") from None
    if points.shape[1] not in (2, 3):
        raise InvalidArgumentError(
            f"{FLAG}: {path}: expected 2 or 3 columns (q of {source}, the value of "
            f"{joint}, the slope), got {points.shape[1]}"
        )
    return MimicCurve(joint, source, *points.T)
