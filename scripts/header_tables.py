# SPDX-License-Identifier: BSD-3-Clause
"""Writes what the core's headers say, for the bindings: enums, structs and texts.

python header_tables.py INCLUDE_FOLDER OUTPUT    # a header for header_tables.hpp
"""

from __future__ import annotations

import json
import re
import sys
from dataclasses import dataclass, field
from pathlib import Path

from header_words import TEXTS, sentences, words

# Where Python has another name, or has to say more or less than C++.
NAMES = {"Kind": "Objective::Kind", "Shape": "Obstacle::Shape"}
PYTHON_NAMES = {"Kind": "ObjectiveKind"}

ENUM = re.compile(
    r"(?P<text>(?:^ *///[^\n]*\n)*)"
    r"^ *enum class (?P<name>\w+)[^{;]*\{(?P<body>[^}]*)\}",
    re.MULTILINE,
)
VALUE = re.compile(
    r"(?P<before>(?:///(?!<)[^\n]*\n\s*)*)(?P<name>[a-z]\w*)(?:\s*=\s*\w+)?,?"
    r"(?P<after>[ \t]*(?:\s*///<[^\n]*)*)"
)
TOKEN = re.compile(
    r"///(?P<after><?)(?P<comment>[^\n]*)|//[^\n]*|^#[^\n]*|(?P<code>.)",
    re.MULTILINE | re.DOTALL,
)
SCOPE = re.compile(
    r"(?P<kind>namespace|struct|class|enum class) (?:IKSEL_EXPORT )?(?P<name>\w*)"
    r"(?: : (?:public )?(?P<base>[\w:]+))?\s*$"
)
LABELS = {"public", "private", "protected"}
NOT_READ = re.compile(
    r"\s*((using|friend|template|class|struct|enum)\b|$)|.*\boperator\b", re.DOTALL
)


@dataclass
class Scope:
    """A namespace or a class."""

    kind: str
    name: str = ""
    base: str = ""
    is_private: bool = False
    fields: list[str] = field(default_factory=list)


@dataclass
class Headers:
    """What the headers declare; members are known as "Class.member"."""

    texts: dict[str, str] = field(default_factory=dict)
    types: dict[str, str] = field(default_factory=dict)
    structs: list[Scope] = field(default_factory=list)

    def text(self, key: str, enums: dict[str, re.Match[str]]) -> str:
        """What is said above or behind it, or else of the enum that it is."""
        type_ = self.types.get(key, "")
        of_enum = enums[type_]["text"] if type_ in enums else ""
        comment = self.texts.get(key) or TEXTS.get(type_) or of_enum
        return sentences(key, comment, type_) if comment.strip() else ""


class Reader:
    """Goes through one header."""

    def __init__(self, headers: Headers) -> None:
        self.headers = headers
        self.scopes = [Scope("namespace")]
        self.names: list[str] = []  # what was declared last
        self.comment = self.above = self.statement = ""
        self.depth = 0  # of braces around what is not read

    def read(self, source: str) -> None:
        """Add what it declares."""
        for token in TOKEN.finditer(source):
            if token["comment"] is None:
                self.take(token["code"] or "")
            elif self.depth == 0 and not token["after"]:
                self.comment += token["comment"] + "\n"
            elif self.depth == 0:
                for name in self.names:
                    before = self.headers.texts.get(name, "")
                    before = "" if self.above and before == self.above else before
                    self.headers.texts[name] = before + token["comment"] + "\n"
                self.above = ""

    def take(self, code: str) -> None:
        """Go on by a character."""
        if self.depth or code == "{":
            self.open(code)
        elif code == "}":
            self.scopes.pop()
            self.statement = "using"
        elif code == ";":
            self.end()
        elif code == ":" and self.statement.strip() in LABELS:
            self.scopes[-1].is_private = self.statement.strip() != "public"
            self.statement = ""
        else:
            self.statement += code

    def open(self, code: str) -> None:
        """Enter a class or a namespace, or pass over braces."""
        found = SCOPE.search(self.statement) if self.depth == 0 else None
        if found and found["kind"] != "enum class":
            kind, name, base = found.groups()
            scope = Scope(kind, name, base or "", kind == "class")
            if kind == "namespace":
                scope = Scope(kind)
            else:
                self.headers.texts.setdefault(name, self.comment)
                if not self.scopes[-1].name:
                    self.headers.structs.append(scope)
            self.scopes.append(scope)
            self.comment = self.statement = ""
            return
        self.depth += {"{": 1, "}": -1}.get(code, 0)
        # A function ends with its body, an initialiser or an enum by a semicolon.
        if self.depth == 0 and is_whole_function(self.statement):
            self.end()

    def end(self) -> None:
        """The statement is over. What is alike and not apart shares a comment."""
        types = self.headers.types
        before, self.names = self.names, self.declare()
        is_apart = re.match(r"\s*\n\s*\n", self.statement)
        is_alike = before and self.names and types[before[0]] == types[self.names[0]]
        self.above = self.comment or ("" if is_apart or not is_alike else self.above)
        for name in self.names:
            self.headers.texts.setdefault(name, self.above)
        self.comment = self.statement = ""

    def declare(self) -> list[str]:
        """Note the data that the statement declares; the names of all that it does."""
        scope = self.scopes[-1]
        bare = re.sub(r"\[\[\w+\]\]", "", without_templates(self.statement))
        if scope.is_private or NOT_READ.match(bare):
            return []
        if "(" in bare.split("=")[0]:
            found = re.search(r"(\w+)\s*\(", bare)
            names = [found[1]] if found else []
        elif scope.name and "static" not in bare:
            parts = re.sub(r"=[^,]*|\([^()]*\)", "", bare).split(",")
            names = [part.split()[-1] for part in parts]
            scope.fields += names
        else:
            return []
        keys = [f"{scope.name}.{name}" if scope.name else name for name in names]
        plain = re.sub(r"\[\[\w+\]\]|\b(const|static)\b|&", "", self.statement)
        type_ = re.split(rf"\b{names[0]}\b", plain)[0] if names else ""
        type_ = re.sub(r"\s*([<>])\s*", r"\1", type_.strip())
        for key in keys:
            self.headers.types.setdefault(key, type_)
        return keys


