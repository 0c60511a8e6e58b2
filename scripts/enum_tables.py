# SPDX-License-Identifier: BSD-3-Clause
"""Writes the names and texts of the core's enums, as its headers have them.

python enum_tables.py INCLUDE_FOLDER OUTPUT    # a header for enums.hpp
"""

import re
import sys
from pathlib import Path

HEADERS = (
    *("dh", "diagnosis", "objective", "options", "request", "result"),
    *("self_motion", "structure", "task", "types"),
)

# Where Python has another name, or has to say more or less than C++.
NAMES = {"Kind": "Objective::Kind"}
PYTHON_NAMES = {"Kind": "ObjectiveKind"}
TEXTS = {
    ("Kind", ""): "What an Objective counts.",
    ("Kind", "none"): "nothing",
    ("Kind", "custom"): "the caller's function",
    ("Iteration", ""): "One scheme of numerical iteration (paper, Table II).",
    (
        "Cause",
        "",
    ): "Why a solve gave no answer. Certain where Diagnosis.proven is true; "
    "else found by search and so likely.",
    ("Scale", "small"): "12,000 samples for 6 joints",
    ("Scale", "medium"): "40,320 samples for 6 joints",
    ("Scale", "large"): "151,200 samples for 6 joints",
    ("GrowthStop", "on"): "always",
    ("GrowthStop", "off"): "never",
}
WORDS = {
    "find_structure": "Robot.structure",
    "::": ".",
    r"Eq\. \(\d\)": r"\g<0> of the paper",
}

ENUM = re.compile(
    r"(?P<text>(?:^ *///[^\n]*\n)*)"
    r"^ *enum class (?P<name>\w+)[^{;]*\{(?P<body>[^}]*)\}",
    re.MULTILINE,
)
VALUE = re.compile(
    r"(?P<before>(?:///(?!<)[^\n]*\n\s*)*)(?P<name>[a-z]\w*)(?:\s*=\s*\w+)?,?"
    r"(?P<after>[ \t]*(?:\s*///<[^\n]*)*)"
)


def text_of(enum: str, value: str, comment: str) -> str:
    """The comment, in words of Python."""
    text = " ".join(re.sub(r"///<?", "", comment).split())
    text = TEXTS.get((enum, value), text)
    for word, other in WORDS.items():
        text = re.sub(word, other, text)
    return text.replace("\\", "\\\\").replace('"', '\\"')


def table(match: re.Match[str]) -> str:
    """The EnumTable of one enum."""
    enum = match["name"]
    name = NAMES.get(enum, enum)
    rows = []
    for value in VALUE.finditer(match["body"]):
        text = text_of(enum, value["name"], value["before"] + value["after"])
        rows.append(f'{{"{value["name"]}", {name}::{value["name"]}, "{text}"}},')
    return (
        f"template <>\nstruct EnumTable<{name}> {{\n"
        f'static constexpr const char* kName = "{PYTHON_NAMES.get(enum, enum)}";\n'
        f'static constexpr const char* kDoc = "{text_of(enum, "", match["text"])}";\n'
        f"static constexpr EnumValue<{name}> kValues[] = {{\n"
        + "\n".join(rows)
        + "\n};\n};\n"
    )


def main(folder: Path, output: Path) -> None:
    """Write the tables of all headers."""
    tables = [
        "// Made by enum_tables.py.\n#pragma once\n",
        "namespace iksel::python {\n",
    ]
    for header in HEADERS:
        source = (folder / "iksel" / f"{header}.hpp").read_text(encoding="utf-8")
        tables += map(table, ENUM.finditer(source))
    text = "".join([*tables, "}\n"])
    if not output.exists() or output.read_text(encoding="utf-8") != text:
        output.write_text(text, encoding="utf-8")  # what includes it is compiled anew


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
