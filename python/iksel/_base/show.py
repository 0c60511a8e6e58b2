# SPDX-License-Identifier: BSD-3-Clause
"""What repr() and notebooks show of the core's objects, which ask for it here."""

from __future__ import annotations

import html
import math
from typing import TYPE_CHECKING, Any

from iksel_cpp import ArcEnd, JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

MOST_ROWS = 20
"""Rows that a table of many answers shows."""


def text(name: str, self: Any) -> str:
    """What repr() shows of an object of the core's class of that name."""
    return f"{name}({TEXTS[name](self)})"


def page(name: str, self: Any) -> str:
    """What notebooks show of it, a table in HTML."""
    caption, header, rows = PAGES[name](self)
    body = "".join(_row(cells, "td") for cells in rows)
    return (
        f"<table><caption>{html.escape(caption)}</caption><thead>{_row(header, 'th')}"
        f"</thead><tbody>{body}</tbody></table>"
    )


def _short(value: float, digits: int = 5) -> str:
    return f"{value:.{digits}g}"


def _numbers(values: Iterable[float]) -> str:
    return f"[{', '.join(map(_short, values))}]"


def _errors(result: Any) -> list[str]:
    return [_short(x, 3) for x in (result.position_error, result.rotation_error)]


def _verdict(answer: Any) -> str:
    """Status, and what proves that there is no answer: not_converged, proven: reach."""
    proof = f", proven: {answer.proof}" if answer.proven and not answer.success else ""
    return f"{answer.status}{proof}"


def _result(s: Any) -> str:
    position, rotation = _errors(s)
    errors = f"position_error={position}, rotation_error={rotation}"
    q = "" if s.q is None else f", q={_numbers(s.q)}, {errors}"
    return f"{_verdict(s)}{q}, attempts={s.attempts}, iterations={s.iterations}"


def _solutions(s: Any) -> str:
    best = f", best q={_numbers(s[0].q)}" if len(s) else ""
    return f"{_verdict(s)}, {len(s)} solutions{best}"


def _path(s: Any) -> str:
    first = "" if s else f", first_unreachable={s.first_unreachable}"
    return f"{s.status}, {len(s.q)} waypoints{first}"


def _limit(s: Any) -> str:
    lower = "" if s.lower == -math.inf else f", lower={s.lower!r}"
    upper = "" if s.upper == math.inf else f", upper={s.upper!r}"
    return f"{s.coefficients}{lower}{upper}"


def _curve(s: Any) -> str:
    q = f", q={_short(s.q[0])}..{_short(s.q[-1])}" if len(s.q) else ""
    return f"{s.joint!r}, {s.follows!r}, {len(s.q)} points{q}"


def _robot(s: Any) -> str:
    tip = f"tip_links={s.tip_links}" if s.tips > 1 else f"tip_link='{s.tip_link}'"
    return f"{s.name!r}, dof={s.dof}, base_link='{s.base_link}', {tip}"


def _spheres(s: Any) -> str:
    count = sum(map(len, s.links.values()))
    return f"{count} on {len(s.links)} links, {len(s.pairs)} pairs"


def _end(s: Any) -> str:
    if s.kind != ArcEnd.limit:
        return str(s.kind)
    what, i = ("joint", s.joint) if s.coupled_limit < 0 else ("sum", s.coupled_limit)
    return f"{what} {i + 1} at its {'upper' if s.at_upper else 'lower'} limit"


def _arc(s: Any) -> str:
    ends = "closed" if s.is_closed else f"from {_end(s.begin)} to {_end(s.end)}"
    return f"{len(s)} configurations, length {_short(s.length, 3)}, {ends}"


