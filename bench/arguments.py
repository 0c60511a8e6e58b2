# SPDX-License-Identifier: BSD-3-Clause
"""Arguments that several commands take."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterable, Sequence


def add_names(
    command: argparse.ArgumentParser, what: str, default: Iterable[str], note: str = ""
) -> None:
    """Which robots, builds or the like; a note on them ends the help."""
    known = tuple(default)
    command.add_argument(
        what,
        nargs="*",
        metavar=what.removesuffix("s").upper(),
        default=known,
        help=f"default: {' '.join(known)}{note}",
    )


def add_robots(
    command: argparse.ArgumentParser, default: Iterable[str], note: str = ""
) -> None:
    """Which robots."""
    add_names(command, "robots", default, note)


def check_robots(command: str, asked: Sequence[str], known: Sequence[str]) -> None:
    """Raise SystemExit, which says what there is, if a command has not all of them."""
    unknown = sorted(set(asked) - set(known))
    if unknown:
        raise SystemExit(
            f"bench {command}: no {', '.join(unknown)}; has {', '.join(known)}"
        )


def add_count(
    command: argparse.ArgumentParser, flag: str, default: int | None, what: str
) -> None:
    """How many of something; without a default the report's number is meant."""
    shown = "as in the report" if default is None else f"{default:,}"
    command.add_argument(
        flag, type=int, default=default, metavar="N", help=f"{what} (default: {shown})"
    )


def add_seed(command: argparse.ArgumentParser, default: int = 1) -> None:
    """The seed of all that is drawn at random."""
    command.add_argument(
        "--seed", type=int, default=default, metavar="N", help="default: %(default)s"
    )


def add_max_error(command: argparse.ArgumentParser, default: float) -> None:
    """How closely spheres cover meshes."""
    command.add_argument(
        "--max-error",
        type=float,
        default=default,
        metavar="M",
        help="by which spheres may stand out of what they cover (default: %(default)s)",
    )


def add_kept(command: argparse.ArgumentParser, quick: str = "fewer targets") -> None:
    """What commands take whose results are kept as the report's are."""
    command.add_argument("--quick", action="store_true", help=quick)
    command.add_argument(
        "--fresh", action="store_true", help="measure again what was measured before"
    )


def add_before_and_after(command: argparse.ArgumentParser, example: str) -> None:
    """Whether to record or to compare, and with which file."""
    command.add_argument(
        "action", choices=["record", "compare"], help="before a change, after it"
    )
    command.add_argument("file", type=Path, metavar="FILE", help=f"e.g. {example}")
