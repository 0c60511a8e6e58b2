# SPDX-License-Identifier: BSD-3-Clause
"""The panel beside the scene: what is going on in words, and what can be set."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import JointType, Status

from iksel._base.limits import violated_limits
from iksel._base.qualities import limit_distance, manipulability
from iksel.view._numbers import DEGREES, UNITS, Numbers
from iksel.view.scene import RAMP
from iksel.view.session import CHOICES, MOST_BRANCHES

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from iksel.view.session import Session

DECIMALS = 3  # of the self-motion's slider
DECIMALS_OF = {"°": 1, "rad": 3, "m": 3}
"""Of the joints' sliders, by unit. Their fields have room for six characters."""


class Controls:
    """Sliders, switches, numbers to copy and type, and the text."""

    def __init__(self, gui: Any, session: Session) -> None:
        """Take viser's GUI and what is shown."""
        self._session = session
        look = {"show_logo": False, "show_share_button": False}
        # Beside the picture, not in front of it; older viser has another name for that.
        if hasattr(gui, "main_panel"):
            gui.configure_theme(control_width="large", **look)
            gui.main_panel.dock_right()
        else:
            gui.configure_theme(
                control_width="large", control_layout="collapsible", **look
            )
        self.text = gui.add_markdown("")
        self.note = ""  # below the text
        self._add_switches(gui)
        self._add_map(gui)
        self._add_joints(gui)
        with gui.add_folder("copy or type"):
            self.numbers = Numbers(gui, session)

    def _add_switches(self, gui: Any) -> None:
        session = self._session
        of = [""] if session.robot.tips == 1 else session.robot.tip_links
        self.tasks = [
            gui.add_dropdown(
                f"task {link}".strip(),
                list(session.tasks),
                initial_value=name,
                hint="what of the target has to be reached",
            )
            for link, name in zip(of, session.task_names, strict=True)
        ]
        self.choice = gui.add_dropdown(
            "solution",
            CHOICES,
            initial_value=session.choice,
            hint="nearest to where the robot is; of the same branch or none; tracked "
            "as in a control loop, as near as it gets; any: the first that is found",
        )
        self.ghosts = gui.add_checkbox(
            "all branches",
            initial_value=False,
            hint=f"show all solutions, or a spread of {MOST_BRANCHES}, as ghosts",
        )
        self.motion: Any = None
        if session.arcs is not None:
            self.motion = gui.add_slider(
                "self-motion",
                min=0.0,
                max=1.0,
                step=10.0**-DECIMALS,
                initial_value=0.0,
                hint="move the arm while its tool rests at the target",
            )
        self.meshes = gui.add_checkbox(
            "meshes",
            initial_value=True,
            visible=False,
            hint="show the links as their URDF does",
        )

    def _add_map(self, gui: Any) -> None:
        """Add what belongs to a reachability map; shown with one."""
        self.map = gui.add_checkbox("map", initial_value=True, visible=False)
        self.cut = gui.add_checkbox(
            "map cut open", initial_value=True, visible=False, hint="leave out y < 0"
        )
        self.legend = gui.add_html(legend(), visible=False)

    def _add_joints(self, gui: Any) -> None:
        robot = self._session.robot
        self._turns = np.array([k != JointType.prismatic for k in robot.joint_types])
        self._endless = self._turns & ~np.isfinite(robot.upper - robot.lower)
        self._lower = np.where(self._endless, -np.pi, robot.lower)
        self._upper = np.where(self._endless, np.pi, robot.upper)
        with gui.add_folder("joints"):
            self.unit = gui.add_dropdown("angles", UNITS, initial_value=DEGREES)
            self.joints = [
                gui.add_slider(name, min=0.0, max=1.0, step=0.1, initial_value=0.0)
                for name in robot.joint_names
            ]
        self.set_unit()

    @property
    def _scales(self) -> np.ndarray[Any, Any]:
        """What a joint's value [rad or m] is multiplied by to be shown, (dof,)."""
        angle = np.rad2deg(1.0) if self.unit.value == DEGREES else 1.0
        return np.where(self._turns, angle, 1.0)

    def set_unit(self) -> None:
        """Give the sliders the unit that is chosen."""
        sign = "°" if self.unit.value == DEGREES else "rad"
        for slider, turns, scale, low, high, value, name in zip(
            self.joints,
            self._turns,
            self._scales,
            self._lower,
            self._upper,
            self._values(),
            self._session.robot.joint_names,
            strict=True,
        ):
            unit = sign if turns else "m"
            slider.precision = DECIMALS_OF[unit]
            step = 10.0**-slider.precision
            slider.label = name if turns else f"{name} [m]"
            # Outwards to whole steps, but for rounding: they have few digits.
            lowest = np.floor(low * scale / step + 1e-3) * step
            highest = np.ceil(high * scale / step - 1e-3) * step
            slider.min = round(float(lowest), slider.precision)
            slider.max = round(float(highest), slider.precision)
            slider.step = step
            slider.value = float(value * scale)

    def joint_value(self, joint: int) -> float:
        """Where a joint's slider is, inside the limits [rad or m]."""
        value = self.joints[joint].value / self._scales[joint]
        return float(np.clip(value, self._lower[joint], self._upper[joint]))

    @property
    def of_map(self) -> list[Any]:
        """What is shown with a map only."""
        return [self.map, self.cut, self.legend]

    def inputs(self) -> list[Any]:
        """Everything that can be set, but the sliders."""
        return [
            *self.tasks,
            self.choice,
            self.ghosts,
            self.meshes,
            self.map,
            self.cut,
            self.unit,
        ]

    def on_change(self, listen: Callable[[Any], Any]) -> None:
        """Call `listen` with the handle that a user has changed."""
        sliders = [*self.joints, *([self.motion] if self.motion else [])]
        for handle in [*self.inputs(), *sliders]:
            handle.on_update(lambda event: listen(event.target))
        for button in self.numbers.buttons:
            button.on_click(lambda event: listen(event.target))

    def apply(self, handle: Any) -> None:
        """Do to the session what a handle that has been changed says."""
        session = self._session
        if handle is self.choice:
            session.set_choice(handle.value)
        elif handle in self.tasks:
            session.set_task(handle.value, self.tasks.index(handle))
        elif handle is self.motion:
            session.slide(handle.value)
        elif handle in self.joints:
            joint = self.joints.index(handle)
            session.move_joint(joint, self.joint_value(joint))

    def draw(self, held: Sequence[Any] = (), solutions: int | None = None) -> None:
        """Show where the robot is, and how it got there.

        Args:
            held: The handles that a user is just moving, which are left as they are.
            solutions: How many the target has; None: not asked.
        """
        self.text.content = describe(self._session, solutions) + self.note
        shown = self._values() * self._scales
        for slider, value in zip(self.joints, shown, strict=True):
            if slider not in held:  # the page would write what is next to 0 as -0.0
                slider.value = float(value) if abs(value) > slider.step / 2 else 0.0
        self.numbers.draw(degrees=self.unit.value == DEGREES)
        if self.motion:
            self.motion.disabled = not self._session.arcs
            if self.motion not in held:
                self.motion.value = self._session.share

    def _values(self) -> np.ndarray[Any, Any]:
        """Joint values that sliders can show: turns of endless joints taken off."""
        q = self._session.q
        turned = (q + np.pi) % (2 * np.pi) - np.pi
        shown = np.where(self._endless, turned, q)
        return np.asarray(np.clip(shown, self._lower, self._upper))


