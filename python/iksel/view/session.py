# SPDX-License-Identifier: BSD-3-Clause
"""What a viewer shows: a robot, a target, and what inverse kinematics says of it."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import (
    ArcEnd,
    InvalidArgumentError,
    JointType,
    SelfMotion,
    Solver,
    Status,
    Task,
)

from iksel._base.arrays import as_floats, reject
from iksel._base.qualities import limit_distance, manipulability
from iksel.pose import check_pose

if TYPE_CHECKING:
    import numpy.typing as npt
    from iksel_cpp import Result, Scene, SelfMotionEnd

    from iksel._base.arrays import FloatArray
    from iksel.pose import PoseLike

TASKS = {
    "pose": Task.pose(),
    "free spin": Task.free_spin(),
    "position only": Task.position_only(),
}
"""What of the target has to be reached, by the name that the viewer shows."""
OWN_TASK = "the solver's"
CHOICES = ("nearest", "same branch", "any")
"""Which of a target's solutions is taken: that nearest to where the robot is, the one
that an attempt from there leads to and no other, or the first that is found."""
DIAGNOSIS_DEADLINE = 0.1  # [s], so that dragging goes on where nothing is found
MOST_BRANCHES = 64
SAMPLES = 4096  # of configurations to begin with
SPACING = 0.02  # [rad] between the configurations of a self-motion


class Session:
    """A robot and its target; without anything drawn.

    The robot is where the last answer put it: where there is none, it stays.
    """

    q: FloatArray
    """Joint values of the robot, (dof,) [rad or m]."""
    target: FloatArray
    """T_base_tcp, (4, 4) [m]."""
    status: Status
    """What came of the last request."""
    reason: str
    """Why the robot is not at the target; empty if it is."""
    seconds: float | None
    """How long the last answer took [s]; None where nothing had to be solved."""

    def __init__(
        self,
        solver: Solver,
        q: npt.ArrayLike | None = None,
        *,
        scene: Scene | None = None,
    ) -> None:
        """Take a solver, and joint values (dof,) to begin with [rad or m].

        Without these it begins away from singularities and limits, upright. Answers
        keep free of the scene.
        """
        self.solver = solver
        self._scene = scene
        self.robot = solver.robot
        self.tasks = dict(TASKS)
        own = solver.options.task
        if own not in TASKS.values():
            self.tasks[OWN_TASK] = own
        self.task_name = next(name for name, task in self.tasks.items() if task == own)
        self.choice = CHOICES[0]
        self._motion: SelfMotion | None = None
        self.show(_open_configuration(solver, scene) if q is None else q)

    @property
    def task(self) -> Task:
        """What of the target has to be reached."""
        return self.tasks[self.task_name]

    @property
    def solved(self) -> bool:
        """Whether the robot is at the target."""
        return self.status == Status.solved

    def show(self, q: npt.ArrayLike) -> None:
        """Put the robot at joint values (dof,) [rad or m], and the target at its TCP.

        Raises:
            InvalidArgumentError: Another shape, or not finite.
        """
        self.q = as_floats("q", q, (self.robot.dof,)).copy()
        if self.q.ndim != 1:
            reject("q", f"expected shape ({self.robot.dof},), got {self.q.shape}")
        self.target = self.robot.fk(self.q)
        self._ended(Status.solved, "", None)

    def move_joint(self, joint: int, value: float) -> None:
        """Turn or slide one joint [rad or m]; the target goes with the TCP."""
        q = self.q.copy()
        q[joint] = value
        self.show(q)

    def move_target(self, pose: PoseLike) -> None:
        """Move the target to T_base_tcp, (4, 4) [m]; the robot follows if it can.

        Raises:
            InvalidArgumentError: Another shape, not finite or not rigid.
        """
        target = check_pose(pose)
        if target.shape != (4, 4):
            reject("pose", f"expected shape (4, 4), got {target.shape}")
        self.target = target
        self.solve()

    def set_task(self, name: str) -> None:
        """Choose a task by one of the names in `tasks`, and solve for it.

        Raises:
            InvalidArgumentError: No such name.
        """
        if name not in self.tasks:
            reject("task", f"{name!r} is none of {', '.join(self.tasks)}")
        self.task_name = name
        self.solve()

    def set_choice(self, name: str) -> None:
        """Choose which solution is taken, by one of CHOICES.

        Raises:
            InvalidArgumentError: No such name.
        """
        if name not in CHOICES:
            reject("choice", f"{name!r} is none of {', '.join(CHOICES)}")
        self.choice = name

    def solve(self) -> None:
        """Solve for the target; which solution is taken, `choice` says."""
        started = time.perf_counter()
        result: Result = self.solver.solve(
            self.target, task=self.task, scene=self._scene, **self._wishes()
        )
        seconds = time.perf_counter() - started
        if result.q is not None:
            self.q = result.q
            self._ended(result.status, "", seconds)
            return
        if self.choice == "same branch" and self._has_another_branch():
            reason = "the robot's branch does not go on to there; others have an answer"
            self._ended(result.status, reason, seconds)
            return
        diagnosis = self.solver.diagnose(
            self.target,
            task=self.task,
            scene=self._scene,
            deadline=DIAGNOSIS_DEADLINE,
        )
        if diagnosis.q_is_solution and diagnosis.q is not None:
            self.q = diagnosis.q
            self._ended(Status.solved, "", time.perf_counter() - started)
            return
        certain = ", proven" if diagnosis.proven else ""
        reason = f"{diagnosis.cause.name}{certain}: {diagnosis.message}"
        self._ended(result.status, reason, seconds)

    def _wishes(self) -> dict[str, Any]:
        """What solve() is asked for besides the target and the task."""
        if self.choice == "nearest":
            return {"near": self.q}
        if self.choice == "same branch":
            return {"seeds": self.q, "database_seeds": False}
        return {}

    def _has_another_branch(self) -> bool:
        """Whether the target has a solution, wherever the robot is."""
        found = self.solver.solve(self.target, task=self.task, scene=self._scene)
        return bool(found)

    def branches(self) -> FloatArray:
        """All solutions of the target, (n, dof) [rad or m], the robot's own first."""
        found = self.solver.solve_all(
            self.target,
            MOST_BRANCHES,
            near=self.q,
            task=self.task,
            scene=self._scene,
        )
        return found.q

    @property
    def motion(self) -> SelfMotion | None:
        """The self-motion at the target; None for robots and tasks without one."""
        if self._motion is None and self.task.is_full_pose:
            try:
                self._motion = self.solver.self_motion(self.target, SPACING)
            except InvalidArgumentError:  # not an arm of which a joint is swept
                return None
        return self._motion

    def slide(self, share: float) -> None:
        """Move along the self-motion, from 0 (first arc's begin) to 1 (last's end)."""
        along = self._along()
        if len(along):
            self.q = along[round(share * (len(along) - 1))].copy()
            self.status, self.reason, self.seconds = Status.solved, "", None

    @property
    def share(self) -> float:
        """Where along the self-motion the robot is, as slide() takes it."""
        along = self._along()
        if len(along) < 2:
            return 0.0
        return self._nearest(along) / (len(along) - 1)

    @property
    def arc(self) -> str:
        """The arc of the self-motion that the robot is on, in words; or none."""
        motion = self.motion
        along = self._along()
        if motion is None or not len(along):
            return "none"
        ends = np.cumsum([len(arc) for arc in motion])
        index = int(np.searchsorted(ends, self._nearest(along), side="right"))
        arc = motion[index]
        text = f"arc {index + 1} of {len(motion)}"
        if arc.is_closed:
            return f"{text}, closed"
        return f"{text}, from {self._end(arc.begin)} to {self._end(arc.end)}"

    def _along(self) -> FloatArray:
        """Configurations along all arcs, (n, dof)."""
        arcs = [arc.q for arc in self.motion or ()]
        return np.concatenate(arcs) if arcs else np.empty((0, self.robot.dof))

    def _nearest(self, along: FloatArray) -> int:
        return int(np.abs(along - self.q).max(axis=1).argmin())

    def _end(self, end: SelfMotionEnd) -> str:
        if end.kind != ArcEnd.limit:
            return "a fold"
        side = "upper" if end.at_upper else "lower"
        return f"the {side} limit of {self.robot.joint_names[end.joint]}"

    def _ended(self, status: Status, reason: str, seconds: float | None) -> None:
        """Keep what came of the last request."""
        self.status = status
        self.reason = reason
        self.seconds = seconds
        self._motion = None


