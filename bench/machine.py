# SPDX-License-Identifier: BSD-3-Clause
"""What the figures were made on, and of."""

from __future__ import annotations

import functools
import hashlib
import os
import platform
import subprocess
import sys
from pathlib import Path
from typing import Any

import iksel_cpp
import numpy as np

ROOT = Path(__file__).resolve().parents[1]

MEASURING = (
    "analytic/cells.py",
    "analytic/counted.py",
    "arms.py",
    "branches.py",
    "cells.py",
    "chain.py",
    "check.py",
    "no.py",
    "targets.py",
    "timing.py",
    "lost.py",
    "moves.py",
    "nearby.py",
    "random_arms.py",
    "random_builds.py",
    "cold.py",
    "tails/*.py",
    "learned/data.py",
    "learned/diffusion.py",
    "learned/errors.py",
    "learned/evaluate.py",
    "learned/flow.py",
    "learned/layers.py",
    "learned/mdn.py",
    "learned/models.py",
    "learned/plan.py",
    "learned/weights/*.npz",
    "paper/artefact.py",
    "paper/newer.py",
    "paper/paired.py",
    "paper/seeds_shown.py",
    "requests.py",
    "restarts.py",
    "seed_makers.py",
    "tips.py",
    "whole_body/cells.py",
    "whole_body/robots.py",
    "whole_body/solvers.py",
    "ikgeo/*.py",
    "rivals/*.py",
    "cpp/baselines/*",
    "cpp/pinocchio/*",
    "*.urdf",
)
"""Files of bench/ that a figure depends on; the others only choose and show."""


def facts() -> dict[str, Any]:
    """Machine, versions and commit, as the report prints them."""
    return {
        "cpu": cpu_name(),
        "cores": os.cpu_count(),
        "system": platform.platform(terse=True),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "iksel": iksel_cpp.__version__,
        "simd": iksel_cpp.simd_level(),
        "commit": commit(),
        "stale": stale(),
        "load": round(os.getloadavg()[2], 1),
    }


def load_text(some_facts: dict[str, Any]) -> str:
    """How much else ran, if that is known: one process measures."""
    load = some_facts.get("load")
    return "" if load is None else f", load average {load:g} of 15 minutes"


def others_text(some_facts: dict[str, Any]) -> str:
    """What other processes took, as bench.others saw it; "" where that is not known."""
    facts = some_facts.get("others")
    if not facts:
        return ""
    return (
        f" Beside the timed jobs other processes took {facts['mean']:g} cores in the "
        f"mean, {facts['most']:g} at most ({facts['job']}); it had waited for them for "
        f"{facts['waited_s']:g} s."
    )


def cpu_name() -> str:
    """The processor as the system calls it."""
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        return platform.processor()
    for line in text.splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


UNKNOWN = "unknown"
"""The commit where there is no repository."""


def commit() -> str:
    """The checkout's commit; with a + if files differ from it that a figure needs.

    Of bench/ these are the measuring ones: what a report writes is no difference.
    """
    revision = git("rev-parse", "--short=10", "HEAD")
    if not revision:
        return UNKNOWN
    measuring = [f":(glob)bench/{pattern}" for pattern in MEASURING]
    changed = git(
        "status", "--porcelain", "--untracked-files=no", "--", ":!bench", ":!README.md"
    ) or git("status", "--porcelain", "--", "cpp", "python", *measuring)
    return revision + ("+" if changed else "")


def stale() -> bool:
    """Whether cpp/ or python/ have changed since the installed core was built."""
    changed = git("log", "-1", "--format=%ct", "--", "cpp", "python")
    built = Path(iksel_cpp.__file__).stat().st_mtime
    return bool(changed) and float(changed) > built


def git(*arguments: str) -> str:
    """What a git command says of the checkout; "" where it fails."""
    command = ["git", "-C", str(ROOT), *arguments]
    try:
        done = subprocess.run(command, check=False, capture_output=True, text=True)
    except OSError:
        return ""
    return done.stdout.strip() if done.returncode == 0 else ""


@functools.cache
def fingerprint() -> str:
    """Changes when a stored figure would no longer be this machine's and code's.

    Made of the installed core, the measuring files, the interpreter and the processor.
    """
    digest = hashlib.sha256()
    digest.update(Path(iksel_cpp.__file__).read_bytes())
    for pattern in MEASURING:
        for path in sorted((ROOT / "bench").glob(pattern)):
            digest.update(path.read_bytes())
    for fact in (cpu_name(), os.cpu_count(), sys.version, iksel_cpp.simd_level()):
        digest.update(str(fact).encode())
    return digest.hexdigest()[:16]
