# SPDX-License-Identifier: BSD-3-Clause
"""Data sets: random poses with all their solutions, for those who train models."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import Proof, Robot, Solver, SolverOptions, Status

from iksel._base.arrays import reject
from iksel.pose import pose_from_quaternion, quaternion_from_pose
from iksel.reach._cells import UNKNOWN, flags
from iksel.reach._errors import check_tips
from iksel.reach._job import Arrays, ArraySpec, Job, common_data

if TYPE_CHECKING:
    from collections.abc import Mapping

    from iksel._base.arrays import FloatArray

TARGETS = ("configurations", "poses")
MOST_SOLUTIONS = 254
CHUNK = 1 << 14
"""Samples of a chunk."""


class SamplePlan(Job):
    """A data set that is to be computed; plan_samples() makes it."""

    kind = "samples"

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the axes."""
        return ("sample",)

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of samples."""
        return (int(self._data["samples"]),)

    def specs(self) -> list[ArraySpec]:
        """The arrays of the result."""
        nan = float("nan")
        solutions = (int(self._data["max_solutions"]), int(self._data["dof"]))
        return [
            ArraySpec(
                "position", "float64", nan, ("xyz",), (3,), _text("T_base_tcp [m]")
            ),
            ArraySpec(
                "quaternion",
                "float64",
                nan,
                ("wxyz",),
                (4,),
                _text("T_base_tcp, w >= 0"),
            ),
            ArraySpec("status", "uint8", UNKNOWN, attributes=flags(Status)),
            ArraySpec("proof", "uint8", UNKNOWN, attributes=flags(Proof)),
            ArraySpec(
                "count", "uint8", UNKNOWN, attributes=_text("number of solutions")
            ),
            ArraySpec(
                "q",
                "float64",
                nan,
                ("solution", "joint"),
                solutions,
                _text("solutions [rad or m]; NaN after the last"),
            ),
        ]

    def coordinates(self) -> dict[str, tuple[tuple[str, ...], np.ndarray[Any, Any]]]:
        """None: samples have only numbers."""
        return {}

    def compute(
        self, index: int, solver: Solver, request: Mapping[str, Any] | None = None
    ) -> Arrays:
        """The chunk of that number, an array for each spec.

        Args:
            index: Of the chunk.
            solver: As solver() makes it.
            request: What request() gives.
        """
        request = request or {}
        (block,) = self.block(index)
        poses = self._poses(solver.robot, index, block.stop - block.start)
        arrays: Arrays = {
            spec.name: np.full((len(poses), *spec.shape), spec.fill, spec.dtype)
            for spec in self.specs()
        }
        arrays["position"][:] = poses[:, :3, 3]
        arrays["quaternion"][:] = quaternion_from_pose(poses)
        most = arrays["q"].shape[1]
        for i, pose in enumerate(poses):
            found = solver.solve_all(pose, max=most, **request)
            arrays["status"][i] = found.status
            arrays["proof"][i] = found.proof
            arrays["count"][i] = len(found.q)
            arrays["q"][i, : len(found.q)] = found.q
        return arrays

    def _poses(self, robot: Robot, index: int, n: int) -> FloatArray:
        """Random targets of a chunk, (n, 4, 4)."""
        origin = np.random.SeedSequence([int(self._data["seed"]), index])
        if self._data["targets"] == "configurations":
            seed = int(origin.generate_state(1, np.uint64)[0])
            return robot.fk(robot.random_configurations(n, seed=seed))
        random = np.random.Generator(np.random.PCG64(origin))
        direction = random.normal(size=(n, 3))
        direction /= np.linalg.norm(direction, axis=-1)[:, None]
        # Uniform in a ball: its volume goes by the cube of the radius.
        radius = robot.reach * np.cbrt(random.uniform(size=(n, 1)))
        turn = random.normal(size=(n, 4))
        turn /= np.linalg.norm(turn, axis=-1)[:, None]
        return pose_from_quaternion(robot.reach_centre + radius * direction, turn)


def plan_samples(
    robot: Robot,
    samples: int,
    *,
    seed: int = 0,
    targets: str = "configurations",
    max_solutions: int = 16,
    options: SolverOptions | None = None,
) -> SamplePlan:
    """Plan a data set of random poses with all their solutions.

    Arrays per sample: position (3,) [m], quaternion (w, x, y, z), status, proof, count,
    and q (max_solutions, dof) [rad or m], which is NaN after the last solution.

    Args:
        robot: With its tool: poses are T_base_tcp.
        samples: How many.
        seed: Of the random numbers, 0 to 2^64 - 1.
        targets: "configurations": poses of configurations uniform in the limits, which
            can all be reached; "poses": positions uniform in the ball that the robot
            reaches, with rotations uniform, of which many cannot.
        max_solutions: Solutions of a pose that are kept, 1 to 254.
        options: Options of the solver; None: the default.

    Raises:
        InvalidArgumentError: An argument out of range, or a robot with several tips.
    """
    check_tips(robot)
    if samples < 1:
        reject("samples", f"{samples} is less than 1")
    if not 0 <= seed < 2**64:
        reject("seed", f"{seed} is not between 0 and 2^64 - 1")
    if targets not in TARGETS:
        reject("targets", f"{targets!r} is none of {', '.join(TARGETS)}")
    if not 1 <= max_solutions <= MOST_SOLUTIONS:
        reject(
            "max_solutions", f"{max_solutions} is not between 1 and {MOST_SOLUTIONS}"
        )
    chunk = min(samples, CHUNK)
    data = {
        **common_data(robot, SolverOptions() if options is None else options),
        "dof": robot.dof,
        "samples": samples,
        # As text: not every reader of JSON has whole numbers of 64 bits.
        "seed": str(seed),
        "targets": targets,
        "max_solutions": max_solutions,
        "chunk": [chunk],
        "inner": [chunk],
    }
    return SamplePlan(data)


def _text(text: str) -> dict[str, str]:
    return {"long_name": text}
