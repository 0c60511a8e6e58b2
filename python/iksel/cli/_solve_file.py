# SPDX-License-Identifier: BSD-3-Clause
"""iksel solve --poses: many poses, each by itself."""

from __future__ import annotations

import contextlib
import itertools
import sys
from collections import Counter
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import InvalidArgumentError, Status

from iksel._base.files import replaced
from iksel.cli._answers import FORMATS
from iksel.cli._lengths import warn_of_millimetres
from iksel.cli._output import Progress, add_progress, print_json, print_pairs
from iksel.cli._parser import count_up_to, warning_line
from iksel.cli._poses import PoseFile

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator

    from iksel_cpp import Solver

    from iksel.cli._angles import Angles

CHUNK = 4096
"""Rows that are held at a time, unless --chunk says how many."""

MOST_ROWS = 1_000_000


def add_poses(parser: argparse.ArgumentParser) -> None:
    """Add what is only for --poses."""
    group = parser.add_argument_group("many poses (with --poses)")
    group.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        help="where the answers go, written beside and renamed; its end says the "
        "format, .csv, .jsonl or .npy (default: -, stdout)",
    )
    group.add_argument(
        "--format",
        choices=list(FORMATS),
        help="of the answers (default: by the output's name, csv for stdout)",
    )
    group.add_argument(
        "--on-invalid",
        choices=("status", "raise"),
        help="what is done with a row that is no pose: it gets the status "
        "invalid_pose, or all ends with an error (default: status)",
    )
    group.add_argument(
        "--threads",
        type=int,
        metavar="N",
        help="that solve at a time; 0: one per core (default: 0)",
    )
    group.add_argument(
        "--chunk",
        type=count_up_to(MOST_ROWS),
        metavar="N",
        help="rows that are read before their answers are written; 1: each is answered "
        f"as it comes, which a live stdin wants (default: {CHUNK})",
    )
    add_progress(group)


def check_flags(arguments: argparse.Namespace) -> None:
    """Refuse flags that have no meaning with --poses, or only with it.

    Raises:
        InvalidArgumentError: One is used.
    """
    names = ("output", "format", "on_invalid", "threads", "chunk", "progress")
    if arguments.poses is None:
        used = [name for name in names if getattr(arguments, name) is not None]
        for name in used:
            flag = name.replace("_", "-")
            raise InvalidArgumentError(f"--{flag}: needs --poses FILE")
        return
    for name in ("all", "diagnose"):
        if getattr(arguments, name):
            raise InvalidArgumentError(f"--{name}: is for one pose, not for --poses")
    if arguments.json and arguments.output in (None, "-"):
        raise InvalidArgumentError(
            "--json: with --poses, prints a summary, which needs -o FILE for the "
            "answers; for answers as JSON give --format jsonl"
        )


def answer_format(arguments: argparse.Namespace) -> str:
    """The format of the answers, by --format or the output's name.

    Raises:
        InvalidArgumentError: The name says none.
    """
    name = arguments.output
    if arguments.format is not None:
        return str(arguments.format)
    if name in (None, "-"):
        return "csv"
    suffix = Path(name).suffix.removeprefix(".").lower()
    if suffix not in FORMATS:
        raise InvalidArgumentError(
            f"-o {name}: its end says no format; give it one of "
            f"{', '.join('.' + form for form in FORMATS)}, or --format"
        )
    return suffix


def solve_file(
    solver: Solver,
    request: dict[str, Any],
    arguments: argparse.Namespace,
    angles: Angles,
) -> int:
    """Solve the poses of a file; 0 if all have an answer, else 1."""
    form = answer_format(arguments)
    robot = solver.robot
    names = robot.joint_names
    no_pose = np.full((4, 4) if robot.tips == 1 else (robot.tips, 4, 4), np.nan)
    on_stdout = arguments.output in (None, "-")
    counts: Counter[str] = Counter()
    warned = False
    show = arguments.progress
    if on_stdout and show is None and sys.stdout.isatty():
        show = False  # the answers are there to be seen
    request["threads"] = arguments.threads or 0
    with (
        PoseFile(arguments.poses, angles, solver.robot.tip_links) as file,
        _output(arguments.output) as output,
        Progress("solving", show=show) as progress,
    ):
        answers = FORMATS[form](output, names)
        size = arguments.chunk or CHUNK
        raising = arguments.on_invalid == "raise"
        for poses in _chunks(file, size, raising=raising):
            targets = np.stack([no_pose if pose is None else pose for pose in poses])
            warned = warned or warn_of_millimetres(robot, arguments.poses, targets)
            batch = solver.solve_batch(targets, **request)
            counts.update(status.name for status in batch.statuses())
            answers.write(batch, angles.show(robot, batch.q))
            output.flush()
            if progress is not None and file.total:
                progress(min(file.done, file.total), file.total)
        answers.close()
    if not on_stdout:
        _print_summary(arguments, counts)
    return 0 if set(counts) == {Status.solved.name} else 1


@contextlib.contextmanager
def _output(name: str | None) -> Iterator[IO[bytes]]:
    if name in (None, "-"):
        yield sys.stdout.buffer
        sys.stdout.buffer.flush()
    else:
        with replaced(Path(str(name))) as file:
            yield file


def _chunks(file: PoseFile, size: int, *, raising: bool) -> Iterator[list[Any]]:
    """Poses, None for what is none, some at a time; warns of the first such.

    Raises:
        InvalidArgumentError: A row is no pose, and `raising`.
    """
    warned = False
    rows = iter(file)
    while chunk := list(itertools.islice(rows, size)):
        bad = [row for row in chunk if isinstance(row, InvalidArgumentError)]
        if bad and raising:
            raise bad[0]
        if bad and not warned:
            warned = True
            text = f"{bad[0]}; this row, and others like it, get status invalid_pose"
            sys.stderr.write(warning_line(text))
        yield [None if isinstance(row, Exception) else row for row in chunk]


def _print_summary(arguments: argparse.Namespace, counts: Counter[str]) -> None:
    if arguments.json:
        print_json(
            {
                "file": arguments.output,
                "poses": counts.total(),
                "solved": counts[Status.solved.name],
                "statuses": dict(counts),
            }
        )
        return
    print_pairs(
        [
            ("file", arguments.output),
            ("poses", f"{counts.total():,}"),
            *((name, f"{number:,}") for name, number in counts.most_common()),
        ]
    )
