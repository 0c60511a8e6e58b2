# SPDX-License-Identifier: BSD-3-Clause
"""What maps say: the same as inverse kinematics of each pose by itself."""

from __future__ import annotations

import json

import numpy as np
import pytest
from reach_maps import computed, random_cells

import iksel
from iksel import reach
from iksel._base.qualities import limit_distance, manipulability

SEED = 30
TOOL = iksel.pose_from_euler([0, 0, 0.12], [0, 0, 0.3])
QUALITIES = ("branches", "manipulability", "limit_distance", "q")


@pytest.fixture(scope="module")
def robot(made):
    return made.robot("ur5e").with_tcp(TOOL)


@pytest.fixture(scope="module")
def full(robot, tmp_path_factory):
    """A map in all dimensions."""
    path = tmp_path_factory.mktemp("maps") / "full.zarr"
    settings = {"spacing": 0.2, "orientations": 300, "symmetry": False}
    return reach.open(computed(path, robot, **settings))


@pytest.fixture(scope="module")
def rings(robot, tmp_path_factory):
    """A map that leaves out what the first and last joint do."""
    path = tmp_path_factory.mktemp("maps") / "rings.zarr"
    return reach.open(computed(path, robot, spacing=0.1, orientations=1000))


def about(axis: str, angle: float) -> np.ndarray:
    rpy = {"y": [0, angle, 0], "z": [0, 0, angle]}[axis]
    return iksel.pose_from_euler([0, 0, 0], rpy)


def pose_of(coordinates, dims, cell) -> np.ndarray:
    """The pose of a cell by Euler angles z-y-z, from the stored coordinates alone."""
    at = dict(zip(dims, cell, strict=True))
    pose = np.eye(4)
    names = ("x", "y", "z") if "x" in at else ("radius", None, "height")
    pose[:3, 3] = [coordinates[n][1][at[n]] if n else 0.0 for n in names]
    x, y, z = (coordinates[f"direction_{a}"][1][at["direction"]] for a in "xyz")
    azimuth = np.arctan2(y, x)
    spin = coordinates["spin"][1][at["spin"]] if "spin" in at else 0.0
    tilt = about("z", azimuth) @ about("y", np.arccos(z)) @ about("z", spin - azimuth)
    return pose @ tilt


def test_cells_are_as_solved_one_by_one(full, robot):
    cells = random_cells(full.grid.shape, 2000, SEED)
    coordinates = full.plan.coordinates()
    poses = np.array([pose_of(coordinates, full.plan.dims, cell) for cell in cells])
    np.testing.assert_allclose(full.poses(cells), poses, atol=1e-14)
    solver = iksel.Solver(robot)
    answers = [solver.solve(pose) for pose in poses]
    stored = full.take(cells)
    np.testing.assert_array_equal(stored["status"], [a.status for a in answers])
    np.testing.assert_array_equal(stored["proof"], [a.proof for a in answers])
    solved = np.array([a.success for a in answers])
    assert 200 < solved.sum() < 1800
    reached = robot.fk(np.array([a.q for a in answers if a.success]))
    np.testing.assert_allclose(reached, poses[solved], atol=2e-6)


def test_a_cell_of_rings_stands_for_all_turns_of_its_pose(rings, robot):
    assert rings.plan.dims == ("radius", "height", "direction")
    rng = np.random.default_rng(SEED)
    cells = random_cells(rings.grid.shape, 2000, SEED)
    first, last = rng.uniform(-np.pi, np.pi, (2, len(cells)))
    coordinates = rings.plan.coordinates()
    poses = np.array(
        [
            about("z", turn) @ pose_of(coordinates, rings.plan.dims, cell)
            for turn, cell in zip(first, cells, strict=True)
        ]
    )
    # The last joint turns the tool about its z axis.
    poses = poses @ np.array([about("z", angle) for angle in last])
    answers = iksel.Solver(robot).solve_batch(poses)
    found = rings.query(poses)
    np.testing.assert_array_equal(found.cells, cells)
    np.testing.assert_array_equal(found.values["status"], answers.status)
    np.testing.assert_array_equal(found.values["proof"], answers.proof)
    np.testing.assert_array_equal(found.solvable, answers.success)
    np.testing.assert_allclose(
        rings.poses(cells, first=first, last=last)[:, :3, 3],
        poses[:, :3, 3],
        atol=1e-14,
    )


