# SPDX-License-Identifier: BSD-3-Clause
"""Laws of coupled limits: no answer violates them, none inside of them is missed."""

from __future__ import annotations

import functools
import math
import re

import numpy as np
import pytest
from conftest import CASES
from linkage_arms import (
    ELBOW,
    FULL_TURN,
    WRIST,
    fanuc_like,
    is_inside,
    palletiser,
    searched,
    sums,
)
from trees import two_arms_on_torso
from urdf_text import joint, link, mimic, robot

import iksel
from iksel._base.limits import violated_limits
from iksel.reach._symmetry import turns_freely

WIDE_ELBOW = (-2.4, 4.9)
MIDDLE = iksel.CoupledLimit({"joint_2": 1, "joint_4": -1}, -1.0, 2.2)
SHOULDER = iksel.CoupledLimit({"joint_1": 1, "joint_3": 1}, -2.5, 3.0)
ANYHOW = iksel.CoupledLimit({"joint_2": 1, "joint_3": 0.5}, -1.0, 1.2)


def iiwa(**settings: object) -> iksel.Robot:
    """Seven joints, with an invented limit if asked for."""
    return iksel.load_robot("iiwa14", **settings)


def turning_iiwa(**settings: object) -> iksel.Robot:
    """The same, whose first joint takes two turns, as an angle off by half of one."""
    before, found, after = iiwa().urdf.partition('<joint name="joint_1"')
    limits = 'lower="-6" upper="6"'
    wide = re.sub(r'lower="[^"]*" upper="[^"]*"', limits, after, count=1)
    return iksel.load_robot(before + found + wide, **settings)


ARMS = {
    "elbow": lambda **s: iksel.load_robot(fanuc_like(), **s),
    "both": lambda **s: iksel.load_robot(fanuc_like(), **s),
    "turning": lambda **s: iksel.load_robot(fanuc_like(WIDE_ELBOW), **s),
    "palletiser": lambda **s: iksel.load_robot(palletiser(), **s),
    "iiwa": iiwa,
    "turning iiwa": turning_iiwa,
    "searched": lambda **s: iksel.load_robot(searched(), **s),
}
LINKAGE = iksel.CoupledLimit({"joint_4": 1, "joint_2": -1}, -0.7, 1.3)
LIMITS = {
    "elbow": [ELBOW],
    "both": [ELBOW, WRIST],
    "turning": [ELBOW, WRIST],
    "palletiser": [LINKAGE],
    "iiwa": [MIDDLE],
    "turning iiwa": [SHOULDER],
    "searched": [ANYHOW],
}
SIX = ["elbow", "both", "turning"]


@functools.cache
def arm(name: str) -> iksel.Robot:
    """An arm with its coupled limits."""
    return ARMS[name](coupled_limits=LIMITS[name])


@functools.cache
def solver(name: str) -> iksel.Solver:
    """Its solver."""
    return iksel.Solver(arm(name))


@functools.cache
def open_solver(name: str) -> iksel.Solver:
    """That of the same arm without coupled limits."""
    return iksel.Solver(ARMS[name]())


@pytest.mark.parametrize("name", ARMS)
def test_samples_lie_inside(name: str) -> None:
    robot = arm(name)
    q = robot.random_configurations(2000, seed=1)
    assert is_inside(robot, q).all()
    assert robot.within_limits(q).all()
    # As a part of what is uniform in the box.
    box = ARMS[name]().random_configurations(20_000, seed=2)
    inside = is_inside(robot, box)
    np.testing.assert_array_equal(robot.within_limits(box), inside)
    assert 0.05 < inside.mean() < 0.98
    np.testing.assert_allclose(q.mean(axis=0), box[inside].mean(axis=0), atol=0.25)


@pytest.mark.parametrize("name", ARMS)
def test_reachable_targets_are_reached_inside(name: str) -> None:
    robot = arm(name)
    n = 5 * CASES
    q = robot.random_configurations(n, seed=3)
    targets = robot.fk(q)
    batch = solver(name).solve_batch(targets)
    missed = np.flatnonzero(~batch.success)
    assert not missed.size, f"seed 3, rows {missed[:5]}"
    assert is_inside(robot, batch.q).all()
    for i in range(0, n, 10):
        single = solver(name).solve(targets[i])
        assert single.success, f"seed 3, row {i}"
        assert is_inside(robot, single.q).all()


