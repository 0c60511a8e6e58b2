# SPDX-License-Identifier: BSD-3-Clause
"""Settings that cells of several sections share: their targets, their SIMD level."""

from __future__ import annotations

from typing import TYPE_CHECKING

import iksel
from bench.size import SEED

if TYPE_CHECKING:
    from bench.store import Settings


def target_cell(robot: str, kind: str, count: int, seed: int = SEED) -> Settings:
    """Targets, made once for all solvers with that count."""
    return {
        "cell": "targets",
        "robot": robot,
        "kind": kind,
        "count": count,
        "seed": seed,
    }


BESIDE_LEVEL = "avx2"
"""The SIMD level of the rows beside those of AVX-512: what most processors have."""


def other_level() -> str | None:
    """BESIDE_LEVEL where the rows are of AVX-512."""
    return BESIDE_LEVEL if iksel.simd_level() == "avx512" else None


def at_level(cell: Settings, level: str) -> Settings:
    """A cell of IKSel's, measured in a process whose SIMD level is another."""
    return {**cell, "simd": level}
