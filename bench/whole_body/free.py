# SPDX-License-Identifier: BSD-3-Clause
"""Answers for both hands that keep all arms, and the body, out of one another.

The meshes are those of example-robot-data, covered by spheres; pairs of links that may
touch are those of the SRDF. Targets are poses of random configurations, whether those
collide or not; coal judges the answers, with the links' own meshes.
"""

from __future__ import annotations

import re
import time
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import iksel
import iksel.exact
import iksel.spheres
from bench.robot_data import robots_folder
from bench.settings import WORK
from bench.timing import time_calls
from bench.tips import TURN, torso
from bench.whole_body.robots import ROBOTS, Body, body_of, load_body

if TYPE_CHECKING:
    from pathlib import Path

LIMIT_S = 3_000.0
"""No call is begun after this time."""
SIDES = ("l_", "r_")
PANDA = "panda_description/{0}/panda.{0}"
PR2 = "pr2_description/srdf/pr2.srdf"


class Robot(NamedTuple):
    """One whose file has meshes."""

    body: Body
    urdf: Path | str
    srdf: Path | str


def load_meshes(name: str) -> Robot:
    """Either two Pandas on a joint, or PR2.

    Raises:
        UnsupportedError: There are no such files here.
    """
    folder = robots_folder()
    pr2 = load_body("pr2")  # says what is missing
    if name == "pr2":
        description = ROBOTS[name]
        assert description is not None
        return Robot(pr2, folder / description.urdf, folder / PR2)
    arm = iksel.load_robot(
        folder / PANDA.format("urdf"), base_link="panda_link0", tip_link="panda_link8"
    )
    tips = tuple(side + arm.tip_link for side in SIDES)
    urdf = torso(arm, (TURN,))
    text = (folder / PANDA.format("srdf")).read_text(encoding="utf-8")
    return Robot(body_of(name, urdf, "base", tips), urdf, both(text))


def both(srdf: str) -> str:
    """The pairs of links that an arm's SRDF disables, of two arms."""
    rows = re.findall(r"<disable_collisions\b.*?/>", srdf)
    named = [re.sub(r'\b(link[12])="', rf'\1="{s}', row) for s in SIDES for row in rows]
    return f'<robot name="both">{"".join(named)}</robot>'


def free(name: str, count: int, seed: int, max_error: float) -> dict[str, Any]:
    """What answers in the scene are worth and cost, on one robot.

    Args:
        name: See load_meshes().
        count: Targets.
        seed: Of these.
        max_error: How far spheres may stick out of the meshes [m].
    """
    body, urdf, srdf = load_meshes(name)
    packages = {"example-robot-data": robots_folder().parent}
    begun = time.process_time()
    spheres = iksel.spheres.from_urdf(
        urdf,
        body.robot,
        max_error=max_error,
        srdf=srdf,
        packages=packages,
        cache=WORK / "body",
    )
    cover_s = time.process_time() - begun
    scene = iksel.Scene(body.robot, spheres)
    exact = iksel.exact.ExactCollision(scene, urdf, packages=packages)
    solver = iksel.Solver(body.robot)
    q = body.random_configurations(count, seed)
    poses = body.fk(q)
    calls = [(pose,) for pose in poses]
    plain, first = time_calls(solver.solve, calls, LIMIT_S)
    times, results = time_calls(
        lambda pose: solver.solve(pose, scene=scene), calls, LIMIT_S
    )
    done = len(results)
    solved = np.array([bool(result) for result in results])
    answers = np.array([result.q for result in results if result])
    by_spheres = np.asarray(scene.is_free(q[:done]))
    by_coal = exact.geometry_is_free(q[:done])
    firsts = np.array([result.q for result in first if result])
    return {
        "spheres": sum(map(len, spheres.links.values())),
        "pairs": len(spheres.pairs),
        "cover_s": cover_s,
        "targets": done,
        "solved": int(solved.sum()),
        "wrong": int(np.count_nonzero(~body.right(poses[:done][solved], answers))),
        "colliding": int(np.count_nonzero(~exact.geometry_is_free(answers))),
        "colliding_without": int(np.count_nonzero(~exact.geometry_is_free(firsts))),
        "free": int(by_spheres.sum()),
        "free_missed": int(np.count_nonzero(by_spheres & ~solved)),
        "free_by_coal": int(by_coal.sum()),
        "free_by_coal_missed": int(np.count_nonzero(by_coal & ~solved)),
        "plain_us": float(plain.mean()) / 1e3,
        "solved_us": float(times[solved].mean()) / 1e3,
        "solved_median_us": float(np.median(times[solved])) / 1e3,
        "none_us": None if solved.all() else float(times[~solved].mean()) / 1e3,
    }
