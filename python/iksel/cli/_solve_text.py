# SPDX-License-Identifier: BSD-3-Clause
"""Answers and diagnoses for people."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from iksel.cli._output import number, print_pairs, print_table
from iksel.cli._robot import chain_text
from iksel.cli.info import pose_text

if TYPE_CHECKING:
    from iksel_cpp import Diagnosis, Result, Robot, Solutions

    from iksel._base.arrays import FloatArray
    from iksel.cli._angles import Angles


def diagnosis_report(
    robot: Robot, diagnosis: Diagnosis, angles: Angles
) -> dict[str, Any]:
    """The fields of a diagnosis; joints by name."""
    joint, coupled = diagnosis.joint, diagnosis.coupled_limit
    return {
        "cause": diagnosis.cause.name,
        "message": diagnosis.message,
        "proof": diagnosis.proof.name,
        "beyond_reach": diagnosis.beyond_reach,
        "rotation_gap": diagnosis.rotation_gap,
        "joint": robot.joint_names[joint] if joint >= 0 else None,
        "coupled_limit": str(robot.coupled_limits[coupled]) if coupled >= 0 else None,
        "limit_violation": diagnosis.limit_violation,
        "branch": angles.show_optional(robot, diagnosis.branch),
        "least_singular_value": diagnosis.least_singular_value,
        "best_effort_q": angles.show_optional(robot, diagnosis.q),
        "best_effort_is_solution": diagnosis.q_is_solution,
        "best_effort_position_error": diagnosis.position_error,
        "best_effort_rotation_error": diagnosis.rotation_error,
    }


def print_diagnosis(robot: Robot, diagnosis: Diagnosis) -> None:
    """Print the reason of a failure for people, and the best effort."""
    print()
    print_pairs([("cause", diagnosis.cause.name), ("", diagnosis.message)])
    if diagnosis.q is None:
        return
    note = "an answer" if diagnosis.q_is_solution else "NO SOLUTION"
    print()
    print(
        f"best effort ({note}): off by {diagnosis.position_error:.3g} m, "
        f"{diagnosis.rotation_error:.3g} rad"
    )
    print_joints(robot, diagnosis.q.tolist())


def target_rows(robot: Robot, target: FloatArray) -> list[tuple[str, str]]:
    """The target of the one tip, or of each."""
    if robot.tips == 1:
        return [("target", pose_text(target))]
    return [
        (f"target of {link}", pose_text(pose))
        for link, pose in zip(robot.tip_links, target, strict=True)
    ]


def print_text(robot: Robot, result: Result, report: dict[str, Any]) -> None:
    """Print the answer for people."""
    rows = [
        ("robot", chain_text(robot)),
        *target_rows(robot, report["target"]),
        ("status", result.status.name),
        *proof_row(result),
        ("attempts", str(result.attempts)),
        ("iterations", str(result.iterations)),
        ("time", f"{number(report['time_us'], 1)} us"),
    ]
    if result.q is not None:
        rows += [
            ("position error", f"{result.position_error:.3g} m"),
            ("rotation error", f"{result.rotation_error:.3g} rad"),
        ]
    if math.isfinite(result.cost):
        rows.append(("cost", f"{result.cost:.6g}"))
    if math.isfinite(result.move):
        rows.append(("joint move", f"{result.move:.4g} rad or m"))
    print_pairs(rows)
    if result.q is None:
        return
    print()
    print_joints(robot, result.q.tolist())


def proof_row(answer: Result | Solutions) -> list[tuple[str, str]]:
    """What is certain, in a row; none where nothing is."""
    if not answer.proven:
        return []
    certain = "these are all" if answer.success else "there is no solution"
    return [("proof", f"{answer.proof.name}: certainly {certain}")]


def print_configurations(robot: Robot, q: FloatArray, angles: Angles) -> None:
    """Print joint values (N, dof) [rad or m] as a table, one configuration a row."""
    print(f"joint values [{angles.unit} or m]")
    rows = angles.show(robot, q).tolist()
    print_table(robot.joint_names, [[number(x, 6) for x in row] for row in rows])


def print_joints(robot: Robot, q: list[float]) -> None:
    """Print joint values as a table."""
    print_table(
        ("joint", "rad or m", "deg"),
        [
            (
                name,
                number(value, 9),
                "" if kind.name == "prismatic" else number(math.degrees(value), 4),
            )
            for name, kind, value in zip(
                robot.joint_names, robot.joint_types, q, strict=True
            )
        ],
    )
