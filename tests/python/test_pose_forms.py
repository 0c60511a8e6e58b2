# SPDX-License-Identifier: BSD-3-Clause
"""Poses as people and other libraries hold them."""

from __future__ import annotations

import re
import types

import numpy as np
import pytest

import iksel

SEED = 51


class Rotation:
    """Like scipy's: of one rotation or of several."""

    def __init__(self, matrix):
        self.matrix = matrix

    def as_matrix(self):
        return self.matrix


class Array:
    def __init__(self, matrix):
        self.matrix = matrix

    def __array__(self, dtype=None, copy=None):
        return np.array(self.matrix, dtype)


def message(first: str, second: str, around: str = ""):
    """As of ROS: a position and a quaternion with named fields, or several."""

    def one(matrix):
        w, *xyz = iksel.quaternion_from_pose(matrix)
        position = types.SimpleNamespace(**dict(zip("xyz", matrix[:3, 3], strict=True)))
        rotation = types.SimpleNamespace(**dict(zip("xyzw", (*xyz, w), strict=True)))
        made = types.SimpleNamespace(**{first: position, second: rotation})
        return types.SimpleNamespace(header=None, **{around: made}) if around else made

    def make(matrices):
        if matrices.ndim == 2:
            return one(matrices)
        return types.SimpleNamespace(poses=[one(matrix) for matrix in matrices])

    return make


def as_dict(value):
    """A message as ROS's tools print it."""
    if isinstance(value, list):
        return [as_dict(item) for item in value]
    if isinstance(value, types.SimpleNamespace):
        return {name: as_dict(item) for name, item in vars(value).items()}
    return value


FORMS = {
    "Pose": message("position", "orientation"),
    "PoseStamped": message("position", "orientation", "pose"),
    "Transform": message("translation", "rotation"),
    "TransformStamped": message("translation", "rotation", "transform"),
    "dict": lambda t: as_dict(message("position", "orientation")(t)),
    "matrix": lambda t: t,
    "3x4": lambda t: t[..., :3, :],
    "3x4 list": lambda t: t[..., :3, :].tolist(),
    "float32": lambda t: t.astype(np.float32),
    "pair of arrays": lambda t: (t[..., :3, 3], t[..., :3, :3]),
    "pair of lists": lambda t: [t[..., :3, 3].tolist(), t[..., :3, :3].tolist()],
    "pair with a rotation": lambda t: (t[..., :3, 3], Rotation(t[..., :3, :3])),
    "as_matrix": Rotation,
    "homogeneous": lambda t: types.SimpleNamespace(homogeneous=t),
    "A": lambda t: types.SimpleNamespace(A=t if t.ndim == 2 else list(t)),
    "__array__": Array,
}


def same(ours, theirs, form):
    atol = 1e-6 if form == "float32" else 1e-12
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=atol)


@pytest.fixture(scope="module")
def poses(made):
    robot = made.robot("ur3")
    return robot.fk(robot.random_configurations(5, SEED))


@pytest.mark.parametrize("form", FORMS)
def test_forms_of_one_pose(made, poses, form) -> None:
    solver, pose = made.solver("ur3"), poses[0]
    held = FORMS[form](pose)
    near = np.zeros(6)
    same(solver.solve(held).q, solver.solve(pose).q, form)
    same(solver.solve(held, near=near).q, solver.solve(pose, near=near).q, form)
    same(solver.solve_all(held).q, solver.solve_all(pose).q, form)
    assert solver.diagnose(held).cause == iksel.Cause.none
    same(solver.robot.with_tcp(held).tcp, pose, form)
    same(iksel.as_pose(held), pose, form)
    same(iksel.check_pose(held), pose, form)
    same(iksel.orthonormalized(held), pose, form)
    same(iksel.euler_from_pose(held), iksel.euler_from_pose(pose), form)
    same(iksel.pose_error(held, pose), (0, 0), form)
    same(
        solver.tracker(near).track(held, 9).q,
        solver.tracker(near).track(pose, 9).q,
        form,
    )
    assert list(solver.database.nearest(held, 2)) == list(
        solver.database.nearest(pose, 2)
    )


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("listed", [False, True])
@pytest.mark.parametrize("n", [1, 2, 3, 4, 5])
def test_forms_of_many_poses(made, poses, form, listed, n) -> None:
    solver, poses = made.solver("ur3"), poses[:n]
    make = FORMS[form]
    held = [make(pose) for pose in poses] if listed else make(poses)
    same(solver.solve_batch(held).q, solver.solve_batch(poses).q, form)
    same(solver.solve_path(held).q, solver.solve_path(poses).q, form)
    same(iksel.as_pose(held), poses, form)


