# SPDX-License-Identifier: BSD-3-Clause
"""The panel beside the scene: what is going on in words, and what can be set."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import JointType

from iksel._limits import violated_limits
from iksel._qualities import limit_distance, manipulability
from iksel.view.session import CHOICES

if TYPE_CHECKING:
    from collections.abc import Callable

    from iksel.view.session import Session

STEP = 1e-4  # of the sliders


class Controls:
    """Sliders, switches and the text."""

    def __init__(self, gui: Any, session: Session) -> None:
        """Take viser's GUI and what is shown."""
        self._session = session
        robot = session.robot
        gui.configure_theme(dark_mode=False, show_logo=False, show_share_button=False)
        self.text = gui.add_markdown("")
        names = list(session.tasks)
        self.task = gui.add_dropdown("task", names, initial_value=session.task_name)
        self.choice = gui.add_dropdown(
            "solution",
            CHOICES,
            initial_value=session.choice,
            hint="nearest to where the robot is; of the same branch or none; any",
        )
        self.ghosts = gui.add_checkbox(
            "all branches", initial_value=False, hint="show all solutions as ghosts"
        )
        self.motion: Any = None
        if session.motion is not None:
            self.motion = gui.add_slider(
                "self-motion", min=0.0, max=1.0, step=STEP, initial_value=0.0
            )
        self.meshes = gui.add_checkbox(
            "meshes",
            initial_value=True,
            visible=False,
            hint="show the links as their URDF does",
        )
        self.note = ""  # below the text
        self.map = gui.add_checkbox("map", initial_value=True, visible=False)
        self.cut = gui.add_checkbox(
            "map cut open", initial_value=True, visible=False, hint="leave out y < 0"
        )
        self._turns = np.array([k != JointType.prismatic for k in robot.joint_types])
        self._endless = self._turns & ~np.isfinite(robot.upper - robot.lower)
        self._lower = np.where(self._endless, -np.pi, robot.lower)
        self._upper = np.where(self._endless, np.pi, robot.upper)
        with gui.add_folder("joints"):
            self.joints = [
                gui.add_slider(
                    f"{name} [{'rad' if turns else 'm'}]",
                    min=float(low),
                    max=float(high),
                    step=STEP,
                    initial_value=float(value),
                )
                for name, turns, low, high, value in zip(
                    robot.joint_names,
                    self._turns,
                    self._lower,
                    self._upper,
                    self._values(),
                    strict=True,
                )
            ]

    def inputs(self) -> list[Any]:
        """Everything that can be set, but the sliders."""
        return [
            self.task,
            self.choice,
            self.ghosts,
            self.meshes,
            self.map,
            self.cut,
        ]

    def on_change(self, listen: Callable[[Any], Any]) -> None:
        """Call `listen` with the handle that a user has changed."""
        sliders = [*self.joints, *([self.motion] if self.motion else [])]
        for handle in [*self.inputs(), *sliders]:
            handle.on_update(lambda event: listen(event.target))

    def draw(self, source: Any = None, solutions: int | None = None) -> None:
        """Show where the robot is, and how it got there.

        Args:
            source: The handle that a user is just moving, which is left as it is.
            solutions: How many the target has; None: not asked.
        """
        self.text.content = describe(self._session, solutions) + self.note
        for slider, value in zip(self.joints, self._values(), strict=True):
            if slider is not source:
                slider.value = float(value)
        if self.motion:
            self.motion.disabled = not self._session.motion
            if self.motion is not source:
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
        lines = [f"**no answer** ({1e3 * (session.seconds or 0):.3f} ms)"]
        lines.append(session.reason)
    if solutions is not None:
        lines.append(f"solutions: {solutions}")
    lines.append(f"manipulability: {manipulability(robot, q)[0]:.4g}")
    lines.append(nearest_limit(session))
    if session.motion is not None:
        lines.append(f"self-motion: {session.arc}")
    return "\n\n".join(lines)


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
    return (
        f"nearest limit: {robot.joint_names[joint]}, {gaps[joint]:.3g} off "
        f"({100 * share:.0f} % of its range)"
    )
