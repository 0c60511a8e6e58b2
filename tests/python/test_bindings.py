# SPDX-License-Identifier: BSD-3-Clause
"""The extension module: arrays in and out, options, errors, copies and pickles."""

from __future__ import annotations

import copy
import gc
import pickle
import sys
import threading

import iksel_cpp as core
import numpy as np
import pytest

OPTION_CLASSES = (core.DatabaseOptions, core.SolverOptions)
# A field of each kind with another value than its default.
CHANGES = {
    core.DatabaseOptions: {
        "sampling": "grid",
        "samples": 123,
        "rotation_weight": 0.25,
        "seed": 2**64 - 1,
    },
    core.SolverOptions: {
        "position_tolerance": 1e-5,
        "neighbours": 17,
        "limit_aware": False,
        "iteration": "dls",
        "database": {"samples": 123},
    },
}


@pytest.fixture(scope="module")
def robot(made):
    return made.robot("ur3")


@pytest.fixture(scope="module")
def solver(robot):
    options = core.SolverOptions(database={"samples": 2000})
    return core.Solver(robot, options)


@pytest.fixture(scope="module")
def joints(robot):
    return robot.random_configurations(50, seed=7)


@pytest.fixture(scope="module")
def poses(robot, joints):
    return robot.fk(joints)


def without_rigidity(pose):
    """Poses that are none, and a word of what is said of each."""
    scaled = pose.copy()
    scaled[:3, :3] *= 1.01
    mirrored = pose.copy()
    mirrored[:3, 0] *= -1
    projective = pose.copy()
    projective[3, 0] = 0.1
    nan = pose.copy()
    nan[0, 3] = np.nan
    infinite = pose.copy()
    infinite[1, 1] = np.inf
    return scaled, mirrored, projective, nan, infinite


# Arrays in


@pytest.mark.parametrize("shape", [(3, 5), (4,), (16,), (1, 4, 4), (4, 5), (), (0,)])
def test_pose_of_wrong_shape_is_named(solver, shape):
    with pytest.raises(core.InvalidArgumentError) as error:
        solver.solve(np.zeros(shape))
    assert str(error.value) == f"pose: expected a (4, 4) array, got shape {shape}"


@pytest.mark.parametrize("shape", [(4, 4), (2, 3, 5), (2, 16), (1, 2, 4, 4), (0,)])
def test_poses_of_wrong_shape_are_named(solver, shape):
    with pytest.raises(core.InvalidArgumentError) as error:
        solver.solve_batch(np.zeros(shape))
    text = f"poses: expected an (N, 4, 4) array, got shape {shape}"
    assert str(error.value).startswith(text)


def test_single_pose_to_solve_batch_points_to_solve(solver):
    with pytest.raises(core.InvalidArgumentError, match=r"solve\(\)"):
        solver.solve_batch(np.eye(4))


@pytest.mark.parametrize("shape", [(5,), (7,), (3, 5), (6, 3), (2, 3, 6), ()])
def test_q_of_wrong_shape_is_named(robot, shape):
    for function in (robot.fk, robot.jacobian):
        with pytest.raises(core.InvalidArgumentError, match=r"^q: expected a \(6,\)"):
            function(np.zeros(shape))


def test_seed_of_wrong_shape_is_named(solver, poses):
    with pytest.raises(core.InvalidArgumentError, match=r"^seeds: expected a \(6,\)"):
        solver.solve(poses[0], seeds=np.zeros(5))


@pytest.mark.parametrize(
    "dtype", ["complex128", "object", "bool", "<U3", "S3", "datetime64[s]"]
)
def test_dtype_that_is_no_real_number_is_named(robot, solver, dtype):
    eye = np.zeros((4, 4)).astype(dtype)
    for name, function, array in (
        ("pose", solver.solve, eye),
        ("poses", solver.solve_batch, eye[None]),
        ("q", robot.fk, np.zeros(6).astype(dtype)),
    ):
        with pytest.raises(core.InvalidArgumentError) as error:
            function(array)
        expected = f"{name}: expected real numbers, got dtype {array.dtype}"
        assert str(error.value) == expected


@pytest.mark.parametrize("value", [None, "pose", {}, [[1.0], [1.0, 2.0]], object()])
def test_what_is_no_array_is_named(solver, value):
    for name, function in (("pose", solver.solve), ("poses", solver.solve_batch)):
        with pytest.raises(core.InvalidArgumentError, match=rf"^{name}: "):
            function(value)


