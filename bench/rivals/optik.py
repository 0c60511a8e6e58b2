# SPDX-License-Identifier: BSD-3-Clause
"""OptIK by optik-py."""

from __future__ import annotations

import importlib
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from bench.rivals.base import PythonRival, UnsupportedError

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array


class OptIk(PythonRival):
    """SLSQP in Rust with restarts."""

    name = "OptIK"
    distribution = "optik-py"
    # Its default tolerance is of a squared error: 1e-6 there is 1 mm.
    settings = (
        "speed, 1 thread, 0.1 s, tol_f 1e-12 (of the squared error), random start"
    )

    mode: ClassVar[str] = "speed"
    max_time: ClassVar[float] = 0.1
    """[s]"""

    def __init__(self, arm: Arm) -> None:
        """Hand it the chain's URDF."""
        module = importlib.import_module("optik")
        if not np.isfinite(arm.chain.lower).all():
            raise UnsupportedError("it has no continuous joints")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "arm.urdf"
            path.write_text(arm.urdf, encoding="utf-8")
            self._robot = module.Robot.from_urdf_file(
                str(path), arm.base_link, arm.tip_link
            )
        self._robot.set_parallelism(1)
        self._config = module.SolverConfig(
            solution_mode=self.mode,
            max_time=self.max_time,
            max_restarts=1_000_000,
            tol_f=1e-12,
            tol_df=-1.0,
            tol_dx=-1.0,
        )

    def prepare(self, pose: Array, start: Array) -> tuple[Any, ...]:
        """As it is."""
        return (self._config, pose, start)

    def call(self, *arguments: Any) -> Any:
        """Solve."""
        return self._robot.ik(*arguments)

    def answers(self, returned: Any) -> list[Array]:
        """A pair of configuration and error, or None."""
        return [] if returned is None else [np.asarray(returned[0])]


class OptIkQuality(OptIk):
    """All of its time for the answer nearest to the start; not in RIVALS."""

    name = "OptIK, quality"
    mode = "quality"
    max_time = 0.01
