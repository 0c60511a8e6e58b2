# SPDX-License-Identifier: BSD-3-Clause
"""What else both hands are asked for: the nearest, what is free, and to carry a box.

Moves by `near` are held beside brute force. Answers that keep all arms out of one
another are judged by coal, with the links' own meshes. Paths of 200 waypoints begin at
random configurations; what the hands carry must stay where they hold it.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import iksel
from bench.arguments import add_count, add_max_error, add_robots, add_seed, check_robots
from bench.branches import SAME_MOVE
from bench.markdown import microseconds, table
from bench.rivals.base import UnsupportedError
from bench.whole_body.brute import RESTARTS, VALUES
from bench.whole_body.carried import JUMP, WAYPOINTS, carried
from bench.whole_body.free import free
from bench.whole_body.nearest import STARTS, nearest
from bench.whole_body.pairs import IN_TIME, nearest_of_pairs, paths_of_pairs
from bench.whole_body.robots import load_body

if TYPE_CHECKING:
    import argparse

ROBOTS = ("two_pandas", "pr2")
PAIRS = "pairs"
"""Of random arms, of which moves and paths are looked at only."""
Rows = dict[str, dict[str, Any]]


def add(commands: Any) -> None:
    """The command `hands`."""
    command = commands.add_parser(
        "hands",
        help="both hands: near beside brute force, free of the body, carrying a box",
        description=__doc__,
    )
    pairs = f"; {PAIRS}: of random arms, moves and paths"
    of_meshes = "; pr2, and the meshes of both, are those of example-robot-data"
    add_robots(command, ROBOTS, pairs + of_meshes)
    add_count(command, "--near", 300, "moves of each start")
    add_count(command, "--free", 10_000, "targets beside bodies")
    add_count(command, "--paths", 40, "paths")
    add_count(command, "--shared", 1, f"joints under both arms of {PAIRS}, for moves")
    add_max_error(command, 0.02)
    add_seed(command)


def run(args: argparse.Namespace) -> int:
    """Measure, and print tables; 1 if an answer is none."""
    check_robots("hands", args.robots, (*ROBOTS, PAIRS))
    made: dict[str, Rows] = {"near": {}, "free": {}, "paths": {}, "known": {}}
    for name in args.robots:
        try:
            _measure(name, args, made)
        except UnsupportedError as reason:
            sys.stdout.write(f"{name}: {reason}\n\n")
    sys.stdout.write(f"Seed {args.seed}, SIMD level {iksel.simd_level()}.\n\n")
    for tell, rows in zip((_near, _free, _paths, _known), made.values(), strict=True):
        if rows:
            sys.stdout.write(tell(rows) + "\n\n")
    all_rows = [row for rows in made.values() for row in rows.values()]
    return int(any(row["wrong"] or row.get("colliding") for row in all_rows))


def _measure(name: str, args: argparse.Namespace, made: dict[str, Rows]) -> None:
    """All that is asked for of a robot; what needs its meshes comes last."""
    if name == PAIRS:
        for start in STARTS if args.near else ():
            row = nearest_of_pairs(start, args.near, args.seed, args.shared)
            made["near"][f"{name}, {start}"] = row
        if args.paths:
            made["known"][name] = paths_of_pairs(args.paths, args.seed)
        return
    body = load_body(name)
    for start in STARTS if args.near else ():
        row = nearest(body, start, args.near, args.seed)
        made["near"][f"{name}, {start}"] = row
    if args.paths:
        made["paths"][name] = carried(body, args.paths, args.seed)
    if args.free:
        made["free"][name] = free(name, args.free, args.seed, args.max_error)


def _near(rows: Rows) -> str:
    head = ["robot, start", "moves", "no answer", "longer", "shorter", "mean, µs"]
    counts = ("cases", "none", "longer", "shorter")
    lines = [
        [name, *(f"{row[k]:,}" for k in counts), microseconds(row["mean_us"])]
        for name, row in rows.items()
    ]
    named = [f"{name}: {row['named']}" for name, row in rows.items() if row["named"]]
    text = (
        f"Moves by `near` beside brute force ({VALUES} values of the shared joint, "
        f"{RESTARTS} random seeds): longer, and shorter, by more than {SAME_MOVE:g} "
        f"rad. Starts are {STARTS['beside']:.0%} of each range about a configuration "
        "at the target, or anywhere."
    )
    text += "\n\n" + table(head, lines)
    return f"{text}\n\nLonger: {'; '.join(named)}" if named else text


def _free(rows: Rows) -> str:
    head = ["robot", "spheres", "pairs", "covered in, s", "targets", "free answers"]
    head += ["of these colliding", "known to be free", "of these missed"]
    head += ["without a scene, µs", "free answer, µs", "median, µs", "none, µs"]
    counts = ("spheres", "pairs", "cover_s", "targets", "solved", "colliding")
    times = ("plain_us", "solved_us", "solved_median_us", "none_us")
    lines = [
        [
            name,
            *(f"{row[k]:,.0f}" for k in counts),
            f"{row['free']:,} ({row['free_by_coal']:,} by coal)",
            f"{row['free_missed']:,} ({row['free_by_coal_missed']:,})",
            *(microseconds(row[k]) for k in times),
        ]
        for name, row in rows.items()
    ]
    first = "; ".join(f"{name} {r['colliding_without']:,}" for name, r in rows.items())
    return (
        "Answers that keep arms and body out of one another, judged by coal on the "
        "meshes; known are the configurations of which the targets were made. Covered "
        f"in 0 s: the spheres were in a file.\n\n{table(head, lines)}\n\n"
        f"Answers without a scene that collide: {first}."
    )


def _paths(rows: Rows) -> str:
    head = ["robot", "paths", "end before", "of these with an answer there"]
    head += ["apart at waypoints, m", "rad", "between, m", "rad", "jumps"]
    head += ["of these without by near", "s each"]
    lines = [
        [
            name,
            *(f"{n:,}" for n in (row["paths"], row["ended"], len(row["lost"]))),
            *(f"{x:.1e}" for x in (*row["apart"], *row["apart_between"])),
            *(f"{len(row[k])}" for k in ("jumps", "needless")),
            f"{row['s_each']:.3f}",
        ]
        for name, row in rows.items()
    ]
    named = "; ".join(f"{name}: {row['needless']}" for name, row in rows.items())
    return (
        f"A box carried along {WAYPOINTS} waypoints from random configurations, so not "
        "every path can be followed to its end: how far the hands ever are from where "
        "they hold it; between waypoints with joints on straight lines, of paths "
        f"without a jump, which is a step above {JUMP:g} rad.\n\n"
        f"{table(head, lines)}\n\n"
        f"Jumps that `near` goes without, from waypoint to waypoint: {named}."
    )


def _known(rows: Rows) -> str:
    head = ["robot", "paths", "end before", "too fast", "jumps"]
    head += ["length to known", "s each"]
    lines = [
        [
            name,
            *(f"{row[k]:,}" for k in ("paths", "ended", "late", "jumps")),
            *(f"{row[k]:.3f}" for k in ("length", "s_each")),
        ]
        for name, row in rows.items()
    ]
    return (
        f"Paths of {WAYPOINTS} waypoints along motions that are straight in joint "
        "space, from anywhere and from their beginning: none needs to end, or to jump. "
        f"*Too fast*: what is called so of those that have {IN_TIME:g} times what the "
        "motion takes by the limits of speed, half as many.\n"
        f"\n\n{table(head, lines)}"
    )