@pytest.mark.parametrize("dtype", ["f2", "f4", ">f8", "i4", "u1", "longdouble"])
def test_real_dtypes_are_converted(robot, dtype):
    q = np.array([0, 1, 0, 1, 1, 0], dtype=dtype)
    np.testing.assert_array_equal(robot.fk(q), robot.fk(q.astype(float)))
    np.testing.assert_array_equal(robot.fk(q[None]), robot.fk(q[None].astype(float)))


def strided(array):
    out = np.zeros((*array.shape[:-1], 2 * array.shape[-1]))
    out[..., ::2] = array
    return out[..., ::2]


def unaligned(array):
    room = np.zeros(array.nbytes + 1, dtype=np.uint8)
    out = room[1:].view(float).reshape(array.shape)
    out[...] = array
    return out


def read_only(array):
    out = array.copy()
    out.flags.writeable = False
    return out


@pytest.mark.parametrize(
    "layout",
    [
        np.asfortranarray,
        strided,
        unaligned,
        read_only,
        lambda a: a[::-1][::-1],
        lambda a: a.tolist(),
    ],
    ids=["fortran", "strided", "unaligned", "read_only", "reversed", "list"],
)
def test_layout_does_not_matter(robot, solver, joints, poses, layout):
    expected = solver.solve_batch(poses)
    np.testing.assert_array_equal(robot.fk(layout(joints)), poses)
    np.testing.assert_array_equal(solver.solve_batch(layout(poses)).q, expected.q)
    np.testing.assert_array_equal(solver.solve(layout(poses[0])).q, expected.q[0])


def test_non_rigid_pose_is_refused(solver, poses):
    for bad in without_rigidity(poses[0]):
        with pytest.raises(core.InvalidArgumentError, match=r"^pose: "):
            solver.solve(bad)


def test_first_bad_pose_of_a_batch_is_named(solver, poses):
    for bad in without_rigidity(poses[0]):
        batch = poses.copy()
        batch[31] = bad
        batch[40] = bad
        with pytest.raises(core.InvalidArgumentError, match=r"^poses\[31\]: "):
            solver.solve_batch(batch, on_invalid_pose="raise")


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_non_finite_joints_are_named(robot, solver, joints, poses, bad):
    rows = joints.copy()
    rows[3, 2] = rows[5, 0] = bad
    for function in (robot.fk, robot.jacobian):
        with pytest.raises(core.InvalidArgumentError, match=r"^q: .* at joint 2"):
            function(rows[3])
        with pytest.raises(core.InvalidArgumentError, match=r"^q\[3\]: .* at joint 2"):
            function(rows)
    with pytest.raises(core.InvalidArgumentError, match=r"^seeds: "):
        solver.solve(poses[0], seeds=rows[3])


def test_empty_batches_are_fine(robot, solver):
    assert robot.fk(np.zeros((0, 6))).shape == (0, 4, 4)
    assert robot.jacobian(np.zeros((0, 6))).shape == (0, 6, 6)
    batch = solver.solve_batch(np.zeros((0, 4, 4)))
    assert len(batch) == 0
    assert batch.q.shape == (0, 6)
    assert repr(batch) == "BatchResult(0 of 0 solved)"


@pytest.mark.parametrize("threads", [-1, 10**6, 2**40])
def test_bad_thread_count_is_refused(solver, poses, threads):
    with pytest.raises(core.InvalidArgumentError, match=r"^threads: "):
        solver.solve_batch(poses, threads=threads)


# Arrays out


@pytest.mark.parametrize("kinematics", ["kernel", "kdl", core.Kinematics.kdl])
def test_rows_equal_single_calls(robot, joints, kinematics):
    for function in (robot.fk, robot.jacobian):
        rows = function(joints, kinematics=kinematics)
        assert rows.flags.c_contiguous
        single = [function(q, kinematics=kinematics) for q in joints]
        np.testing.assert_array_equal(rows, single)