TEXTS: dict[str, Callable[[Any], str]] = {
    "BatchResult": lambda s: f"{s.solved} of {len(s)} solved",
    "Contact": lambda s: f"'{s.link}', '{s.other}', depth={_short(s.depth)}",
    "CoupledLimit": _limit,
    "Database": lambda s: f"{s.size} samples, dof={s.dof}, {s.options!r}",
    "Diagnosis": lambda s: f"{s.cause}: {s.message}",
    "LinkTree": lambda s: f"{s.robot_name!r}, {len(s.links)} links, {len(s.tips)} tips",
    "LinkTreeJoint": lambda s: (
        f"'{s.name}', {s.type}, '{s.parent_link}' -> '{s.child_link}'"
    ),
    "MimicCurve": _curve,
    "Objective": lambda s: str(s.kind),
    "Obstacle": lambda s: str(s.shape),
    "PathResult": _path,
    "Result": _result,
    "Robot": _robot,
    "RobotSpheres": _spheres,
    "Scene": lambda s: (
        f"{s.robot!r}, {len(s.obstacles)} obstacles, {len(s.attached)} attached"
    ),
    "Selector": lambda s: repr(s.database),
    "SelfMotion": lambda s: f"{_verdict(s)}, {len(s)} arcs",
    "SelfMotionArc": _arc,
    "SelfMotionEnd": _end,
    "Solutions": _solutions,
    "Solver": lambda s: f"{s.robot!r}, {s.options!r}",
    "Structure": lambda s: f"{s.kind}: {s.description}",
    "Tracker": lambda s: f"{s.__getstate__()['solver'].robot!r}, q={_numbers(s.q)}",
}

Table = tuple[str, "Sequence[str]", "Iterable[Sequence[str]]"]


def _row(cells: Sequence[str], tag: str) -> str:
    tagged = (f"<{tag}>{html.escape(each)}</{tag}>" for each in cells)
    return f"<tr>{''.join(tagged)}</tr>"


def _first_rows(answers: Any, cells: Callable[[Any], list[str]]) -> list[list[str]]:
    """Cells of the first answers, and how many more there are."""
    shown = min(len(answers), MOST_ROWS)
    rows = [[str(i), *cells(answers[i])] for i in range(shown)]
    rest = len(answers) - shown
    return [*rows, [f"... and {rest} more"]] if rest else rows


def _robot_table(s: Any) -> Table:
    columns = zip(
        s.joint_names, s.joint_types, s.lower, s.upper, s.velocity_limit, strict=True
    )
    rows = [
        [name, f"{kind} {'[m]' if kind == JointType.prismatic else '[rad]'}"]
        + [_short(x) for x in limits]
        for name, kind, *limits in columns
    ]
    caption = f"{s.name}: {s.base_link} to {', '.join(s.tip_links)}"
    return caption, ["joint", "type", "lower", "upper", "velocity limit"], rows


def _result_table(s: Any) -> Table:
    names = ("position error [m]", "rotation error [rad]")
    q = (
        []
        if s.q is None
        else [("q", _numbers(s.q)), *zip(names, _errors(s), strict=True)]
    )
    proof = [] if s else [("proof", str(s.proof))]
    work = [("attempts", str(s.attempts)), ("iterations", str(s.iterations))]
    return "Result", ["status", str(s.status)], [*q, *proof, *work]


def _batch_table(s: Any) -> Table:
    def cells(each: Any) -> list[str]:
        q = ["", "", ""] if each.q is None else [_numbers(each.q), *_errors(each)]
        proof = "" if each else str(each.proof)
        return [str(each.status), proof, *q, str(each.attempts), str(each.iterations)]

    header = ["", "status", "proof", "q", "position error [m]", "rotation error [rad]"]
    caption = f"{s.solved} of {len(s)} solved"
    return caption, [*header, "attempts", "iterations"], _first_rows(s, cells)


def _solutions_table(s: Any) -> Table:
    joints = [f"q[{i}]" for i in range(s.q.shape[1])]
    header = ["", *joints, "position error [m]", "rotation error [rad]", "move"]
    rows = _first_rows(
        s, lambda each: [*map(_short, each.q), *_errors(each), _short(each.move, 3)]
    )
    return f"{len(s)} solutions, {_verdict(s)}", header, rows


PAGES: dict[str, Callable[[Any], Table]] = {
    "BatchResult": _batch_table,
    "Result": _result_table,
    "Robot": _robot_table,
    "Solutions": _solutions_table,
}