def without_templates(text: str) -> str:
    """The text, and nothing between < and >."""
    while (shorter := re.sub(r"<[^<>]*>", "", text)) != text:
        text = shorter
    return text


def is_whole_function(statement: str) -> bool:
    """Whether it has all of its parameters."""
    bare = without_templates(statement)
    return "(" in bare.split("=")[0] and bare.count("(") == bare.count(")")


def enum_table(match: re.Match[str]) -> str:
    """The EnumTable of one enum."""
    enum = match["name"]
    name = NAMES.get(enum, enum)
    doc = json.dumps(TEXTS.get(enum, words(match["text"])))
    rows = []
    for value in VALUE.finditer(match["body"]):
        value_name = value["name"]
        text = words(value["before"] + value["after"])
        text = json.dumps(TEXTS.get(f"{enum}.{value_name}", text))
        rows.append(f'{{"{value_name}", {name}::{value_name}, {text}}},')
    return (
        f"template <>\nstruct EnumTable<{name}> {{\n"
        f'static constexpr const char* kName = "{PYTHON_NAMES.get(enum, enum)}";\n'
        f"static constexpr const char* kDoc = {doc};\n"
        f"static constexpr EnumValue<{name}> kValues[] = {{\n"
        + "\n".join(rows)
        + "\n};\n};\n"
    )


def member_table(struct: Scope) -> str:
    """The Members of one struct, those of its base first."""
    base = f"Members<{struct.base}>::visit(use);\n" if struct.base else ""
    uses = [
        f'use("{struct.name}.{name}", &{struct.name}::{name});\n'
        for name in struct.fields
    ]
    return (
        f"template <>\nstruct Members<{struct.name}> {{\n"
        f'static constexpr const char* kName = "{struct.name}";\n'
        f"template <class Use>\nstatic void visit(const Use& use) {{\n"
        + base
        + "".join(uses)
        + "}\n};\n"
    )


def main(folder: Path, output: Path) -> None:
    """Write the tables of all headers."""
    tables = ["// Made by header_tables.py.\n#pragma once\nnamespace iksel::python {\n"]
    headers = Headers()
    enums = {}
    for path in sorted((folder / "iksel").glob("*.hpp")):
        source = path.read_text(encoding="utf-8")
        Reader(headers).read(source)
        for match in ENUM.finditer(source):
            if "::" not in match["name"]:
                enums[match["name"]] = match
    tables += map(enum_table, enums.values())
    tables += map(
        member_table,
        [each for each in headers.structs if each.kind == "struct" and each.fields],
    )
    keys = sorted(headers.types.keys() | headers.texts.keys())
    texts = ((key, headers.text(key, enums)) for key in keys)
    rows = [f'{{"{key}", {json.dumps(text)}}},\n' for key, text in texts if text]
    tables.append(
        "constexpr HeaderText kHeaderTexts[] = {\n" + "".join(rows) + "};\n}\n"
    )
    text = "".join(tables)
    if not output.exists() or output.read_text(encoding="utf-8") != text:
        output.write_text(text, encoding="utf-8")  # what includes it is compiled anew


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
