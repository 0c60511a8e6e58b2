# SPDX-License-Identifier: BSD-3-Clause
"""Pinocchio in C++: bench/cpp/pinocchio, compiled with the headers of the wheel."""

from __future__ import annotations

import importlib.metadata
import importlib.util
import shutil
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from bench.rivals.base import Rival, UnsupportedError
from bench.rivals.kdl import ROOT, run_program
from bench.rivals.pinocchio import DAMPING, ITERATIONS, STARTS, TOLERANCE

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.rivals.base import Run
    from bench.targets import Targets

SOURCE = ROOT / "bench" / "cpp" / "pinocchio" / "loop.cpp"
BUILD = ROOT / "build" / "pinocchio"
FLAGS = (
    "-std=c++17",
    "-O3",
    "-DNDEBUG",
    # As the wheel's own CMake target has them: its variant has more types than usual.
    "-DBOOST_MPL_LIMIT_LIST_SIZE=30",
    "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
)


def include_folder() -> Path:
    """The headers of the wheel."""
    spec = importlib.util.find_spec("pinocchio")
    for folder in Path(spec.origin).parents if spec and spec.origin else ():
        headers = folder / "include"
        if (headers / "pinocchio" / "multibody.hpp").exists():
            return headers
    raise UnsupportedError(
        "Pinocchio has no headers beside its module (pip install pin)"
    )


def build() -> Path:
    """The program for this release of the library, compiled once: it takes minutes.

    Raises:
        UnsupportedError: It cannot be compiled here.
    """
    headers = include_folder()
    program = BUILD / f"loop-{importlib.metadata.version('pin')}"
    if program.exists() and program.stat().st_mtime > SOURCE.stat().st_mtime:
        return program
    compiler = shutil.which("c++")
    if compiler is None or shutil.which("pkg-config") is None:
        raise UnsupportedError("c++ or pkg-config is not installed")
    eigen = ["pkg-config", "--cflags", "eigen3"]
    found = subprocess.run(eigen, check=False, capture_output=True, text=True)
    if found.returncode:
        raise UnsupportedError("eigen3 is not installed (scripts/bootstrap.sh --bench)")
    BUILD.mkdir(parents=True, exist_ok=True)
    part = program.with_suffix(".part")
    command = [compiler, *FLAGS, str(SOURCE), "-isystem", str(headers)]
    command += [*found.stdout.split(), "-o", str(part)]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode:
        error = " ".join(done.stderr.split())[:300]
        raise UnsupportedError(f"Pinocchio's C++ loop does not compile: {error}")
    part.replace(program)
    return program


class PinocchioCpp(Rival):
    """The same loop as Pinocchio's in Python."""

    name = "Pinocchio, C++ loop"
    distribution = "pin"
    measured = "each call in C++"
    settings = (
        f"the same loop in C++, damping {DAMPING:g}, {ITERATIONS} iterations, {STARTS} "
        f"starts, {TOLERANCE:g} m and rad, wrapped into the limits"
    )

    def __init__(self, arm: Arm) -> None:
        """Compile the program."""
        if arm.chain.prismatic.any() or not np.isfinite(arm.chain.lower).all():
            raise UnsupportedError("the loop has revolute joints with limits only")
        self._arm = arm
        self._program = build()

    def run(self, targets: Targets) -> Run:
        """Run the program once over all targets."""
        return run_program(self._arm, targets, [str(self._program)])