def test_a_robot_on_a_tilted_base_keeps_its_symmetry(made, tmp_path):
    """Its first axis is neither the base's z axis nor through its origin."""
    mount = '<joint name="mount" type="fixed"><parent link="wall"/>'
    mount += '<child link="base_link"/><origin xyz="0.2 -0.1 0.4" rpy="0.5 1.1 0.2"/>'
    urdf = made.robot("ur5e").urdf
    end = urdf.rindex("</robot>")
    urdf = urdf[:end] + f'<link name="wall"/>{mount}</joint>' + urdf[end:]
    robot = iksel.Robot.from_urdf(urdf, base_link="wall", tip_link="tool0")
    path = computed(tmp_path / "wall.zarr", robot, spacing=0.3, orientations=72)
    found = reach.open(path)
    assert found.plan.first_turn
    assert found.plan.last_turn
    cells = random_cells(found.grid.shape, 500, SEED)
    angles = np.random.default_rng(SEED).uniform(-np.pi, np.pi, (2, 500))
    poses = found.poses(cells, first=angles[0], last=angles[1])
    answers = found.query(poses, exact=True)
    np.testing.assert_array_equal(answers.cells, cells)
    np.testing.assert_array_equal(answers.values["status"], answers.exact.status)


def test_a_joint_with_tight_limits_is_computed_in_full(made, tmp_path):
    robot = made.robot("irb120")
    path = computed(tmp_path / "map.zarr", robot, spacing=0.4, orientations=200)
    found = reach.open(path)
    assert found.plan.dims == ("x", "y", "z", "direction")
    cells = random_cells(found.grid.shape, 500, SEED)
    spins = np.random.default_rng(SEED).uniform(-np.pi, np.pi, 500)
    answers = found.query(found.poses(cells, last=spins), exact=True)
    np.testing.assert_array_equal(answers.cells, cells)
    np.testing.assert_array_equal(answers.values["status"], answers.exact.status)
    with pytest.raises(iksel.InvalidArgumentError, match="first"):
        found.poses(cells, first=1.0)


def test_a_free_spin_is_any_spin(made, tmp_path):
    robot = made.robot("irb120")
    path = computed(
        tmp_path / "m.zarr", robot, spacing=0.4, orientations=48, free_spin=True
    )
    found = reach.open(path)
    assert found.plan.dims == ("x", "y", "z", "direction")
    cells = random_cells(found.grid.shape, 300, SEED)
    stored = found.take(cells)["status"] == iksel.Status.solved
    solver = iksel.Solver(robot)
    spins = np.linspace(-np.pi, np.pi, 25)
    some = np.array(
        [solver.solve_batch(found.poses(cells, last=s)).success for s in spins]
    )
    np.testing.assert_array_equal(stored, some.any(axis=0))


def test_qualities_are_those_of_all_solutions(made, tmp_path):
    robot = made.robot("ur5e")
    settings = {"spacing": 0.5, "orientations": 72, "symmetry": False}
    path = computed(tmp_path / "q.zarr", robot, qualities=QUALITIES, **settings)
    found = reach.open(path)
    assert found.names == ("status", "proof", *QUALITIES)
    cells = random_cells(found.grid.shape, 300, SEED)
    values = found.take(cells)
    solver = iksel.Solver(robot)
    for pose, *row in zip(found.poses(cells), *values.values(), strict=True):
        status, _, branches, dexterity, distance, q = row
        solutions = solver.solve_all(pose).q
        assert branches == len(solutions)
        if status != iksel.Status.solved:
            assert np.isnan([dexterity, distance, *q]).all()
            continue
        best = solver.solve_all(pose, order="manipulability").q[0]
        assert dexterity == pytest.approx(manipulability(robot, best[None])[0], 1e-6)
        np.testing.assert_allclose(
            manipulability(robot, q[None]), manipulability(robot, best[None])
        )
        np.testing.assert_allclose(robot.fk(q), pose, atol=2e-6)
        far = solver.solve_all(pose, order="limit_distance").q[0]
        assert distance == pytest.approx(limit_distance(robot, far[None])[0], 1e-6)


def test_manipulability_is_the_product_of_the_singular_values(made):
    for name in ("so100", "ur5e", "panda"):
        solver = made.solver(name)
        q = solver.robot.random_configurations(20, seed=SEED)
        expected = np.linalg.svd(solver.robot.jacobian(q), compute_uv=False).prod(
            axis=1
        )
        np.testing.assert_allclose(manipulability(solver.robot, q), expected, rtol=1e-8)


