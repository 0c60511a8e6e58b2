# SPDX-License-Identifier: BSD-3-Clause
"""Small objects of every bound class, for the fuzzer of pickles."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))
import iksel_cpp
import urdf_text

import iksel

ARM = iksel.Robot.from_urdf(urdf_text.arm())
POSE = ARM.fk([0.3, 0.4])


def make_samples() -> list[Any]:
    """An object or more of every bound class."""
    options = iksel.SolverOptions(database={"samples": 6})
    solver = iksel.Solver(ARM, options)
    panda = iksel.load_robot("panda")
    motion = iksel.Solver(panda, options).self_motion(
        panda.fk(panda.random_configurations(1, 1)[0])
    )
    spheres = iksel.RobotSpheres({ARM.link_names[-1]: [[0.0, 0.0, 0.0, 0.05]]}, [])
    scene = iksel.Scene(ARM, spheres)
    scene.add_box("box", [1.0, 1.0, 1.0], POSE, margin=0.01)
    scene.add_points("cloud", [[2.0, 0.0, 0.0]], radius=0.01)
    two_tips = iksel.Solver(
        iksel.Robot.from_urdf(urdf_text.arm(), tip_links=["elbow", "hand"]), options
    )
    both = two_tips.robot.fk([0.3, 0.4])
    return [
        two_tips,
        two_tips.robot,
        two_tips.solve(both),
        two_tips.solve_batch([both, both]),
        two_tips.diagnose(both),
        scene,
        spheres,
        *scene.obstacles.values(),
        scene.contacts([0.3, 0.4])[0],
        motion,
        motion[0],
        motion[0].begin,
        ARM,
        ARM.structure,
        options,
        iksel.SolverOptions.paper(),
        iksel.Lanes(),
        iksel.Paper(),
        options.database,
        iksel.Task.free_spin(),
        iksel.Objective.near_posture([0.1, 0.2]),
        solver,
        solver.database,
        solver.solve(POSE),
        solver.solve_all(POSE),
        solver.solve_batch([POSE, POSE]),
        solver.solve_path([POSE]),
        solver.diagnose(POSE),
        iksel.Selector(iksel.Database.build(ARM, {"key_scheme": "full", "samples": 6})),
        iksel.Tracker(solver, [0.1, 0.2]),
        iksel.Tracker(solver, [0.1, 0.2], closest=[1, 1, 1, 1, 1, 1]),
        iksel_cpp.evaluate(solver, 3, 1),
        iksel.CoupledLimit({"first": 1, "second": -0.5}, lower=-1, upper=2),
        iksel.MimicCurve("first", "second", [0, 1, 2], [0, 1, 0], [1, 0, -1]),
        iksel.LinkTree.from_urdf(urdf_text.arm()),
        iksel.LinkTree.from_urdf(urdf_text.arm()).joints[0],
    ]
