# SPDX-License-Identifier: BSD-3-Clause
"""Mends what pybind11-stubgen cannot know; a filter from stdin to stdout."""

import enum
import re
import sys

import iksel_cpp

PICKLING = re.compile(
    r"    def __(?:get|set)state__\(.*\) -> .*:\n        \.\.\.\n",
)
# What the classes' own refuses what was never made.
NEW = re.compile(
    r"    @staticmethod\n    def __new__\(type, .*\n"
    r"        \"\"\"\n.*\n        \"\"\"\n"
)
# What every enum has from enum.Enum, listed anew without types.
ENUM_METHODS = re.compile(
    r"    @classmethod\n    def __new__\(cls, value\):\n        \.\.\.\n"
    r"|    def __(?:format|str)__\(self.*\):\n        \.\.\.\n",
)
ENUM_MEMBER = re.compile(r"    (\w+): typing\.ClassVar\[(\w+)\]")


def enum_member(match: re.Match[str]) -> str:
    """A member with its value, which type checkers need to see one in it."""
    name, class_name = match.groups()
    cls = getattr(iksel_cpp, class_name, None)
    if not (isinstance(cls, type) and issubclass(cls, enum.Enum)):
        return match.group()
    return f"    {name} = {cls[name].value}"


def member(block: str, name: str) -> str:
    """The text of a method or property in that of its class."""
    start = r"^(?:    @property\n)?    def "
    match = re.search(rf"(?ms){start}{name}\(.*?(?={start}|\Z)", block)
    assert match, name
    return match.group()


def tell_solved_from_unsolved(text: str) -> str:
    """Result as a union of two, so that `if result.success` tells that q is there."""
    begin = text.index("class Result:\n")
    end = text.index("\nclass ", begin) + 1
    block = base = text[begin:end]
    for name in ("q", "success", "__bool__"):
        base = base.replace(member(block, name), "")
    parts = [base.replace("class Result:", "@typing.type_check_only\nclass _Result:")]
    for name, truth, q in (
        ("_Solved", "True", "numpy.typing.NDArray[numpy.float64]"),
        ("_Unsolved", "False", "None"),
    ):
        returns = {"q": q, "success": f"typing.Literal[{truth}]"}
        returns["__bool__"] = returns["success"]
        members = (
            re.sub(r"-> .*:\n", f"-> {type_}:\n", member(block, of), count=1)
            for of, type_ in returns.items()
        )
        parts.append(
            f"@typing.type_check_only\nclass {name}(_Result):\n" + "".join(members)
        )
    parts.append("Result: typing.TypeAlias = _Solved | _Unsolved\n")
    return text[:begin] + "".join(parts) + text[end:]


def tidy(text: str) -> str:
    """The stub without private parts, and with the types that only Python knows."""
    text = PICKLING.sub("", text)
    text = NEW.sub("", text)
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
    text = tell_solved_from_unsolved(text)
    batch = text.index("class BatchResult:\n")
    text = text[:batch] + text[batch:].replace(
        "def __bool__(self) -> bool:", "def __bool__(self) -> typing.NoReturn:", 1
    )
    # The name that numpy 1 has too.
    text = text.replace("numpy.bool]", "numpy.bool_]")
    text = re.sub(r"^(__version__: str) = .*$", r"\1", text, flags=re.MULTILINE)
    text = re.sub(r"[ \t]+$", "", text, flags=re.MULTILINE)
    return "# SPDX-License-Identifier: BSD-3-Clause\n" + text.rstrip() + "\n"


if __name__ == "__main__":
    sys.stdout.write(tidy(sys.stdin.read()))
