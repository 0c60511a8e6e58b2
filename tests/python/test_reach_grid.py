# SPDX-License-Identifier: BSD-3-Clause
"""Grids over orientations and positions, and which turns a robot leaves out."""

from __future__ import annotations

import numpy as np
import pytest

import iksel
from iksel import reach
from iksel.reach import _healpix
from iksel.reach._symmetry import first_axis, last_axis, turns_freely

SEED = 20
SIDES = (1, 2, 3, 4, 7, 16)

TWO_TURNS = """
<robot name="tilted">
  <link name="base"/><link name="a"/><link name="b"/>
  <joint name="j1" type="{kind}"><parent link="base"/><child link="a"/>
    <origin xyz="0.3 -0.2 0.1" rpy="0.4 0 0"/><axis xyz="0 0 1"/>
    <limit lower="{lower}" upper="{upper}" velocity="1" effort="1"/></joint>
  <joint name="j2" type="revolute"><parent link="a"/><child link="b"/>
    <origin xyz="0.5 0 0.2" rpy="0 1 0"/><axis xyz="0 1 0"/>
    <limit lower="-7" upper="7" velocity="1" effort="1"/>{mimic}</joint>
</robot>
"""


def tilted(kind="revolute", lower=-3.2, upper=3.2, mimic="") -> iksel.Robot:
    return iksel.Robot.from_urdf(
        TWO_TURNS.format(kind=kind, lower=lower, upper=upper, mimic=mimic)
    )


def random_rotations(n: int, seed: int = SEED) -> np.ndarray:
    q = np.random.default_rng(seed).normal(size=(n, 4))
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    return iksel.pose_from_quaternion(np.zeros((n, 3)), q)[:, :3, :3]


@pytest.mark.parametrize("nside", SIDES)
def test_a_pixel_holds_its_centre_and_all_pixels_are_equally_large(nside):
    centres = _healpix.centres(nside)
    assert len(centres) == 12 * nside**2
    np.testing.assert_allclose(np.linalg.norm(centres, axis=1), 1, atol=1e-15)
    np.testing.assert_array_equal(_healpix.pixel(nside, centres), range(len(centres)))
    directions = np.random.default_rng(SEED).normal(size=(400 * len(centres), 3))
    found = np.bincount(_healpix.pixel(nside, directions), minlength=len(centres))
    # A share that were off by 30 % would be six standard deviations away.
    assert found.min() > 280
    assert found.max() < 520


@pytest.mark.parametrize("nside", [1, 2, 8, 64])
def test_pixels_are_those_of_astropy(nside):
    other = pytest.importorskip("astropy_healpix", reason="pip install iksel[dev]")
    centres = _healpix.centres(nside)
    expected = other.healpix_to_xyz(np.arange(len(centres)), nside, order="ring")
    np.testing.assert_allclose(np.stack(expected, -1), centres, atol=1e-14)
    directions = np.random.default_rng(SEED).normal(size=(20_000, 3))
    np.testing.assert_array_equal(
        _healpix.pixel(nside, directions),
        other.xyz_to_healpix(*directions.T, nside=nside, order="ring"),
    )


@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 0.6, -0.8)])
@pytest.mark.parametrize("nside", [1, 3])
def test_orientations_are_rotations_in_their_own_cells(nside, axis):
    grid = reach.Orientations(nside, 5, axis)
    turns = grid.rotations
    np.testing.assert_allclose(
        turns @ np.swapaxes(turns, 1, 2),
        np.tile(np.eye(3), (grid.size, 1, 1)),
        atol=1e-14,
    )
    np.testing.assert_allclose(np.linalg.det(turns), 1)
    cells = np.stack([m.ravel() for m in np.indices(grid.counts)], -1)
    np.testing.assert_array_equal(grid.index(turns), cells)
    np.testing.assert_allclose(turns @ axis, grid.directions[cells[:, 0]], atol=1e-14)


def test_orientations_are_even():
    """Random rotations fall into all cells alike, and none is far from its centre."""
    grid = reach.Orientations(2, 12)
    turns = random_rotations(400 * grid.size)
    cells = grid.index(turns)
    flat = np.ravel_multi_index(tuple(cells.T), grid.counts)
    found = np.bincount(flat, minlength=grid.size)
    assert found.min() > 280
    assert found.max() < 520
    trace = np.einsum("nij,nij->n", turns, grid.rotations[flat])
    assert np.arccos((trace - 1) / 2).max() < 1.5 * _healpix.spacing(2)


def test_positions_cover_the_box_and_volumes_add_up():
    box = reach.Positions(0.5, (-1.0, 0.0, 2.0), (4, 2, 1))
    points = box.points([slice(None)] * 3)
    cells, inside = box.index(points)
    assert inside.all()
    np.testing.assert_array_equal(
        np.ravel_multi_index(tuple(cells.T), box.counts), range(8)
    )
    assert box.volumes().sum() == pytest.approx(2 * 1 * 0.5)
    _, inside = box.index(np.array([[-1.01, 0.1, 2.1], [0.0, 0.1, 2.51]]))
    assert not inside.any()
    rings = reach.Positions(0.25, (0.0, -1.0), (8, 8))
    assert rings.volumes().sum() == pytest.approx(np.pi * 2**2 * 2)