def _open_configuration(solver: Solver, scene: Scene | None) -> FloatArray:
    """Of some random configurations one that shows the robot well.

    It is manipulable, far from limits, and free; no link is below the base's floor,
    where that is possible; and the arm stands up, with its tool before it (along x) and
    pointing down.
    """
    robot = solver.robot
    some = robot.random_configurations(SAMPLES, seed=0)
    if scene is not None:
        free = np.asarray(scene.is_free(some))
        some = some[free] if free.any() else some
    heights = robot.link_poses(some)[..., 2, 3]
    lowest = heights.min(axis=1)
    above = lowest >= min(0.0, lowest.max()) - 1e-9
    some, heights = some[above], heights[above]
    tool = robot.fk(some)
    sideways = tool[:, :2, 3]
    before = sideways[:, 0] / np.maximum(np.linalg.norm(sideways, axis=1), 1e-9)
    quality = (
        manipulability(robot, some)
        * limit_distance(robot, some)
        * np.maximum(heights.mean(axis=1) - heights[:, 0].min(), 1e-9) ** 2
        * (1.2 + before)
        * (1.5 - tool[:, 2, 2])
    )
    q = some[np.argmax(quality)]
    # Of joints that can turn further than once around, the least turn.
    turns = np.array([kind != JointType.prismatic for kind in robot.joint_types])
    least = np.where(turns, (q + np.pi) % (2 * np.pi) - np.pi, q)
    inside = (robot.lower <= least) & (least <= robot.upper)
    return np.asarray(np.where(inside, least, q))
