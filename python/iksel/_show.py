# SPDX-License-Identifier: BSD-3-Clause
"""What repr() and notebooks show of the core's objects, which ask for it here."""

from __future__ import annotations

import html
import math
from typing import TYPE_CHECKING, Any

from iksel_cpp import ArcEnd, JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from iksel_cpp import (
        BatchResult,
        CoupledLimit,
        Result,
        Robot,
        RobotSpheres,
        SelfMotion,
        SelfMotionArc,
        SelfMotionEnd,
        Solutions,
    )

    from iksel._arrays import FloatArray

MOST_ROWS = 20
"""Rows that a table of many answers shows."""


def number(value: float, digits: int = 5) -> str:
    """0.0123, with at most so many significant digits."""
    return f"{value:.{digits}g}"


def numbers(values: Iterable[float]) -> str:
    """[0.3, -1.2, 1.5], rounded."""
    return f"[{', '.join(map(number, values))}]"


def verdict(answer: Result | Solutions | SelfMotion) -> str:
    """Status, and what proves that there is no answer: not_converged, proven: reach."""
    is_proven = str(answer.proof) in {"reach", "target", "closed_form"}
    proof = f", proven: {answer.proof}" if is_proven and not answer.success else ""
    return f"{answer.status}{proof}"


def end_of(arc: SelfMotionEnd) -> str:
    """What ends an arc: joint 3 at its upper limit."""
    if arc.kind != ArcEnd.limit:
        return str(arc.kind)
    what = "joint" if arc.coupled_limit < 0 else "sum"
    which = (arc.joint if arc.coupled_limit < 0 else arc.coupled_limit) + 1
    return f"{what} {which} at its {'upper' if arc.at_upper else 'lower'} limit"


def arguments(limit: CoupledLimit) -> str:
    """Those of its constructor that are not at their default."""
    lower = "" if limit.lower == -math.inf else f", lower={limit.lower!r}"
    upper = "" if limit.upper == math.inf else f", upper={limit.upper!r}"
    return f"({limit.coefficients}{lower}{upper})"


def chain(robot: Robot) -> str:
    """The robot's name and links."""
    tips = f"tip_links={robot.tip_links}" if robot.tips > 1 else ""
    tip = tips or f"tip_link='{robot.tip_link}'"
    return f"({robot.name!r}, dof={robot.dof}, base_link='{robot.base_link}', {tip})"


def answer(result: Result) -> str:
    """Status, joint values and work."""
    q = errors = ""
    if result.q is not None:
        position = number(result.position_error, 3)
        rotation = number(result.rotation_error, 3)
        q = f", q={numbers(result.q)}"
        errors = f", position_error={position}, rotation_error={rotation}"
    work = f"attempts={result.attempts}, iterations={result.iterations}"
    return f"({verdict(result)}{q}{errors}, {work})"


def ends(arc: SelfMotionArc) -> str:
    """How an arc ends."""
    way = f"from {end_of(arc.begin)} to {end_of(arc.end)}"
    return "closed" if arc.is_closed else way


def span(q: FloatArray) -> str:
    """Where a curve begins and ends."""
    return f", q={number(q[0])}..{number(q[-1])}" if len(q) else ""


def count_spheres(self: RobotSpheres) -> int:
    """All of them."""
    return sum(map(len, self.links.values()))


# What stands behind the name of the class.
TEXTS: dict[str, Callable[[Any], str]] = {
    "Robot": chain,
    "LinkTreeJoint": lambda s: (
        f"('{s.name}', {s.type}, '{s.parent_link}' -> '{s.child_link}')"
    ),
    "LinkTree": lambda s: (
        f"({s.robot_name!r}, {len(s.links)} links, {len(s.tips)} tips)"
    ),
    "CoupledLimit": arguments,
    "MimicCurve": lambda s: (
        f"({s.joint!r}, {s.follows!r}, {len(s.q)} points{span(s.q)})"
    ),
    "Structure": lambda s: f"({s.kind}: {s.description})",
    "Database": lambda s: f"({s.size} samples, dof={s.dof}, {s.options!r})",
    "Selector": lambda s: f"({s.database!r})",
    "Solver": lambda s: f"({s.robot!r}, {s.options!r})",
    "Objective": lambda s: f"({s.kind})",
    "Tracker": lambda s: f"({s.__getstate__()['solver'].robot!r}, q={numbers(s.q)})",
    "Contact": lambda s: f"('{s.link}', '{s.other}', depth={number(s.depth)})",
    "Obstacle": lambda s: f"({s.shape})",
    "RobotSpheres": lambda s: (
        f"({count_spheres(s)} on {len(s.links)} links, {len(s.pairs)} pairs)"
    ),
    "Scene": lambda s: (
        f"({s.robot!r}, {len(s.obstacles)} obstacles, {len(s.attached)} attached)"
    ),
    "Result": answer,
    "Solutions": lambda s: (
        f"({verdict(s)}, {len(s)} solutions"
        f"{f', best q={numbers(s[0].q)}' if len(s) else ''})"
    ),
    "BatchResult": lambda s: f"({s.solved} of {len(s)} solved)",
    "PathResult": lambda s: (
        f"({s.status}, {len(s.q)} waypoints"
        f"{'' if s else f', first_unreachable={s.first_unreachable}'})"
    ),
    "Diagnosis": lambda s: f"({s.cause}: {s.message})",
    "SelfMotionEnd": lambda s: f"({end_of(s)})",
    "SelfMotionArc": lambda s: (
        f"({len(s)} configurations, length {number(s.length, 3)}, {ends(s)})"
    ),
    "SelfMotion": lambda s: f"({verdict(s)}, {len(s)} arcs)",
}


