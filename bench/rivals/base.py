# SPDX-License-Identifier: BSD-3-Clause
"""What a solver looks like to the harness."""

from __future__ import annotations

import importlib.metadata
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from bench.timing import PASSES, SHORT_S, least_times, time_calls

if TYPE_CHECKING:
    import numpy.typing as npt

    from bench.arms import Arm
    from bench.chain import Array
    from bench.targets import Targets


class UnsupportedError(Exception):
    """A solver that cannot be had for a robot, or at all; the text says why."""


@dataclass(frozen=True)
class Run:
    """One solver's way through some targets."""

    times_ns: npt.NDArray[Any]
    """Time of each call, (N,) [ns]."""
    answers: list[list[Array]]
    """What it returned as answers: per target any number of configurations."""


class Rival(ABC):
    """A solver of single poses, made for one robot.

    An object is made in a process of its own, where `__init__` may take its time. What
    a caller could do once per target before the clock starts is done in `prepare`.
    """

    name: ClassVar[str]
    """Name in tables and in --only."""
    distribution: ClassVar[str]
    """Package on PyPI whose version the report gives; "" for none."""
    settings: ClassVar[str]
    """Settings, as the report states them."""
    measured: ClassVar[str] = "each call from Python"
    """What a time is of."""
    keeps_limits: ClassVar[bool] = True
    """Whether joint limits are its business: else answers outside them are left out."""
    share: ClassVar[float] = 1.0
    """Part of the usual number of targets, for the slow ones."""
    limit_s: ClassVar[float] = 60.0
    """No further target is begun after this time [s]."""

    @abstractmethod
    def __init__(self, arm: Arm) -> None:
        """Make it for a robot; UnsupportedError if it cannot be."""

    @abstractmethod
    def run(self, targets: Targets) -> Run:
        """Solve all targets, one after another."""

    @classmethod
    def version(cls) -> str:
        """Version of the package, or why there is none.

        Raises:
            UnsupportedError: It is not installed.
        """
        try:
            return importlib.metadata.version(cls.distribution)
        except importlib.metadata.PackageNotFoundError:
            raise UnsupportedError(
                f"{cls.distribution} is not installed (pip install {cls.distribution})"
            ) from None


def least_run(rival: Rival, targets: Targets) -> Run:
    """The answers of a run; if it was short, with the least times of more of them."""
    run = rival.run(targets)
    if run.times_ns.sum() >= SHORT_S * 1e9:
        return run
    more = [rival.run(targets).times_ns for _ in range(PASSES - 1)]
    times = least_times([run.times_ns, *more])
    return Run(times, run.answers[: len(times)])


class PythonRival(Rival):
    """A solver called from Python, timed around each call."""

    @abstractmethod
    def prepare(self, pose: Array, start: Array) -> tuple[Any, ...]:
        """The arguments of `call`, made before the clock starts."""

    @abstractmethod
    def call(self, *arguments: Any) -> Any:
        """Solve one pose: the one thing that is timed."""

    @abstractmethod
    def answers(self, returned: Any) -> list[Array]:
        """The configurations in what `call` returned, made after the clock stopped."""

    def run(self, targets: Targets) -> Run:
        """Time `call` on every target; see bench.timing."""
        prepared = [
            self.prepare(pose, start)
            for pose, start in zip(targets.poses, targets.starts, strict=True)
        ]
        times, returned = time_calls(self.call, prepared, self.limit_s)
        return Run(times, [self.answers(value) for value in returned])
