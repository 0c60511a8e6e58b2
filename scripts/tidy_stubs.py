# SPDX-License-Identifier: BSD-3-Clause
"""Mends what pybind11-stubgen cannot know; a filter from stdin to stdout."""

import enum
import re
import sys

import iksel_cpp

PICKLING = re.compile(
    r"    def __(?:get|set)state__\(.*\) -> .*:\n        \.\.\.\n",
)
# What every enum has from enum.Enum, listed anew without types.
ENUM_METHODS = re.compile(
    r"    @classmethod\n    def __new__\(cls, value\):\n        \.\.\.\n"
    r"|    def __format__\(self, format_spec\):\n        \.\.\.\n",
)
ENUM_MEMBER = re.compile(r"    (\w+): typing\.ClassVar\[(\w+)\]")


def enum_member(match: re.Match[str]) -> str:
    """A member with its value, which type checkers need to see one in it."""
    name, class_name = match.groups()
    cls = getattr(iksel_cpp, class_name, None)
    if not (isinstance(cls, type) and issubclass(cls, enum.Enum)):
        return match.group()
    return f"    {name} = {cls[name].value}"


def tidy(text: str) -> str:
    """The stub without private parts, and with the types that only Python knows."""
    text = PICKLING.sub("", text)
    text = ENUM_METHODS.sub("", text)
    text = ENUM_MEMBER.sub(enum_member, text)
    text = text.replace(
        "def __eq__(self, other: typing.Any) -> typing.Any:",
        "def __eq__(self, other: object) -> bool:",
    )
    text = text.replace(
        "__hash__: typing.ClassVar[None] = None",
        "__hash__: typing.ClassVar[None] = None  # type: ignore[assignment]",
    )
    text = re.sub(r"(?<=memo: )dict\b", "dict[int, object]", text)
    # Of each error its own.
    text = text.replace(
        "available: typing.ClassVar[tuple] = tuple()", "available: tuple[str, ...]"
    )
    # The name that numpy 1 has too.
    text = text.replace("numpy.bool]", "numpy.bool_]")
    text = re.sub(r"^(__version__: str) = .*$", r"\1", text, flags=re.MULTILINE)
    text = re.sub(r"[ \t]+$", "", text, flags=re.MULTILINE)
    return "# SPDX-License-Identifier: BSD-3-Clause\n" + text.rstrip() + "\n"


if __name__ == "__main__":
    sys.stdout.write(tidy(sys.stdin.read()))
