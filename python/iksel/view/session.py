# SPDX-License-Identifier: BSD-3-Clause
"""What a viewer shows: a robot, its targets, and what inverse kinematics finds."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from iksel_cpp import InvalidArgumentError, SelfMotion, Solver, Status, Task

from iksel._base.arrays import as_floats, reject
from iksel.pose import check_pose, pose_error
from iksel.view import _reasons as reasons
from iksel.view._arcs import Arcs
from iksel.view._begin import open_configuration
from iksel.view._tracking import OTHER_TASKS, Tracking, words

if TYPE_CHECKING:
    import numpy.typing as npt
    from iksel_cpp import Result, Scene

    from iksel._base.arrays import FloatArray
    from iksel.pose import PoseLike

TASKS = {
    "pose": Task.pose(),
    "free spin": Task.free_spin(),
    "position only": Task.position_only(),
}
"""What of a target has to be reached, by the name that the viewer shows."""
OWN_TASK = "the solver's"
CHOICES = ("nearest", "same branch", "tracked", "any")
"""Which of the targets' solutions is taken: that nearest to where the robot is, the one
that an attempt from there leads to and no other, where a Tracker goes from there, if
only as near as it gets, or the first that is found."""
TIPS_DEADLINE = 0.2  # [s] for an answer of several tips, so that dragging goes on
MOST_BRANCHES = 16  # an arm of six joints has no more; of a spread more hide each other
SPACING = 0.02  # [rad] between the configurations of a self-motion


class Session:
    """A robot and a target for each of its tips; without anything drawn.

    The robot is where the last answer put it, with all tips at their targets: where
    there is none, it stays.
    """

    q: FloatArray
    """Joint values of the robot, (dof,) [rad or m]."""
    targets: FloatArray
    """T_base_tcp of each tip, (tips, 4, 4) [m]."""
    task_names: list[str]
    """What of each target has to be reached, by names in `tasks`."""
    status: Status
    """What came of the last request."""
    reason: str
    """Why the robot is not at its targets; empty if it is."""
    tip_reasons: list[str]
    """Of several tips, why each cannot be at its target even by itself; empty of those
    that can."""
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
        self.scene = scene
        self.robot = solver.robot
        self.tasks = dict(TASKS)
        own = solver.options.task
        if own not in TASKS.values():
            self.tasks[OWN_TASK] = own
        name = next(name for name, task in self.tasks.items() if task == own)
        self._own_tasks = [name] * self.robot.tips
        self.task_names = self._own_tasks.copy()
        self.choice = CHOICES[0]
        self._tracking = Tracking(solver, scene)
        self._arcs: Arcs | None = None
        self.show(open_configuration(solver, scene) if q is None else q)

    @property
    def target(self) -> FloatArray:
        """The target of the one tip, (4, 4), or those of all tips, (tips, 4, 4)."""
        return self.targets if self.robot.tips > 1 else self.targets[0]

    @property
    def solved(self) -> bool:
        """Whether all tips are at their targets."""
        return self.status == Status.solved

    def errors(self) -> tuple[FloatArray, FloatArray]:
        """How far each tip is from its target, (tips,) [m] and (tips,) [rad]."""
        return pose_error(self.targets, self._tips())

    def show(self, q: npt.ArrayLike) -> None:
        """Put the robot at joint values (dof,) [rad or m], and the targets at its TCPs.

        Raises:
            InvalidArgumentError: Another shape, or not finite.
        """
        self.q = as_floats("q", q, (self.robot.dof,)).copy()
        if self.q.ndim != 1:
            reject("q", f"expected shape ({self.robot.dof},), got {self.q.shape}")
        self.targets = self._tips()
        self._ended(Status.solved, "", None)

    def move_joint(self, joint: int, value: float) -> None:
        """Turn or slide one joint [rad or m]; the targets go with the TCPs."""
        q = self.q.copy()
        q[joint] = value
        self.show(q)

    def move_target(self, pose: PoseLike, tip: int | None = None) -> None:
        """Move the target to T_base_tcp, (4, 4) [m]; the robot follows if it can.

        Args:
            pose: Of the one tip or of `tip`; else of all, (tips, 4, 4).
            tip: Whose target alone is moved, counted from 0.

        Raises:
            InvalidArgumentError: Another shape, not finite or not rigid; or no such
                tip.
        """
        self._check_tip(tip)
        poses = check_pose(pose)
        expected = self.targets[0] if tip is not None else self.target
        if poses.shape != expected.shape:
            reject("pose", f"expected shape {expected.shape}, got {poses.shape}")
        self.targets = self.targets.copy()
        self.targets[slice(None) if tip is None else tip] = poses
        self.solve()

    def set_task(self, name: str, tip: int | None = None) -> None:
        """Choose a task by one of the names in `tasks`, and solve for it.

        Args:
            name: Of the task.
            tip: Whose task it is, counted from 0; None: that of all tips.

        Raises:
            InvalidArgumentError: No such name, or no such tip.
        """
        self._check_tip(tip)
        if name not in self.tasks:
            reject("task", f"{name!r} is none of {', '.join(self.tasks)}")
        for one in range(self.robot.tips) if tip is None else [tip]:
            self.task_names[one] = name
        self.solve()

    def set_choice(self, name: str) -> None:
        """Choose which solution is taken, by one of CHOICES; look again if none is.

        Raises:
            InvalidArgumentError: No such name.
        """
        if name not in CHOICES:
            reject("choice", f"{name!r} is none of {', '.join(CHOICES)}")
        self.choice = name
        if not self.solved:
            self.solve()

    def solve(self) -> None:
        """Solve for all targets at once; which solution is taken, `choice` says."""
        if self.choice == "tracked":
            self._track()
            return
        started = time.perf_counter()
        result = self._search(**self._wishes())
        seconds = time.perf_counter() - started
        if result.q is not None:
            self.q = result.q
            self._ended(result.status, "", seconds)
            return
        if self.choice == "same branch" and self._search():  # wherever the robot is
            self._ended(result.status, reasons.OTHER_BRANCH, seconds)
            return
        alone = reasons.of_each_tip(self.solver, self.targets, self._chosen())
        if any(alone):
            reason = reasons.not_alone(self.robot.tip_links, alone)
            self._ended(result.status, reason, seconds, alone)
            return
        if self.robot.tips > 1:
            wishes = {**self._wishes(), "scene": None}
            without = self._search(**wishes) if self.scene is not None else result
            reason = reasons.of_all_tips(self.scene, without)
            self._ended(result.status, reason, seconds)
            return
        diagnosis = self.solver.diagnose(
            self.target, **self._given(), deadline=reasons.DEADLINE
        )
        if diagnosis.q_is_solution and diagnosis.q is not None:
            self.q = diagnosis.q
            self._ended(Status.solved, "", time.perf_counter() - started)
            return
        self._ended(result.status, reasons.words(diagnosis), seconds)

    def _track(self) -> None:
        """Move on towards all targets, as far as a Tracker goes."""
        if self.task_names != self._own_tasks:
            self._ended(Status.not_converged, OTHER_TASKS, None)
            return
        started = time.perf_counter()
        result = self._tracking.follow(self.q, self.target)
        seconds = time.perf_counter() - started
        if result.q is not None:
            self.q = result.q
        self._ended(result.status, words(result.status), seconds)

    def _search(self, **wishes: Any) -> Result:
        """An answer for all targets, if there is one to be found soon."""
        asked = {**self._given(), **self._hurry(), **wishes}
        return self.solver.solve(self.target, **asked)

    def _hurry(self) -> dict[str, Any]:
        """When a search ends; that of one tip, whose end is near, by itself."""
        return {"deadline": TIPS_DEADLINE} if self.robot.tips > 1 else {}

    def _given(self) -> dict[str, Any]:
        """The tasks and the scene, as keywords of Solver's methods."""
        return {"tasks": self._chosen(), "scene": self.scene}

    def _chosen(self) -> list[Task]:
        """The task of each tip."""
        return [self.tasks[name] for name in self.task_names]

    def _wishes(self) -> dict[str, Any]:
        """What solve() is asked for besides the targets and the tasks."""
        if self.choice == "nearest":
            return {"near": self.q}
        if self.choice == "same branch":
            return {"seeds": self.q, "database_seeds": False}
        return {}

    def branches(self) -> FloatArray:
        """Solutions of the targets, (n, dof) [rad or m], the robot's own first.

        All, or of robots that can move with all tips at rest a spread of them.
        """
        found = self.solver.solve_all(
            self.target, MOST_BRANCHES, near=self.q, **self._given(), **self._hurry()
        )
        return found.q

    @property
    def arcs(self) -> Arcs | None:
        """The self-motion at the one tip's target; None where it is not known."""
        if self.robot.tips > 1 or not self.tasks[self.task_names[0]].is_full_pose:
            return None
        if self._arcs is None:
            try:
                motion: SelfMotion = self.solver.self_motion(self.target, SPACING)
            except InvalidArgumentError:  # not an arm of which a joint is swept
                return None
            self._arcs = Arcs(self.robot, motion)
        return self._arcs

    def slide(self, share: float) -> None:
        """Move along the self-motion, from 0 (first arc's begin) to 1 (last's end)."""
        q = self.arcs.at(share) if self.arcs else None
        if q is not None:
            self.q = q
            self.status, self.reason, self.seconds = Status.solved, "", None

    @property
    def share(self) -> float:
        """Where along the self-motion the robot is, as slide() takes it."""
        return self.arcs.share(self.q) if self.arcs else 0.0

    def _check_tip(self, tip: int | None) -> None:
        if tip is not None and tip not in range(self.robot.tips):
            links = ", ".join(self.robot.tip_links)
            reject("tip", f"{tip} is no number of one of {links}, counted from 0")

    def _tips(self) -> FloatArray:
        """T_base_tcp of each tip, (tips, 4, 4), where the robot is."""
        return self.robot.fk(self.q).reshape(-1, 4, 4)

    def _ended(
        self,
        status: Status,
        reason: str,
        seconds: float | None,
        tip_reasons: list[str] | None = None,
    ) -> None:
        """Keep what came of the last request."""
        self.status = status
        self.reason = reason
        self.seconds = seconds
        self.tip_reasons = tip_reasons or [""] * self.robot.tips
        self._arcs = None
