# SPDX-License-Identifier: BSD-3-Clause
"""The core with another value of a constant, compiled into a folder of its own."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from typing import TYPE_CHECKING, NamedTuple

import pybind11

from bench.machine import ROOT

if TYPE_CHECKING:
    from pathlib import Path

SOURCES = ("CMakeLists.txt", "cpp", "python", "scripts")
DEFINITION = r"(?P<before>\bconstexpr [\w:<> ]+ {name} = )(?P<value>[^;]+)(?P<after>;)"


class Constant(NamedTuple):
    """A constant of the core."""

    file: str
    """From the top of the repository."""
    name: str
    value: str
    """As the source has it."""


def constants(name: str = r"k[A-Z]\w*") -> list[Constant]:
    """All with that name."""
    definition = re.compile(DEFINITION.format(name=name))
    found = []
    for path in sorted((ROOT / "cpp").rglob("*.?pp")):
        if path.is_relative_to(ROOT / "cpp" / "src"):
            file = path.relative_to(ROOT).as_posix()
            for match in definition.finditer(path.read_text(encoding="utf-8")):
                last = match["before"].split()[-2]
                found.append(Constant(file, last, match["value"]))
    return found


def find(wanted: str) -> Constant:
    """The constant NAME, or FILE:NAME with the end of the file's path.

    Raises SystemExit, which says what there is, unless it is one.
    """
    file, _, name = wanted.rpartition(":")
    same = constants(re.escape(name))
    found = [constant for constant in same if constant.file.endswith(file)]
    if len(found) == 1:
        return found[0]
    known = {f"{c.file.removeprefix('cpp/src/')}:{c.name}" for c in same or constants()}
    raise SystemExit(
        f"bench constant: {len(found) or 'no'} constants {wanted} in cpp/src; "
        f"has {', '.join(sorted(known))}"
    )


def patched(text: str, name: str, value: str) -> str:
    """A source with another value of the constant."""
    definition = re.compile(DEFINITION.format(name=re.escape(name)))
    changed, count = definition.subn(rf"\g<before>{value}\g<after>", text)
    if count != 1:
        raise ValueError(f"{name} is defined {count} times")
    return changed


def build(constant: Constant, value: str, folder: Path) -> Path:
    """Compile the extension with that value; the folder that it is in.

    What the same folder built before is used again as far as it is the same.
    """
    tree, objects = folder / "tree", folder / "objects"
    library = folder / re.sub(r"[^\w.+-]+", "_", value)
    for source in SOURCES:
        if (ROOT / source).exists():
            _copy(ROOT / source, tree / source)
    path = tree / constant.file
    text = patched(path.read_text(encoding="utf-8"), constant.name, value)
    path.write_text(text, encoding="utf-8")
    options = [
        *("-DCMAKE_BUILD_TYPE=Release", "-DIKSEL_BUILD_PYTHON=ON"),
        "-DBUILD_SHARED_LIBS=OFF",
        f"-DPython_EXECUTABLE={sys.executable}",
        f"-Dpybind11_DIR={pybind11.get_cmake_dir()}",
    ]
    run("cmake", "-S", tree, "-B", objects, "-G", "Ninja", *options)
    run("cmake", "--build", objects, "--target", "iksel_cpp")
    library.mkdir(parents=True, exist_ok=True)
    for made in (objects / "python").glob("iksel_cpp*.so"):
        shutil.copy2(made, library)
    return library


def _copy(source: Path, target: Path) -> None:
    """Files that differ only, so that the rest is not compiled again."""
    if source.is_dir():
        for inside in source.iterdir():
            _copy(inside, target / inside.name)
    elif not target.exists() or target.read_bytes() != source.read_bytes():
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, target)


def run(*command: str | Path) -> None:
    """Run a program; SystemExit with the end of what it said if it fails."""
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode:
        said = (done.stdout + done.stderr)[-2000:]
        raise SystemExit(f"bench constant: {command[0]} failed:\n{said}")
