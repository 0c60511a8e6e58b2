# SPDX-License-Identifier: BSD-3-Clause
"""Databases: what is in them, bits and threads, and files that go wrong."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

import iksel_cpp
import numpy as np
import pytest

import iksel

SAMPLINGS = [kind.name for kind in iksel.Sampling]
KEYS = [kind.name for kind in iksel.RotationKey]
SMALL = iksel.DatabaseOptions(samples=300, scale="small", key_scheme="full")
WORK = {"kmeans": {"kmeans_pool": 3000}, "cvt": {"cvt_updates": 3000}}


def small(sampling: str, **changes: int) -> iksel.DatabaseOptions:
    return SMALL.replace(sampling=sampling, **WORK.get(sampling, {}), **changes)


def arrays(database: iksel.Database) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """q, poses and pseudo-inverses of all samples."""
    indices = range(len(database))
    return (
        np.stack([database.q(i) for i in indices]),
        np.stack([database.pose(i) for i in indices]),
        np.stack([database.pseudo_inverse(i) for i in indices]),
    )


def assert_same(a: iksel.Database, b: iksel.Database) -> None:
    assert a.chain_hash == b.chain_hash
    assert a.to_bytes() == b.to_bytes()
    for mine, theirs in zip(arrays(a), arrays(b), strict=True):
        np.testing.assert_array_equal(mine, theirs)


@pytest.fixture(scope="module")
def database(made) -> iksel.Database:
    return iksel.Database.build(made.robot("ur3"), SMALL)


@pytest.mark.parametrize("name", ["ur3", "irb14050", "gen3_6dof", "xarm5"])
@pytest.mark.parametrize("sampling", ["cvt", "low_discrepancy", "random", "kmeans"])
def test_samples_are_what_they_say(made, name: str, sampling: str) -> None:
    robot = made.robot(name)
    database = iksel.Database.build(robot, small(sampling))
    assert len(database) == database.size == 300
    assert database.dof == robot.dof
    assert database.chain_hash == robot.chain_hash
    bare = robot.with_tcp(np.eye(4))
    q, poses, inverses = arrays(database)
    assert all(robot.within_limits(row) for row in q)
    assert len(np.unique(q, axis=0)) == 300
    np.testing.assert_allclose(poses, bare.fk(q, "kdl"), rtol=0, atol=1e-12)
    cutoff = database.options.pinv_cutoff
    expected = np.linalg.pinv(bare.jacobian(q, "kdl"), rcond=cutoff)
    scale = np.abs(expected).max(axis=(1, 2), keepdims=True)
    np.testing.assert_allclose(inverses / scale, expected / scale, rtol=0, atol=1e-9)


@pytest.mark.parametrize("sampling", ["low_discrepancy", "cvt", "random", "kmeans"])
def test_samples_spread_over_the_limits(made, sampling: str) -> None:
    robot = made.robot("cvr038")
    options = small(sampling, samples=2000)
    q = arrays(iksel.Database.build(robot, options))[0]
    part = (q - robot.lower) / (robot.upper - robot.lower)
    np.testing.assert_allclose(part.mean(axis=0), 0.5, rtol=0, atol=0.05)
    # Uniform: 1/12; the centres of Voronoi cells keep away from the border.
    low = 0.03 if sampling in ("cvt", "kmeans") else 0.075
    assert (part.var(axis=0) > low).all()
    assert (part.var(axis=0) < 0.092).all()


@pytest.mark.parametrize(
    ("scale", "dof", "counts"),
    [
        ("small", 6, [6, 5, 5, 5, 4, 4]),
        ("medium", 6, [8, 7, 6, 6, 5, 4]),
        ("large", 6, [10, 9, 8, 7, 6, 5]),
        ("small", 7, [6, 5, 5, 5, 4, 4, 4]),
        ("medium", 7, [8, 7, 6, 6, 5, 5, 4]),
        ("large", 7, [10, 9, 8, 7, 6, 5, 4]),
    ],
)
def test_grid_has_the_papers_counts(scale: str, dof: int, counts: list[int]) -> None:
    assert iksel_cpp.grid_counts(dof, scale) == counts


def test_grid_has_the_papers_points(made) -> None:
    robot = made.robot("cvr038")
    options = iksel.DatabaseOptions.paper().replace(scale="small")
    q = arrays(iksel.Database.build(robot, options))[0]
    assert len(q) == 12_000
    for i, count in enumerate([6, 5, 5, 5, 4, 4]):
        points = np.linspace(robot.lower[i], robot.upper[i], count + 2)[1:-1]
        values = np.unique(q[:, i])
        np.testing.assert_allclose(values, points, rtol=0, atol=1e-12)
    assert len(np.unique(q, axis=0)) == 12_000


@pytest.mark.parametrize("samples", [1, 2, 17])
@pytest.mark.parametrize("name", ["ur3", "xarm5", "synthetic10"])
def test_tiny_databases_work(made, name: str, samples: int) -> None:
    robot = made.robot(name)
    options = iksel.SolverOptions(database=SMALL.replace(samples=samples))
    solver = iksel.Solver(robot, options)
    assert len(solver.database) == samples
    batch = solver.solve_batch(robot.fk(robot.random_configurations(20, 1)))
    assert (batch.attempts <= samples).all()
    found = solver.database.nearest(np.eye(4), samples + 5)
    assert sorted(found) == list(range(samples))


def key_of(pose: np.ndarray, kind: str, weight: float) -> np.ndarray:
    if kind == "dual_quaternion":
        r = iksel.quaternion_from_pose(pose)
        p = pose[..., :3, 3]
        vector = r[..., :1] * p + np.cross(p, r[..., 1:])
        scalar = -np.sum(p * r[..., 1:], axis=-1, keepdims=True)
        return np.concatenate([weight * r, 0.5 * scalar, 0.5 * vector], axis=-1)
    rotation = {
        "rotation_vector": iksel.rotation_vector_from_pose,
        "quaternion": iksel.quaternion_from_pose,
        "matrix": lambda p: p[..., :3, :3].reshape(*p.shape[:-2], 9),
        "euler": iksel.euler_from_pose,
    }[kind](pose)
    return np.concatenate([pose[..., :3, 3], weight * rotation], axis=-1)


@pytest.mark.parametrize("kind", KEYS)
@pytest.mark.parametrize("weight", [1.0, 0.2])
def test_nearest_agrees_with_brute_force(made, kind: str, weight: float) -> None:
    robot = made.robot("cvr038").with_tcp(np.eye(4))
    options = SMALL.replace(rotation_key=kind, rotation_weight=weight, samples=500)
    database = iksel.Database.build(robot, options)
    poses = arrays(database)[1]
    keys = key_of(poses, kind, weight)
    assert database.key_dimension == keys.shape[1]
    for target in robot.fk(robot.random_configurations(30, 2)):
        every = np.linalg.norm(keys - key_of(target, kind, weight), axis=1)
        found = every[database.nearest(target, 40)]
        np.testing.assert_allclose(found, np.sort(every)[:40], rtol=0, atol=1e-12)
    for i in (0, 250, 499):
        assert database.nearest(poses[i], 1).tolist() == [i]


@pytest.mark.parametrize("sampling", SAMPLINGS)
def test_threads_change_no_bit(made, sampling: str) -> None:
    robot = made.robot("xarm5")
    options = small(sampling, samples=1000)
    one = iksel.Database.build(robot, options.replace(threads=1))
    for threads in (2, 8, 0):
        assert_same(one, iksel.Database.build(robot, options.replace(threads=threads)))


@pytest.mark.parametrize("sampling", ["low_discrepancy", "random", "cvt", "kmeans"])
def test_seeds_change_the_samples(made, sampling: str) -> None:
    robot = made.robot("ur3")
    q = [
        arrays(iksel.Database.build(robot, small(sampling, seed=seed)))[0]
        for seed in (0, 1, 1)
    ]
    assert (q[0] != q[1]).any()
    np.testing.assert_array_equal(q[1], q[2])


def test_progress_is_told_and_may_end_the_build(made) -> None:
    told: list[tuple[int, int]] = []
    options = SMALL.replace(samples=20_000)
    iksel.Database.build(
        made.robot("ur3"), options, lambda done, total: told.append((done, total))
    )
    done = [d for d, _ in told]
    assert done == sorted(done)
    assert told
    assert all(0 <= d <= total for d, total in told)

    class EnoughError(Exception):
        pass

    def stop(done: int, total: int) -> None:
        raise EnoughError(done, total)

    with pytest.raises(EnoughError):
        iksel.Database.build(made.robot("ur3"), options, stop)


def test_file_comes_back_in_another_process(made, database, tmp_path: Path) -> None:
    robot = made.robot("ur3")
    path, answers = tmp_path / "ur3.iksel", tmp_path / "answers.npz"
    database.save(path)
    assert_same(iksel.Database.load(path), database)
    assert path.read_bytes() == database.to_bytes()
    program = """
        import sys
        import numpy as np
        import iksel

        robot = iksel.load_robot("ur3")
        solver = iksel.Solver(robot, database=iksel.Database.load(sys.argv[1]))
        poses = robot.fk(robot.random_configurations(50, 3))
        batch = solver.solve_batch(poses)
        np.savez(sys.argv[2], poses=poses, q=batch.q, iterations=batch.iterations)
    """
    run_python(program, path, answers)
    theirs = np.load(answers)
    poses = robot.fk(robot.random_configurations(50, 3))
    ours = iksel.Solver(robot, database=database).solve_batch(poses)
    np.testing.assert_array_equal(theirs["poses"], poses)
    np.testing.assert_array_equal(theirs["q"], ours.q)
    np.testing.assert_array_equal(theirs["iterations"], ours.iterations)


def test_built_in_another_process_has_the_same_bits(database, tmp_path: Path) -> None:
    path = tmp_path / "ur3.iksel"
    program = """
        import sys
        import iksel

        options = iksel.DatabaseOptions(samples=300, scale="small", key_scheme="full")
        iksel.Database.build(iksel.load_robot("ur3"), options).save(sys.argv[1])
    """
    run_python(program, path)
    assert path.read_bytes() == database.to_bytes()


def test_options_are_in_the_file(made, tmp_path: Path) -> None:
    options = SMALL.replace(
        sampling="random",
        key_scheme="full",
        rotation_key="matrix",
        rotation_weight=0.3,
        seed=7,
    )
    database = iksel.Database.build(made.robot("ur3"), options)
    database.save(tmp_path / "file")
    loaded = iksel.Database.load(tmp_path / "file").options
    assert loaded.replace(threads=0) == options.replace(threads=0)


def test_a_loaded_file_may_be_replaced_and_removed(database, tmp_path: Path) -> None:
    path = tmp_path / "ur3.iksel"
    database.save(path)
    loaded = iksel.Database.load(path)
    database.save(path)
    path.unlink()
    assert_same(loaded, database)


def test_mapped_files_are_the_same(made, database, tmp_path: Path) -> None:
    path = tmp_path / "ur3.iksel"
    database.save(path)
    mapped = iksel.Database.load(path, mmap=True)
    assert_same(mapped, database)
    poses = made.robot("ur3").fk(made.robot("ur3").random_configurations(20, 1))
    answers = [
        iksel.Solver(made.robot("ur3"), database=d).solve_batch(poses).q
        for d in (database, mapped)
    ]
    np.testing.assert_array_equal(*answers)
    database.save(path)
    path.unlink()
    assert_same(mapped, database)
    with pytest.raises(iksel.InvalidArgumentError, match="mmap"):
        iksel.Database.load(path, mmap="yes")


@pytest.mark.parametrize("preset", ["default", "paper"])
def test_what_is_written_into_a_loaded_file_changes_nothing(
    made, tmp_path: Path, preset: str
) -> None:
    solver = made.solver("ur3", preset)
    path = tmp_path / "ur3.iksel"
    solver.database.save(path)
    loaded = iksel.Solver(solver.robot, solver.options, iksel.Database.load(path))
    content = np.fromfile(path)
    with path.open("r+b") as file:
        file.write(np.full_like(content, np.nan).tobytes())
        file.truncate(5000)
    poses = solver.robot.fk(solver.robot.random_configurations(50, 1))
    # Positions that are reached, with rotations that few are.
    poses[25:, :3, :3] = poses[:25, :3, :3]
    expected, batch = solver.solve_batch(poses), loaded.solve_batch(poses)
    np.testing.assert_array_equal(batch.q, expected.q)


def test_a_mapped_file_cut_short_ends_no_process(tmp_path: Path) -> None:
    program = """
        import faulthandler
        import os
        import sys
        import iksel

        options = iksel.SolverOptions.paper()
        robot = iksel.load_robot("ur3")
        iksel.Database.build(robot, options.database).save(sys.argv[1])
        mapped = iksel.Database.load(sys.argv[1], mmap=True)
        solver = iksel.Solver(robot, options, mapped)
        poses = robot.fk(robot.random_configurations(50, 1))
        os.truncate(sys.argv[1], 5000)
        batch = solver.solve_batch(poses)
        calls = [
            lambda: solver.solve(poses[0]),
            lambda: solver.solve_batch(poses),
            lambda: mapped.q(0),
            lambda: mapped.to_bytes(),
            lambda: mapped.save(sys.argv[1]),
        ]
        for call in calls:
            try:
                call()
            except iksel.DatabaseIoError as error:
                print(error)
    """
    output = run_python(program, tmp_path / "ur3.iksel")
    assert output.count("cut short") == 5


def assert_refused(content: bytes, path: Path) -> None:
    """Neither the bytes nor a file of them is taken for a database."""
    typed = (iksel.DatabaseCorruptError, iksel.DatabaseMismatchError)
    with pytest.raises(typed):
        iksel.Database.from_bytes(content)
    path.write_bytes(content)
    with pytest.raises(typed, match=path.name):
        iksel.Database.load(path)


@pytest.mark.parametrize("seed", [1, 2])
def test_flipped_bytes_are_refused(
    database, tmp_path: Path, cases: int, seed: int
) -> None:
    content = database.to_bytes()
    random = np.random.default_rng(seed)
    # Every byte of the header, then random ones of the rest.
    for i in [*range(256), *random.integers(256, len(content), cases)]:
        damaged = bytearray(content)
        damaged[i] ^= 1 << int(random.integers(8))
        assert_refused(bytes(damaged), tmp_path / "damaged.iksel")


@pytest.mark.parametrize("seed", [1, 2])
def test_truncated_files_are_refused(
    database, tmp_path: Path, cases: int, seed: int
) -> None:
    content = database.to_bytes()
    random = np.random.default_rng(seed)
    lengths = [0, 1, 7, 8, 255, 256, 257, len(content) - 8, len(content) - 1]
    for length in [*lengths, *random.integers(0, len(content), cases // 4)]:
        assert_refused(content[:length], tmp_path / "short.iksel")
    for more in (b"\0", b"\0" * 8, content):
        assert_refused(content + more, tmp_path / "long.iksel")
        with pytest.raises(iksel.DatabaseCorruptError, match="behind it"):
            iksel.Database.from_bytes(content + more)


@pytest.mark.slow
def test_large_file_serves_another_process_and_no_damage_passes(tmp_path: Path) -> None:
    """The paper's large grid: solved with elsewhere, damaged 300 times, cut 30."""
    path, damaged = tmp_path / "ur3.iksel", tmp_path / "damaged.iksel"
    command = [sys.executable, "-m", "iksel"]
    build = ["build", "ur3", "--scale", "large", "-o", path]
    subprocess.run([*command, *build], check=True, capture_output=True)
    assert len(iksel.Database.load(path)) == 151_200
    pose = ["--pose", "0.3", "0.1", "0.2", "0", "1", "0", "0"]
    solve = ["solve", "ur3", "--database", path, *pose]
    subprocess.run([*command, *solve], check=True, capture_output=True)

    shutil.copy(path, damaged)
    size = path.stat().st_size
    random = np.random.default_rng(1)
    typed = (iksel.DatabaseCorruptError, iksel.DatabaseMismatchError)
    with damaged.open("r+b", buffering=0) as file:
        for place in random.integers(0, size, 300):
            file.seek(place)
            right = file.read(1)
            for byte in (bytes([right[0] ^ random.integers(1, 256)]), right):
                file.seek(place)
                file.write(byte)
                if byte != right:
                    # Reading takes longer, and is checked by the same code.
                    mapped = bool(place % 8)
                    with pytest.raises(typed, match="damaged"):
                        iksel.Database.load(damaged, mmap=mapped)
        assert len(iksel.Database.load(damaged)) == 151_200
        for length in np.sort(random.integers(0, size, 30))[::-1]:
            file.truncate(int(length))
            with pytest.raises(typed, match="damaged"):
                iksel.Database.load(damaged)