def test_poses_outside_are_unknown(full):
    far = iksel.pose_from_euler([9, 0, 0], [0, 0, 0])
    answers = full.query([far])
    assert not answers.inside[0]
    assert not answers.solvable[0]
    assert answers.values["status"][0] == reach.UNKNOWN
    assert full.query(np.empty((0, 4, 4))).solvable.shape == (0,)
    with pytest.raises(iksel.InvalidArgumentError, match="poses"):
        full.query(np.eye(3))


def test_the_share_of_orientations_is_their_mean(full):
    expected = (full.array("status") == iksel.Status.solved).mean(axis=(3, 4))
    np.testing.assert_allclose(full.fraction, expected)
    assert full.volume == pytest.approx((expected > 0).sum() * 0.2**3)
    axes, shares = full.box()
    np.testing.assert_allclose(shares, expected)
    u, v, plane = full.slice("y", axes[1][3])
    np.testing.assert_allclose((u, v), (axes[0], axes[2]))
    np.testing.assert_allclose(plane, expected[:, 3])
    point = [axes[0][5], axes[1][3], axes[2][5]]
    assert len(full.rotations_at(point)) == round(expected[5, 3, 5] * 288)
    assert full.fraction_at([9.0, 0, 0]) == 0


def test_rings_and_cubes_tell_of_the_same_volume(full, rings):
    """Cells of 20 and of 10 cm; they see the surface of 3.4 m^2 per metre alike."""
    assert rings.volume == pytest.approx(full.volume, rel=0.1)
    axes, shares = rings.box()
    x, y, z = np.meshgrid(*axes, indexing="ij")
    turned = rings.fraction_at(np.stack([y, -x, z], axis=-1))
    np.testing.assert_array_equal(shares, turned)
    point = [0.31, 0.42, 0.5]
    turns = rings.rotations_at(point)
    poses = np.tile(np.eye(4), (len(turns), 1, 1))
    poses[:, :3, :3], poses[:, :3, 3] = turns, point
    assert len(turns) > 10
    assert rings.query(poses).solvable.all()


def test_a_base_from_which_all_poses_are_reached(full, rings, robot):
    down = iksel.pose_from_euler([0, 0, 0], [np.pi, 0, 0])
    poses = np.array([down] * 9)
    poses[:, :2, 3] = [(0.2 * i, 0.2 * j) for i in range(3) for j in range(3)]
    for found in (full, rings):
        placements = reach.place_base(found, poses, spacing=0.2, yaws=4, checked=5)
        assert len(placements) == 5
        assert [p.reached for p in placements] == sorted(
            (p.reached for p in placements), reverse=True
        )
        best = placements[0]
        assert best.reached == 9
        assert best.reachable.all()
        np.testing.assert_allclose(
            best.T_world_base @ robot.fk(best.q), poses, atol=2e-6
        )
    # Turned about its first axis a robot reaches the same.
    assert len({p.T_world_base[1, 0] for p in placements}) == 1
    given = reach.place_base(rings, poses, bases=[best.T_world_base, np.eye(4) * 1.0])
    np.testing.assert_array_equal(given[0].T_world_base, best.T_world_base)
    with pytest.raises(iksel.InvalidArgumentError, match="poses"):
        reach.place_base(rings, np.empty((0, 4, 4)))


def test_two_tools_are_compared(full, rings, made, tmp_path):
    same = reach.compare(full, full)
    assert same.overlap == 1
    assert same.only_first == same.only_second == 0
    assert same.both == pytest.approx(full.fraction.sum() * 0.2**3)
    assert same.both + same.neither == pytest.approx(full.fraction.size * 0.2**3)
    axes = full.axes()
    settings = {
        "box": np.transpose([(a[0] - 0.1, a[-1] + 0.1) for a in axes]),
        "spacing": 0.2,
        "orientations": 300,
        "symmetry": False,
    }
    path = computed(tmp_path / "bare.zarr", made.robot("ur5e"), **settings)
    other = reach.open(path)
    mine, theirs = (m.array("status") == iksel.Status.solved for m in (full, other))
    there, back = reach.compare(full, other), reach.compare(other, full)
    cell = 0.2**3 / full.grid.orientations.size
    assert there.both == pytest.approx((mine & theirs).sum() * cell)
    assert there.only_first == pytest.approx((mine & ~theirs).sum() * cell)
    assert there.only_second == pytest.approx((theirs & ~mine).sum() * cell)
    assert (back.only_first, back.only_second) == pytest.approx(
        (there.only_second, there.only_first)
    )
    np.testing.assert_array_equal(there.difference, -back.difference)
    assert 0.5 < there.overlap < 1
    mixed = reach.compare(rings, full)
    assert mixed.difference.shape == full.fraction.shape
    assert mixed.overlap > 0.8


