# SPDX-License-Identifier: BSD-3-Clause
"""The C++ baselines of bench/cpp/baselines, made of KDL and NLopt."""

from __future__ import annotations

import functools
import os
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from bench.rivals.base import Rival, Run, UnsupportedError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bench.arms import Arm
    from bench.targets import Targets

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "bench" / "cpp" / "baselines"
BUILD = ROOT / "build" / "baselines"
PROGRAM = BUILD / "baselines"

PACKAGES = ("orocos-kdl", "nlopt", "eigen3")


@functools.cache
def build() -> None:
    """Build the program, if anything changed, once in a process.

    Raises:
        UnsupportedError: It cannot be built here.
    """
    for tool in ("cmake", "pkg-config"):
        if shutil.which(tool) is None:
            raise UnsupportedError(f"{tool} is not installed")
    for package in PACKAGES:
        if subprocess.run(["pkg-config", "--exists", package], check=False).returncode:
            raise UnsupportedError(
                f"{package} is not installed (scripts/bootstrap.sh --bench)"
            )
    jobs = str(os.cpu_count() or 1)
    for command in (
        ["cmake", "-S", str(SOURCE), "-B", str(BUILD)],
        ["cmake", "--build", str(BUILD), "--parallel", jobs],
    ):
        done = subprocess.run(command, check=False, capture_output=True, text=True)
        if done.returncode:
            error = " ".join(done.stderr.split())
            raise UnsupportedError(f"the C++ baselines do not build: {error}")


def library_version(package: str) -> str:
    """Version that pkg-config has for a library."""
    command = ["pkg-config", "--modversion", package]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    return done.stdout.strip()


def write_problem(path: Path, arm: Arm, targets: Targets) -> None:
    """What the program reads; problem.hpp has the form."""
    chain = arm.chain
    lines = [str(chain.dof)]
    lines += [_row(offset[:3].ravel()) for offset in chain.offsets]
    for i in range(chain.dof):
        prismatic = int(chain.prismatic[i])
        lines.append(f"{prismatic} {chain.lower[i]:.17g} {chain.upper[i]:.17g}")
    lines.append(str(len(targets)))
    for pose, start in zip(targets.poses, targets.starts, strict=True):
        lines.append(_row(pose[:3].ravel()) + " " + _row(start))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _row(values: np.ndarray) -> str:
    return " ".join(f"{value:.17g}" for value in values)


def run_program(
    arm: Arm, targets: Targets, command: Sequence[str], options: Sequence[str] = ()
) -> Run:
    """What a program answers that gets a problem's file and one for its answers."""
    with tempfile.TemporaryDirectory() as folder:
        problem, answers = Path(folder) / "problem", Path(folder) / "answers"
        write_problem(problem, arm, targets)
        subprocess.run([*command, str(problem), str(answers), *options], check=True)
        table = np.loadtxt(answers, ndmin=2)
    solved = table[:, 0] != 0
    q = table[:, 2:]
    return Run(
        table[:, 1].astype(np.int64),
        [[row] if yes else [] for yes, row in zip(solved, q, strict=True)],
    )


class Baseline(Rival):
    """One solver of the program."""

    solver: ClassVar[str]
    """Its name on the program's command line."""
    options: ClassVar[tuple[str, ...]] = ("--tolerance", "1e-6", "--time-limit", "5e-3")
    distribution = ""
    measured = "each call in C++"
    settings = "random start and restarts, 5 ms, 1e-6 m and rad"

    def __init__(self, arm: Arm) -> None:
        """Build the program."""
        build()
        self._arm = arm

    @classmethod
    def version(cls) -> str:
        """The libraries' versions."""
        if not PROGRAM.exists():
            build()
        return f"KDL {library_version('orocos-kdl')}, NLopt {library_version('nlopt')}"

    def run(self, targets: Targets) -> Run:
        """Run the program once over all targets."""
        return run_program(
            self._arm, targets, [str(PROGRAM), self.solver], self.options
        )


class Newton(Baseline):
    """KDL's Newton with random restarts."""

    name = "KDL Newton + restarts"
    solver = "newton"


class Slsqp(Baseline):
    """NLopt's SLSQP with random restarts."""

    name = "SLSQP + restarts"
    solver = "slsqp"


class Race(Baseline):
    """Both at once, as TRAC-IK does."""

    name = "TRAC-IK style"
    solver = "race"
    settings = "Newton and SLSQP on two threads, 5 ms, 1e-6 m and rad, random start"


class KdlLma(Baseline):
    """KDL's Levenberg-Marquardt."""

    name = "KDL LMA"
    solver = "kdl_lma"
    options = ("--tolerance", "1e-6", "--starts", "20")
    settings = (
        "ChainIkSolverPos_LMA, unit weights, 100 iterations, 20 random starts, "
        "wrapped, 1e-6 m and rad"
    )


class KdlNrJl(Baseline):
    """KDL's Newton-Raphson with limits."""

    name = "KDL NR_JL"
    solver = "kdl_nr_jl"
    options = ("--tolerance", "1e-6", "--starts", "20")
    settings = (
        "ChainIkSolverPos_NR_JL, 100 iterations, 20 random starts, wrapped, "
        "1e-6 m and rad"
    )
    share = 0.5
