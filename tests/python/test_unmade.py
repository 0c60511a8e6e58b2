# SPDX-License-Identifier: BSD-3-Clause
"""Objects that were never made, and pickles that hold the wrong state, are refused."""

from __future__ import annotations

import contextlib
import importlib.util
import math
import pickle
import subprocess
import sys
import textwrap
from pathlib import Path

import iksel_cpp as core
import numpy as np
import pytest
from trees import two_armed

import iksel

CLASSES = [
    thing for thing in vars(core).values() if type(thing).__name__ == "pybind11_type"
]

# What Python itself gives every object.
OF_OBJECT = set(dir(object)) - {"__repr__", "__eq__", "__hash__"}


def half_square(q: np.ndarray) -> float:
    """A cost that pickles."""
    return 0.5 * float(q @ q)


@pytest.fixture(scope="module")
def solver(made) -> iksel.Solver:
    return iksel.Solver(
        made.robot("ur3"), iksel.SolverOptions(database={"samples": 500})
    )


def examples(solver: iksel.Solver) -> list[object]:
    """One of each bound class, or several where they differ much."""
    robot = solver.robot
    q = robot.random_configurations(5, 3)
    poses = robot.fk(q)
    far = poses[0].copy()
    far[0, 3] = 9.0
    line = np.stack([poses[0]] * 3)
    line[:, 2, 3] += [0.0, 1e-3, 2e-3]
    broken = line.copy()
    broken[2, 0, 3] = 9.0
    tracker = solver.tracker(q[0])
    tracker.track(line[1], dt=0.1)
    tree = iksel.LinkTree.from_urdf(robot.urdf)
    seven = iksel.Solver(iksel.load_robot("panda"), solver.options)
    motion = seven.self_motion(
        seven.robot.fk(seven.robot.random_configurations(1, 3)[0])
    )
    return [
        robot,
        robot.structure,
        tree,
        tree.joints[1],
        iksel.CoupledLimit({"a": 1.0, "b": -0.5}, lower=-1.0),
        iksel.MimicCurve("a", "b", [0.0, 1.0], [0.0, 2.0]),
        solver,
        solver.options,
        iksel.Lanes(damping=0.5),
        iksel.Paper(iteration="cwln"),
        solver.options.database,
        solver.database,
        iksel.Selector(
            iksel.Database.build(robot, {"key_scheme": "full", "samples": 9})
        ),
        iksel.Task.free_spin(),
        solver.solve(poses[0]),
        solver.solve(far),
        solver.solve(poses[1], near=q[0], objective="limits"),
        solver.solve_batch(np.concatenate([poses, far[None]]), near=q[0]),
        solver.solve_all(poses[0], near=q[0]),
        solver.solve_all(far),
        solver.solve_path(line, start=q[0]),
        solver.solve_path(broken, start=q[0]),
        motion,
        motion[0],
        motion[0].end,
        solver.diagnose(poses[0]),
        solver.diagnose(far),
        *proven_noes(solver),
        *scene_and_parts(robot),
        *two_arms(solver),
        solver.solve(far, closest=True),
        iksel.Objective.near_posture(q[0], weights=np.arange(6.0)),
        iksel.Objective.far_from_limits(),
        iksel.Objective.custom(half_square, np.negative),
        iksel.evaluate(solver, 10, seed=1),
        tracker,
    ]


def scene_and_parts(robot: iksel.Robot) -> list[object]:
    """A scene that touches the arm, and what it is made of."""
    link = robot.link_names[-1]
    spheres = iksel.RobotSpheres({link: [[0.0, 0.0, 0.0, 0.05]]}, [])
    scene = iksel.Scene(robot, spheres)
    scene.add_box("box", [1.0, 1.0, 1.0], robot.fk(np.zeros(robot.dof)), margin=0.01)
    scene.add_points("cloud", [[2.0, 0.0, 0.0], [2.0, 0.1, 0.0]], radius=0.01)
    contacts = scene.contacts(np.zeros(robot.dof))
    return [scene, spheres, *scene.obstacles.values(), contacts[0]]