@pytest.mark.parametrize("n", [2, 3, 4])
def test_many_positions_may_have_one_rotation(poses, n) -> None:
    positions, rotation = poses[:n, :3, 3], poses[0, :3, :3]
    expected = iksel.pose_from_matrix(positions, rotation)
    same(iksel.as_pose((positions, Rotation(rotation))), expected, "")


@pytest.mark.parametrize(
    ("orientation", "text"),
    [
        ((0, 0, 0, 0), "x, y, z, w = .*, as in a message that was not filled in"),
        ((0, 0, 0.5, 1), "its orientation is no unit quaternion"),
        ((0, 0, 0, np.nan), "its orientation is no unit quaternion"),
        ((0, 0, 0, "1"), "expected a number"),
    ],
)
def test_a_message_without_a_rotation_is_refused(made, orientation, text) -> None:
    quaternion = dict(zip("xyzw", orientation, strict=True))
    held = {"position": {"x": 0, "y": 0, "z": 0.3}, "orientation": quaternion}
    with pytest.raises(iksel.InvalidArgumentError, match="^pose: .*" + text):
        made.solver("ur3").solve(held)
    with pytest.raises(iksel.InvalidArgumentError, match="^poses: .*" + text):
        made.solver("ur3").solve_batch([{"pose": held}])


def test_a_rounded_quaternion_of_a_message_is_made_one(poses) -> None:
    held = message("position", "orientation")(poses[0])
    for name in "xyzw":
        setattr(held.orientation, name, round(getattr(held.orientation, name), 4))
    np.testing.assert_allclose(iksel.as_pose(held), poses[0], rtol=0, atol=2e-4)


class Tensor:
    """Like one of torch's that requires gradients."""

    requires_grad = True

    def __array__(self, dtype=None, copy=None):
        raise RuntimeError("Can't call numpy() on Tensor that requires grad.")

    def detach(self):
        return np.eye(4)


def refusals_of_gradients(solver, tensor, row):
    return {
        "pose": lambda: solver.solve(tensor),
        "poses": lambda: solver.solve_batch([tensor, tensor]),
        "near": lambda: solver.solve(np.eye(4), near=row),
        "q": lambda: solver.robot.fk(row),
        "value": lambda: iksel.as_pose((row, tensor)),
        "position": lambda: iksel.pose_from_euler(row, [0, 0, 0]),
    }


@pytest.mark.parametrize("argument", refusals_of_gradients(None, None, None))
def test_tensors_with_gradients(made, argument) -> None:
    call = refusals_of_gradients(made.solver("ur3"), Tensor(), Tensor())[argument]
    with pytest.raises(iksel.InvalidArgumentError, match=f"^{argument}: .*") as error:
        call()
    assert "detach()" in str(error.value) or argument == "position"


@pytest.mark.parametrize("argument", refusals_of_gradients(None, None, None))
def test_tensors_of_torch(made, argument) -> None:
    torch = pytest.importorskip("torch")
    tensor = torch.eye(4, dtype=torch.float64, requires_grad=True)
    row = torch.zeros(6, dtype=torch.float64, requires_grad=True)
    call = refusals_of_gradients(made.solver("ur3"), tensor, row)[argument]
    with pytest.raises(iksel.InvalidArgumentError, match=f"^{argument}: .*detach()"):
        call()
    detached = refusals_of_gradients(made.solver("ur3"), tensor.detach(), row.detach())
    if argument in {"pose", "poses", "near", "q"}:
        detached[argument]()


def test_spatialmath(made, poses) -> None:
    spatial = pytest.importorskip("spatialmath")
    held = spatial.SE3(list(poses))
    same(iksel.as_pose(held), poses, "")
    same(iksel.as_pose(held[0]), poses[0], "")
    for n in (1, 2, 3, 4, 5):
        turns = spatial.UnitQuaternion(list(iksel.quaternion_from_pose(poses[:n])))
        positions = poses[:n, :3, 3] if n > 1 else poses[0, :3, 3]
        expected = poses[:n] if n > 1 else poses[0]
        same(iksel.as_pose((positions, turns)), expected, "")
    one = (
        poses[0, :3, 3],
        spatial.UnitQuaternion(iksel.quaternion_from_pose(poses[0])),
    )
    same(made.solver("ur3").solve(one).q, made.solver("ur3").solve(poses[0]).q, "")
    with pytest.raises(iksel.InvalidArgumentError, match="pair"):
        made.solver("ur3").solve(one[1])


