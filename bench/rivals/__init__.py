# SPDX-License-Identifier: BSD-3-Clause
"""The solvers that are compared, each behind bench.rivals.base.Rival."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bench.rivals.crx import Crx
from bench.rivals.eaik import Eaik
from bench.rivals.frankik import Frankik, FrankikDefaults
from bench.rivals.ikdh import Ikdh
from bench.rivals.ikfast import IkFast
from bench.rivals.ikgeo import IkGeo
from bench.rivals.iksel_ import IkselDefault, IkselPaper
from bench.rivals.kdl import KdlLma, KdlNrJl, Newton, Race, Slsqp
from bench.rivals.known import EaikBranches, IkGeoBranches, Iksel
from bench.rivals.loops import Mink, Pink
from bench.rivals.optik import OptIk
from bench.rivals.opw import Opw
from bench.rivals.pinocchio import Pinocchio
from bench.rivals.pinocchio_cpp import PinocchioCpp
from bench.rivals.py_ikgeo import PyIkGeo
from bench.rivals.robotics_toolbox import RoboticsToolbox
from bench.rivals.ssik import Ssik, SsikWithoutRescue
from bench.rivals.tracik import TracIk

if TYPE_CHECKING:
    from collections.abc import Iterable

    from bench.rivals.base import Rival
    from bench.rivals.enumerator import Enumerator

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
        PinocchioCpp,
        Race,
        Newton,
        Slsqp,
        KdlLma,
        KdlNrJl,
    )
}
"""All of them by name, in the order of the tables."""


def timed_in_cpp(names: Iterable[str]) -> list[str]:
    """Those whose calls are timed inside C++, and so without Python's part."""
    return [name for name in names if "C++" in RIVALS[name].measured]


ENUMERATORS: dict[str, type[Enumerator]] = {
    rival.name: rival
    for rival in (
        Iksel,
        Ssik,
        SsikWithoutRescue,
        Ikdh,
        EaikBranches,
        IkGeoBranches,
        PyIkGeo,
        Opw,
        Frankik,
        FrankikDefaults,
        Crx,
        IkFast,
        Pink,
        Mink,
    )
}
"""Those of the section "analytic": for one answer, for all, for the nearest."""