@pytest.mark.parametrize(
    "content",
    [b"", b"x", b"<robot/>" * 100, bytes(4096), np.ones(999).tobytes(), b"\xff" * 300],
    ids=["empty", "one byte", "URDF", "zeros", "numbers", "ones"],
)
def test_other_files_are_refused(content: bytes, tmp_path: Path) -> None:
    assert_refused(content, tmp_path / "other.iksel")


@pytest.mark.parametrize("other", ["ur3e", "ur3_wrs", "panda", "xarm5"])
def test_other_robots_are_refused(made, database, other: str) -> None:
    with pytest.raises(iksel.DatabaseMismatchError, match=f"robot '{other}'"):
        iksel.Solver(made.robot(other), database=database)


def test_the_same_chain_with_other_limits_is_refused(made, database) -> None:
    locked = iksel.load_robot("ur3", locked_joints={"wrist_3_joint": 0.1})
    with pytest.raises(iksel.DatabaseMismatchError):
        iksel.Solver(locked, database=database)
    narrower = re.sub(r'lower="[^"]*"', 'lower="-1.5"', made.robot("ur3").urdf, count=1)
    robot = iksel.Robot.from_urdf(narrower, tip_link="tool0", base_link="base_link")
    assert (robot.lower != made.robot("ur3").lower).any()
    with pytest.raises(iksel.DatabaseMismatchError):
        iksel.Solver(robot, database=database)


