# SPDX-License-Identifier: BSD-3-Clause
"""Calls that do not fit get a sentence that says what would."""

from __future__ import annotations

import types

import iksel_cpp as core
import numpy as np
import pytest
from urdf_text import arm

import iksel

CLASSES = [
    thing for thing in vars(core).values() if type(thing).__name__ == "pybind11_type"
]


@pytest.fixture(scope="module")
def solver(made) -> iksel.Solver:
    return made.solver("ur3")


def refuse(call, *words: str) -> str:
    with pytest.raises(iksel.SignatureError) as error:
        call()
    text = str(error.value)
    assert "\n" not in text
    assert "incompatible" not in text
    for word in words:
        assert word in text, text
    return text


def test_a_call_that_does_not_fit_is_a_type_error_of_the_library() -> None:
    assert issubclass(iksel.SignatureError, iksel.InvalidArgumentError)
    assert issubclass(iksel.SignatureError, TypeError)


def test_names_in_the_place_of_robots(solver) -> None:
    for call in (
        lambda: iksel.Solver("ur3"),
        lambda: iksel.Database.build("ur3"),
        lambda: iksel.time_kdl_fk_jacobian("ur3"),
        lambda: iksel.Solver(solver.robot, nominal="ur3"),
    ):
        refuse(call, "'ur3'", "load_robot(", "Robot.from_urdf(")
    refuse(lambda: iksel.evaluate("ur3", 10, 1), "solver", "Solver(robot)")
    refuse(lambda: iksel.Solver(solver.robot, database="ur3.iksel"), "Database.load(")
    refuse(
        lambda: iksel.Tracker(solver.robot, np.zeros(6)), "solver: expected a Solver"
    )
    with pytest.raises(
        iksel.InvalidArgumentError, match="options: expected SolverOptions"
    ):
        iksel.Solver(solver.robot, "paper")


@pytest.mark.parametrize("cls", CLASSES, ids=lambda cls: cls.__name__)
def test_classes_that_are_not_called_say_what_is(cls) -> None:
    if not isinstance(vars(cls)["__init__"], types.WrapperDescriptorType):
        return  # it has a constructor
    for arguments in ((), ("ur3",), (1, 2, 3)):
        text = refuse(lambda a=arguments: cls(*a), f"{cls.__name__} is not made by")
        assert "other functions" not in text
    refuse(lambda: cls(name="ur3"))


def test_robots_are_loaded() -> None:
    refuse(lambda: iksel.Robot("ur3"), "iksel.load_robot(name)", "Robot.from_urdf(")


@pytest.mark.parametrize(
    "keyword", ["seed", "q_init", "q0", "x0", "initial_guess", "seed_state"]
)
def test_other_names_of_seeds(solver, keyword: str) -> None:
    refuse(
        lambda: solver.solve(np.eye(4), **{keyword: np.zeros(6)}),
        f"Solver.solve() has no argument '{keyword}'",
        "seeds=[q]",
        "near=q",
    )


@pytest.mark.parametrize(
    ("wrong", "right"),
    [("nearr", "near"), ("sed", "seeds"), ("objectiv", "objective"), ("taks", "tasks")],
)
def test_misspelled_keywords(solver, wrong: str, right: str) -> None:
    refuse(lambda: solver.solve(np.eye(4), **{wrong: 1}), f"did you mean '{right}'?")


@pytest.mark.parametrize("keyword", ["timeout", "time_limit", "max_time"])
def test_other_names_of_the_deadline(solver, keyword: str) -> None:
    refuse(
        lambda: solver.solve(np.eye(4), **{keyword: 0.1}),
        f"Solver.solve() has no argument '{keyword}'",
        "write deadline=",
    )


