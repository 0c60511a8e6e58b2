# SPDX-License-Identifier: BSD-3-Clause
"""The code blocks of docs/, and how they run.

A page's blocks run in order in one empty folder: Python and the cells of notebooks in
one namespace, `sh` by bash. A `text` block right behind a block is what that prints,
with "..." for what may differ. Comments above a block say more:

    <!-- file: NAME -->        it is written to that file, and not run
    <!-- needs: MODULE -->     it runs where that module can be imported, see run_page
    <!-- not run: REASON -->   shown only

Blocks of C++ are programs, which tests/package/docs.py runs.

Run as a program, this writes what the blocks print into the pages that it is given.
"""

from __future__ import annotations

import contextlib
import dataclasses
import doctest
import io
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
MARKS = ("file", "needs", "not run")
FENCE = re.compile(r"^(?P<fence>`{3,})(?P<language>\S*).*$")
MARK = re.compile(r"^<!-- (?P<name>[a-z ]+?): (?P<value>.*) -->$")
CELL = "{code-cell}"


@dataclasses.dataclass
class Block:
    """A fenced block of a page."""

    page: Path
    line: int
    """Of its first line of code, from 1."""
    language: str
    code: str
    lines: int
    marks: dict[str, str]
    output: Block | None = None

    @property
    def place(self) -> str:
        """Where it is, for messages."""
        return f"{self.page.relative_to(ROOT)}:{self.line}"

    @property
    def is_python(self) -> bool:
        """Whether it is Python: a block, or a notebook's cell."""
        return self.language in {"python", CELL}


def pages() -> list[Path]:
    """All pages."""
    return sorted(DOCS.rglob("*.md"))


def name(page: Path) -> str:
    """A page's name for tests."""
    return page.relative_to(DOCS).with_suffix("").as_posix()


def blocks(page: Path) -> list[Block]:
    """A page's blocks of code, each with the block of what it prints."""
    lines = page.read_text(encoding="utf-8").splitlines()
    found: list[Block] = []
    marks: dict[str, str] = {}
    behind = False  # nothing but empty lines since the last block
    i = 0
    while i < len(lines):
        line = lines[i]
        if match := FENCE.match(line):
            end = lines.index(match["fence"], i + 1)
            code = lines[i + 1 : end]
            if match["language"] == CELL:
                code = ["" if c.startswith(":tags:") else c for c in code]
            text = "".join(f"{c}\n" for c in code)
            block = Block(page, i + 2, match["language"], text, len(code), marks)
            if block.language == "text" and behind and not marks:
                found[-1].output = block
            else:
                found.append(block)
            marks, behind, i = {}, True, end
        elif match := MARK.match(line):
            if match["name"] not in MARKS:
                raise ValueError(f"{page}:{i + 1}: no such mark: {match['name']}")
            marks[match["name"]] = match["value"]
        elif line:
            marks, behind = {}, False
        i += 1
    return found


def needs(page: Path) -> list[str]:
    """Modules that some of a page's blocks need."""
    here = [b for b in blocks(page) if b.language != "cpp" and "needs" in b.marks]
    return list(dict.fromkeys(b.marks["needs"] for b in here))


def run_python(block: Block, namespace: dict[str, object]) -> str:
    """Run it; tracebacks name the page's lines."""
    out = io.StringIO()
    code = "\n" * (block.line - 1) + block.code
    with contextlib.redirect_stdout(out):
        exec(compile(code, str(block.page), "exec"), namespace)
    return out.getvalue()


def run_shell(block: Block) -> str:
    """Run it, with `iksel` as a command of this Python's."""
    with tempfile.TemporaryDirectory() as folder:
        command = Path(folder) / "iksel"
        command.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m iksel "$@"\n')
        command.chmod(0o755)
        done = subprocess.run(
            ["bash", "-euo", "pipefail", "-c", block.code],
            env=os.environ | {"PATH": f"{folder}:{os.environ['PATH']}"},
            capture_output=True,
            text=True,
            check=False,
        )
    if done.returncode:
        raise AssertionError(f"{block.place}: {done.stdout}{done.stderr}")
    return done.stdout


def agrees(wanted: str, got: str) -> bool:
    """Whether it is what a block is to print, in which "..." stands for anything."""
    return doctest.OutputChecker().check_output(wanted, got, doctest.ELLIPSIS)


def run_page(page: Path, modules: tuple[str, ...] = ()) -> list[tuple[Block, str]]:
    """Run a page's blocks in the current folder; those printed, with what they print.

    Blocks that need a module run if `modules` has it. C++ does not run here.
    """
    namespace: dict[str, object] = {"__name__": "__main__"}
    ran = []
    for block in blocks(page):
        needed = block.marks.get("needs")
        if "not run" in block.marks or (needed and needed not in modules):
            continue
        if "file" in block.marks:
            Path(block.marks["file"]).write_text(block.code, encoding="utf-8")
        elif block.is_python:
            ran.append((block, run_python(block, namespace)))
        elif block.language == "sh":
            ran.append((block, run_shell(block)))
    return ran


def put(block: Block, got: str) -> None:
    """Write what a block prints into its page, of which no other line moves."""
    assert block.output is not None
    lines = block.page.read_text(encoding="utf-8").splitlines()
    start = block.output.line - 1
    lines[start : start + block.output.lines] = got.rstrip("\n").splitlines()
    block.page.write_text("\n".join(lines) + "\n", encoding="utf-8")


def main() -> None:
    """Write what the given pages' blocks print, from the last to the first."""
    os.environ["MPLBACKEND"] = "agg"
    for page in [Path(given).resolve() for given in sys.argv[1:]]:
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            ran = run_page(page, tuple(needs(page)))
            os.chdir(ROOT)
        for block, got in reversed(ran):
            if block.output is not None and not agrees(block.output.code, got):
                put(block, got)


if __name__ == "__main__":
    main()