def two_arms(solver: iksel.Solver) -> list[object]:
    """Several tips, and what is found for them."""
    both = iksel.Solver(two_armed(solver.robot), solver.options)
    poses = both.robot.fk(both.robot.random_configurations(3, 3))
    poses[2, 1, 0, 3] = 9.0
    return [
        both,
        both.robot,
        both.solve(poses[0]),
        both.solve(poses[2]),
        both.solve_all(poses[0]),
        both.solve_batch(poses),
        both.diagnose(poses[2]),
        both.tracker(np.zeros(both.robot.dof)),
    ]


def proven_noes(solver: iksel.Solver) -> list[iksel.Diagnosis]:
    """One for each cause that a closed form proves."""
    robot = solver.robot
    poses = robot.fk(robot.random_configurations(40, seed=9))
    poses[:, :3, :3] = poses[::-1, :3, :3].copy()
    found = {}
    for name in ("ur3", "irb120"):
        other = iksel.Solver(iksel.load_robot(name))
        for diagnosis in map(other.diagnose, poses):
            if diagnosis.proof == iksel.Proof.closed_form:
                found[diagnosis.cause] = diagnosis
    assert set(found) == {iksel.Cause.no_branch, iksel.Cause.joint_limits}
    return list(found.values())


def value_of(thing: object, name: str) -> object:
    """An attribute, or the words of its refusal."""
    try:
        return getattr(thing, name)
    except iksel.InvalidArgumentError as error:
        return str(error)


def contents(thing: object) -> dict[str, object]:
    """All that can be read of an object."""
    names = [n for n in dir(thing) if not n.startswith("_") and n != "nominal"]
    values = {name: value_of(thing, name) for name in names}
    plain = {name: value for name, value in values.items() if not callable(value)}
    if hasattr(thing, "__len__") and not isinstance(thing, iksel.Database):
        plain["rows"] = [repr(row) for row in thing]
    return plain | {"repr": repr(thing)}


def test_every_class_has_an_example(solver) -> None:
    assert {type(thing) for thing in examples(solver)} == set(CLASSES)
    assert len(CLASSES) >= 14


def test_the_fuzzer_of_pickles_knows_every_class() -> None:
    folder = Path(__file__).parents[1] / "fuzz"
    if not folder.is_dir():
        pytest.skip("the fuzzers are not part of the package")
    spec = importlib.util.spec_from_file_location(
        "pickle_samples", folder / "pickle_samples.py"
    )
    samples = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(samples)
    assert {type(sample) for sample in samples.make_samples()} == set(CLASSES)


# Pickles


@pytest.mark.parametrize("protocol", range(2, pickle.HIGHEST_PROTOCOL + 1))
def test_everything_bound_is_pickled_whole(solver, protocol: int) -> None:
    for thing in examples(solver):
        twin = pickle.loads(pickle.dumps(thing, protocol))
        assert type(twin) is type(thing)
        before, after = contents(thing), contents(twin)
        assert before.keys() == after.keys()
        for name, value in before.items():
            if isinstance(value, (np.ndarray, float)):
                np.testing.assert_array_equal(after[name], value, err_msg=name)
            elif "object at 0x" not in repr(value):
                assert repr(after[name]) == repr(value), name


def test_objectives_and_trackers_go_on_as_before(solver) -> None:
    pose = solver.robot.fk(np.full(6, 0.4))
    for objective in (
        iksel.Objective.near_posture(np.ones(6)),
        iksel.Objective.custom(half_square),
    ):
        twin = pickle.loads(pickle.dumps(objective))
        expected = solver.solve(pose, objective=objective)
        np.testing.assert_array_equal(solver.solve(pose, objective=twin).q, expected.q)
    tracker = solver.tracker(np.zeros(6))
    twin = pickle.loads(pickle.dumps(tracker))
    for _ in range(3):
        one, other = tracker.track(pose, 0.01), twin.track(pose, 0.01)
        assert repr(one) == repr(other)
        np.testing.assert_array_equal(tracker.q, twin.q)