def test_missing_files_are_named(tmp_path: Path) -> None:
    with pytest.raises(iksel.DatabaseIoError, match=r"absent\.iksel.*No such file"):
        iksel.Database.load(tmp_path / "absent.iksel")
    with pytest.raises(iksel.DatabaseIoError, match=tmp_path.name):
        iksel.Database.load(tmp_path)


def test_places_that_cannot_be_written_are_named(database, tmp_path: Path) -> None:
    with pytest.raises(iksel.DatabaseIoError, match=r"no.folder.*No such file"):
        database.save(tmp_path / "no folder" / "file")
    (tmp_path / "folder").mkdir()
    with pytest.raises(iksel.DatabaseIoError, match="folder"):
        database.save(tmp_path / "folder")
    assert [path.name for path in tmp_path.iterdir()] == ["folder"]


def test_saving_through_a_link_leaves_it(database, tmp_path: Path) -> None:
    (tmp_path / "far").mkdir()
    link, second = tmp_path / "link.iksel", tmp_path / "second.iksel"
    link.symlink_to("second.iksel")
    second.symlink_to(tmp_path / "far" / "real.iksel")
    for _ in range(2):  # first it points to nothing
        database.save(link)
        assert link.is_symlink()
        assert second.is_symlink()
    assert len(iksel.Database.load(tmp_path / "far" / "real.iksel")) == len(database)
    assert sorted(path.name for path in tmp_path.rglob("*")) == [
        *("far", "link.iksel", "real.iksel", "second.iksel")
    ]