@pytest.mark.parametrize("name", SIX)
def test_all_solutions_are_those_of_the_open_arm_inside(name: str) -> None:
    robot = arm(name)
    targets = robot.fk(robot.random_configurations(CASES, seed=4))
    cut = 0
    for i, target in enumerate(targets):
        every = open_solver(name).solve_all(target, max=2000, whole_turns=True).q
        expected = every[is_inside(robot, every)]
        found = solver(name).solve_all(target, max=2000, whole_turns=True).q
        assert is_inside(robot, found).all(), f"seed 4, target {i}"
        doubtful = is_inside(robot, every, 1e-5) != is_inside(robot, every, -1e-5)
        if doubtful.any():
            continue
        assert len(found) == len(expected), f"seed 4, target {i}"
        away = np.abs(found[:, None] - expected[None]).max(axis=2)
        assert away.min(axis=1).max() < 1e-4, f"seed 4, target {i}"
        cut += len(every) > len(expected)
    assert cut > CASES / 4


@pytest.mark.parametrize("name", SIX)
def test_a_no_is_proven_where_every_branch_lies_outside(name: str) -> None:
    robot = arm(name)
    box = ARMS[name]().random_configurations(4 * CASES, seed=5)
    outside = box[~is_inside(robot, box)]
    refused = proven = 0
    for i, target in enumerate(robot.fk(outside)):
        every = open_solver(name).solve_all(target, max=2000, whole_turns=True).q
        result = solver(name).solve(target)
        assert result.success == (is_inside(robot, every).any()), f"seed 5, target {i}"
        if result.success:
            continue
        refused += 1
        proven += result.proven
    # Beside singularities nothing is proven.
    assert refused > CASES / 4
    assert proven > 0.95 * refused


