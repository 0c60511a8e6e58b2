# SPDX-License-Identifier: BSD-3-Clause
"""Self-collision from a URDF's collision geometry, as a filter for solves.

    from iksel.collision import SelfCollision

    solver.solve(pose, filter=SelfCollision("arm.urdf", robot, srdf="arm.srdf"))

Needs the library coal: `pip install iksel[collision]`.
"""

from __future__ import annotations

from iksel.collision._self_collision import SelfCollision

__all__ = ["SelfCollision"]
