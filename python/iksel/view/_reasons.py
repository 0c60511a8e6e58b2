# SPDX-License-Identifier: BSD-3-Clause
"""Why a robot is not at its targets, said soon enough while they are dragged."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from iksel_cpp import Diagnosis, Result, Scene, Solver, Task

    from iksel._base.arrays import FloatArray

DEADLINE = 0.1  # [s] of a diagnosis
OTHER_BRANCH = "the robot's branch does not go on to there; others have an answer"
TOGETHER = (
    "each tip can be at its target by itself, but nothing was found with all there: "
    "move or turn a target, or give a tip a task that leaves it free"
)
"""What is known so soon of several tips that are not at their targets."""


def words(diagnosis: Diagnosis) -> str:
    """What a diagnosis says."""
    certain = ", proven" if diagnosis.proven else ""
    return f"{diagnosis.cause.name}{certain}: {diagnosis.message}"


def not_alone(links: Sequence[str], reasons: Sequence[str]) -> str:
    """Which tips have a reason of their own, by their links."""
    lost = zip(links, reasons, strict=True)
    names = ", ".join(link for link, reason in lost if reason)
    return f"cannot be reached even by itself: {names}"


def of_all_tips(scene: Scene | None, without: Result) -> str:
    """Why there is no answer for several tips of which each can be there by itself.

    Args:
        scene: What answers keep free of.
        without: The answer that there is without the scene.
    """
    if scene is None or without.q is None:
        return TOGETHER
    for deepest in scene.contacts(without.q):
        return f"collision: {deepest.link} would touch {deepest.other}"
    return TOGETHER


def of_each_tip(
    solver: Solver, targets: FloatArray, tasks: Sequence[Task]
) -> list[str]:
    """Why the chain to each tip has no answer by itself, whatever is in its way.

    Args:
        solver: Of the robot.
        targets: T_base_tcp of each tip, (tips, 4, 4).
        tasks: What of each has to be reached.

    Returns:
        One for each tip; empty of those that can be there, and of a robot's only one.
    """
    reasons = [""] * len(targets)
    if len(targets) == 1:
        return reasons
    for tip, (pose, task) in enumerate(zip(targets, tasks, strict=True)):
        chain = solver.chain_solver(tip)
        if not chain.solve(pose, task=task):
            deadline = DEADLINE / len(targets)
            diagnosis = chain.diagnose(pose, task=task, deadline=deadline)
            reasons[tip] = "" if diagnosis.q_is_solution else words(diagnosis)
    return reasons
