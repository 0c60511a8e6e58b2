# SPDX-License-Identifier: BSD-3-Clause
"""Pairs of random arms on a random joint, so that no constant is tuned on robots."""

from __future__ import annotations

import re
import time
from typing import TYPE_CHECKING, Any

import numpy as np

import iksel
from bench.moves import BUILDS
from bench.random_arms import sketch
from bench.whole_body.carried import JUMP, WAYPOINTS
from bench.whole_body.nearest import nearest
from bench.whole_body.robots import body_of

if TYPE_CHECKING:
    from bench.chain import Array
    from bench.whole_body.robots import Body

EACH = 10
"""Moves of a pair."""
IN_TIME = 1.5
"""So many times what a motion takes by the limits of speed."""


def random_pair(seed: int, shared: int = 1, sides: str = "ab") -> Body:
    """Two arms or more, of seven joints, mounted anyhow on turning or sliding ones."""
    rng = np.random.default_rng([seed, 4711])
    text = '<robot name="pair"><link name="base"/>'
    for i in range(shared):
        if rng.random() < 0.5:
            kind, lower = "revolute", -rng.uniform(0.5, 3.1)
            upper = rng.uniform(0.5, 3.1)
        else:
            kind, lower, upper = "prismatic", 0.0, rng.uniform(0.2, 1.0)
        axis = rng.normal(size=3)
        place = rng.uniform(-0.3, 0.3, 3) if i else np.zeros(3)
        parent, link = f"torso{i - 1}" if i else "base", f"torso{i}"
        text += f"""<link name="{link}"/><joint name="shared{i}" type="{kind}">
            <parent link="{parent}"/><child link="{link}"/>
            <origin xyz="{_words(place)}"/>
            <axis xyz="{_words(axis / np.linalg.norm(axis))}"/>
            <limit lower="{lower}" upper="{upper}" effort="1" velocity="1"/></joint>"""
    for side in (f"{name}_" for name in sides):
        build = BUILDS[rng.integers(len(BUILDS))]
        arm = sketch(build, int(rng.integers(1_000_000))).urdf()
        arm = re.sub(r"</?robot.*?>", "", arm)
        text += re.sub(r'\b(name|link|joint)="', rf'\1="{side}', arm)
        place, turn = rng.uniform(-0.3, 0.3, 3), rng.uniform(-3, 3, 3)
        text += f"""<joint name="{side}mount" type="fixed">
            <parent link="torso{shared - 1}"/><child link="{side}l0"/>
            <origin xyz="{_words(place)}" rpy="{_words(turn)}"/></joint>"""
    tips = tuple(f"{name}_tip" for name in sides)
    return body_of(f"pair{seed}", text + "</robot>", "base", tips)


def nearest_of_pairs(
    start: str, count: int, seed: int, shared: int = 1
) -> dict[str, Any]:
    """As `nearest`, `count` moves in all; they are named by how many came before."""
    pairs = range(-(-count // EACH))
    bodies = [random_pair(1000 * seed + k, shared) for k in pairs]
    rows = [
        nearest(body, start, min(EACH, count - EACH * k), seed)
        for k, body in enumerate(bodies)
    ]
    sums = ("cases", "none", "wrong", "longer", "shorter")
    return {key: sum(row[key] for row in rows) for key in sums} | {
        "longest": max(row["longest"] for row in rows),
        "mean_us": float(np.mean([row["mean_us"] for row in rows])),
        "named": [EACH * k + i for k in pairs for i in rows[k]["named"]],
    }


def paths_of_pairs(count: int, seed: int) -> dict[str, Any]:
    """Paths of known motions, straight on in joint space, one of each pair.

    From anywhere, and from where the motion begins; jumps are needless, and so is
    an end before the end, with time enough as without any limit of it.
    """
    counts = ("paths", "ended", "late", "jumps", "wrong")
    row: dict[str, Any] = dict.fromkeys(counts, 0)
    spent, length = [], []
    for k in range(count):
        body = random_pair(1000 * seed + k)
        solver = iksel.Solver(body.robot)
        begin, end = body.random_configurations(2, (seed, k))
        q = np.linspace(begin, end, WAYPOINTS)
        poses, step = body.fk(q), np.linalg.norm(q[1] - q[0])
        for start in (None, q[0]):
            begun = time.perf_counter()
            result = solver.solve_path(poses, start=start)
            spent.append(time.perf_counter() - begun)
            row["paths"] += 1
            row["ended"] += not result
            if result:
                row["jumps"] += result.largest_step > JUMP
                row["wrong"] += not body.right(poses, result.q).all()
                length.append(result.move / (step * (WAYPOINTS - 1)))
        dt = IN_TIME * np.max(np.abs(q[1] - q[0]) / body.robot.velocity_limit)
        row["late"] += not solver.solve_path(poses, start=q[0], dt=dt)
    return row | {"length": float(np.mean(length)), "s_each": float(np.mean(spent))}


def _words(values: Array) -> str:
    return " ".join(repr(float(value)) for value in values)
