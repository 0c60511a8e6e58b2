# SPDX-License-Identifier: BSD-3-Clause
"""The solvers that are compared, each behind bench.rivals.base.Rival."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bench.rivals.eaik import Eaik
from bench.rivals.ikgeo import IkGeo
from bench.rivals.iksel_ import IkselDefault, IkselPaper
from bench.rivals.kdl import KdlLma, KdlNrJl, Newton, Race, Slsqp
from bench.rivals.optik import OptIk
from bench.rivals.pinocchio import Pinocchio
from bench.rivals.robotics_toolbox import RoboticsToolbox
from bench.rivals.tracik import TracIk

if TYPE_CHECKING:
    from bench.rivals.base import Rival

RIVALS: dict[str, type[Rival]] = {
    rival.name: rival
    for rival in (
        IkselDefault,
        IkselPaper,
        Eaik,
        IkGeo,
        RoboticsToolbox,
        OptIk,
        TracIk,
        Pinocchio,
        Race,
        Newton,
        Slsqp,
        KdlLma,
        KdlNrJl,
    )
}
"""All of them by name, in the order of the tables."""