def test_batch_equals_loop(robot, poses):
    options = core.SolverOptions.paper()
    options.database.scale = "small"
    solver = core.Solver(robot, options)
    batch = solver.solve_batch(poses)
    assert len(batch) == len(poses)
    for pose, row, status in zip(poses, batch, batch.statuses(), strict=True):
        single = solver.solve(pose)
        assert row.success == single.success
        assert row.status is single.status is status
        assert row.attempts == single.attempts
        assert row.iterations == single.iterations
        np.testing.assert_array_equal(row.q, single.q)
        np.testing.assert_equal(row.position_error, single.position_error)
        np.testing.assert_equal(row.rotation_error, single.rotation_error)


def test_batch_in_lanes_solves_what_a_loop_solves(robot, solver, poses):
    batch = solver.solve_batch(poses)
    for pose, row in zip(poses, batch, strict=True):
        assert row.status is solver.solve(pose).status
        if row.success:
            np.testing.assert_allclose(robot.fk(row.q), pose, atol=3e-6)


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_threads_do_not_change_bits(solver, poses, threads):
    expected = solver.solve_batch(poses)
    batch = solver.solve_batch(poses, threads=threads)
    np.testing.assert_array_equal(batch.q, expected.q)
    np.testing.assert_array_equal(batch.status, expected.status)
    np.testing.assert_array_equal(batch.iterations, expected.iterations)


def test_unsolved_has_no_q(solver, poses):
    far = poses[:2].copy()
    far[1, :3, 3] = 50.0
    single = solver.solve(far[1])
    assert not single.success
    assert single.status is core.Status.out_of_reach
    assert single.q is None
    assert np.isnan(single.position_error)
    assert np.isnan(single.rotation_error)
    batch = solver.solve_batch(far)
    assert batch.success.tolist() == [True, False]
    assert batch.status.tolist() == [
        core.Status.solved.value,
        core.Status.out_of_reach.value,
    ]
    assert batch.solved == 1
    assert np.isfinite(batch.q[0]).all()
    assert np.isnan(batch.q[1]).all()
    assert np.isnan(batch.position_error[1])
    assert batch[1].q is None
    assert repr(batch) == "BatchResult(1 of 2 solved)"


def test_batch_arrays_have_the_documented_types(solver, poses):
    batch = solver.solve_batch(poses)
    n = len(poses)
    for name, dtype, shape in (
        ("q", "float64", (n, 6)),
        ("success", "bool", (n,)),
        ("status", "uint8", (n,)),
        ("position_error", "float64", (n,)),
        ("rotation_error", "float64", (n,)),
        ("attempts", "int32", (n,)),
        ("iterations", "int32", (n,)),
    ):
        array = getattr(batch, name)
        assert array.dtype == dtype
        assert array.shape == shape
        assert getattr(batch, name) is array


def test_batch_rows_are_found_from_both_ends(solver, poses):
    batch = solver.solve_batch(poses[:3])
    np.testing.assert_array_equal(batch[-1].q, batch[2].q)
    np.testing.assert_array_equal(batch[np.int64(1)].q, batch.q[1])
    for row in (3, -4):
        with pytest.raises(IndexError, match=r"row -?\d of 3"):
            batch[row]


def test_result_is_explicit_about_success(solver, poses):
    result = solver.solve(poses[0])
    assert result.success is True
    assert bool(result) is True
    assert result.q is result.q
    with pytest.raises(AttributeError):
        result.success = False
    assert repr(result).startswith("Result(solved, q=[")
    assert "], position_error=" in repr(result)


@pytest.mark.parametrize(
    "name", ["lower", "upper", "velocity_limit", "soft_lower", "soft_upper"]
)
def test_joint_vectors_are_read_only_views(robot, name):
    vector = getattr(robot, name)
    assert vector.shape == (robot.dof,)
    assert vector.base is robot
    assert np.shares_memory(vector, getattr(robot, name))
    with pytest.raises(ValueError, match="read-only"):
        vector[0] = 0.0


def test_view_outlives_the_name_of_its_robot(robot):
    other = pickle.loads(pickle.dumps(robot))
    lower = other.lower
    del other
    gc.collect()
    np.testing.assert_array_equal(lower, robot.lower)


