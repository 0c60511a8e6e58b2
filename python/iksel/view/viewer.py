# SPDX-License-Identifier: BSD-3-Clause
"""The viewer: a session, what is drawn of it, and what users do to it."""

from __future__ import annotations

import contextlib
import threading
import time
from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import InvalidArgumentError, PathResult

from iksel._base import extras
from iksel._base.arrays import as_floats, reject
from iksel.view._camera import look_at
from iksel.view._maps import check_map
from iksel.view._obstacles import corners
from iksel.view._page import Page
from iksel.view._server import start
from iksel.view.controls import Controls
from iksel.view.scene import Scene
from iksel.view.session import Session
from iksel.view.skeleton import Skeleton
from iksel.view.visuals import read_pieces

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    import iksel_cpp
    import numpy.typing as npt
    from iksel_cpp import Solver

    from iksel.description import Source
    from iksel.formats._packages import Packages
    from iksel.pose import PoseLike
    from iksel.reach import Map

PORT = 8080
"""Where a viewer is served unless another port is given."""
LIMIT_MARGIN = 1e-3  # [rad or m]; a joint that near to a limit is shown as at it


class Viewer(Page):
    """A robot in the browser, served until close() or the end of the program.

    The robot follows a target, or one for each of its tips, that is dragged in the
    browser or moved by move_target(); sliders turn its joints. Every method may be
    called from any thread. Pages of other sites are refused, but for `origins`.
    """

    def __init__(
        self,
        solver: Solver,
        *,
        urdf: Source | None = None,
        packages: Packages | None = None,
        xacro_args: Mapping[str, str] | None = None,
        trusted: bool = False,
        scene: iksel_cpp.Scene | None = None,
        port: int = PORT,
        host: str = "127.0.0.1",
        origins: Iterable[str] = (),
    ) -> None:
        """Start to serve.

        Args:
            solver: What solves; its robot and task are shown.
            urdf: Where the robot is from, as load_robot() takes it: its links are shown
                as their visual geometry. Without, or where a URDF has none, they are
                bars; what cannot be read of it is in `lost`.
            packages: Folders of package:// names of meshes; others are looked for
                around the file, in $ROS_PACKAGE_PATH and $AMENT_PREFIX_PATH.
            xacro_args: Values of a xacro file's arguments.
            trusted: Whether a xacro file may run whatever Python it contains.
            scene: What answers may not collide with; its obstacles are shown.
            port: Where to serve; the next free one if another program has it.
            host: Address to listen at: by default only this machine can look;
                "0.0.0.0" for all.
            origins: Pages that may connect besides the viewer's own, such as one behind
                a proxy: ["https://lab.example:8443"].

        Raises:
            MissingExtraError: viser is not installed.
            InvalidArgumentError: No address of this machine, no port that is free, or
                what is no origin.
            UrdfError, UnknownNameError: `urdf` cannot be read.
        """
        viser = extras.need("viser", user="iksel.view", extra="'iksel[view]'")
        self.session = Session(solver, scene=scene)
        pieces, self.lost = (
            ([], [])
            if urdf is None
            else read_pieces(urdf, packages, xacro_args, trusted=trusted)
        )
        self._lock = threading.RLock()
        self._drawing = False
        self._dragged: set[int] = set()
        self._map: Map | None = None
        super().__init__(start(viser, host, port, origins), host)
        robot = solver.robot
        self._server.gui.set_panel_label(f"iksel: {robot.name}")
        self._skeleton = Skeleton(robot)
        self.scene = Scene(self._server.scene, self._skeleton, pieces)
        obstacles = {} if scene is None else scene.obstacles
        self.scene.add_obstacles(obstacles)
        self._around = corners(obstacles)
        self._look()
        self.controls = Controls(self._server.gui, self.session)
        if len(self.scene.visuals):
            self.controls.meshes.visible = True
            self.scene.dress(dressed=True)
        if self.lost:
            some = f"not shown of the meshes: {len(self.lost)}, such as {self.lost[0]}"
            self.controls.note = f"\n\n{some}"
        self.controls.on_change(self._changed)
        for tip, target in enumerate(self.scene.targets):
            target.on_update(lambda _event, tip=tip: self._drag(tip))
        self._draw()

    @property
    def text(self) -> str:
        """What the panel says, in Markdown."""
        return str(self.controls.text.content)

    def show(self, q: npt.ArrayLike) -> Viewer:
        """Put the robot at joint values (dof,) [rad or m], and the targets at its TCPs.

        Returns:
            The viewer.

        Raises:
            InvalidArgumentError: Another shape, or not finite.
        """
        with self._lock:
            self.session.show(q)
            self._look()
            self._draw()
        return self

    def move_target(self, pose: PoseLike, tip: int | None = None) -> Viewer:
        """Move the target to T_base_tcp, (4, 4) [m], as if it were dragged there.

        Args:
            pose: Of the one tip or of `tip`; else of all, (tips, 4, 4).
            tip: Of a robot with several, whose target alone is moved, counted from 0.

        Returns:
            The viewer; `session` and `text` say what came of it.

        Raises:
            InvalidArgumentError: Another shape, not finite or not rigid; or no such
                tip.
        """
        with self._lock:
            self.session.move_target(pose, tip)
            self._look()
            self._draw()
        return self

    def play(self, path: PathResult | npt.ArrayLike, dt: float = 0.04) -> Viewer:
        """Show configurations one after the other; returns after the last.

        Args:
            path: What Solver.solve_path() gave, or joint values (n, dof) [rad or m].
            dt: Time from one to the next [s].

        Returns:
            The viewer.

        Raises:
            InvalidArgumentError: Another shape, not finite, or a time that is negative.
        """
        values = path.q if isinstance(path, PathResult) else path
        steps = as_floats("path", values, (self.session.robot.dof,))
        if steps.ndim != 2:
            reject("path", f"expected shape (n, dof), got {steps.shape}")
        if not 0 <= dt < np.inf:
            reject("dt", f"expected a time [s] from 0, got {dt}")
        due = time.monotonic()
        for q in steps:
            self.show(q)
            due += dt
            time.sleep(max(0.0, due - time.monotonic()))
        return self

    def show_map(self, reach_map: Map) -> Viewer:
        """Show a reachability map as a layer of coloured balls.

        Red ones are reached with few of the orientations, blue ones with all. Of a
        robot with several tips it is of one of them.

        Returns:
            The viewer.

        Raises:
            InvalidArgumentError: The map is of another robot, or of another tool.
        """
        check_map(self.session.robot, reach_map)
        with self._lock:
            self._map = reach_map
            axes, _ = reach_map.box()
            self._around = np.array([[axis[0], axis[-1]] for axis in axes]).T
            self._look()
            for handle in self.controls.of_map:
                handle.visible = True
            self._draw_map()
        return self

    def _drag(self, tip: int) -> None:
        """A tip's target is being dragged: follow to where all are by now.

        Events come faster than answers are drawn, so of those that wait for the lock
        only the first finds something to do.
        """
        self._dragged.add(tip)
        with self._lock:
            if not self._dragged or self._closed.is_set():
                return
            dragged, self._dragged = self._dragged, set()
            session, scene = self.session, self.scene
            poses = session.targets.copy()
            for one in dragged:
                poses[one] = scene.target_pose(one)
            session.move_target(poses if len(poses) > 1 else poses[0])
            self._draw(*(scene.targets[one] for one in dragged))

    def _changed(self, handle: Any) -> None:
        """A switch or slider has been changed, unless by _draw() itself."""
        with self._lock:
            if self._drawing or self._closed.is_set():
                return
            controls = self.controls
            if handle in controls.numbers.buttons:
                self._typed(handle)
                return
            if handle in controls.of_map:
                self._draw_map()
                return
            if handle is controls.unit:
                with self._silently():
                    controls.set_unit()
            elif handle is controls.meshes:
                self.scene.dress(dressed=bool(handle.value))
            else:
                controls.apply(handle)
            self._draw(handle)

    def _typed(self, button: Any) -> None:
        """Move to what has been typed, or say why not."""
        try:
            self.controls.numbers.apply(button)
        except InvalidArgumentError as error:
            self.controls.text.content = f"**not moved**: {error}"
        else:
            self._draw()

    def _look(self) -> None:
        """Have the camera of pages from now on see the robot and what is around it."""
        q = self.session.q
        body = self._skeleton.points(q[None])[0]
        others = np.concatenate([self._around, self.scene.visuals.corners(q)])
        look_at(self._server.initial_camera, self._skeleton, body, others)

    def _draw(self, *held: Any) -> None:
        """Draw everything but the map, and the handles that a user is just moving."""
        session = self.session
        robot, q = session.robot, session.q
        near = np.minimum(q - robot.lower, robot.upper - q) < LIMIT_MARGIN
        with self._lock, self._silently(), self._server.atomic():
            self.scene.draw_robot(q, near, solved=session.solved)
            asked = self.controls.ghosts.value
            ghosts = session.branches() if asked else q[None][:0]
            self.scene.draw_ghosts(ghosts)
            self.scene.draw_targets(session.targets, held)
            self.controls.draw(held, len(ghosts) if asked else None)
        self._server.flush()  # viser would wait for 1/60 s for more to send

    def _draw_map(self) -> None:
        """Draw the map, if there is one that is switched on."""
        if self._map is None:
            return
        from iksel.reach._pictures import reached_places  # noqa: PLC0415 (an extra)

        cut = bool(self.controls.cut.value)
        points, shares, spacing = reached_places(self._map, cut=cut)
        if not self.controls.map.value:
            points, shares = points[:0], shares[:0]
        self.scene.draw_map(points, shares, spacing)

    @contextlib.contextmanager
    def _silently(self) -> Iterator[None]:
        """Take no notice of what is changed meanwhile; others wait for the lock."""
        before, self._drawing = self._drawing, True
        try:
            yield
        finally:
            self._drawing = before
