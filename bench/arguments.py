# SPDX-License-Identifier: BSD-3-Clause
"""Arguments that several commands take."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence


def add_robots(command: argparse.ArgumentParser, default: Sequence[str]) -> None:
    """Which robots."""
    command.add_argument(
        "robots",
        nargs="*",
        metavar="ROBOT",
        default=default,
        help=f"default: {' '.join(default)}",
    )
