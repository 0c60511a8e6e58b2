# SPDX-License-Identifier: BSD-3-Clause
"""Work in chunks, each a function of the job and the chunk's number alone."""

from __future__ import annotations

import hashlib
import json
import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import (
    CoupledLimit,
    MimicCurve,
    Robot,
    Solver,
    SolverOptions,
    simd_level,
)

from iksel import __version__
from iksel.reach._errors import PlanMismatchError

if TYPE_CHECKING:
    from collections.abc import Mapping

FORMAT = 1
"""Of the stored plan and arrays."""

Filter = Callable[[Any], Any]
"""Says which of n configurations (n, dof) may be answers, as in Solver.solve."""

Arrays = dict[str, np.ndarray[Any, Any]]
Block = tuple[slice, ...]


@dataclass(frozen=True)
class ArraySpec:
    """An array of the result; its first axes are the job's."""

    name: str
    dtype: str
    fill: float
    """What stands where nothing has been computed."""
    dims: tuple[str, ...] = ()
    """Names of the axes after the job's."""
    shape: tuple[int, ...] = ()
    """Lengths of these."""
    attributes: Mapping[str, Any] = field(default_factory=dict)


class Job(ABC):
    """What to compute, and with which robot and options; made of plain data alone."""

    kind: str
    """Which subclass it is, in the stored plan."""

    def __init__(self, data: Mapping[str, Any]) -> None:
        self._data = data

    @property
    @abstractmethod
    def dims(self) -> tuple[str, ...]:
        """Names of the axes."""

    @property
    @abstractmethod
    def shape(self) -> tuple[int, ...]:
        """Length of each axis."""

    @abstractmethod
    def specs(self) -> list[ArraySpec]:
        """The arrays of the result."""

    @abstractmethod
    def coordinates(self) -> dict[str, tuple[tuple[str, ...], np.ndarray[Any, Any]]]:
        """Names, axes and values of what the axes mean."""

    @abstractmethod
    def compute(
        self, index: int, solver: Solver, request: Mapping[str, Any] | None = None
    ) -> Arrays:
        """The chunk of that number, an array for each spec.

        Args:
            index: Of the chunk.
            solver: As solver() makes it.
            request: What request() gives.
        """

    def request(self, filter: Filter | None = None) -> dict[str, Any]:  # noqa: A002
        """Keywords of all solves: the plan's scene and filter, if it has any.

        Args:
            filter: The one that the plan names; a plan is data and holds no code.

        Raises:
            PlanMismatchError: The plan names another, or none.
        """
        planned, given = self._data.get("filter"), filter and filter_name(filter)
        if given != planned:
            raise PlanMismatchError(
                f"the plan's filter is {planned or 'none'}, got {given or 'none'}; it "
                "is given to run() and open() as filter="
            )
        return {} if filter is None else {"filter": filter}

    @property
    def size(self) -> int:
        """Number of cells."""
        return math.prod(self.shape)

    @property
    def chunk(self) -> tuple[int, ...]:
        """Cells of a chunk along each axis; those at the end may be cut off."""
        return tuple(self._data["chunk"])

    @property
    def inner(self) -> tuple[int, ...]:
        """Cells along each axis that can be read by themselves."""
        return tuple(self._data["inner"])

    @property
    def chunk_grid(self) -> tuple[int, ...]:
        """Number of chunks along each axis."""
        pairs = zip(self.shape, self.chunk, strict=True)
        return tuple(-(-n // part) for n, part in pairs)

    @property
    def chunks(self) -> int:
        """Number of chunks."""
        return math.prod(self.chunk_grid)

    def block(self, index: int) -> Block:
        """Where the chunk of that number lies."""
        places = np.unravel_index(index, self.chunk_grid)
        return tuple(
            slice(int(i) * part, min((int(i) + 1) * part, n))
            for i, part, n in zip(places, self.chunk, self.shape, strict=True)
        )

    @property
    def robot_data(self) -> Mapping[str, Any]:
        """What the robot is made of."""
        data: Mapping[str, Any] = self._data["robot"]
        return data

    @property
    def options(self) -> SolverOptions:
        """Options of the solver."""
        return SolverOptions(**_from_json(self._data["options"]))

    @property
    def version(self) -> str:
        """Version of iksel that it was planned by, and has to be computed by."""
        return str(self._data["version"])

    def robot(self) -> Robot:
        """The robot of the stored URDF.

        Raises:
            PlanMismatchError: It is another one to this version of iksel.
        """
        data = dict(self.robot_data)
        expected = data.pop("chain_hash")
        urdf, tcp = data.pop("urdf"), data.pop("tcp")
        del data["name"]
        data["tcp"] = np.array(tcp).reshape(4, 4)
        data["coupled_limits"] = [
            CoupledLimit(*_from_json(limit)) for limit in data.get("coupled_limits", ())
        ]
        data["mimic_curves"] = [
            MimicCurve(*curve) for curve in data.get("mimic_curves", ())
        ]
        robot = Robot.from_urdf(urdf, **data)
        if f"{robot.chain_hash:016x}" != expected:
            raise PlanMismatchError(
                f"the plan's robot has the chain hash {expected}, but the URDF in it "
                f"gives {robot.chain_hash:016x}"
            )
        return robot

    def check_machine(self) -> None:
        """Make sure that this process computes the bytes that others do.

        Raises:
            PlanMismatchError: It has another instruction set than the plan says.
        """
        planned, here = self._data.get("simd", simd_level()), simd_level()
        if here != planned:
            raise PlanMismatchError(
                f"the plan is for {planned}, and this process computes with {here}, "
                "whose last digits may differ: set the environment variable "
                f"IKSEL_SIMD={planned} if the machine has that, or plan again with "
                "IKSEL_SIMD set to what all machines have"
            )

    def solver(self) -> Solver:
        """A solver for the robot.

        Raises:
            PlanMismatchError: The plan was made by another version of iksel.
        """
        if self.version != __version__:
            raise PlanMismatchError(
                f"the plan was made by iksel {self.version}, this is {__version__}: "
                "compute it with that version, or plan again"
            )
        return Solver(self.robot(), self.options)

    @cached_property
    def id(self) -> str:
        """A hash of the whole plan, 32 hexadecimal digits."""
        text = json.dumps(self.to_dict(), sort_keys=True, allow_nan=False)
        return hashlib.blake2b(text.encode(), digest_size=16).hexdigest()

    def to_dict(self) -> dict[str, Any]:
        """Plain data, for JSON."""
        return {"kind": self.kind, **self._data}

    def __repr__(self) -> str:
        name = self.robot_data["name"]
        return (
            f"{type(self).__name__}({name}, {self.size:,} cells, {self.chunks} chunks)"
        )


def filter_name(filter: Filter) -> str:  # noqa: A002 (as in solve)
    """What a plan calls a filter: the name of its function or class."""
    named = filter if hasattr(filter, "__qualname__") else type(filter)
    return f"{named.__module__}.{named.__qualname__}"


def common_data(robot: Robot, options: SolverOptions) -> dict[str, Any]:
    """What every plan holds about its origin."""
    return {
        "format": FORMAT,
        "version": __version__,
        "simd": simd_level(),
        "robot": {
            "name": robot.name,
            "urdf": robot.urdf,
            "base_link": robot.base_link,
            "tip_link": robot.tip_link,
            "tcp": robot.tcp.ravel().tolist(),
            "locked_joints": dict(robot.locked_joints),
            "soft_limits": robot.soft_limits,
            "default_limits": _plain(robot.default_limits),
            **_coupled_data(robot),
            **_curve_data(robot),
            "chain_hash": f"{robot.chain_hash:016x}",
        },
        "options": _plain(options.to_dict()),
    }


def _coupled_data(robot: Robot) -> dict[str, Any]:
    """The coupled limits, if there are any: plans without are what they were."""
    limits = [[x.coefficients, x.lower, x.upper] for x in robot.coupled_limits]
    return {"coupled_limits": _plain(limits)} if limits else {}


def _curve_data(robot: Robot) -> dict[str, Any]:
    """How joints follow others, if any do by a curve."""
    curves = [
        [x.joint, x.follows, x.q.tolist(), x.values.tolist()]
        + ([] if x.slopes is None else [x.slopes.tolist()])
        for x in robot.mimic_curves
    ]
    return {"mimic_curves": curves} if curves else {}


def _plain(value: Any) -> Any:
    """Data as JSON has it: lists, and infinities as text."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float) and math.isinf(value):
        return "inf" if value > 0 else "-inf"
    return value


def _from_json(value: Any) -> Any:
    """The data of _plain()."""
    if isinstance(value, dict):
        return {key: _from_json(item) for key, item in value.items()}
    if isinstance(value, list):
        return tuple(map(_from_json, value))
    return float(value) if value in ("inf", "-inf") else value