def test_calls_leak_no_references(robot, solver, joints, poses):
    pose, q = poses[0].copy(), joints[0].copy()
    arguments = (pose, q, poses, joints)
    solver.solve_batch(poses)
    before = [sys.getrefcount(a) for a in arguments]
    for _ in range(20):
        robot.fk(q)
        robot.jacobian(joints)
        solver.solve(pose, seeds=[q], near=q)
        solver.solve_batch(poses[:2])
        with pytest.raises(core.InvalidArgumentError):
            solver.solve(q)
    del _
    gc.collect()
    assert [sys.getrefcount(a) for a in arguments] == before


def test_inputs_are_left_alone(robot, solver, joints, poses):
    joints_before, poses_before = joints.copy(), poses.copy()
    robot.fk(joints)
    solver.solve_batch(poses)
    solver.solve(poses[0], seeds=joints)
    np.testing.assert_array_equal(joints, joints_before)
    np.testing.assert_array_equal(poses, poses_before)


def test_random_configurations_depend_on_the_seed_alone(robot):
    first = robot.random_configurations(20, 3)
    assert first.shape == (20, 6)
    assert first.flags.c_contiguous
    np.testing.assert_array_equal(first, robot.random_configurations(20, seed=3))
    assert (first != robot.random_configurations(20, 4)).any()
    assert all(robot.within_limits(q) for q in first)
    assert not robot.within_limits(robot.upper + 1e-3)


def test_random_configurations_without_a_seed_are_fresh(robot):
    draws = [robot.random_configurations(3) for _ in range(4)]
    draws.append(robot.random_configurations(3, seed=None))
    assert len({draw.tobytes() for draw in draws}) == len(draws)
    assert robot.within_limits(np.concatenate(draws)).all()


def test_limits_are_asked_of_one_and_of_many(robot):
    rows = robot.random_configurations(100, 8) * 1.1
    many = robot.within_limits(rows)
    assert many.dtype == bool
    assert many.shape == (100,)
    expected = ((rows >= robot.lower) & (rows <= robot.upper)).all(axis=1)
    np.testing.assert_array_equal(many, expected)
    assert 0 < many.sum() < 100
    for q, inside in zip(rows, many, strict=True):
        assert robot.within_limits(q) is bool(inside)
    assert robot.within_limits(np.zeros((0, 6))).shape == (0,)
    with pytest.raises(core.InvalidArgumentError, match=r"^q: expected a \(6,\)"):
        robot.within_limits(np.zeros((2, 5)))


@pytest.mark.parametrize("count", [-1, 1.5, "3", True, None])
def test_bad_count_is_named(robot, count):
    with pytest.raises(core.InvalidArgumentError, match=r"^n: expected an int"):
        robot.random_configurations(count, 0)


# Robot


def test_robot_from_path_and_text(robot, tmp_path):
    path = tmp_path / "arm.urdf"
    path.write_text(robot.urdf)
    links = {"base_link": robot.base_link, "tip_link": robot.tip_link}
    for source in (path, str(path), robot.urdf, "\n  " + robot.urdf.lstrip()):
        same = core.Robot.from_urdf(source, **links)
        assert same.chain_hash == robot.chain_hash
        assert same.joint_names == robot.joint_names
    assert repr(robot) == "Robot('ur3', dof=6, base_link='base_link', tip_link='tool0')"


def test_robot_refuses_what_is_no_source(tmp_path):
    with pytest.raises(core.InvalidArgumentError, match="path_or_xml"):
        core.Robot.from_urdf(3)
    with pytest.raises(core.UrdfError, match="missing.urdf"):
        core.Robot.from_urdf(tmp_path / "missing.urdf")
    with pytest.raises(core.UrdfError):
        core.Robot.from_urdf("<robot")


def test_unknown_names_list_what_there_is(robot):
    with pytest.raises(core.UnknownNameError, match="'wrist'.*tool0"):
        core.Robot.from_urdf(robot.urdf, tip_link="wrist")
    with pytest.raises(core.UnknownNameError, match="'knee'.*elbow_joint"):
        core.Robot.from_urdf(robot.urdf, locked_joints={"knee": 0.0})
    with pytest.raises(core.InvalidArgumentError, match=r"^locked_joints\['knee'\]"):
        core.Robot.from_urdf(robot.urdf, locked_joints={"knee": "bent"})
    with pytest.raises(core.InvalidArgumentError, match=r"^locked_joints: "):
        core.Robot.from_urdf(robot.urdf, locked_joints=["knee"])