def describe(session: Session, solutions: int | None = None) -> str:
    """What is going on, in Markdown.

    Args:
        session: What is shown.
        solutions: How many the target has; None: not asked.
    """
    robot, q = session.robot, session.q[None]
    if session.solved:
        took = "" if session.seconds is None else f" in {1e3 * session.seconds:.3f} ms"
        lines = [f"**solved**{took}"]
    else:
        what = "closest" if session.status == Status.closest else "no answer"
        lines = [f"**{what}** ({1e3 * (session.seconds or 0):.3f} ms)"]
        lines.append(session.reason)
    if robot.tips > 1:
        lines.append("\n".join(f"- {line}" for line in tip_lines(session)))
    for deepest in session.scene.contacts(q[0])[:1] if session.scene else ():
        lines.append(f"**in collision**: {deepest.link} touches {deepest.other}")
    if solutions is not None:
        more = " or more" if solutions == MOST_BRANCHES else ""
        lines.append(f"solutions: {solutions}{more}")
    lines.append(f"manipulability: {manipulability(robot, q)[0]:.4g}")
    lines.append(nearest_limit(session))
    if session.arcs is not None:
        lines.append(f"self-motion: {session.arcs.words(session.q)}")
    elif robot.tips > 1:
        lines.append("self-motion: shown of robots with one tip only")
    return "\n\n".join(lines)


def tip_lines(session: Session) -> list[str]:
    """Of each tip whether it is at its target, else how far away, and why alone."""
    lines = []
    for link, task, distance, angle, reason in zip(
        session.robot.tip_links,
        session.task_names,
        *session.errors(),
        session.tip_reasons,
        strict=True,
    ):
        state = f"{1e3 * distance:.1f} mm"
        if session.tasks[task].is_full_pose:
            state += f", {np.rad2deg(angle):.1f}°"
        state = "at its target" if session.solved else f"{state} away"
        lines.append(f"**{link}**: {state}" + (f"; {reason}" if reason else ""))
    return lines


def nearest_limit(session: Session) -> str:
    """Which joint is nearest to a limit, by the share of its range."""
    robot, q = session.robot, session.q
    if not robot.within_limits(q):
        return f"**outside the limits**: {', '.join(violated_limits(robot, q))}"
    ranges = robot.upper - robot.lower
    limited = np.isfinite(ranges) & (ranges > 0)
    if not limited.any():
        return "limits: none"
    gaps = np.minimum(q - robot.lower, robot.upper - q)
    shares = np.where(limited, gaps / np.where(limited, ranges, 1.0), np.inf)
    joint = int(np.argmin(shares))
    share = limit_distance(robot, q[None])[0]
    slides = robot.joint_types[joint] == JointType.prismatic
    gap = f"{gaps[joint]:.3g} m" if slides else f"{np.rad2deg(gaps[joint]):.3g}°"
    return (
        f"nearest limit: {robot.joint_names[joint]}, {gap} off "
        f"({100 * share:.0f} % of its range)"
    )


def legend() -> str:
    """What the colours of a map mean, in HTML."""
    stops = ", ".join(f"rgb({r:.0f}, {g:.0f}, {b:.0f})" for r, g, b in RAMP)
    return (
        '<div style="padding: 0 0.75em 0.5em; font-size: 0.8em">'
        f'<div style="height: 0.9em; background: linear-gradient(to right, {stops})">'
        '</div><div style="display: flex; justify-content: space-between">'
        "<span>few</span><span>orientations reached</span><span>all</span></div></div>"
    )
