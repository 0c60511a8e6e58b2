# SPDX-License-Identifier: BSD-3-Clause
"""iksel evaluate: success and time over random reachable targets."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import iksel_cpp
from iksel_cpp import Database, Solver

from iksel.cli._options import (
    add_solver_options,
    given_database,
    overrides,
    solver_options,
)
from iksel.cli._output import Progress, add_json, add_progress, print_json, print_pairs
from iksel.cli._parser import count, seed
from iksel.cli._robot import load
from iksel.cli._robot_flags import add_robot

if TYPE_CHECKING:
    import argparse

    from iksel_cpp import Robot, SolverOptions

EXAMPLES = """\
examples:
  iksel evaluate ur3
  iksel evaluate ur3_wrs --preset paper --targets 10000 --seed 1 --json
  iksel evaluate xarm5 --task free_spin --targets 100000
  iksel evaluate panda --preset paper --iteration cwln --max-attempts 6 --stages
"""

STAGES = ("query_us", "rank_us", "iterate_us", "reselect_us")


def add_parser(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser(
        "evaluate",
        usage="iksel evaluate ROBOT [options]",
        help="measure success and time over random targets",
        description="Solve random reachable targets one after another on one thread, "
        "timing each call inside the core, failures included. 'ratio' is the mean over "
        "the time of one KDL forward kinematics plus one KDL Jacobian in the same run.",
        epilog=EXAMPLES,
    )
    add_robot(parser)
    parser.add_argument(
        "--targets",
        type=count,
        default=10_000,
        metavar="N",
        help="number of targets (default: %(default)s)",
    )
    parser.add_argument(
        "--seed",
        type=seed,
        default=0,
        metavar="S",
        help="seed of the random targets (default: %(default)s)",
    )
    parser.add_argument(
        "--stages",
        action="store_true",
        help="also time the stages, in a second pass over the targets",
    )
    add_json(parser)
    add_progress(parser)
    add_solver_options(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and print the figures."""
    robot = load(arguments)
    options = solver_options(arguments)
    database, build_s = _database(arguments, robot, options)
    solver = Solver(robot, options, database)
    with Progress("solving", show=arguments.progress) as progress:
        figures = iksel_cpp.evaluate(
            solver, arguments.targets, arguments.seed, arguments.stages, progress
        ).to_dict()
    if not arguments.stages:
        figures = {key: value for key, value in figures.items() if key not in STAGES}
    report = {
        "robot": arguments.robot,
        "preset": arguments.preset,
        "overrides": overrides(arguments),
        **figures,
        "position_tolerance": options.position_tolerance,
        "rotation_tolerance": options.rotation_tolerance,
        "threads": 1,
        "simd": iksel_cpp.simd_level(),
        "work_bound": solver.work_bound,
        "database_samples": len(database),
        "build_s": build_s,
    }
    if arguments.json:
        print_json(report)
    else:
        print_text(report)
    return 0


def print_text(report: dict[str, Any]) -> None:
    """Print the figures for people."""
    changed = ", ".join(f"{k}={v}" for k, v in report["overrides"].items())
    times = [
        (name, report[f"{name}_us"])
        for name in ("mean", "std", "min", "median", "p99", "p999", "max")
    ]
    build_s = report["build_s"]
    origin = "from file" if build_s is None else f"built in {build_s:.3f} s"
    position, rotation = report["position_tolerance"], report["rotation_tolerance"]
    tolerance = f"{position:g} m, {rotation:g} rad"
    print_pairs(
        [
            ("robot", report["robot"]),
            ("preset", report["preset"] + (f" with {changed}" if changed else "")),
            ("database", f"{report['database_samples']:,} samples, {origin}"),
            ("targets", f"{report['targets']:,}, seed {report['seed']}"),
            ("tolerance", tolerance),
            ("threads", f"{report['threads']}, SIMD {report['simd']}"),
            ("solved", f"{report['solved']:,}, {report['success_percent']:.3f} %"),
            ("false successes", str(report["false_success"])),
            ("attempts", f"{report['mean_attempts']:.2f} on average"),
            ("iterations", f"{report['mean_iterations']:.2f} on average"),
            ("  most", f"{report['max_iterations']}, bound {report['work_bound']}"),
            *((f"{name} time", f"{value:10.2f} us") for name, value in times),
            *(
                (f"  {key.removesuffix('_us')}", f"{report[key]:10.2f} us")
                for key in STAGES
                if key in report
            ),
            ("KDL FK + Jacobian", f"{report['kdl_fk_jac_us']:10.2f} us"),
            ("ratio", f"{report['ratio']:10.2f}"),
        ]
    )


def _database(
    arguments: argparse.Namespace, robot: Robot, options: SolverOptions
) -> tuple[Database, float | None]:
    """The database to use, and the seconds it took to build, if it was built."""
    given = given_database(arguments)
    if given is not None:
        return given, None
    start = time.perf_counter()
    with Progress(f"building {robot.name}", show=arguments.progress) as progress:
        database = Database.build(robot, options.database, progress)
    return database, time.perf_counter() - start