def test_tcp_and_locked_joints(robot, joints):
    tcp = np.eye(4)
    tcp[:3, 3] = 0.1, 0.2, 0.3
    tool = robot.with_tcp(tcp)
    np.testing.assert_array_equal(tool.tcp, tcp)
    np.testing.assert_allclose(tool.fk(joints), robot.fk(joints) @ tcp, atol=1e-14)
    assert tool.chain_hash == robot.chain_hash
    with pytest.raises(core.InvalidArgumentError, match=r"^tcp: "):
        robot.with_tcp(2 * np.eye(4))

    elbow = robot.joint_names[2]
    locked = core.Robot.from_urdf(
        robot.urdf,
        base_link=robot.base_link,
        tip_link=robot.tip_link,
        locked_joints={elbow: joints[0, 2]},
    )
    assert locked.dof == 5
    assert locked.locked_joints == {elbow: joints[0, 2]}
    np.testing.assert_allclose(
        locked.fk(np.delete(joints[0], 2)), robot.fk(joints[0]), atol=1e-14
    )


def test_robot_facts_have_their_types(robot):
    assert robot.joint_types == [core.JointType.revolute] * 6
    assert isinstance(robot.chain_hash, int)
    assert robot.reach > 0
    assert robot.reach_centre.shape == (3,)
    assert robot.tcp.shape == (4, 4)


# Options


@pytest.mark.parametrize("cls", OPTION_CLASSES)
def test_defaults_show_nothing(cls):
    assert repr(cls()) == f"{cls.__name__}()"
    assert cls() == cls()


def test_repr_shows_what_differs():
    assert (
        repr(core.SolverOptions(max_attempts=2, iteration="dls"))
        == "SolverOptions(max_attempts=2, iteration='dls')"
    )
    nested = core.SolverOptions(database=core.DatabaseOptions(samples=5))
    assert repr(nested) == "SolverOptions(database=DatabaseOptions(samples=5))"


@pytest.mark.parametrize("cls", OPTION_CLASSES)
def test_repr_makes_an_equal_object(cls):
    for options in (cls(), cls.paper(), cls(**CHANGES[cls])):
        assert eval(repr(options), vars(core)) == options


@pytest.mark.parametrize("cls", OPTION_CLASSES)
def test_dict_makes_an_equal_object(cls):
    for options in (cls(), cls.paper(), cls(**CHANGES[cls])):
        assert cls(**options.to_dict()) == options
        for name, value in options.to_dict().items():
            if not isinstance(value, dict):
                attribute = getattr(options, name)
                assert getattr(attribute, "name", attribute) == value


@pytest.mark.parametrize("cls", OPTION_CLASSES)
@pytest.mark.parametrize("via", ["pickle", "copy", "deepcopy"])
def test_options_are_copied_whole(cls, via):
    make = {
        "pickle": lambda o: pickle.loads(pickle.dumps(o)),
        "copy": copy.copy,
        "deepcopy": copy.deepcopy,
    }[via]
    options = cls(**CHANGES[cls])
    twin = make(options)
    assert twin == options
    twin.seed = 5
    assert twin != options


@pytest.mark.parametrize("cls", OPTION_CLASSES)
def test_replace_leaves_the_original(cls):
    options = cls()
    changed = options.replace(**CHANGES[cls])
    assert options == cls()
    assert changed == cls(**CHANGES[cls])
    assert changed != options


@pytest.mark.parametrize("cls", OPTION_CLASSES)
def test_every_field_makes_a_difference(cls):
    for name, value in cls().to_dict().items():
        assert name in cls.__init__.__doc__
        assert name in cls.replace.__doc__
        assert getattr(cls, name).__doc__
        if isinstance(value, bool):
            other = not value
        elif isinstance(value, int):
            other = value + 1
        elif isinstance(value, float):
            other = value * 0.5 or 0.5
        elif isinstance(value, dict):
            other = {"samples": 1} if name == "database" else core.Task.free_spin()
        else:
            enum = type(getattr(cls(), name))
            other = next(member.name for member in enum if member.name != value)
        # Only a full key has a choice of rotation_key.
        base = cls(key_scheme="full") if name == "rotation_key" else cls()
        options = base.replace(**{name: other})
        assert options != base
        assert options.replace(**{name: value}) == base
        assert f"{name}=" in repr(options)