def test_which_robots_leave_out_a_turn(made):
    expected = {
        "ur5e": (True, True),
        "irb120": (False, True),
        "panda": (False, False),
        "cvr038": (False, False),
    }
    for name, turns in expected.items():
        robot = made.robot(name)
        found = first_axis(robot) is not None, last_axis(robot) is not None
        assert found == turns, name


def test_a_tool_beside_the_last_axis_is_not_spun(made):
    robot = made.robot("ur5e")
    beside = iksel.pose_from_euler([0.1, 0, 0.1], [0, 0, 0])
    tilted_tool = iksel.pose_from_euler([0, 0, 0.1], [0, 1, 0])
    assert last_axis(robot.with_tcp(beside)) is None
    axis = last_axis(robot.with_tcp(tilted_tool))
    expected = [np.sin(1), 0, np.cos(1)]
    np.testing.assert_allclose(np.abs(axis), expected, atol=1e-15)


def test_a_range_just_below_a_turn_is_no_turn():
    assert turns_freely(tilted(lower=-np.pi, upper=np.pi), 0)
    assert not turns_freely(tilted(lower=-3.14159, upper=3.14159), 0)
    assert not turns_freely(tilted(kind="prismatic", lower=-9, upper=9), 0)
    assert turns_freely(tilted(kind="continuous"), 0)


def test_a_tilted_first_axis_is_found_where_it_is():
    robot = tilted()
    frame = first_axis(robot)
    expected = iksel.pose_from_euler([0.3, -0.2, 0.1], [0.4, 0, 0])
    np.testing.assert_allclose(frame[:3, 2], expected[:3, 2], atol=1e-12)
    away = expected[:3, 3] - frame[:3, 3]
    np.testing.assert_allclose(np.cross(away, frame[:3, 2]), 0, atol=1e-12)


def test_a_joint_that_mimics_the_first_one_makes_its_turn_no_symmetry():
    mimic = '<mimic joint="j1" multiplier="0.5"/>'
    robot = iksel.Robot.from_urdf(
        TWO_TURNS.format(kind="revolute", lower=-3.2, upper=3.2, mimic=mimic)
    )
    assert robot.dof == 1
    assert first_axis(robot) is None


@pytest.mark.parametrize(
    ("settings", "culprit"),
    [
        ({"spacing": 0.0}, "spacing"),
        ({"spacing": 1e-9}, "spacing"),
        ({"orientations": 0}, "orientations"),
        ({"orientations": 10, "angle": 0.1}, "orientations"),
        ({"angle": 0.0}, "angle"),
        ({"box": [[0, 0, 0], [1, -1, 1]]}, "box"),
        ({"axis": "w"}, "axis"),
        ({"qualities": ["beauty"]}, "qualities.*branches"),
        ({"chunk_cells": 0}, "chunk_cells"),
        (
            {"free_spin": True, "options": {"task": iksel.Task.upright()}},
            "free_spin",
        ),
    ],
)
def test_a_plan_out_of_range_is_refused(made, settings, culprit):
    if "options" in settings:
        settings = {**settings, "options": iksel.SolverOptions(**settings["options"])}
    with pytest.raises(iksel.InvalidArgumentError, match=culprit):
        reach.plan(made.robot("ur5e"), **settings)


def test_branches_of_a_redundant_arm_cannot_be_counted(made):
    with pytest.raises(iksel.InvalidArgumentError, match="redundant"):
        reach.plan(made.robot("panda"), qualities=["branches"])
    with pytest.raises(iksel.InvalidArgumentError, match="redundant"):
        reach.plan(made.robot("ur5e"), free_spin=True, qualities=["branches"])


def test_turns_stay_where_the_limits_or_the_task_see_them(made):
    robot = made.robot("ur5e")

    def left_out(**settings):
        plan = reach.plan(robot, spacing=0.2, orientations=72, **settings)
        return plan.first_turn, plan.last_turn

    assert left_out() == (True, True)
    assert left_out(symmetry=False) == (False, False)
    # Its joints have limits, if only two turns away: the distance to them changes.
    assert left_out(qualities=["limit_distance"]) == (False, False)
    box = iksel.Task.box([0.1] * 3, [0.1] * 3, "base")
    assert left_out(options=iksel.SolverOptions(task=box)) == (False, False)
    assert left_out(free_spin=True) == (True, False)


def test_the_same_plan_has_the_same_id_and_another_has_another(made):
    robot = made.robot("ur5e")
    one = reach.plan(robot, spacing=0.2)
    assert one.id == reach.plan(robot, spacing=0.2).id
    tool = iksel.pose_from_euler([0, 0, 0.1], [0, 0, 0])
    for other in (
        reach.plan(robot, spacing=0.2001),
        reach.plan(robot.with_tcp(tool), spacing=0.2),
        reach.plan(
            robot, spacing=0.2, options=iksel.SolverOptions(position_tolerance=1e-5)
        ),
    ):
        assert one.id != other.id


def test_chunks_cover_every_cell_once(made):
    plan = reach.plan(
        made.robot("ur5e"),
        spacing=0.3,
        orientations=72,
        symmetry=False,
        chunk_cells=1000,
    )
    seen = np.zeros(plan.shape, int)
    for index in range(plan.chunks):
        seen[plan.block(index)] += 1
    assert (seen == 1).all()
    assert np.prod(plan.chunk) <= 1000