def text(name: str, self: Any) -> str:
    """What repr() shows of an object of the core's class of that name."""
    return f"{name}{TEXTS[name](self)}"


def table(caption: str, header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A small table of HTML, whatever text it is given."""

    def row(cells: Sequence[str], tag: str) -> str:
        tagged = (f"<{tag}>{html.escape(each)}</{tag}>" for each in cells)
        return f"<tr>{''.join(tagged)}</tr>"

    body = "".join(row(cells, "td") for cells in rows)
    return (
        f"<table><caption>{html.escape(caption)}</caption><thead>{row(header, 'th')}"
        f"</thead><tbody>{body}</tbody></table>"
    )


def first_rows(answers: Solutions | BatchResult, cells: Any) -> list[list[str]]:
    """Cells of the first answers, and how many more there are."""
    shown = min(len(answers), MOST_ROWS)
    rows = [[str(i), *cells(answers[i])] for i in range(shown)]
    rest = len(answers) - shown
    return [*rows, [f"... and {rest} more"]] if rest else rows


def robot_page(self: Robot) -> str:
    """A table of the joints."""
    rows = [
        [
            self.joint_names[i],
            f"{kind} {'[m]' if kind == JointType.prismatic else '[rad]'}",
            *(
                number(each[i])
                for each in (self.lower, self.upper, self.velocity_limit)
            ),
        ]
        for i, kind in enumerate(self.joint_types)
    ]
    caption = f"{self.name}: {self.base_link} to {', '.join(self.tip_links)}"
    return table(caption, ["joint", "type", "lower", "upper", "velocity limit"], rows)


def result_page(self: Result) -> str:
    """A table of what it says."""
    rows = []
    if self.q is not None:
        rows += [
            ("q", numbers(self.q)),
            ("position error [m]", number(self.position_error, 3)),
            ("rotation error [rad]", number(self.rotation_error, 3)),
        ]
    rows += [] if self else [("proof", str(self.proof))]
    rows += [("attempts", str(self.attempts)), ("iterations", str(self.iterations))]
    return table("Result", ["status", str(self.status)], rows)


def batch_page(self: BatchResult) -> str:
    """A table of the first answers."""

    def cells(each: Result) -> list[str]:
        q = ["", "", ""]
        if each.q is not None:
            errors = (each.position_error, each.rotation_error)
            q = [numbers(each.q), *(number(x, 3) for x in errors)]
        proof = "" if each else str(each.proof)
        return [str(each.status), proof, *q, str(each.attempts), str(each.iterations)]

    header = ["", "status", "proof", "q", "position error [m]", "rotation error [rad]"]
    caption = f"{self.solved} of {len(self)} solved"
    return table(caption, [*header, "attempts", "iterations"], first_rows(self, cells))


def solutions_page(self: Solutions) -> str:
    """A table of the first solutions."""

    def cells(each: Result) -> list[str]:
        errors = (each.position_error, each.rotation_error, each.move)
        q = () if each.q is None else each.q
        return [*map(number, q), *(number(x, 3) for x in errors)]

    joints = [f"q[{i}]" for i in range(self.q.shape[1])]
    header = ["", *joints, "position error [m]", "rotation error [rad]", "move"]
    return table(
        f"{len(self)} solutions, {verdict(self)}", header, first_rows(self, cells)
    )


PAGES: dict[str, Callable[[Any], str]] = {
    "Robot": robot_page,
    "Result": result_page,
    "BatchResult": batch_page,
    "Solutions": solutions_page,
}


def page(name: str, self: Any) -> str:
    """What notebooks show."""
    return PAGES[name](self)
