# SPDX-License-Identifier: BSD-3-Clause
"""What the settings of a cell stand for: a solver, targets; where files are kept."""

from __future__ import annotations

import functools
import hashlib
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import iksel
from bench.arms import load_arm
from bench.machine import fingerprint
from bench.targets import cached_targets
from iksel.cli._options import PRESETS

if TYPE_CHECKING:
    from bench.store import Settings
    from bench.targets import Targets

WORK = Path(__file__).resolve().parents[1] / "build" / "bench"
"""Where targets, databases and results are kept."""

DATABASE = "database."
"""Prefix of the overrides that are of DatabaseOptions."""


def solver_options(preset: str, overrides: dict[str, Any]) -> iksel.SolverOptions:
    """A preset with fields changed; database fields are written database.FIELD."""
    options = PRESETS[preset]()
    database = {
        name.removeprefix(DATABASE): value
        for name, value in overrides.items()
        if name.startswith(DATABASE)
    }
    rest = {
        name: value
        for name, value in overrides.items()
        if not name.startswith(DATABASE)
    }
    strategy = {name: rest.pop(name) for name in [*rest] if hasattr(iksel.Paper, name)}
    return options.replace(
        database=options.database.replace(**database),
        strategy=options.strategy.replace(**strategy),
        **rest,
    )


def command_line(settings: Settings) -> str:
    """The command that shows an `evaluate` cell to a reader."""
    words = ["iksel evaluate", settings["robot"], "--preset", settings["preset"]]
    for name, value in settings["overrides"].items():
        flag = name.removeprefix(DATABASE).replace("_", "-")
        if name in ("database.pinv_cutoff", "database.seed", "database.threads"):
            flag = "database-" + flag
        words += ["--" + flag, str(value)]
    words += ["--targets", str(settings["count"]), "--seed", str(settings["seed"])]
    return " ".join(words)


@functools.lru_cache(maxsize=2)
def _database(robot: str, fields: str) -> iksel.Database:
    """A database by its options as JSON; those that take long are kept in files."""
    options = iksel.DatabaseOptions(**json.loads(fields))
    arm = load_arm(robot)
    if options.sampling not in (iksel.Sampling.cvt, iksel.Sampling.kmeans):
        return iksel.Database.build(arm.robot, options)
    name = hashlib.sha256(f"{fingerprint()} {fields}".encode()).hexdigest()[:20]
    path = WORK / "databases" / f"{robot}-{name}.iksel"
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        iksel.Database.build(arm.robot, options).save(path)
    return iksel.Database.load(path)


def make_solver(settings: Settings) -> iksel.Solver:
    """The solver of a cell with robot, preset and overrides."""
    options = solver_options(settings["preset"], settings["overrides"])
    fields = json.dumps(options.database.to_dict(), sort_keys=True)
    database = _database(settings["robot"], fields)
    return iksel.Solver(load_arm(settings["robot"]).robot, options, database)


def targets_of(settings: Settings) -> Targets:
    """The targets of a cell with robot, kind, count and seed."""
    arm = load_arm(settings["robot"])
    kind, count, seed = settings["kind"], settings["count"], settings["seed"]
    return cached_targets(WORK / "targets", arm, kind, count, seed)
