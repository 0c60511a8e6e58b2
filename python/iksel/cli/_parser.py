# SPDX-License-Identifier: BSD-3-Clause
"""argparse with one-line errors, and numbers in arguments."""

from __future__ import annotations

import argparse
import difflib
import re
from typing import TYPE_CHECKING, Any, NoReturn

from iksel_cpp import InvalidArgumentError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

EXIT_BAD_INPUT = 2

POSE_METAVAR = "NUMBER"
POSE_COUNTS = (6, 7, 16)
POSE_FORMS = (
    "6 numbers x y z roll pitch yaw, 7 numbers x y z qw qx qy qz (with --order xyzw, "
    "as ROS prints it, x y z qx qy qz qw), or 16 numbers, a 4x4 matrix row by row "
    "[m, rad]"
)

# argparse knows -1 and -1.5 as numbers, but not -1e-3, nor a list such as -1,2,3.
_STARTS_AS_NUMBER = re.compile(r"-(\.?\d|inf|nan)", re.IGNORECASE)
_SEPARATORS = re.compile(r"[\s,;\[\]()]+")


def error_line(message: str) -> str:
    """An error message as the one line that stderr gets."""
    return f"iksel: error: {' '.join(message.split())}\n"


def warning_line(message: str) -> str:
    """The same for a warning, after which the command goes on."""
    return f"iksel: warning: {' '.join(message.split())}\n"


class Parser(argparse.ArgumentParser):
    """An ArgumentParser whose errors are one line."""

    def __init__(self, **settings: Any) -> None:
        """Take the settings of argparse.ArgumentParser."""
        settings.setdefault("allow_abbrev", False)
        settings.setdefault("formatter_class", argparse.RawDescriptionHelpFormatter)
        super().__init__(**settings)
        self._negative_number_matcher = _STARTS_AS_NUMBER

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Say which of the choices is like what was given; argparse asks this."""
        try:
            super()._check_value(action, value)
        except argparse.ArgumentError as error:
            choices = [str(choice) for choice in action.choices or ()]
            close = difflib.get_close_matches(str(value), choices)
            if close:
                error.message += f"; did you mean {' or '.join(close)}?"
            raise

    def error(self, message: str) -> NoReturn:
        """Print one line instead of the usage and exit."""
        self.exit(EXIT_BAD_INPUT, error_line(f"{message} (see {self.prog} --help)"))


def count(text: str) -> int:
    """An argument that is a whole number from 1."""
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text} is less than 1")
    return value


def count_up_to(most: int) -> Callable[[str], int]:
    """The type of an argument that is a whole number from 1 to `most`."""

    def bounded(text: str) -> int:
        value = count(text)
        if value > most:
            raise argparse.ArgumentTypeError(f"{text} is more than {most}")
        return value

    bounded.__name__ = "count"  # as argparse calls it in its message
    return bounded


def seed(text: str) -> int:
    """An argument that is a seed, a whole number from 0 to 2^64 - 1."""
    value = int(text)
    if not 0 <= value < 2**64:
        raise argparse.ArgumentTypeError(f"{text} is not between 0 and 2^64 - 1")
    return value


def split_numbers(text: str) -> list[str]:
    """The words of a text in which numbers are separated by spaces, commas and such."""
    return [word for word in _SEPARATORS.split(text) if word]


def parse_numbers(flag: str, words: Sequence[str]) -> list[float]:
    """Numbers that are given as separate arguments, as one in quotes, or with commas.

    Raises:
        InvalidArgumentError: A word is no number.
    """
    text = " ".join(words)
    try:
        return [float(word) for word in split_numbers(text)]
    except ValueError:
        raise InvalidArgumentError(f"{flag}: not all numbers in {text!r}") from None
