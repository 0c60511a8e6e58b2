# SPDX-License-Identifier: BSD-3-Clause
"""IKSel itself, called as its rivals are."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import iksel
from bench.rivals.base import PythonRival

if TYPE_CHECKING:
    from bench.arms import Arm
    from bench.chain import Array


class IkselDefault(PythonRival):
    """The default preset."""

    name = "IKSel"
    distribution = "iksel"
    settings = "SolverOptions(): 1e-6 m, 1e-6 rad"
    share = 10.0

    def __init__(self, arm: Arm) -> None:
        """Build the database."""
        self._solver = iksel.Solver(arm.robot, self.options())
        self.call = self._solver.solve  # type: ignore[assignment, method-assign]

    @classmethod
    def version(cls) -> str:
        """Of the module that is measured."""
        return iksel.__version__

    @staticmethod
    def options() -> iksel.SolverOptions:
        """The settings."""
        return iksel.SolverOptions()

    def prepare(self, pose: Array, start: Array) -> tuple[Any, ...]:
        """The pose is all there is."""
        del start
        return (pose,)

    def call(self, *arguments: Any) -> Any:
        """Solve; replaced by the bound method itself."""
        return self._solver.solve(*arguments)

    def answers(self, returned: Any) -> list[Array]:
        """At most one."""
        return [returned.q] if returned.success else []


class IkselPaper(IkselDefault):
    """The paper's method at tolerances that the judge can accept."""

    name = "IKSel, paper preset"
    settings = "SolverOptions.paper(), max_attempts 21, 1e-6 m, 1e-6 rad"
    share = 1.0

    @staticmethod
    def options() -> iksel.SolverOptions:
        """The paper's settings with #ReA 20."""
        return iksel.SolverOptions.paper().replace(
            max_attempts=21, position_tolerance=1e-6, rotation_tolerance=1e-6
        )