def test_one_position_may_have_many_rotations(made, poses) -> None:
    pair = (poses[0, :3, 3], poses[:, :3, :3])
    expected = iksel.pose_from_matrix(*pair)
    np.testing.assert_array_equal(iksel.as_pose(pair), expected)
    np.testing.assert_array_equal(
        made.solver("ur3").solve_batch(pair).q,
        made.solver("ur3").solve_batch(expected).q,
    )


@pytest.mark.parametrize("order", ["wxyz", "xyzw"])
@pytest.mark.parametrize("many", [False, True])
def test_quaternions_with_their_order_named(poses, order, many) -> None:
    poses = poses if many else poses[0]
    position, q = poses[..., :3, 3], iksel.quaternion_from_pose(poses)
    if order == "xyzw":
        q = np.roll(q, -1, axis=-1)
    for value in (
        (position, q),
        [position.tolist(), q.tolist()],
        np.concatenate([position, q], axis=-1),
    ):
        same(iksel.as_pose(value, order=order), poses, "")
    same(iksel.pose_from_quaternion(position, q, order=order), poses, "")


def test_the_scalar_comes_first_by_default(poses) -> None:
    q = iksel.quaternion_from_pose(poses)
    same(iksel.pose_from_quaternion(poses[:, :3, 3], q), poses, "")
    same(iksel.pose_from_quaternion(poses[:, :3, 3], q, "wxyz"), poses, "")


def endless() -> dict:
    """Lists, mappings and objects that hold themselves."""
    row: list = [1]
    row += [row, row]
    message: dict = {}
    message["pose"] = message
    one, other = types.SimpleNamespace(), types.SimpleNamespace()
    one.A, other.A = other, one
    deep = [1.0]
    for _ in range(100_000):
        deep = [deep]
    return {"list": row, "message": message, "object": one, "deep": deep}


@pytest.mark.parametrize("kind", endless())
def test_what_has_no_end_is_refused(made, kind) -> None:
    value, solver = endless()[kind], made.solver("ur3")
    for call in (solver.solve, solver.solve_batch, solver.robot.fk, iksel.as_pose):
        with pytest.raises(iksel.InvalidArgumentError, match="expected"):
            call(value)


QUATERNIONS = [
    ([0, 0, 0], [1, 0, 0, 0]),
    (np.zeros(3), np.array([1, 0, 0, 0])),
    np.array([0, 0, 0, 1, 0, 0, 0.0]),
    [0, 0, 0, 1, 0, 0, 0],
]


@pytest.mark.parametrize("value", QUATERNIONS)
def test_a_quaternion_without_an_order_is_refused(made, value) -> None:
    solver = made.solver("ur3")
    message = r"order.*iksel\.as_pose\(value, order=.wxyz.\) or order=.xyzw."
    for call in (solver.solve, solver.solve_all, solver.robot.with_tcp, iksel.as_pose):
        with pytest.raises(iksel.InvalidArgumentError, match=message):
            call(value)
    with pytest.raises(iksel.InvalidArgumentError, match="^poses: .*" + message):
        solver.solve_batch([value, value])


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (Rotation(np.eye(3)), "a pose, or a pair (position, rotation)"),
        (np.eye(3), "expected a (4, 4) array, got shape (3, 3)"),
        (np.zeros((2, 4, 4)), "expected a (4, 4) array, got shape (2, 4, 4)"),
        ("pose", "real numbers"),
        (None, "real numbers"),
        ([[1, 2], [3]], "real numbers"),
        ((np.zeros(3), "rotation"), "real numbers"),
        ((np.zeros(3), Rotation(np.eye(2))), "real numbers"),
        (types.SimpleNamespace(homogeneous=np.eye(3)), "pair (position, rotation)"),
        ((np.zeros(3), 2 * np.eye(3)), "not rigid"),
        (np.eye(4, dtype=complex), "complex128"),
        ([0, 0, 0.5], "a position says nothing of the rotation"),
    ],
)
def test_what_is_no_pose_is_refused(made, value, message) -> None:
    with pytest.raises(
        iksel.InvalidArgumentError, match="^pose: .*" + re.escape(message)
    ):
        made.solver("ur3").solve(value)