def test_xarray_opens_a_map(full):
    pytest.importorskip("xarray", reason="pip install iksel[reach]")
    dataset = full.to_xarray()
    assert dataset.status.dims == ("x", "y", "z", "direction", "spin")
    np.testing.assert_array_equal(dataset.status.values, full.array("status"))
    near = dataset.sel(x=0.3, y=0.0, z=0.5, method="nearest")
    assert near.status.shape == full.grid.orientations.counts
    meanings = dataset.status.attrs["flag_meanings"].split()
    assert meanings[iksel.Status.out_of_reach] == "out_of_reach"


def test_npy_files_hold_the_arrays(full, tmp_path):
    for name in ("status", "proof", "fraction"):
        reach.export_npy(full, tmp_path / "a.npy", name)
        expected = full.fraction if name == "fraction" else full.array(name)
        np.testing.assert_array_equal(np.load(tmp_path / "a.npy"), expected)
    with pytest.raises(iksel.InvalidArgumentError, match="fraction, status, proof"):
        reach.export_npy(full, tmp_path / "a.npy", "beauty")
    with pytest.raises(reach.MapIoError, match="missing"):
        reach.export_npy(full, tmp_path / "missing" / "a.npy")


@pytest.mark.parametrize("kind", ["full", "rings"])
def test_reuleaux_files_hold_poses_that_are_reached(kind, request, tmp_path):
    h5py = pytest.importorskip("h5py", reason="pip install iksel[reach]")
    found = request.getfixturevalue(kind)
    reach.export_reuleaux(found, tmp_path / "a.h5", spacing=0.4)
    with h5py.File(tmp_path / "a.h5") as file:
        spheres = file["Spheres/sphere_dataset"]
        assert spheres.attrs["Resolution"] == np.float32(0.4)
        rows, poses = spheres[:], file["Poses/poses_dataset"][:]
    np.testing.assert_allclose(found.fraction_at(rows[:, :3]) * 100, rows[:, 3])
    assert len(poses) == round(rows[:, 3].sum() / 100 * found.grid.orientations.size)
    quaternion = np.roll(poses[:, 6:], 1, axis=1)
    targets = iksel.pose_from_quaternion(poses[:, 3:6], quaternion)
    assert found.query(targets).solvable.all()


@pytest.mark.parametrize("suffix", ["png", "svg"])
def test_pictures_are_drawn_the_same_each_time(full, rings, tmp_path, suffix):
    pytest.importorskip("matplotlib", reason="pip install iksel[reach]")
    poses = full.poses([[5, 5, 5, 0, 0], [0, 0, 0, 0, 0]])
    placements = reach.place_base(rings, poses, spacing=0.5)
    for draw in (
        lambda path: reach.draw_slice(full, path, axis="z", at=0.3),
        lambda path: reach.draw_spheres(rings, path, spacing=0.2),
        lambda path: reach.draw_placements(placements, poses, path),
    ):
        paths = [tmp_path / f"{i}.{suffix}" for i in range(2)]
        for path in paths:
            draw(path)
        assert paths[0].stat().st_size > 5000
        assert paths[0].read_bytes() == paths[1].read_bytes()
    with pytest.raises(iksel.InvalidArgumentError, match="axis"):
        full.slice("w")


def test_arrays_of_older_formats_are_not_read(robot, tmp_path):
    """They may be pickles; a group's metadata can hold them for its arrays."""
    path = computed(tmp_path / "map.zarr", robot, spacing=0.4, orientations=50)
    group = json.loads((path / "zarr.json").read_text())
    names = [folder.name for folder in path.iterdir() if folder.is_dir()]
    array = {
        "zarr_format": 2,
        "node_type": "array",
        "shape": [1],
        "chunks": [1],
        "dtype": "<f8",
        "compressor": None,
        "fill_value": 0.0,
        "order": "C",
        "filters": [{"id": "pickle"}],
        "attributes": {},
    }
    group["consolidated_metadata"] = {
        "kind": "inline",
        "must_understand": False,
        "metadata": dict.fromkeys(names, array),
    }
    before = reach.open(path).array("status")
    (path / "zarr.json").write_text(json.dumps(group))
    np.testing.assert_array_equal(reach.open(path).array("status"), before)
