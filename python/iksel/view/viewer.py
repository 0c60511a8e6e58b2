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
from iksel.view._obstacles import corners
from iksel.view._server import quietly, start
from iksel.view.controls import Controls
from iksel.view.scene import Scene
from iksel.view.session import Session
from iksel.view.skeleton import Skeleton
from iksel.view.visuals import read_pieces

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from types import TracebackType

    import iksel_cpp
    import numpy.typing as npt
    from iksel_cpp import Solver

    from iksel._base.arrays import FloatArray
    from iksel.description import Source
    from iksel.formats._packages import Packages
    from iksel.pose import PoseLike
    from iksel.reach import Map

PORT = 8080
"""Where a viewer is served unless another port is given."""
VIEW_FROM = np.array([0.75, -1.0, 0.45])
"""Direction from the robot to the camera."""
FIELD_OF_VIEW = np.deg2rad(40.0)
"""From the upper edge of the picture to the lower; narrow, so that the robot's
proportions are little changed by perspective."""
FARTHEST_IN_VIEW = 2.0
"""How far from the robot the picture goes at first for a map or obstacles [reaches]."""
LIMIT_MARGIN = 1e-3  # [rad or m]; a joint that near to a limit is shown as at it


class Viewer:
    """A robot in the browser, served until close() or the end of the program.

    The robot follows a target that is dragged in the browser or moved by
    move_target(); sliders turn its joints. Every method may be called from any thread.
    Pages of other sites are refused, but for `origins`.
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
        self._dragged = False
        self._map: Map | None = None
        self._closed = threading.Event()
        self._server = start(viser, host, port, origins)
        self.host = host
        robot = solver.robot
        self._server.gui.set_panel_label(f"iksel: {robot.name}")
        skeleton = Skeleton(robot)
        self.scene = Scene(self._server.scene, skeleton, pieces)
        self._body = skeleton.points(self.session.q[None])[0]
        obstacles = {} if scene is None else scene.obstacles
        self.scene.add_obstacles(obstacles)
        self._look_at(corners(obstacles))
        self.controls = Controls(self._server.gui, self.session)
        if len(self.scene.visuals):
            self.controls.meshes.visible = True
            self.scene.dress(dressed=True)
        if self.lost:
            some = f"not shown of the meshes: {len(self.lost)}, such as {self.lost[0]}"
            self.controls.note = f"\n\n{some}"
        self.controls.on_change(self._changed)
        self.scene.target.on_update(lambda _event: self._drag())
        self._draw()

    def __enter__(self) -> Viewer:  # noqa: PYI034 (Self needs Python 3.11)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    @property
    def port(self) -> int:
        """Where it is served."""
        return int(self._server.get_port())

    @property
    def url(self) -> str:
        """What to open in a browser."""
        everywhere = self.host in ("0.0.0.0", "127.0.0.1")  # noqa: S104 (only asked)
        host = "localhost" if everywhere else self.host
        return f"http://{host}:{self.port}"

    def _repr_html_(self) -> str:
        """The page inside a notebook."""
        return f'<iframe src="{self.url}" width="100%" height="600"></iframe>'

    @property
    def text(self) -> str:
        """What the panel says, in Markdown."""
        return str(self.controls.text.content)

    def show(self, q: npt.ArrayLike) -> Viewer:
        """Put the robot at joint values (dof,) [rad or m], and the target at its TCP.

        Returns:
            The viewer.

        Raises:
            InvalidArgumentError: Another shape, or not finite.
        """
        with self._lock:
            self.session.show(q)
            self._draw()
        return self

    def move_target(self, pose: PoseLike) -> Viewer:
        """Move the target to T_base_tcp, (4, 4) [m], as if it were dragged there.

        Returns:
            The viewer; `session` and `text` say what came of it.

        Raises:
            InvalidArgumentError: Another shape, not finite or not rigid.
        """
        with self._lock:
            self.session.move_target(pose)
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

        Red ones are reached with few of the orientations, blue ones with all.

        Returns:
            The viewer.

        Raises:
            InvalidArgumentError: The map is of another robot, or of another tool.
        """
        mine, its = self.session.robot, reach_map.robot
        if mine.chain_hash != its.chain_hash:
            raise InvalidArgumentError(
                f"map: it is of {its.name}, {its.base_link} -> {its.tip_link}, and the "
                f"viewer shows {mine.name}, {mine.base_link} -> {mine.tip_link}"
            )
        if not np.allclose(mine.tcp, its.tcp, rtol=0, atol=1e-9):
            raise InvalidArgumentError(
                "map: its tool is another than the robot's; load the robot with the "
                f"map's tcp, which is at {its.tcp[:3, 3]} in the tip link's frame"
            )
        with self._lock:
            self._map = reach_map
            axes, _ = reach_map.box()
            self._look_at(np.array([[axis[0], axis[-1]] for axis in axes]).T)
            for handle in self.controls.of_map:
                handle.visible = True
            self._draw_map()
        return self

    def wait(self) -> None:
        """Serve until close(), from another thread, or Ctrl-C."""
        with contextlib.suppress(KeyboardInterrupt):
            self._closed.wait()

    def close(self) -> None:
        """Stop to serve."""
        if not self._closed.is_set():
            self._closed.set()
            with quietly():
                self._server.stop()

    def _drag(self) -> None:
        """The target is being dragged: follow to where it is by now.

        Events come faster than answers are drawn, so of those that wait for the lock
        only the first finds something to do.
        """
        self._dragged = True
        with self._lock:
            if self._dragged and not self._closed.is_set():
                self._dragged = False
                self.session.move_target(self.scene.target_pose())
                self._draw(self.scene.target)

    def _changed(self, handle: Any) -> None:
        """A switch or slider has been changed, unless by _draw() itself."""
        with self._lock:
            if self._drawing or self._closed.is_set():
                return
            controls, session = self.controls, self.session
            if handle is controls.choice:
                session.set_choice(handle.value)
            elif handle is controls.task:
                session.set_task(handle.value)
            elif handle is controls.motion:
                session.slide(handle.value)
            elif handle in controls.joints:
                joint = controls.joints.index(handle)
                session.move_joint(joint, controls.joint_value(joint))
            elif handle in controls.numbers.buttons:
                self._typed(handle)
                return
            elif handle is controls.unit:
                with self._silently():
                    controls.set_unit()
            elif handle is controls.meshes:
                self.scene.dress(dressed=bool(handle.value))
            elif handle is not controls.ghosts:
                self._draw_map()
                return
            self._draw(handle)

    def _typed(self, button: Any) -> None:
        """Move to what has been typed, or say why not."""
        try:
            self.controls.numbers.apply(button)
        except InvalidArgumentError as error:
            self.controls.text.content = f"**not moved**: {error}"
        else:
            self._draw()

    def _look_at(self, others: FloatArray) -> None:
        """Have the camera see the robot and other points (n, 3), and little else."""
        robot, camera = self.session.robot, self._server.initial_camera
        away = np.linalg.norm(others - robot.reach_centre, axis=-1)
        near = others[away < FARTHEST_IN_VIEW * robot.reach]
        points = np.concatenate([self._body, near])
        lowest, highest = points.min(axis=0), points.max(axis=0)
        centre = (lowest + highest) / 2
        # The target's handles stick out.
        radius = np.linalg.norm(points - centre, axis=1).max() + 0.12 * robot.reach
        distance = radius / np.sin(FIELD_OF_VIEW / 2)
        direction = VIEW_FROM / np.linalg.norm(VIEW_FROM)
        camera.fov = float(FIELD_OF_VIEW)
        camera.position = centre + distance * direction
        camera.look_at = centre

    def _draw(self, source: Any = None) -> None:
        """Draw everything but the map, and the handle that a user is just moving."""
        session = self.session
        robot, q = session.robot, session.q
        near = np.minimum(q - robot.lower, robot.upper - q) < LIMIT_MARGIN
        with self._lock, self._silently(), self._server.atomic():
            self.scene.draw_robot(q, near, solved=session.solved)
            asked = self.controls.ghosts.value
            ghosts = session.branches() if asked else q[None][:0]
            self.scene.draw_ghosts(ghosts)
            if source is not self.scene.target:
                self.scene.draw_target(session.target)
            self.controls.draw(source, len(ghosts) if asked else None)
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