def test_saving_never_replaces_a_device(database, tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pytest.raises(iksel.DatabaseIoError, match="pipe': it is no regular file"):
        database.save(pipe)
    assert pipe.is_fifo()
    assert list(tmp_path.iterdir()) == [pipe]


def test_a_full_disk_leaves_the_old_file(database, tmp_path: Path) -> None:
    pytest.importorskip("resource")
    path = tmp_path / "ur3.iksel"
    path.write_bytes(database.to_bytes())
    program = """
        import resource
        import signal
        import sys
        import iksel

        options = iksel.DatabaseOptions(samples=2000)
        database = iksel.Database.build(iksel.load_robot("ur3"), options)
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
        try:
            database.save(sys.argv[1])
        except iksel.DatabaseIoError as error:
            print(error)
        else:
            sys.exit("saved beyond the limit")
    """
    output = run_python(program, path)
    assert str(path) in output
    assert "File too large" in output
    assert path.read_bytes() == database.to_bytes()
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize("i", [-1, 300, 10**9, 1.5, "a"])
def test_bad_indices_are_refused(database, i) -> None:
    for get in (database.q, database.pose, database.pseudo_inverse):
        with pytest.raises(iksel.InvalidArgumentError, match="^i: "):
            get(i)


def test_more_samples_than_fit_are_refused() -> None:
    with pytest.raises(iksel.InvalidArgumentError, match="samples"):
        SMALL.replace(samples=2**62)
    pytest.importorskip("resource")
    program = """
        import resource
        import iksel

        resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))
        options = iksel.DatabaseOptions(samples=100_000_000)
        try:
            iksel.Database.build(iksel.load_robot("ur3"), options)
        except iksel.DatabaseError as error:
            print(error)
    """
    assert "100000000 samples" in run_python(program)


def run_python(program: str, *arguments: Path) -> str:
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(program), *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return done.stdout
