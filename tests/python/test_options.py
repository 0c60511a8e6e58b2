# SPDX-License-Identifier: BSD-3-Clause
"""Options: defaults, copies, what each field takes."""

from __future__ import annotations

import copy
import gc
import pickle

import iksel_cpp as core
import numpy as np
import pytest

OPTION_CLASSES = (core.DatabaseOptions, core.SolverOptions)
STRATEGIES = (core.Lanes, core.Paper)
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
        "max_attempts": 17,
        "database": {"samples": 123},
        "strategy": {"name": "paper", "limit_aware": True, "iteration": "pinv"},
    },
    core.Lanes: {"neighbours": 17, "damping": 0.5},
    core.Paper: {"neighbours": 17, "limit_aware": True, "iteration": "pinv"},
}


@pytest.mark.parametrize("cls", [*OPTION_CLASSES, *STRATEGIES])
def test_defaults_show_nothing(cls):
    assert repr(cls()) == f"{cls.__name__}()"
    assert cls() == cls()


def test_repr_shows_what_differs():
    assert (
        repr(core.SolverOptions(max_attempts=2, strategy=core.Paper(iteration="pinv")))
        == "SolverOptions(max_attempts=2, strategy=Paper(iteration='pinv'))"
    )
    nested = core.SolverOptions(database=core.DatabaseOptions(samples=5))
    assert repr(nested) == "SolverOptions(database=DatabaseOptions(samples=5))"


@pytest.mark.parametrize("cls", OPTION_CLASSES)
def test_repr_makes_an_equal_object(cls):
    for options in (cls(), cls.paper(), cls.paper(2026), cls(**CHANGES[cls])):
        assert eval(repr(options), vars(core)) == options


@pytest.mark.parametrize("cls", STRATEGIES)
def test_strategies_are_values(cls):
    strategy = cls(**CHANGES[cls])
    assert eval(repr(strategy), vars(core)) == strategy
    assert cls(**strategy.to_dict()) == strategy
    assert pickle.loads(pickle.dumps(strategy)) == strategy
    options = core.SolverOptions(strategy=strategy)
    assert options.strategy == strategy
    assert options.to_dict()["strategy"]["name"] == cls.__name__.lower()
    with pytest.raises(AttributeError):
        options.strategy.damping = 1.0
    options.strategy = cls.__name__.lower()
    assert options.strategy == cls()


@pytest.mark.parametrize("cls", OPTION_CLASSES)
def test_dict_makes_an_equal_object(cls):
    for options in (cls(), cls.paper(), cls.paper(2026), cls(**CHANGES[cls])):
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


@pytest.mark.parametrize("cls", [*OPTION_CLASSES, *STRATEGIES])
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
            other = {
                "database": {"samples": 1},
                "strategy": "paper",
                "task": core.Task.free_spin(),
            }[name]
        else:
            enum = type(getattr(cls(), name))
            other = next(member.name for member in enum if member.name != value)
        # Only a full key has a choice of rotation_key, kmeans a pool, cvt updates.
        base = cls()
        if name == "rotation_key":
            base = cls(key_scheme="full")
        elif name.startswith("kmeans"):
            base = cls(sampling="kmeans")
        elif name == "cvt_updates":
            base = cls(sampling="cvt")
        options = base.replace(**{name: other})
        assert options != base
        assert options.replace(**{name: value}) == base
        assert f"{name}=" in repr(options)


def test_enums_are_taken_as_members_and_names():
    options = core.DatabaseOptions(sampling=core.Sampling.cvt)
    assert options == core.DatabaseOptions(sampling="cvt")
    assert options.sampling is core.Sampling.cvt
    options.sampling = "grid"
    assert options.sampling is core.Sampling.grid
    assert core.Paper(iteration="pinv").iteration is core.Iteration.pinv
    assert {member.name for member in core.Iteration} == {
        "dls", "pinv", "pinv_rr", "cwln", "cwpi", "lm",
    }  # fmt: skip


@pytest.mark.parametrize("value", ["newton", "", "DLS", 0, None, core.Scale.small])
def test_wrong_enum_lists_the_possible_names(value):
    match = r"^iteration: expected one of dls, pinv, pinv_rr, cwln, cwpi, lm, got "
    for call in (core.Paper, core.Paper().replace):
        with pytest.raises(core.InvalidArgumentError, match=match):
            call(iteration=value)


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
        ("max_attempts", "many"),
        ("max_attempts", 1.5),
        ("max_attempts", True),
        ("max_attempts", 2**40),
        ("max_attempts", 0),
        ("position_tolerance", "small"),
        ("position_tolerance", True),
        ("position_tolerance", -1.0),
        ("position_tolerance", np.nan),
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
        max_attempts=np.int32(7),
        position_tolerance=np.float32(0.5),
        strategy=core.Paper(limit_aware=np.bool_(True)),  # noqa: FBT003
        rotation_tolerance=1,
    )
    assert options.max_attempts == 7
    assert options.position_tolerance == 0.5
    assert options.strategy.limit_aware is True
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


def test_updates_that_no_sampling_makes_are_refused():
    with pytest.raises(core.InvalidArgumentError, match="cvt_updates: only read by"):
        core.DatabaseOptions(cvt_updates=5)
    assert core.DatabaseOptions(sampling="cvt", cvt_updates=5).cvt_updates == 5


@pytest.mark.parametrize("strategy", ["\udcff", {"name": "\udcff"}])
def test_a_name_that_is_no_text_is_named(strategy) -> None:
    with pytest.raises(core.InvalidArgumentError, match="strategy: .* in UTF-8"):
        core.SolverOptions(strategy=strategy)
