# SPDX-License-Identifier: BSD-3-Clause
"""The command line; `iksel --help` lists the commands.

Exit status: 0 done or solved, 1 no solution, 2 bad input (one line on stderr), 130
interrupted, 141 the reader of the output went away.
"""

from __future__ import annotations

import contextlib
import io
import os
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

from iksel_cpp import AngleUnitWarning, Error

from iksel import __version__
from iksel.cli import (
    build,
    dataset,
    evaluate,
    fk,
    info,
    jacobian,
    path,
    plot,
    reach,
    robots,
    solve,
    view,
)
from iksel.cli._parser import EXIT_BAD_INPUT, Parser, error_line

if TYPE_CHECKING:
    from collections.abc import Sequence

EXIT_INTERRUPTED = 130
EXIT_BROKEN_PIPE = 141

COMMANDS = (
    robots,
    info,
    fk,
    jacobian,
    solve,
    path,
    plot,
    view,
    build,
    evaluate,
    reach,
    dataset,
)

EXAMPLES = """\
examples:
  iksel robots
  iksel info ur3
  iksel solve ur3 --pose 0.2 0.15 0.3 0 3.1416 0
  iksel solve ur3 --poses poses.csv -o answers.csv
  iksel fk ur3 0 -1.2 1.4 -0.6 1.2 0.2
  iksel jacobian ur3 --degrees 0 -70 80 -35 70 10
  iksel solve arm.urdf --base base_link --tip tool0 --from-q 0 -1 1 0 0.5 0
  iksel path ur3 poses.txt --start 0.3 -1.2 1.4 -0.6 1.2 0.2 --dt 0.01
  iksel view ur5e
  iksel plot ur3 -o ur3.png
  iksel build panda -o panda.iksel --samples 40000
  iksel evaluate ur3 --preset paper --targets 10000 --seed 1 --json
  iksel reach plan ur5e -o ur5e.zarr
"""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line.

    Args:
        argv: Arguments without the program's name; None: those of the process.

    Returns:
        The exit status.
    """
    if "stdout" in _prepare_streams():
        return _report("cannot write the output: stdout is closed")
    try:
        code = _run(argv)
        sys.stdout.flush()
    except KeyboardInterrupt:
        return EXIT_INTERRUPTED
    except BrokenPipeError:
        _drop_output()
        return EXIT_BROKEN_PIPE
    except OSError as error:
        _drop_output()
        return _report(f"cannot write the output: {error}")
    return code


def make_parser() -> Parser:
    """The parser of the whole command line."""
    parser = Parser(
        prog="iksel",
        description="Fast numerical inverse kinematics. Lengths are metres, angles "
        "radians; a pose is that of the TCP, or of the tip link without a "
        "tool, in the base link's frame.",
        epilog=EXAMPLES,
    )
    parser.add_argument("--version", action="version", version=f"iksel {__version__}")
    commands = parser.add_subparsers(
        title="commands", metavar="COMMAND", dest="command", required=True
    )
    for command in COMMANDS:
        command.add_parser(commands)
    return parser


def _run(argv: Sequence[str] | None) -> int:
    words = sys.argv[1:] if argv is None else argv
    for word in words:
        if not _is_text(word):
            return _report(f"argument {word!r}: not in UTF-8")
    try:
        arguments = make_parser().parse_args(argv)
        with warnings.catch_warnings():
            # The command line has its own, which names the flag.
            warnings.simplefilter("ignore", AngleUnitWarning)
            return int(arguments.run(arguments))
    except SystemExit as stop:
        return int(stop.code or 0)
    except Error as error:
        return _report(str(error))
    except MemoryError:
        return _report("not enough memory")


def _is_text(word: str) -> bool:
    """Whether a word is one in UTF-8; Python hides the bytes of others in it."""
    try:
        word.encode()
    except UnicodeEncodeError:
        return False
    return True


def _prepare_streams() -> list[str]:
    """Put empty streams in the place of those that are closed, which it names.

    What stdout's encoding has no character for, as ASCII for a sign, becomes `?`.
    """
    closed = []
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            empty = Path(os.devnull).open(mode, encoding="utf-8")  # noqa: SIM115
            setattr(sys, name, empty)
            closed.append(name)
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")
    return closed


def _report(message: str) -> int:
    with contextlib.suppress(OSError):  # there is nowhere else to say it
        sys.stderr.write(error_line(message))
        sys.stderr.flush()
    return EXIT_BAD_INPUT


def _drop_output() -> None:
    """Send what is still to be written nowhere, lest the interpreter fail at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
