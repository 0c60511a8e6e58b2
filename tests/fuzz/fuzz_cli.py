# SPDX-License-Identifier: BSD-3-Clause
"""Arguments for the command line: an exit status and sane streams, whatever they are.

An input is a choice of a command, its flags and odd values. A good run's --json is
JSON; a bad one says so in one line on stderr and prints nothing else.
"""

from __future__ import annotations

import argparse
import contextlib
import functools
import io
import json
import os
import sys
import tempfile
from pathlib import Path

import atheris
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))
import urdf_text

with atheris.instrument_imports(include=["iksel"]):
    import iksel
    from iksel import cli

# The parser takes most of the time to make, and is the same for all.
cli.make_parser = functools.cache(cli.make_parser)

NUMBERS = (
    *("0", "1", "-1", "0.3", "-0.5", "3.1416", "90", "1e-3", "-1e-300", "1e308"),
    *("nan", "-inf", "1e400", "0x10", "1_0", "٣", "1,2", "0.1;0.2", ""),
)
# Counts that are worked through stay small, or are beyond all bounds.
COUNTS = ("0", "1", "2", "7", "-1", "1.5", "x", "", "1" + "0" * 30)
SEEDS = ("0", "18446744073709551615", "18446744073709551616", "-1", "x")
WORDS = ("first", "first=0.3", "second=nan", "=", "base", "hand", "x", "none", "z", "ä")
TASKS = (
    "pose",
    "free_spin",
    "free_spin:x",
    "box:1,1,1,inf,inf,inf",
    "box:1",
    "planar:",
)
FILES = (
    *("arm.urdf", "bad.urdf", "missing.urdf", "folder", "arm.iksel", "bad.iksel"),
    *("poses.txt", "bad.txt", "poses.npy", "-", "/dev/null", ""),
    *("new.iksel", "new.csv", "new.jsonl", "new.npy"),
)
ROBOTS = (*["arm.urdf"] * 20, "ur3", "so100", "nobody", *FILES)


def flags_of_commands() -> dict[str, dict[str, argparse.Action]]:
    """The flags of each command that ends, as its own parser has them."""
    actions = cli.make_parser()._subparsers._group_actions
    return {
        name: dict(sorted(parser._option_string_actions.items()))
        for name, parser in actions[0].choices.items()
        if name != "view"  # serves until it is interrupted
    }


def write_files(folder: Path) -> None:
    """What arguments name."""
    (folder / "folder").mkdir()
    arm = urdf_text.arm()
    (folder / "arm.urdf").write_text(arm)
    (folder / "bad.urdf").write_text(arm[:300])
    database = iksel.Database.build(
        iksel.Robot.from_urdf(arm), iksel.DatabaseOptions(samples=20)
    )
    database.save(folder / "arm.iksel")
    (folder / "bad.iksel").write_bytes(database.to_bytes()[:-8])
    (folder / "poses.txt").write_text("# two\n0 0 0.5 0 0 0\n0.1,0,0.6,0,0,0\n")
    np.save(folder / "poses.npy", [[0, 0, 0.5, 0, 0, 0], [0, 0, float("nan"), 0, 0, 0]])
    (folder / "bad.txt").write_text("0 0 0.5\nx\n\0")


def values_for(flag: str) -> tuple[str, ...]:
    """What may follow a flag."""
    if flag in {"-o", "--output", "--database", "--srdf", "--poses"}:
        return (*FILES, "/dev/full")
    if "seed" in flag and flag != "--seed-q":
        return SEEDS
    if flag in {"--base", "--tip", "--lock", "--preset", "--objective"}:
        return WORDS
    if flag == "--task":
        return TASKS
    if flag in {"--pose", "--from-q", "--near", "--start", "--tcp", "--seed-q"}:
        return NUMBERS
    return (*COUNTS, *COUNTS, *NUMBERS[-9:])


class Stream(io.TextIOWrapper):
    """A stream that is kept, and encodes as the process's own does."""

    def __init__(self, errors: str) -> None:
        self.content = io.BytesIO()
        super().__init__(self.content, "utf-8", errors, write_through=True)

    def fileno(self) -> int:
        """A file that nobody reads, which the command line may close for good."""
        return SINK

    def text(self) -> str:
        """All that was written; an array is no text."""
        return self.content.getvalue().decode(errors="replace")


# One input alone, as when a finding is repeated: say what it is.
SHOW = any(Path(word).is_file() for word in sys.argv[1:])
SINK = os.open(os.devnull, os.O_WRONLY)
COMMANDS = flags_of_commands()