def test_a_cost_that_cannot_be_pickled_says_so() -> None:
    objective = iksel.Objective.custom(lambda q: 0.0)
    with pytest.raises((pickle.PicklingError, AttributeError), match="lambda"):
        pickle.dumps(objective)


def states(thing: object) -> object:
    """The state of a pickle."""
    return thing.__getstate__()


def unpickled(cls: type, state: object) -> object:
    made = cls.__new__(cls)
    made.__setstate__(state)
    return made


JUNK = (
    None,
    3,
    -7,
    2**70,
    math.nan,
    "x",
    b"x",
    (),
    [],
    {},
    [math.nan] * 6,
    np.eye(3),
    object(),
)


def test_states_of_another_kind_are_refused(solver) -> None:
    for thing in examples(solver):
        for junk in (None, 3, "x", b"x", (), (1,), {"x": 1}, [], object()):
            with pytest.raises(iksel.Error):
                unpickled(type(thing), junk)


def test_states_with_other_items_are_refused(solver) -> None:
    for thing in examples(solver):
        state = states(thing)
        if isinstance(state, bytes):
            continue
        first = next(iter(state))
        without = {key: value for key, value in state.items() if key != first}
        for other in (without, {**state, "x": 1}, {**without, "x": 1}, {**state, 3: 1}):
            with pytest.raises(iksel.InvalidArgumentError):
                unpickled(type(thing), other)


def test_states_with_junk_in_them_are_refused_or_harmless(solver) -> None:
    refused = 0
    for thing in examples(solver):
        state = states(thing)
        if isinstance(state, bytes):
            continue
        for key in state:
            for junk in JUNK:
                try:
                    contents(unpickled(type(thing), {**state, key: junk}))
                except iksel.Error:
                    refused += 1
    assert refused > 500


def test_arrays_that_do_not_fit_each_other_are_refused(solver) -> None:
    poses = solver.robot.fk(solver.robot.random_configurations(4, 5))
    state = states(solver.solve_batch(poses))

    def refuse(match: str, **items: object) -> None:
        with pytest.raises(iksel.InvalidArgumentError, match=match):
            unpickled(iksel.BatchResult, {**state, **items})

    for name, array in state.items():
        for other in (array[:-1], array.astype(np.float32), array[..., None], array[0]):
            refuse("pickled BatchResult", **{name: other})
    status, success, proof, q = (
        state[name].copy() for name in ("status", "success", "proof", "q")
    )
    status[1] = 200
    refuse("status.*200", status=status)
    success[2] = False
    refuse("success", success=success)
    for value in (0, 1, 200):
        proof[2] = value
        refuse("proof.*row 2", proof=proof)
    q[3, 2] = math.nan
    refuse("row 3.*joint 2", q=q)


def test_proofs_that_there_are_not_are_refused(solver) -> None:
    far = np.eye(4)
    far[0, 3] = 9.0
    here = solver.robot.fk(np.zeros(6))
    failed, solved = states(solver.solve(far)), states(solver.solve(here))
    assert (failed["proof"], solved["proof"]) == ("reach", "answer")
    nothing, found = states(solver.solve_all(far)), states(solver.solve_all(here))
    for wrong in ("perhaps", 1, None):
        with pytest.raises(iksel.InvalidArgumentError, match="pickled Result, proof"):
            unpickled(iksel.Result, {**failed, "proof": wrong})
        with pytest.raises(iksel.InvalidArgumentError, match="Solutions, proof"):
            unpickled(iksel.Solutions, {**nothing, "proof": wrong})
        with pytest.raises(iksel.InvalidArgumentError, match="Structure, kind"):
            unpickled(iksel.Structure, {"kind": wrong, "description": "text"})
    for type_, state, wrong in (
        (iksel.Result, solved, "reach"),
        (iksel.Result, solved, "none"),
        (iksel.Result, failed, "answer"),
        (iksel.Solutions, found, "none"),
        (iksel.Solutions, nothing, "answer"),
    ):
        with pytest.raises(iksel.InvalidArgumentError, match="answer.*where solved"):
            unpickled(type_, {**state, "proof": wrong})


