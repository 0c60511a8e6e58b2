# SPDX-License-Identifier: BSD-3-Clause
"""Arguments that several commands take."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence


def add_robots(
    command: argparse.ArgumentParser, default: Sequence[str], note: str = ""
) -> None:
    """Which robots; a note on them ends the help."""
    command.add_argument(
        "robots",
        nargs="*",
        metavar="ROBOT",
        default=default,
        help=f"default: {' '.join(default)}{note}",
    )


def check_robots(command: str, asked: Sequence[str], known: Sequence[str]) -> None:
    """Raise SystemExit, which says what there is, if a command has not all of them."""
    unknown = sorted(set(asked) - set(known))
    if unknown:
        raise SystemExit(
            f"bench {command}: no {', '.join(unknown)}; has {', '.join(known)}"
        )


def add_quick(command: argparse.ArgumentParser, what: str = "fewer targets") -> None:
    """Whether less is measured, and what."""
    command.add_argument("--quick", action="store_true", help=what)


def add_fresh(command: argparse.ArgumentParser) -> None:
    """Whether kept results do not count."""
    command.add_argument(
        "--fresh", action="store_true", help="measure again what was measured before"
    )