def make_values(
    flag: str, action: argparse.Action, dice: atheris.FuzzedDataProvider
) -> list[str]:
    """Values after a flag: mostly as many and of the kind that it takes."""
    pool = [*(action.choices or values_for(flag))]
    if dice.ConsumeIntInRange(0, 9) == 0:
        pool = [*WORDS, *NUMBERS]
    counts = {None: [1], "+": [1, 2, 2, 2, 6, 6, 7, 16]}.get(action.nargs)
    count = dice.PickValueInList(counts or [int(action.nargs)])
    if dice.ConsumeIntInRange(0, 19) == 0:
        count = dice.ConsumeIntInRange(0, 7)
    return [dice.PickValueInList(pool) for _ in range(count)]


def usual_arguments(command: str, dice: atheris.FuzzedDataProvider) -> list[str]:
    """What a command needs; small, so that a run takes milliseconds.

    Later flags override it.
    """
    small = {
        "evaluate": ["--targets", "20"],
        "plot": ["--configurations", "20"],
        "fk": ["0.3", "0.4"],
        "jacobian": ["0.3", "0.4"],
    }
    usual = list(small.get(command, []))
    file = dice.PickValueInList(list(FILES))
    if command == "path":
        usual.append(file)
    if command in {"solve", "path", "build", "evaluate"}:
        usual += ["--samples", "30"]
    if command == "solve":
        one = ["--from-q", "0.3", "0.4"]
        usual += one if dice.ConsumeBool() else ["--poses", file]
    return usual


def make_arguments(data: bytes) -> list[str]:
    """An argument list out of any bytes."""
    dice = atheris.FuzzedDataProvider(data)
    command = dice.PickValueInList([*COMMANDS] * 4 + ["", "nonsense", "--help"])
    arguments = [command]
    if dice.ConsumeIntInRange(0, 9):
        arguments.append(dice.PickValueInList(list(ROBOTS)))
    arguments += usual_arguments(command, dice)
    flags = COMMANDS.get(command, {})
    for _ in range(dice.ConsumeIntInRange(0, 5) if flags else 0):
        flag = dice.PickValueInList(list(flags))
        arguments += [flag, *make_values(flag, flags[flag], dice)]
    if dice.ConsumeIntInRange(0, 9) == 0:
        # Any bytes but NUL, as a shell may give them.
        arguments.append(os.fsdecode(dice.ConsumeBytes(20).replace(b"\0", b"")))
    return arguments


def refuse(constant: str) -> None:
    """NaN and Infinity are no JSON."""
    raise AssertionError(f"{constant} is no JSON")


def check(arguments: list[str], code: int, out: str, err: str) -> None:
    """What a run owes its caller."""
    assert code in {0, 1, 2}, f"exit status {code}"
    # Progress writes lines of its own.
    if "--progress" not in arguments:
        lines = err.splitlines()
        assert all(line.startswith("iksel: ") for line in lines), err
    if code == 2:
        # Answers that were written before an error in a later row stay.
        assert out == "" or "--poses" in arguments, out
        assert "iksel: error: " in err, err
    elif "--json" in arguments and not {"-h", "--help", "--version"} & {*arguments}:
        json.loads(out, parse_constant=refuse)


def one_input(data: bytes) -> None:
    """Run the command line once."""
    arguments = make_arguments(data)
    out, err = Stream("strict"), Stream("backslashreplace")
    if SHOW:
        print("iksel", *map(repr, arguments), file=sys.stderr, flush=True)  # noqa: T201
    sys.stdin = io.TextIOWrapper(io.BytesIO(b"0 0 0.5 0 0 0\n"), "utf-8")
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = cli.main(arguments)
        check(arguments, code, out.text(), err.text())
    except BaseException:
        print("finding: iksel", *map(repr, arguments), file=sys.stderr)  # noqa: T201
        raise


def from_here(setting: str) -> str:
    """A setting of libFuzzer whose path holds from any folder."""
    name, equals, path = setting.rpartition("=")
    if equals and name != "-artifact_prefix":
        return setting
    if not equals and not Path(path).exists():
        return setting
    return f"{name}{equals}{os.path.abspath(path)}" + "/" * path.endswith("/")  # noqa: PTH100


def main() -> None:
    """Fuzz in a folder of its own."""
    settings = map(from_here, ["-artifact_prefix=./", *sys.argv[1:]])
    with tempfile.TemporaryDirectory() as folder:
        write_files(Path(folder))
        arguments = [sys.argv[0], *settings]
        os.chdir(folder)
        atheris.Setup(arguments, one_input)
        atheris.Fuzz()


main()