def test_joint_values_of_another_length_are_refused(solver) -> None:
    tracker = states(solver.tracker(np.zeros(6)))
    with pytest.raises(iksel.InvalidArgumentError, match=r"q: expected a \(6,\)"):
        unpickled(iksel.Tracker, {**tracker, "q": np.zeros(7)})
    with pytest.raises(iksel.Error, match="solver"):
        unpickled(iksel.Tracker, {**tracker, "solver": solver.robot})
    result = states(solver.solve(solver.robot.fk(np.zeros(6))))
    for q in (np.zeros(33), np.zeros((2, 3)), np.full(6, math.nan), None):
        with pytest.raises(iksel.InvalidArgumentError, match="q"):
            unpickled(iksel.Result, {**result, "q": q})


# Objects that were never made


def unmade(cls: type) -> object:
    """What a pickle that ends before the state leaves."""
    return pickle.loads(
        b"\x80\x02c" + f"{cls.__module__}\n{cls.__name__}\n".encode() + b")\x81."
    )


def test_unmade_objects_raise_in_all_that_they_have() -> None:
    # In a process of its own: what this guards against ends the interpreter.
    program = """
        import sys
        sys.path.insert(0, sys.argv[1])
        import test_unmade
        test_unmade.try_all()
        print("all tried")
    """
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(program), __file__.rpartition("/")[0]],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout) == (0, "all tried\n"), done.stderr[-3000:]


def try_all() -> None:
    """Try every attribute and method of every class, with any number of arguments."""
    tried = 0
    for cls in CLASSES:
        for thing in (
            unmade(cls),
            cls.__new__(cls),
            type("Sub", (cls,), {}).__new__(cls),
        ):
            for text in (repr, str):
                with pytest.raises(iksel.Error):
                    text(thing)
            with contextlib.suppress(iksel.Error):
                pickle.dumps(thing)
                pytest.fail(f"{cls.__name__} was pickled without a state")
            for name in dir(cls):
                if name in OF_OBJECT or name in {"__setstate__", "__module__"}:
                    continue
                if name.startswith("_pybind11_"):  # between modules, for nobody else
                    continue
                member = vars(cls).get(name)
                if member is None or isinstance(member, staticmethod):
                    continue
                tried += 1
                if isinstance(member, property):
                    with pytest.raises(iksel.Error):
                        getattr(thing, name)
                    continue
                # Python asks the other object where operators take no such argument.
                for count in (1,) if name == "__eq__" else range(5):
                    with pytest.raises(iksel.Error):
                        # An iterator asks for rows later.
                        list(getattr(thing, name)(*[None] * count))
    assert tried > 300


def test_unmade_objects_are_refused_as_arguments(solver) -> None:
    for call in (
        lambda: iksel.Solver(unmade(iksel.Robot)),
        lambda: iksel.Solver(solver.robot, options=unmade(iksel.SolverOptions)),
        lambda: iksel.Solver(solver.robot, database=unmade(iksel.Database)),
        lambda: iksel.evaluate(unmade(iksel.Solver), 10, 1),
        lambda: solver.solve(np.eye(4), task=unmade(iksel.Task)),
        lambda: solver.solve(np.eye(4), objective=unmade(iksel.Objective)),
        lambda: solver.options == unmade(iksel.SolverOptions),
    ):
        with pytest.raises(iksel.InvalidArgumentError, match="never made"):
            call()


def test_methods_before_the_constructor_are_refused() -> None:
    class Hasty(iksel.Solver):
        def __init__(self) -> None:
            self.solve(np.eye(4))

    with pytest.raises(iksel.InvalidArgumentError, match="never made"):
        Hasty()