def test_enums_are_taken_as_members_and_names():
    options = core.SolverOptions(iteration=core.Iteration.pinv)
    assert options == core.SolverOptions(iteration="pinv")
    assert options.iteration is core.Iteration.pinv
    options.iteration = "cwln"
    assert options.iteration is core.Iteration.cwln
    assert {member.name for member in core.Iteration} == {
        "dls", "pinv", "pinv_rr", "cwln", "cwpi", "lm",
    }  # fmt: skip


@pytest.mark.parametrize("value", ["newton", "", "DLS", 0, None, core.Scale.small])
def test_wrong_enum_lists_the_possible_names(value):
    match = r"^iteration: expected one of dls, pinv, pinv_rr, cwln, cwpi, lm, got "
    with pytest.raises(core.InvalidArgumentError, match=match):
        core.SolverOptions(iteration=value)
    with pytest.raises(core.InvalidArgumentError, match=match):
        core.SolverOptions().iteration = value


@pytest.mark.parametrize("cls", OPTION_CLASSES)
def test_unknown_keyword_is_named_with_the_possible_ones(cls):
    for call in (cls, cls().replace):
        with pytest.raises(TypeError, match=f"^{cls.__name__}: no field 'sed'; .*seed"):
            call(sed=1)
    with pytest.raises(TypeError):
        cls(1)
    with pytest.raises(AttributeError):
        cls().sed = 1


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("neighbours", "many"),
        ("neighbours", 1.5),
        ("neighbours", True),
        ("neighbours", 2**40),
        ("neighbours", 0),
        ("position_tolerance", "small"),
        ("position_tolerance", True),
        ("position_tolerance", -1.0),
        ("position_tolerance", np.nan),
        ("limit_aware", 1),
        ("limit_aware", "yes"),
        ("seed", -1),
        ("database", 3),
        ("database", {"samples": -1}),
    ],
)
def test_wrong_value_names_its_field(name, value):
    culprit = "samples" if isinstance(value, dict) else name
    with pytest.raises(core.InvalidArgumentError, match=culprit):
        core.SolverOptions(**{name: value})


def test_numpy_numbers_are_numbers():
    options = core.SolverOptions(
        neighbours=np.int32(7),
        position_tolerance=np.float32(0.5),
        limit_aware=np.bool_(False),  # noqa: FBT003
        rotation_tolerance=1,
    )
    assert options.neighbours == 7
    assert options.position_tolerance == 0.5
    assert options.limit_aware is False
    assert options.rotation_tolerance == 1.0


def test_nested_options_are_reached_in_place():
    options = core.SolverOptions()
    options.database.samples = 42
    assert options.database.samples == 42
    inner = options.database
    del options
    gc.collect()
    assert inner.samples == 42


def test_options_are_not_hashable_and_equal_to_nothing_else():
    with pytest.raises(TypeError):
        hash(core.SolverOptions())
    assert core.SolverOptions() != core.DatabaseOptions()
    assert core.SolverOptions() != "SolverOptions()"


def test_solver_keeps_its_own_options(robot, solver):
    options = core.SolverOptions(database={"samples": 2000})
    assert solver.options == options
    solver.options.seed = 99
    assert solver.options == options
    options.max_iterations = -1
    with pytest.raises(core.InvalidArgumentError, match="max_iterations"):
        core.Solver(robot, options)
    with pytest.raises(core.InvalidArgumentError, match="max_iterations"):
        options.validate()


# Errors


def test_error_hierarchy():
    for error, bases in (
        (core.Error, (Exception,)),
        (core.UrdfError, (core.Error,)),
        (core.UnknownNameError, (core.UrdfError,)),
        (core.InvalidArgumentError, (core.Error, ValueError)),
        (core.SignatureError, (core.InvalidArgumentError, TypeError)),
        (core.DatabaseError, (core.Error,)),
        (core.DatabaseIoError, (core.DatabaseError,)),
        (core.DatabaseCorruptError, (core.DatabaseError,)),
        (core.DatabaseMismatchError, (core.DatabaseError,)),
    ):
        assert error.__bases__ == bases
        assert error.__doc__
        twin = pickle.loads(pickle.dumps(error("why")))
        assert type(twin) is error
        assert twin.args == ("why",)


# Database


