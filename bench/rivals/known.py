# SPDX-License-Identifier: BSD-3-Clause
"""IKSel, EAIK and IK-Geo, asked as the other enumerating solvers are."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any, ClassVar

import iksel
from bench.rivals.eaik import Eaik
from bench.rivals.enumerator import Enumerator, Request
from bench.rivals.ikgeo import IkGeo
from bench.rivals.iksel_ import IkselDefault

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array


class Iksel(Enumerator):
    """The default preset."""

    name = IkselDefault.name
    distribution = IkselDefault.distribution
    settings = (
        "SolverOptions(): 1e-6 m, 1e-6 rad; solve, solve_all, and solve with near"
    )

    @classmethod
    def version(cls) -> str:
        """Of the module that is measured."""
        return iksel.__version__

    def ways(self, arm: Arm) -> dict[str, Request]:
        """All three."""
        solver = _solver(arm)

        def both(pose: Array, near: Array) -> tuple[Any, ...]:
            return pose, near

        def nearest(pose: Array, near: Array) -> iksel.Result:
            return solver.solve(pose, near=near)

        def single(result: Any) -> list[Array]:
            return [result.q] if result.success else []

        return {
            "one": Request(_alone, solver.solve, single),
            "every": Request(_alone, solver.solve_all, _every),
            "nearest": Request(both, nearest, single),
        }

    def so_many(self, arm: Arm, number: int) -> Request:
        """The option max."""
        call = functools.partial(_solver(arm).solve_all, max=number)
        return Request(_alone, call, _every)


def _solver(arm: Arm) -> iksel.Solver:
    return iksel.Solver(arm.robot, IkselDefault.options())


def _alone(pose: Array, near: Array) -> tuple[Any, ...]:
    del near
    return (pose,)


def _every(solutions: iksel.Solutions) -> list[Array]:
    return list(solutions.q)


class Branches(Enumerator):
    """A solver known from the other benchmarks, which has all branches only."""

    known: ClassVar[type[Eaik | IkGeo]]
    keeps_limits = False

    def ways(self, arm: Arm) -> dict[str, Request]:
        """All."""
        known = self.known(arm)
        return {"every": Request(known.prepare, known.call, known.answers)}


class EaikBranches(Branches):
    """EAIK."""

    known = Eaik
    name = Eaik.name
    distribution = Eaik.distribution
    settings = Eaik.settings


class IkGeoBranches(Branches):
    """IK-Geo."""

    known = IkGeo
    name = IkGeo.name
    distribution = IkGeo.distribution
    settings = IkGeo.settings
