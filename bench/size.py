# SPDX-License-Identifier: BSD-3-Clause
"""How much a report measures, in two sizes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bench.store import Settings

SEED = 1
"""Seed of all targets."""


@dataclass(frozen=True)
class Size:
    """How much is measured."""

    paper: int
    """Targets of the paper's tables."""
    figure: int
    """Targets for the times of the figures."""
    figure_attempts: tuple[int, ...]
    """#ReA that the figures' times are taken at."""
    cvt_scales: tuple[str, ...]
    """Sizes of the databases that are also sampled by CVT."""
    rivals: dict[str, int]
    """Targets per kind for a solver whose share is 1."""
    robots: int
    """Targets for the table of all robots."""
    batch: int
    """Poses in a batch."""
    artefact: int
    """Queries looked at for singular samples."""
    patience_s: float = 30.0
    """Time that a report waits for other processes to be through, in all [s]."""
    requests: int = 10_000
    """Targets of the requests."""
    restarts: int = 1_000
    """Targets that are restarted a thousand times each."""
    no: int = 5_000
    """Targets of each kind for the noes, and what goes with them."""
    no_slow: int = 30
    """The same for slow solvers, which may take a tenth of a second for a no."""
    no_seed: int = SEED
    """Their seed."""
    analytic: int = 500
    """Targets of each kind for solvers that enumerate."""
    analytic_s: float = 0.2
    """Time after which none of them is begun any more, in each way to ask [s]."""
    tail_calls: int = 1_000_000
    """Reachable targets whose single calls are looked at one by one."""
    tail_noes: int = 100_000
    """The same with random rotations, and beside another thread."""
    tail_beside: int = 200
    """Calls that each follow other work."""
    tail_s: float = 1.0
    """Time after which none is begun beside another thread [s]."""
    random_arms: int = 100
    """Random arms of each build."""
    random_targets: int = 5_000
    """Reachable targets of each, in a batch."""
    random_asked: int = 100
    """Targets of each that are asked one by one, as many of each kind."""
    random_brute: int = 5
    """Noes of each that brute force looks for an answer of, and moves beside it."""
    random_s: float = 12.0
    """Time after which no further arm of a build is begun [s]."""
    random_seed: int = 20_000
    """Seed of a build's first arm: constants were chosen with lower ones in view."""


FULL = Size(
    paper=10_000,
    figure=500,
    figure_attempts=(1, 2, 3, 5, 7, 10, 15, 20),
    cvt_scales=("small", "medium"),
    rivals={
        "uniform": 1_000,
        "near_limits": 300,
        "near_singular": 300,
        "lines": 300,
        "unreachable": 20,
    },
    robots=100_000,
    batch=10_000,
    artefact=1_000,
)

QUICK = Size(
    paper=1_000,
    figure=200,
    figure_attempts=(1, 5, 20),
    cvt_scales=(),
    rivals={
        "uniform": 100,
        "near_limits": 40,
        "near_singular": 40,
        "lines": 40,
        "unreachable": 5,
    },
    robots=2_000,
    batch=2_000,
    artefact=200,
    patience_s=0.0,
    requests=500,
    restarts=50,
    no=500,
    no_slow=10,
    analytic=20,
    analytic_s=0.2,
    tail_calls=5_000,
    tail_noes=500,
    tail_beside=20,
    tail_s=0.1,
    random_arms=3,
    random_targets=500,
    random_asked=40,
    random_brute=2,
)


@dataclass(frozen=True)
class Job:
    """Cells measured by one process."""

    name: str
    section: str
    cells: list[Settings]
    timed: bool = True
