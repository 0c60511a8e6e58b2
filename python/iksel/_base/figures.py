# SPDX-License-Identifier: BSD-3-Clause
"""Figures of matplotlib, and the files that they are written to."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

from iksel_cpp import InvalidArgumentError

from iksel._base.files import write_file

if TYPE_CHECKING:
    import os

SIZE = (6.4, 5.2)  # [inch]
COLOURS = "viridis"
DOTS_PER_INCH = 150
SUFFIXES = (".png", ".svg", ".pdf")


def make_figure(size: tuple[float, float] = SIZE) -> Any:
    """An empty figure of a width and height [inch]; matplotlib must be there."""
    # Without pyplot, which would want a display and keep the figure.
    from matplotlib.figure import Figure  # noqa: PLC0415 (an optional extra)

    return Figure(figsize=size, layout="constrained")


def check_suffix(path: str | os.PathLike[str]) -> str:
    """The format that a file's name ends with, without the point.

    Raises:
        InvalidArgumentError: It is none of SUFFIXES.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in SUFFIXES:
        raise InvalidArgumentError(
            f"'{path}': a picture's name ends in one of {', '.join(SUFFIXES)}"
        )
    return suffix[1:]


def save_figure(figure: Any, path: str | os.PathLike[str]) -> None:
    """Write a picture, the same bytes each time, and as a whole or not at all.

    Raises:
        InvalidArgumentError: The name says no format, or it cannot be written.
    """
    from matplotlib import rc_context  # noqa: PLC0415 (an optional extra)

    suffix = check_suffix(path)
    dates = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(suffix)
    content = io.BytesIO()
    with rc_context({"svg.hashsalt": "iksel"}):
        figure.savefig(content, format=suffix, dpi=DOTS_PER_INCH, metadata=dates)
    write_file(Path(path), content.getvalue())
