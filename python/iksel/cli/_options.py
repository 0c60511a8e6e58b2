# SPDX-License-Identifier: BSD-3-Clause
"""A flag for every field of the option classes, made from the fields."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from iksel_cpp import (
    Axis,
    Database,
    DatabaseOptions,
    InvalidArgumentError,
    Lanes,
    Paper,
    SolverOptions,
    Task,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

Options = DatabaseOptions | SolverOptions | Lanes | Paper

PRESETS: dict[str, Callable[[], SolverOptions]] = {
    "default": SolverOptions,
    "paper": SolverOptions.paper,
    "paper2026": lambda: SolverOptions.paper(2026),
}
STRATEGIES = {"lanes": Lanes, "paper": Paper}

TASK_FORMS = (
    "pose, position_only, free_spin[:AXIS] (any spin about an axis of the tool), "
    "upright[:AXIS] (any turn about an axis of the base), planar[:AXIS], or "
    "box:PX,PY,PZ,RX,RY,RZ (tolerances in the tool's axes [m, rad], inf: free); "
    "AXIS is x, y or z (default z)"
)
_TASKS = {"free_spin": Task.free_spin, "upright": Task.upright, "planar": Task.planar}

# Fields whose plain flag would mean two things in one command.
_SOLVER_FLAGS = {"seed": "--solver-seed"}
_DATABASE_FLAGS = {
    "pinv_cutoff": "--database-pinv-cutoff",
    "seed": "--database-seed",
    "threads": "--database-threads",
}
_SOLVER, _DATABASE, _STRATEGY = "solver.", "database.", "strategy."

# Who names a scale means the paper's databases, which have their sizes from it.
_WITH_SCALE = {"sampling": "grid", "key_scheme": "full", "samples": 0}
_NOTES = {
    "scale": "; unless other flags say otherwise, with --sampling grid "
    "--key-scheme full, as in the paper"
}


def add_preset(parser: argparse.ArgumentParser) -> None:
    """Add --preset."""
    parser.add_argument(
        "--preset",
        choices=list(PRESETS),
        default="default",
        help="the settings that the flags below start from (default: %(default)s)",
    )


def add_solver_options(
    parser: argparse.ArgumentParser, *, database: bool = True
) -> None:
    """Add --preset, and a flag for every field of the solver and of a database."""
    add_preset(parser)
    if database:
        parser.add_argument(
            "--database",
            type=Path,
            metavar="FILE",
            help="use a database made by 'iksel build' instead of building one; over "
            "one with a full key seeds are iterated one by one, not in SIMD lanes",
        )
        parser.add_argument(
            "--mmap",
            action="store_true",
            help="map --database FILE instead of reading it: processes share its "
            "samples",
        )
    else:
        parser.set_defaults(database=None)
    group = parser.add_argument_group("solver options")
    group.add_argument(
        "--task",
        metavar="TASK",
        help=f"what of a pose has to be reached: {TASK_FORMS}",
    )
    _add_fields(group, SolverOptions, _SOLVER, _SOLVER_FLAGS)
    group = parser.add_argument_group(
        "strategy options",
        "only those that the strategy reads can be used; lanes reads --neighbours and "
        "--damping",
    )
    group.add_argument(
        "--strategy",
        choices=list(STRATEGIES),
        help="seeds in SIMD lanes, or one at a time as in the paper (default: the "
        "preset's)",
    )
    _add_fields(group, Paper, _STRATEGY, {})
    if database:
        add_database_options(parser)


def add_database_options(parser: argparse.ArgumentParser) -> None:
    """Add a flag for every database field."""
    group = parser.add_argument_group("database options")
    _add_fields(group, DatabaseOptions, _DATABASE, _DATABASE_FLAGS)


def solver_options(arguments: argparse.Namespace) -> SolverOptions:
    """The preset with the given flags on top.

    Raises:
        InvalidArgumentError: A value out of range, or database flags where a database
            is given.
    """
    changes = _database_changes(arguments)
    if changes and arguments.database is not None:
        given = _given(arguments, _DATABASE)
        flags = ", ".join(_flag(name, _DATABASE_FLAGS) for name in given)
        raise InvalidArgumentError(
            f"{flags}: cannot be used with --database, whose file has its own settings"
        )
    options = PRESETS[arguments.preset]()
    database = options.database.replace(**changes)
    task = parse_task(arguments.task) if arguments.task else options.task
    return options.replace(
        database=database,
        task=task,
        strategy=_strategy(arguments, options.strategy),
        **_given(arguments, _SOLVER),
    )


def _strategy(arguments: argparse.Namespace, preset: Lanes | Paper) -> Lanes | Paper:
    """The preset's strategy, or another one, with the given flags on top.

    Raises:
        InvalidArgumentError: A flag that the strategy does not read.
    """
    name = arguments.strategy
    strategy = preset if name is None else STRATEGIES[name]()
    given = _given(arguments, _STRATEGY)
    for field in given:
        if not hasattr(strategy, field):
            raise InvalidArgumentError(
                f"{_flag(field, {})}: the strategy 'lanes' does not read it; it "
                "belongs to --strategy paper, which --preset paper has too"
            )
    return strategy.replace(**given)


def given_database(arguments: argparse.Namespace) -> Database | None:
    """The database of --database FILE; None without.

    Raises:
        InvalidArgumentError: --mmap without a file.
        DatabaseError: The file cannot be read, or is no database.
    """
    if arguments.database is not None:
        return Database.load(arguments.database, mmap=arguments.mmap)
    if arguments.mmap:
        raise InvalidArgumentError("--mmap: needs --database FILE")
    return None


def parse_task(text: str) -> Task:
    """A task in one of TASK_FORMS.

    Raises:
        InvalidArgumentError: Not one of them.
    """
    name, _, rest = text.partition(":")
    if name in _TASKS and (not rest or rest in Axis.__members__):
        return _TASKS[name](rest) if rest else _TASKS[name]()
    if text == "pose":
        return Task.pose()
    if text == "position_only":
        return Task.position_only()
    if name == "box":
        try:
            values = [float(word) for word in rest.split(",")]
        except ValueError:
            values = []
        if len(values) == 6:
            return Task.box(values[:3], values[3:])
    raise InvalidArgumentError(f"--task: {text!r} is none of {TASK_FORMS}")


def database_options(arguments: argparse.Namespace) -> DatabaseOptions:
    """The preset's database with the given flags on top.

    Raises:
        InvalidArgumentError: A value out of range.
    """
    options = PRESETS[arguments.preset]().database
    return options.replace(**_database_changes(arguments))


def overrides(arguments: argparse.Namespace) -> dict[str, Any]:
    """The fields that flags changed from the preset; database fields as database.x."""
    database = _database_changes(arguments)
    task = getattr(arguments, "task", None)
    return {
        **({"task": task} if task else {}),
        **_given(arguments, _SOLVER),
        **_strategy_overrides(arguments),
        **{_DATABASE + name: value for name, value in database.items()},
    }


def _strategy_overrides(arguments: argparse.Namespace) -> dict[str, Any]:
    name = getattr(arguments, "strategy", None)
    given = _given(arguments, _STRATEGY)
    return {
        **({"strategy": name} if name else {}),
        **given,
    }


def _database_changes(arguments: argparse.Namespace) -> dict[str, Any]:
    """The database fields that the flags change from the preset.

    Raises:
        InvalidArgumentError: Two sizes at once.
    """
    given = _given(arguments, _DATABASE)
    if "scale" not in given:
        return given
    if given.get("samples") and getattr(arguments, "database", None) is None:
        raise InvalidArgumentError(
            f"--samples {given['samples']}: cannot be used with --scale "
            f"{given['scale']}, which has a size of its own"
        )
    return {**_WITH_SCALE, **given}


def _given(arguments: argparse.Namespace, prefix: str) -> dict[str, Any]:
    """The fields under `prefix` whose flag was used."""
    return {
        name.removeprefix(prefix): value
        for name, value in vars(arguments).items()
        if name.startswith(prefix)
    }


def _flag(field: str, renamed: Mapping[str, str]) -> str:
    return renamed.get(field, "--" + field.replace("_", "-"))


def _add_fields(
    group: argparse._ArgumentGroup,
    options: type[Options],
    prefix: str,
    renamed: Mapping[str, str],
) -> None:
    """A flag per field of `options`; those that are not used leave no trace."""
    presets = {name: _part(make(), options) for name, make in PRESETS.items()}
    for field, default in options().to_dict().items():
        if isinstance(default, dict):
            continue
        note = _NOTES.get(field, "") if options is DatabaseOptions else ""
        doc = getattr(options, field).__doc__
        text = f"{doc}{note} ({_defaults(presets, field)})"
        group.add_argument(
            _flag(field, renamed),
            dest=prefix + field,
            default=argparse.SUPPRESS,
            help=text.replace("%", "%%"),
            **_kind(options, field, default),
        )


def _part(preset: SolverOptions, options: type[Options]) -> dict[str, Any]:
    """The fields of a class in a preset; where it has no such strategy, its own."""
    parts = (preset, preset.database, preset.strategy, options())
    return next(part for part in parts if isinstance(part, options)).to_dict()


def _defaults(presets: Mapping[str, dict[str, Any]], field: str) -> str:
    """A field's values by preset, each where it is not that of the one before."""
    values = {name: fields[field] for name, fields in presets.items()}
    before = [object(), *values.values()]
    pairs = zip(values.items(), before, strict=False)
    return ", ".join(f"{n}: {value}" for (n, value), last in pairs if value != last)


def _kind(options: type[Options], field: str, default: object) -> dict[str, Any]:
    """How argparse reads a field with that default."""
    if isinstance(default, bool):
        return {"action": argparse.BooleanOptionalAction}
    if isinstance(default, str):
        members = type(getattr(options(), field)).__members__
        return {"choices": list(members)}
    whole = isinstance(default, int)
    return {"type": int if whole else float, "metavar": "N" if whole else "X"}
