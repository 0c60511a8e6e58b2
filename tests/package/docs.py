# SPDX-License-Identifier: BSD-3-Clause
"""Builds and runs the C++ programs of docs/, outside the tree, against an install.

Usage: docs.py PREFIX [--write]    (where the library is installed)

What a program prints has to be what its page says; --write puts it there instead.
"""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))
from docs_pages import agrees, blocks, pages, put

OTHERS = {"kdl_parser": "-I/usr/include/eigen3 -lkdl_parser -lorocos-kdl"}
"""Libraries that a block may need, with what links them."""


def flags(prefix: Path) -> list[str]:
    """What compiles and links a program with the library."""
    file = next(prefix.rglob("iksel.pc"))
    os.environ["PKG_CONFIG_PATH"] = str(file.parent)
    os.environ["LD_LIBRARY_PATH"] = str(file.parent.parent)

    def ask(*arguments: str) -> str:
        command = ["pkg-config", *arguments, "iksel"]
        return subprocess.check_output(command, text=True).strip()

    robots = f'-DIKSEL_ROBOTS_DIR="{ask("--variable=robotsdir")}"'
    return [robots, *shlex.split(ask("--cflags", "--libs"))]


def has(library: str) -> bool:
    """Whether another library's header is there."""
    test = f"#if !__has_include(<{library}/{library}.hpp>)\n#error\n#endif\n"
    command = [*compiler(), "-fsyntax-only", "-x", "c++", "-"]
    done = subprocess.run(
        command, input=test.encode(), capture_output=True, check=False
    )
    return done.returncode == 0


def compiler() -> list[str]:
    """The compiler's command."""
    return [*shlex.split(os.environ.get("CXX", "c++")), "-std=c++17", "-O1"]


def run(code: str, options: list[str]) -> str:
    """Build a program and run it; what it prints."""
    with tempfile.TemporaryDirectory() as folder:
        source, program = Path(folder) / "main.cpp", Path(folder) / "app"
        source.write_text(code, encoding="utf-8")
        warnings = ["-Wall", "-Wextra", "-Werror"]
        command = [*compiler(), *warnings, str(source), "-o", str(program), *options]
        subprocess.run(command, check=True)
        return subprocess.check_output([str(program)], text=True)


def main() -> None:
    """Entry point."""
    options = flags(Path(sys.argv[1]))
    count = 0
    programs = [b for page in pages() for b in blocks(page) if b.language == "cpp"]
    # From the last of a page on, as what is written moves what stands below.
    for block in reversed(programs):
        other = block.marks.get("needs")
        if other and not has(other):
            print(f"{block.place}: not run, {other} is not installed")
            continue
        got = run(block.code, [*options, *shlex.split(OTHERS.get(other, ""))])
        count += 1
        if block.output is not None and not agrees(block.output.code, got):
            if "--write" not in sys.argv:
                sys.exit(f"{block.place} prints\n{got}and not\n{block.output.code}")
            put(block, got)
    print(f"{count} C++ programs of docs/ build, and print what it says")


if __name__ == "__main__":
    main()