@pytest.mark.parametrize("name", ["elbow", "turning", "searched"])
def test_diagnosis_names_the_limit(name: str) -> None:
    robot = arm(name)
    box = ARMS[name]().random_configurations(4 * CASES, seed=6)
    outside = box[~is_inside(robot, box)]
    named = 0
    for i, target in enumerate(robot.fk(outside)[: CASES // 4]):
        if solver(name).solve(target).success:
            continue
        diagnosis = solver(name).diagnose(target)
        where = f"seed 6, target {i}: {diagnosis.message}"
        assert diagnosis.cause is iksel.Cause.joint_limits, where
        assert not is_inside(robot, diagnosis.branch).any(), where
        assert is_inside(robot, diagnosis.q).all(), where
        if diagnosis.coupled_limit < 0:
            continue
        named += 1
        assert diagnosis.joint == -1
        limit = robot.coupled_limits[diagnosis.coupled_limit]
        total = sums(robot, diagnosis.branch)[0, diagnosis.coupled_limit]
        beyond = max(limit.lower - total, total - limit.upper)
        assert diagnosis.limit_violation == pytest.approx(beyond), where
        assert iksel.CoupledLimit.__str__(limit).split(" <= ")[1] in diagnosis.message
    assert named > 3


@pytest.mark.parametrize("name", ARMS)
def test_near_is_the_nearest(name: str) -> None:
    robot = arm(name)
    q = robot.random_configurations(CASES, seed=7)
    rng = np.random.default_rng(7)
    near = q + rng.normal(0, 0.6, q.shape)
    farther = 0
    for i, target in enumerate(robot.fk(q)):
        result = solver(name).solve(target, near=near[i])
        assert result.success, f"seed 7, target {i}"
        assert is_inside(robot, result.q).all()
        # The configuration that the target was made of is an answer.
        farther += result.move > np.linalg.norm(q[i] - near[i]) + 1e-4
    # Where limits leave but a narrow part of a curve, or by search: of iiwa14 in 5 of
    # 3,000, with coupled limits and without.
    allowed = {"iiwa": 0.02, "turning iiwa": 0.02, "searched": 0.03, "palletiser": 0.03}
    assert farther <= allowed.get(name, 0) * len(q), f"seed 7: {farther}"


@pytest.mark.parametrize("name", SIX)
def test_near_is_the_nearest_of_all_images(name: str) -> None:
    robot = arm(name)
    q = robot.random_configurations(CASES, seed=8)
    near = q + np.random.default_rng(8).normal(0, 1.0, q.shape)
    for i, target in enumerate(robot.fk(q)):
        every = solver(name).solve_all(target, max=2000, whole_turns=True).q
        result = solver(name).solve(target, near=near[i])
        least = np.linalg.norm(every - near[i], axis=1).min()
        assert result.move == pytest.approx(least, abs=1e-4), f"seed 8, target {i}"


def test_near_over_a_curve_is_no_farther_than_its_points() -> None:
    robot = arm("iiwa")
    q = robot.random_configurations(CASES // 8, seed=9)
    near = q + np.random.default_rng(9).normal(0, 0.8, q.shape)
    for i, target in enumerate(robot.fk(q)):
        result = solver("iiwa").solve(target, near=near[i])
        arcs = solver("iiwa").self_motion(target, spacing=0.01)
        least = min(np.linalg.norm(arc.q - near[i], axis=1).min() for arc in arcs)
        assert result.move <= least + 1e-5, f"seed 9, target {i}"
        assert result.move >= least - 0.02, f"seed 9, target {i}"


def test_arcs_end_at_coupled_limits() -> None:
    robot = arm("iiwa")
    q = robot.random_configurations(CASES // 8, seed=10)
    ends = 0
    for i, target in enumerate(robot.fk(q)):
        motion = solver("iiwa").self_motion(target, spacing=0.02)
        assert motion.success, f"seed 10, target {i}"
        points = np.concatenate([arc.q for arc in motion])
        assert is_inside(robot, points).all(), f"seed 10, target {i}"
        whole = open_solver("iiwa").self_motion(target, spacing=0.02)
        expected = np.concatenate([arc.q for arc in whole])
        # Each fifth, 0.1 rad apart: all of them take half a minute.
        for q_expected in expected[is_inside(robot, expected, -1e-3)][::5]:
            away = np.abs(points - q_expected).max(axis=1).min()
            assert away < 0.05, f"seed 10, target {i}"
        for arc in motion:
            for end, at in [(arc.begin, arc.q[0]), (arc.end, arc.q[-1])]:
                if end.coupled_limit < 0:
                    continue
                ends += 1
                assert end.kind is iksel.ArcEnd.limit
                assert end.joint == -1
                limit = robot.coupled_limits[end.coupled_limit]
                bound = limit.upper if end.at_upper else limit.lower
                total = sums(robot, at)[0, end.coupled_limit]
                assert total == pytest.approx(bound, abs=1e-6), f"seed 10, target {i}"
                assert "sum 1" in repr(end)
    assert ends > 5


@pytest.mark.parametrize("name", ["elbow", "turning", "iiwa", "searched"])
def test_paths_stay_inside(name: str) -> None:
    robot = arm(name)
    rng = np.random.default_rng(11)
    for trial in range(max(CASES // 40, 2)):
        start, end = robot.random_configurations(2, seed=100 + trial)
        # Along a straight line in joint space, which lies inside: limits are convex.
        q = start + np.linspace(0, 0.5 + 0.5 * rng.random(), 25)[:, None] * (
            end - start
        )
        path = solver(name).solve_path(robot.fk(q), start=q[0])
        assert path.success, f"seed {100 + trial}: {path}"
        assert is_inside(robot, path.q).all()


def test_tracking_slides_along_a_limit() -> None:
    robot = arm("iiwa")
    q = robot.random_configurations(CASES, seed=12)
    rng = np.random.default_rng(12)
    for i in range(len(q)):
        tracker = iksel.Tracker(solver("iiwa"), q[i])
        result = tracker.track(robot.fk(q[i] + rng.normal(0, 0.01, 7)), dt=1.0)
        assert is_inside(robot, np.asarray(tracker.q)).all(), f"seed 12, row {i}"
        if result.success:
            assert is_inside(robot, result.q).all()


@pytest.mark.parametrize("name", ["elbow", "iiwa", "searched"])
@pytest.mark.parametrize(
    "options",
    [
        iksel.SolverOptions.paper(),
        iksel.SolverOptions(strategy=iksel.Paper(iteration="lm")),
        iksel.SolverOptions(strategy=iksel.Paper(iteration="cwln")),
    ],
    ids=["paper", "lm", "cwln"],
)
def test_schemes_give_no_answer_outside(
    name: str, options: iksel.SolverOptions
) -> None:
    robot = arm(name)
    scheme = iksel.Solver(robot, options)
    q = robot.random_configurations(CASES, seed=13)
    solved = 0
    for i, target in enumerate(robot.fk(q)):
        result = scheme.solve(target)
        solved += result.success
        if result.success:
            assert is_inside(robot, result.q).all(), f"seed 13, target {i}"
    assert solved > len(q) / 2


@pytest.mark.parametrize("name", ["elbow", "turning", "iiwa", "searched"])
def test_the_closest_lies_inside(name: str) -> None:
    robot = arm(name)
    q = ARMS[name]().random_configurations(CASES, seed=14)
    for i, target in enumerate(robot.fk(q[~is_inside(robot, q)])[: CASES // 4]):
        result = solver(name).solve(target, closest=True)
        assert is_inside(robot, result.q).all(), f"seed 14, target {i}"
        if result.success:
            continue
        # No step from it that stays inside brings it nearer.
        best = result.position_error
        tries = result.q + np.random.default_rng(i).normal(0, 1e-3, (200, robot.dof))
        tries = tries[is_inside(robot, tries)]
        off = np.linalg.norm(robot.fk(tries)[:, :3, 3] - target[:3, 3], axis=1)
        turned = robot.fk(tries)[:, :3, :3]
        cosine = (np.einsum("nij,ij->n", turned, target[:3, :3]) - 1) / 2
        angle = np.arccos(np.clip(cosine, -1, 1))
        worse = (off >= best - 1e-6) | (angle >= result.rotation_error - 1e-6)
        assert worse.all(), f"seed 14, target {i}"


@pytest.mark.parametrize("name", ["iiwa"])
def test_an_objective_keeps_away_from_coupled_limits(name: str) -> None:
    robot = arm(name)
    objective = iksel.Objective.far_from_limits()
    targets = robot.fk(robot.random_configurations(CASES // 4, seed=15))
    nearer, open_nearer = [], []
    limit = robot.coupled_limits[0]
    for target in targets:
        for solve, margins in [(solver, nearer), (open_solver, open_nearer)]:
            result = solve(name).solve(target, objective=objective)
            total = sums(robot, result.q)[0, 0]
            margins.append(min(total - limit.lower, limit.upper - total))
    assert min(nearer) >= 0
    assert np.mean(nearer) > np.mean(open_nearer)


def test_batches_give_what_single_calls_do() -> None:
    robot = arm("turning")
    box = ARMS["turning"]().random_configurations(CASES, seed=16)
    targets = robot.fk(box)
    batch = solver("turning").solve_batch(targets)
    for i, target in enumerate(targets):
        assert batch.success[i] == solver("turning").solve(target).success


def test_limits_of_mimic_and_locked_joints_are_of_their_sources() -> None:
    robot = iksel.load_robot(
        palletiser(),
        # Joint 5 is -joint 4, and joint 3 -joint 2.
        coupled_limits=[iksel.CoupledLimit({"joint_3": 1, "joint_5": -1}, -0.7, 1.3)],
    )
    same = arm("palletiser")
    q = ARMS["palletiser"]().random_configurations(2000, seed=17)
    np.testing.assert_array_equal(robot.within_limits(q), same.within_limits(q))
    locked = iksel.load_robot(
        fanuc_like(), locked_joints={"joint_3": 0.4}, coupled_limits=[ELBOW]
    )
    q = locked.random_configurations(2000, seed=18)
    second = q[:, locked.joint_names.index("joint_2")]
    assert second.min() >= -1.6
    assert second.max() <= 1.6
    assert second.max() > 1.5


def test_limits_of_what_carries_an_arm_are_kept() -> None:
    """Seven joints of the arm are an arm themselves, wherever the torso stands."""
    panda = iksel.load_robot("panda")
    torso = iksel.CoupledLimit({"lift": 4, "turn": 1}, 0.9, 1.1)
    robot = iksel.Robot.from_urdf(
        two_arms_on_torso(panda), "base", "l_" + panda.tip_link, coupled_limits=[torso]
    )
    solver = iksel.Solver(robot)
    q = robot.random_configurations(CASES, seed=5)
    near = q + 0.1 * np.sin(np.arange(q.size)).reshape(q.shape)
    for answers in (
        solver.solve_batch(robot.fk(q)),
        solver.solve_batch(robot.fk(q), near=near),
    ):
        assert answers.solved == len(q)
        assert is_inside(robot, answers.q).all()


def test_databases_are_of_one_set_of_limits() -> None:
    free, bound = ARMS["searched"](), arm("searched")
    assert free.chain_hash != bound.chain_hash
    assert bound.chain_hash == arm("searched").with_tcp(np.eye(4)).chain_hash
    with pytest.raises(iksel.DatabaseMismatchError):
        iksel.Solver(bound, database=open_solver("searched").database)


@pytest.mark.parametrize(
    ("limits", "match"),
    [
        ([{"joint_2": 1}], r"coupled_limits\[0\]"),
        (ELBOW, "coupled_limits: expected a sequence"),
        (np.eye(3), r"coupled_limits\[0\]: expected a CoupledLimit"),
        ([iksel.CoupledLimit({}, 0, 1)], "names no joint"),
        ([iksel.CoupledLimit({"joint_2": 0}, 0, 1)], "'joint_2' is 0"),
        ([iksel.CoupledLimit({"joint_2": math.nan}, 0, 1)], "'joint_2'"),
        ([iksel.CoupledLimit({"joint_2": 1}, math.nan, 1)], "not a number"),
        ([iksel.CoupledLimit({"joint_2": 1})], "neither"),
        ([iksel.CoupledLimit({"joint_2": 1}, 2, 1)], "upper has to be above"),
        ([iksel.CoupledLimit({"joint_2": 1}, 1, 1)], "mimic"),
        (
            [iksel.CoupledLimit({"joint_2": 1, "joint_3": 1}, 20, 30)],
            r"from -4\.14 to 6\.13",
        ),
        (
            [
                iksel.CoupledLimit({"joint_2": 1, "joint_3": 1}, 1.5, 2),
                iksel.CoupledLimit({"joint_2": 1, "joint_3": 1}, -1, 0),
            ],
            "no configuration",
        ),
        ([ELBOW] * 9, "at most 8"),
    ],
)
def test_wrong_limits_are_named(limits: object, match: str) -> None:
    with pytest.raises(iksel.InvalidArgumentError, match=match):
        iksel.load_robot(fanuc_like(), coupled_limits=limits)


def test_unknown_joints_are_named_with_what_there_is() -> None:
    wrong = iksel.CoupledLimit({"joint_2": 1, "elbow": 1}, 0, 1)
    with pytest.raises(iksel.UnknownNameError, match=r"'elbow'.*joint_1, joint_2"):
        iksel.load_robot(fanuc_like(), coupled_limits=[wrong])


def test_joints_that_turn_without_limits_are_refused() -> None:
    name = iksel.load_robot("gen3_6dof").joint_names[0]
    limit = iksel.CoupledLimit({name: 1}, 0, 1)
    with pytest.raises(iksel.InvalidArgumentError, match="turns without limits"):
        iksel.load_robot("gen3_6dof", coupled_limits=[limit])


@pytest.mark.parametrize("name", ["source", "follower"])
def test_nor_where_only_what_follows_them_is_on_the_chain(name: str) -> None:
    free = {"kind": "continuous", "inside": ""}
    xml = robot(
        link("base", "aside", "elbow", "hand"),
        joint("source", "base", "aside", **free),
        joint(
            "follower", "base", "elbow", **free | {"inside": mimic("source", "", "")}
        ),
        joint("last", "elbow", "hand", axis="0 1 0"),
    )
    limit = iksel.CoupledLimit({name: 1, "last": 1}, -1, 1)
    with pytest.raises(iksel.InvalidArgumentError, match="turns without limits"):
        iksel.Robot.from_urdf(xml, "base", "hand", coupled_limits=[limit])


def test_limits_show_what_they_are() -> None:
    limit = iksel.CoupledLimit({"a": 1, "b": -0.5}, upper=2.5)
    assert str(limit) == "a - 0.5 b <= 2.5"
    assert eval(repr(limit), {"CoupledLimit": iksel.CoupledLimit}) == limit
    assert limit != iksel.CoupledLimit({"a": 1, "b": -0.5}, upper=2.6)
    assert limit != "a"
    assert arm("both").coupled_limits == [ELBOW, WRIST]
    assert arm("both").with_tcp(np.eye(4)).coupled_limits == [ELBOW, WRIST]
    assert WIDE_ELBOW[1] - WIDE_ELBOW[0] > FULL_TURN


def test_plans_of_maps_keep_them() -> None:
    reach = pytest.importorskip("iksel.reach")
    plan = reach.plan(arm("both"), spacing=0.3, angle=1.5)
    assert plan.robot().coupled_limits == [ELBOW, WRIST]
    assert (
        "coupled_limits" not in reach.plan(iksel.load_robot("ur3")).to_dict()["robot"]
    )
    assert turns_freely(ARMS["both"](), 5)
    assert not turns_freely(arm("both"), 5)


def test_what_is_violated_is_listed() -> None:
    robot = arm("both")
    assert violated_limits(robot, np.zeros(6)) == []
    assert violated_limits(robot, np.array([4.0, 1.4, 1.2, 0, 0, 0])) == [
        "joint_1",
        str(ELBOW),
    ]
    mimic = iksel.load_robot(
        palletiser(), coupled_limits=[iksel.CoupledLimit({"joint_3": 1}, -0.5, 0.5)]
    )
    assert violated_limits(mimic, np.array([0, 1.0, 0, 0])) == ["a coupled limit"]