def test_keywords_that_are_of_the_options(solver) -> None:
    both = "'position_tolerance' or 'rotation_tolerance'"
    for call in (solver.solve, solver.solve_all, solver.solve_batch):
        refuse(
            lambda call=call: call(np.eye(4), tol=1e-4),
            f"options have {both}: Solver(robot, SolverOptions(...))",
        )
        refuse(
            lambda call=call: call(np.eye(4), max_attempts=3),
            "options have 'max_attempts': Solver(",
        )
    refuse(lambda: iksel.SolverOptions(tol=1e-4), f"did you mean {both}?")
    refuse(lambda: iksel.SolverOptions(deadline=1), "no field 'deadline'", "possible:")


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("base", "'base_link'"),
        ("tip", "'tip_link' or 'tip_links'"),
        ("tpc", "'tcp'"),
    ],
)
def test_mistyped_keywords_of_robots(wrong: str, right: str) -> None:
    urdf = iksel.load_robot("ur3").urdf
    for call, name in (
        (iksel.load_robot, "load_robot"),
        (iksel.Robot.from_urdf, "Robot.from_urdf"),
    ):
        refuse(
            lambda call=call: call(urdf, **{wrong: "base_link"}),
            f"{name}() has no argument '{wrong}'; did you mean {right}?",
        )
    refuse(
        lambda: iksel.load_tree("ur3", package={}),
        "load_tree() has no argument 'package'; did you mean 'packages'?",
    )


def test_misspelled_fields_of_options() -> None:
    for call in (
        lambda: iksel.SolverOptions(max_atempts=3),
        lambda: iksel.SolverOptions().replace(max_atempts=3),
    ):
        refuse(call, "did you mean 'max_attempts'?", "position_tolerance")
    refuse(
        lambda: iksel.SolverOptions(database={"sample": 3}), "did you mean 'samples'?"
    )


def functions() -> list[tuple[str, object]]:
    """Every bound function and method with at least one named argument."""
    found = []
    for owner in (core, *CLASSES):
        for name, thing in vars(owner).items():
            if name.startswith("_") or isinstance(thing, (type, property)):
                continue
            function = getattr(owner, name)
            if callable(function):
                found.append((f"{owner.__name__}.{name}", function))
    return found


@pytest.mark.parametrize(("name", "function"), functions(), ids=lambda x: str(x)[:40])
def test_every_function_answers_in_a_sentence(name: str, function) -> None:
    if name.rpartition(".")[2] == "replace":
        return
    refuse(lambda: function(no_such_argument=1))
    refuse(lambda: function(*[object()] * 40))


def test_what_is_missing_or_too_much_is_named(solver) -> None:
    q = np.zeros(6)
    refuse(solver.robot.fk, "Robot.fk() needs 'q'")
    refuse(
        lambda: solver.robot.fk(q, "kdl", 3), "at most 2", "got 3", "(q, kinematics)"
    )
    refuse(lambda: solver.robot.fk(q, q=q), "'q' twice")
    refuse(lambda: iksel.evaluate(solver), "needs 'targets'")
    refuse(
        lambda: solver.solve(np.eye(4), q),
        "at most 1 argument by position, got 2",
        "write seeds=[q]",
        "(pose, *, near",
    )
    refuse(lambda: iksel.Robot.fk(3, q), "Robot.fk", "int")


def test_links_that_are_none_are_not_given(made) -> None:
    urdf = made.robot("ur3").urdf
    robot = iksel.Robot.from_urdf(urdf, base_link=None, tip_link="tool0")
    assert robot.base_link == iksel.Robot.from_urdf(urdf, tip_link="tool0").base_link
    assert (
        iksel.Robot.from_urdf(arm(), base_link=None, tip_link=None).tip_link == "hand"
    )
    with pytest.raises(
        iksel.InvalidArgumentError, match="tip_link: expected a str, got 3"
    ):
        iksel.Robot.from_urdf(urdf, tip_link=3)


@pytest.mark.parametrize("thing", [3, "x"])
def test_what_is_no_callable_is_named(solver, thing: object) -> None:
    pose = solver.robot.fk(np.zeros(6))
    for name, call in (
        ("filter", lambda: solver.solve(pose, filter=thing)),
        ("filter", lambda: solver.solve_batch(pose[None], filter=thing)),
        ("progress", lambda: iksel.evaluate(solver, 10, 1, progress=thing)),
        ("cost", lambda: iksel.Objective.custom(thing)),
    ):
        with pytest.raises(iksel.SignatureError, match=f"^{name}: .*callable"):
            call()


def test_errors_of_callables_are_left_alone(solver) -> None:
    def fussy(q):
        raise TypeError("fussy(): incompatible function arguments")

    pose = solver.robot.fk(np.zeros(6))
    with pytest.raises(TypeError, match="^fussy") as error:
        solver.solve(pose, filter=fussy)
    assert type(error.value) is TypeError
