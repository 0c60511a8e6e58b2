# SPDX-License-Identifier: BSD-3-Clause
"""Files of poses, one a row: lines of numbers or of JSON, or a NumPy array."""

from __future__ import annotations

import io
import json
import math
import sys
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import InvalidArgumentError

from iksel.cli._columns import MOST_NAMES, Columns, form_names, read_columns
from iksel.cli._lengths import warn_of_millimetres
from iksel.cli._parser import POSE_COUNTS, parse_numbers

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from iksel_cpp import Robot

    from iksel._base.arrays import FloatArray
    from iksel.cli._angles import Angles
    from iksel.pose import QuaternionOrder

FILE_FORMS = """\
FILE has one pose a row; - is stdin. What it is shows in its content:
  numbers  a line each, in the forms of `iksel solve --pose`, separated by spaces or
           commas; empty lines and those that start with # are left out. A first line of
           names, with x y z roll pitch yaw or x y z qw qx qy qz among them in any
           order, says what the columns are; others, such as times, are not read
  several  the poses of all --tip in their order, in one form; in a line of names each
  tips     begins with the tip's link and a point, as left_hand.x
  JSON     a line each: a list of these numbers, a 4x4 list, or {"pose": such a list}
  .npy     an array of shape (N, 4, 4), (N, 6), (N, 7) or (N, 16), or for k tips
           (N, k, 4, 4), (N, 6 k), (N, 7 k) or (N, 16 k)
"""

LONGEST_LINE = 1 << 20
"""Bytes; a longer line is no pose, but a file of another kind."""

_NPY = b"\x93NUMPY"


class PoseFile:
    """The poses of a file or of stdin, one after the other; a context.

    Lines are read as they are asked for, so that a file may be of any length.
    """

    def __init__(self, name: str, angles: Angles, tips: Sequence[str]) -> None:
        """Take the file's name, or -, the unit of angles, and the robot's tip links."""
        self._name = name
        self._angles = angles
        self._tips = tips
        self.done = 0
        """Bytes of lines, or rows of an array, that have been read."""
        self.total = 0
        """How many there are; 0: not known."""

    def __enter__(self) -> PoseFile:  # noqa: PYI034 (Self is of Python 3.11)
        """Open it.

        Raises:
            InvalidArgumentError: It cannot be opened.
        """
        try:
            if self._name == "-":
                self._file: IO[bytes] = sys.stdin.buffer
            else:
                path = Path(self._name)
                self._file = path.open("rb")
                self.total = path.stat().st_size
        except OSError as error:
            raise self._error(str(error.strerror)) from None
        return self

    def __exit__(self, *exception: object) -> None:
        """Close it."""
        if self._name != "-":
            self._file.close()

    def __iter__(self) -> Iterator[FloatArray | InvalidArgumentError]:
        """The rows: poses (4, 4), of k tips (k, 4, 4), and why others are none.

        Raises:
            InvalidArgumentError: It cannot be read, or nothing in it is a row.
        """
        try:
            line = self._file.readline(LONGEST_LINE)
            rows = self._array(line) if line.startswith(_NPY) else self._lines(line)
            nothing = True
            for row in rows:
                nothing = False
                yield row
        except OSError as error:
            raise self._error(str(error.strerror)) from None
        if nothing:
            raise self._error("no poses in it")

    def _lines(self, line: bytes) -> Iterator[FloatArray | InvalidArgumentError]:
        columns: Columns | None = None
        first = True
        index = 0
        while line:
            index += 1
            self.done += len(line)
            where = f"{self._name}, line {index}"
            if len(line) == LONGEST_LINE:
                raise self._error(f"line {index} is longer than {LONGEST_LINE} bytes")
            try:
                text = line.decode("utf-8").strip().lstrip("\ufeff")
            except UnicodeDecodeError as error:
                raise self._error(f"line {index}: {error}") from None
            if text and not text.startswith("#"):
                named = read_columns(where, text, self._tips) if first else None
                if named is not None:
                    columns = named
                else:
                    yield self._row(where, text, columns)
                first = False
            line = self._file.readline(LONGEST_LINE)

    def _array(self, start: bytes) -> Iterator[FloatArray | InvalidArgumentError]:
        try:
            if self._name == "-" or not self._file.seekable():
                content = io.BytesIO(start + self._file.read())
                array = np.load(content, allow_pickle=False)
            else:
                array = np.load(self._name, mmap_mode="r", allow_pickle=False)
        except (ValueError, EOFError) as error:
            raise self._error(f"no array: {error}") from None
        tips = len(self._tips)
        rows: list[tuple[int, ...]] = [(4, 4) if tips == 1 else (tips, 4, 4)]
        rows += [(count * tips,) for count in POSE_COUNTS]
        if array.shape[1:] not in rows:
            shapes = [f"(N, {', '.join(map(str, row))})" for row in rows]
            raise self._error(
                f"expected an array of shape {', '.join(shapes[:-1])} or {shapes[-1]}, "
                f"got {array.shape}"
            )
        if array.dtype.kind not in "iuf":
            raise self._error(f"expected numbers, got an array of {array.dtype}")
        self.total = len(array)
        for index, row in enumerate(array):
            self.done = index + 1
            numbers = [float(x) for x in row.ravel()]
            yield self._pose(f"{self._name}, row {index}", numbers)

    def _row(
        self, where: str, text: str, columns: Columns | None
    ) -> FloatArray | InvalidArgumentError:
        try:
            if columns is not None:
                return self._poses(where, columns.pick(where, text), order="wxyz")
            found = _json_numbers(where, text)
            numbers = parse_numbers(where, [text]) if found is None else found
        except InvalidArgumentError as error:
            return error
        return self._pose(where, numbers)

    def _pose(
        self, where: str, numbers: list[float]
    ) -> FloatArray | InvalidArgumentError:
        try:
            return self._poses(where, numbers)
        except InvalidArgumentError as error:
            of_each = len(numbers) / len(self._tips)
            if of_each == 16 or of_each <= MOST_NAMES:
                return error
            return InvalidArgumentError(
                f"{error}; where there are further columns, a first line of names, "
                f"{form_names(self._tips)}, says which are the pose"
            )

    def _poses(
        self, where: str, numbers: list[float], order: QuaternionOrder | None = None
    ) -> FloatArray:
        """The pose of the one tip, (4, 4), or of each, (k, 4, 4).

        Raises:
            InvalidArgumentError: They are something else.
        """
        tips = self._tips
        if len(tips) == 1:
            return self._angles.as_pose(where, numbers, order)
        count, rest = divmod(len(numbers), len(tips))
        if rest or count not in POSE_COUNTS:
            forms = ", ".join(str(n * len(tips)) for n in POSE_COUNTS)
            raise InvalidArgumentError(
                f"{where}: expected a pose for each of {', '.join(tips)}, in one form: "
                f"one of {forms} numbers; got {len(numbers)}"
            )
        parts = [numbers[i * count : (i + 1) * count] for i in range(len(tips))]
        return np.stack(
            [
                self._angles.as_pose(f"{where}, {tip}", part, order)
                for tip, part in zip(tips, parts, strict=True)
            ]
        )

    def _error(self, problem: str) -> InvalidArgumentError:
        return InvalidArgumentError(f"{self._name}: {problem}")