@pytest.mark.parametrize("order", ["zyxw", "", "WXYZ", 4])
def test_an_unknown_order_is_refused(order) -> None:
    for call in (
        lambda: iksel.as_pose([0, 0, 0, 1, 0, 0, 0], order=order),
        lambda: iksel.pose_from_quaternion([0, 0, 0], [1, 0, 0, 0], order=order),
    ):
        with pytest.raises(iksel.InvalidArgumentError, match=r"^order: .*wxyz, xyzw"):
            call()


def test_errors_of_the_object_itself_reach_the_caller(made) -> None:
    class Broken:
        def as_matrix(self):
            raise KeyError

    with pytest.raises(KeyError):
        made.solver("ur3").solve(Broken())


def test_scipy(made, poses) -> None:
    spatial = pytest.importorskip("scipy.spatial.transform")
    solver = made.solver("ur3")
    rotation = spatial.Rotation.from_matrix(poses[:, :3, :3])
    one = (poses[0, :3, 3], rotation[0])
    same(iksel.as_pose(one), poses[0], "")
    same(solver.solve(one).q, solver.solve(poses[0]).q, "")
    same(iksel.as_pose((poses[:, :3, 3], rotation)), poses, "")
    same(iksel.as_pose(list(zip(poses[:, :3, 3], rotation, strict=True))), poses, "")
    with pytest.raises(iksel.InvalidArgumentError, match="pair"):
        solver.solve(rotation[0])
    q = rotation.as_quat()
    same(iksel.pose_from_quaternion(poses[:, :3, 3], q, order="xyzw"), poses, "")
    if hasattr(spatial, "RigidTransform"):
        transform = spatial.RigidTransform.from_matrix(poses)
        same(iksel.as_pose(transform), poses, "")
        same(solver.solve(transform[0]).q, solver.solve(poses[0]).q, "")
        same(solver.solve_batch(transform).q, solver.solve_batch(poses).q, "")


@pytest.mark.parametrize("name", ["ur3", "panda"])
def test_a_position_is_enough_where_the_rotation_is_free(made, name) -> None:
    task = iksel.Task.position_only()
    robot = made.robot(name)
    solver = made.solver(name)
    free = iksel.Solver(robot, iksel.SolverOptions(task=task), solver.database)
    poses = robot.fk(robot.random_configurations(20, SEED))
    positions = poses[:, :3, 3]
    for position in positions:
        for result in (
            solver.solve(position, task=task),
            solver.solve(tuple(position), task=task, near=np.zeros(robot.dof)),
            solver.solve_all(position.tolist(), task=task)[0],
            free.solve(position),
        ):
            assert result.success
            assert np.linalg.norm(robot.fk(result.q)[:3, 3] - position) <= 1e-6
    for batch in (
        solver.solve_batch(positions, task=task),
        solver.solve_batch(positions.tolist(), task=task),
        free.solve_batch(positions),
    ):
        assert batch.success.all()
        reached = robot.fk(batch.q)[:, :3, 3]
        assert np.linalg.norm(reached - positions, axis=1).max() <= 1e-6
    assert free.solve_batch(positions[:2].tolist()).success.all()
    assert free.solve_path(positions[:1]).success
    # A bad row is a row as any other.
    positions[3] = np.nan
    assert free.solve_batch(positions).status[3] == iksel.Status.invalid_pose


@pytest.mark.parametrize(
    "task", [None, iksel.Task.free_spin(), iksel.Task.planar(), iksel.Task.upright()]
)
def test_a_position_is_too_little_elsewhere(made, task) -> None:
    solver = made.solver("ur3")
    message = r"a position says nothing of the rotation.*position_only\(\)"
    with pytest.raises(iksel.InvalidArgumentError, match="^pose: " + message):
        solver.solve([0.2, 0.1, 0.3], task=task)
    with pytest.raises(iksel.InvalidArgumentError, match="^poses: " + message):
        solver.solve_batch([[0.2, 0.1, 0.3]], task=task)