@pytest.fixture(scope="module")
def database(robot):
    options = core.DatabaseOptions(key_scheme="full", rotation_weight=1.0, samples=2000)
    return core.Database.build(robot, options)


def test_database_round_trips(database, tmp_path):
    path = tmp_path / "arm.iksel"
    database.save(path)
    content = database.to_bytes()
    assert path.read_bytes() == content
    for twin in (
        core.Database.load(path),
        core.Database.load(str(path)),
        core.Database.from_bytes(content),
        pickle.loads(pickle.dumps(database)),
        copy.deepcopy(database),
    ):
        assert twin.to_bytes() == content
        assert twin.options == database.options
        assert twin.chain_hash == database.chain_hash


def test_database_file_errors(database, tmp_path):
    with pytest.raises(core.DatabaseIoError):
        core.Database.load(tmp_path / "missing.iksel")
    with pytest.raises(core.DatabaseIoError):
        database.save(tmp_path / "missing" / "arm.iksel")
    with pytest.raises(core.DatabaseCorruptError):
        core.Database.from_bytes(b"no database at all")
    with pytest.raises(core.InvalidArgumentError, match=r"^path: expected a path"):
        core.Database.load(3)


def test_database_facts(robot, database):
    assert len(database) == database.size == 2000
    assert database.dof == robot.dof
    assert database.chain_hash == robot.chain_hash
    assert database.nbytes > 2000 * 8 * (6 + 6 + 36)
    assert database.key_dimension == 6
    text = f"Database(2000 samples, dof=6, {database.options!r})"
    assert repr(database) == text


def test_samples_are_consistent(robot, database):
    for i in (0, 1234, np.int64(1999)):
        q = database.q(i)
        np.testing.assert_allclose(robot.fk(q), database.pose(i), atol=1e-12)
        inverse = database.pseudo_inverse(i)
        assert inverse.shape == (6, 6)
        jacobian = robot.jacobian(q)
        np.testing.assert_allclose(
            inverse, np.linalg.pinv(jacobian, rcond=1e-4), atol=1e-6
        )


@pytest.mark.parametrize("i", [-1, 2000, 10**9])
def test_sample_index_is_checked(database, i):
    for function in (database.q, database.pose, database.pseudo_inverse):
        with pytest.raises(core.InvalidArgumentError, match=r"^i: "):
            function(i)


def test_nearest_finds_a_sample_at_its_own_pose(database):
    found = database.nearest(database.pose(17), 5)
    assert found.dtype == np.int64
    assert found.shape == (5,)
    assert found[0] == 17
    with pytest.raises(core.InvalidArgumentError, match=r"^pose: "):
        database.nearest(np.zeros((4, 4)), 5)


def test_database_of_another_robot_is_refused(made, database):
    with pytest.raises(core.DatabaseMismatchError, match="ur5"):
        core.Solver(made.robot("ur5"), database=database)


def test_build_reports_progress_and_stops_on_an_exception(robot):
    options = core.DatabaseOptions(samples=5000)
    calls = []
    built = core.Database.build(
        robot, options, progress=lambda done, total: calls.append((done, total))
    )
    assert len(built) == 5000
    assert calls == sorted(calls)
    assert calls[-1] == (5000, 5000)

    def refuse(done, total):
        raise LookupError

    with pytest.raises(LookupError):
        core.Database.build(robot, options, progress=refuse)


@pytest.mark.skipif(sys.platform == "win32", reason="signals to oneself")
@pytest.mark.skipif(
    threading.current_thread() is not threading.main_thread(), reason="main thread only"
)
def test_interrupt_ends_a_long_build(robot, interrupted):
    endless = core.DatabaseOptions(sampling="cvt", samples=1000, cvt_updates=10**9)
    with interrupted():
        core.Database.build(robot, endless)


# Solver


def test_solver_round_trips(solver, poses):
    expected = solver.solve_batch(poses)
    for twin in (
        pickle.loads(pickle.dumps(solver)),
        copy.copy(solver),
        copy.deepcopy(solver),
    ):
        np.testing.assert_array_equal(twin.solve_batch(poses).q, expected.q)
        assert repr(twin) == repr(solver)