def read_poses(name: str, angles: Angles, robot: Robot) -> FloatArray:
    """The poses of a file, (N, 4, 4), for a robot of k tips (N, k, 4, 4).

    Raises:
        InvalidArgumentError: It cannot be read, or a row is no pose.
    """
    poses = []
    with PoseFile(name, angles, robot.tip_links) as rows:
        for row in rows:
            if isinstance(row, InvalidArgumentError):
                raise row
            poses.append(row)
    found = np.stack(poses)
    warn_of_millimetres(robot, name, found)
    return found


def _json_numbers(where: str, text: str) -> list[float] | None:
    """The numbers of a line that is JSON; None if it is none."""
    if text[0] not in "[{":
        return None
    try:
        value = json.loads(text)
    except (ValueError, RecursionError):
        if text[0] == "[":
            return None  # brackets, but not JSON's: numbers as after --pose
        raise InvalidArgumentError(f"{where}: no JSON in {text[:60]!r}") from None
    if isinstance(value, dict):
        if "pose" not in value:
            keys = ", ".join(value) or "none"
            raise InvalidArgumentError(f"{where}: no key 'pose'; its keys are {keys}")
        value = value["pose"]
    return list(_flat(where, value))


def _flat(where: str, value: Any) -> Iterator[float]:
    """The numbers of nested lists; null is NaN."""
    if isinstance(value, list):
        for item in value:
            yield from _flat(where, item)
    elif value is None:
        yield math.nan
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        try:
            yield float(value)
        except OverflowError:
            yield math.inf
    else:
        raise InvalidArgumentError(f"{where}: {value!r} is no number")
