# SPDX-License-Identifier: BSD-3-Clause
"""A robot in the browser: a target to drag, and what inverse kinematics says of it.

    import iksel
    from iksel.view import Viewer

    solver = iksel.Solver(iksel.load_robot("ur5e"))
    viewer = Viewer(solver).show([0, -1.2, 1.5, -0.4, 1.6, 0])
    print(viewer.url)
    viewer.wait()

Needs the extra `pip install iksel[view]`; only making a Viewer imports it.
"""

from __future__ import annotations

from iksel._base.extras import MissingExtraError
from iksel.view.session import TASKS, Session
from iksel.view.viewer import PORT, Viewer

__all__ = ["PORT", "TASKS", "MissingExtraError", "Session", "Viewer"]