def test_robot_round_trips(robot, joints):
    tcp = np.eye(4)
    tcp[:3, 3] = 0.0, 0.0, 0.1
    for original in (robot, robot.with_tcp(tcp)):
        for twin in (
            pickle.loads(pickle.dumps(original)),
            copy.copy(original),
            copy.deepcopy(original),
        ):
            np.testing.assert_array_equal(twin.fk(joints), original.fk(joints))
            assert twin.chain_hash == original.chain_hash
            assert repr(twin) == repr(original)


def test_results_round_trip(solver, poses):
    far = np.eye(4)
    far[0, 3] = 9.0
    for pose in (poses[0], far):
        result = solver.solve(pose)
        twin = pickle.loads(pickle.dumps(result))
        assert repr(twin) == repr(result)
        np.testing.assert_array_equal(twin.q, result.q)
    batch = solver.solve_batch(poses)
    twin = pickle.loads(pickle.dumps(batch))
    for name in ("q", "success", "status", "position_error", "attempts", "iterations"):
        np.testing.assert_array_equal(getattr(twin, name), getattr(batch, name))
    assert repr(copy.deepcopy(batch)) == repr(batch)


def test_seed_is_tried_first(robot, solver, joints, poses):
    for q, pose in zip(joints, poses, strict=True):
        result = solver.solve(pose, seeds=[q])
        assert result.success
        assert result.attempts == 1
        turns = (result.q - q) / (2 * np.pi)
        np.testing.assert_allclose(turns, np.round(turns), atol=1e-5)
        single = solver.solve(pose, seeds=q)
        np.testing.assert_array_equal(single.q, result.q)


def test_batch_lets_other_threads_run(robot, solver):
    slow = core.Solver(robot, core.SolverOptions.paper(), solver.database)
    poses = robot.fk(robot.random_configurations(2000, 1))
    ticks = 0
    finished = threading.Event()

    def tick():
        nonlocal ticks
        while not finished.wait(0.001):
            ticks += 1

    thread = threading.Thread(target=tick)
    thread.start()
    slow.solve_batch(poses, threads=1)
    seen = ticks
    finished.set()
    thread.join()
    assert seen > 0


# Evaluation


def test_evaluation(solver):
    calls = []
    outcome = core.evaluate(
        solver, 200, seed=3, progress=lambda done, total: calls.append((done, total))
    )
    assert outcome.targets == 200
    assert outcome.seed == 3
    assert outcome.false_success == 0
    assert outcome.success_percent == pytest.approx(100 * outcome.solved / 200)
    assert outcome.min_us <= outcome.median_us <= outcome.p99_us <= outcome.max_us
    assert outcome.ratio == pytest.approx(outcome.mean_us / outcome.kdl_fk_jac_us)
    assert outcome.query_us == 0
    assert calls[-1] == (200, 200)
    assert pickle.loads(pickle.dumps(outcome)) == outcome
    assert outcome.to_dict()["seed"] == 3
    with pytest.raises(AttributeError):
        outcome.solved = 200


def test_evaluation_with_stages(solver):
    outcome = core.evaluate(solver, 200, 3, stages=True)
    assert outcome.iterate_us > 0


def test_kdl_time_is_a_time(robot):
    assert 0 < core.time_kdl_fk_jacobian(robot) < 1e4


def test_pose_error_is_zero_only_between_equals(poses):
    np.testing.assert_allclose(core.pose_error(poses[0], poses[0]), 0, atol=1e-12)
    moved = poses[0].copy()
    moved[2, 3] += 0.25
    error = core.pose_error(moved, poses[0])
    np.testing.assert_allclose(error, [0, 0, 0.25, 0, 0, 0], atol=1e-12)
    rows = core.pose_error(poses, poses[::-1])
    assert rows.shape == (len(poses), 6)
    for row, target, pose in zip(rows, poses, poses[::-1], strict=True):
        np.testing.assert_array_equal(row, core.pose_error(target, pose))
    with pytest.raises(core.InvalidArgumentError, match="as many poses as targets"):
        core.pose_error(poses, poses[1:])
    with pytest.raises(core.InvalidArgumentError, match=r"pose: .*\(4, 4\)"):
        core.pose_error(poses[0], poses)


def test_grid_counts_are_the_papers():
    assert core.grid_counts(6, "medium") == [8, 7, 6, 6, 5, 4]
    assert core.grid_counts(7, core.Scale.small) == [6, 5, 5, 5, 4, 4, 4]
