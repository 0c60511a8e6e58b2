# SPDX-License-Identifier: BSD-3-Clause
"""Files of answers, one a row: CSV, lines of JSON, or a NumPy array."""

from __future__ import annotations

import csv
import io
import json
from typing import IO, TYPE_CHECKING, Any, Protocol

import numpy as np
from iksel_cpp import Proof, Status

from iksel.cli._output import plain

if TYPE_CHECKING:
    from collections.abc import Sequence

    from iksel_cpp import BatchResult

    from iksel._base.arrays import FloatArray

ERRORS = ("position_error", "rotation_error")

FILE_FORMS = """\
  csv    a first line of names, then a line each: status, proof, the joint values under
         the joints' names, position_error [m], rotation_error [rad]; what there is none
         of is empty
  jsonl  a line each: {"status", "proof", "q", "position_error", "rotation_error"}; what
         there is none of is null
  npy    a structured array of the fields status and proof (numbers of iksel.Status and
         iksel.Proof), q, position_error and rotation_error; NaN where there is none
"""


class Answers(Protocol):
    """Writes answers to a file."""

    def __init__(self, file: IO[bytes], joint_names: Sequence[str]) -> None:
        """Take the file and the names of the joints."""

    def write(self, batch: BatchResult, q: FloatArray) -> None:
        """Write rows, with joint values (N, dof) in the user's unit."""

    def close(self) -> None:
        """Write what is left."""


class CsvAnswers(Answers):
    """Writes answers as comma-separated values."""

    def __init__(self, file: IO[bytes], joint_names: Sequence[str]) -> None:
        """Take the file and the names, which are written before the first row."""
        self._file = file
        self._header = [["status", "proof", *joint_names, *ERRORS]]

    def write(self, batch: BatchResult, q: FloatArray) -> None:
        """Write rows, with joint values (N, dof) in the user's unit."""
        rows = (
            [status, proof, *(values or [None] * q.shape[1]), *errors]
            for status, proof, values, *errors in _rows(batch, q)
        )
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows([*self._header, *rows])
        self._file.write(text.getvalue().encode())
        self._header = []

    def close(self) -> None:
        """Nothing is left to write."""


class JsonAnswers(Answers):
    """Writes answers as lines of JSON."""

    def __init__(self, file: IO[bytes], joint_names: Sequence[str]) -> None:  # noqa: ARG002 (a row is a list)
        """Take the file."""
        self._file = file

    def write(self, batch: BatchResult, q: FloatArray) -> None:
        """Write rows, with joint values (N, dof) in the user's unit."""
        names = ("status", "proof", "q", *ERRORS)
        lines = (
            json.dumps(dict(zip(names, row, strict=True)), allow_nan=False) + "\n"
            for row in _rows(batch, q)
        )
        self._file.write("".join(lines).encode())

    def close(self) -> None:
        """Nothing is left to write."""


class NpyAnswers(Answers):
    """Writes answers as a structured array; its header has their number, so at last."""

    def __init__(self, file: IO[bytes], joint_names: Sequence[str]) -> None:
        """Take the file."""
        self._file = file
        self._type = np.dtype(
            [
                ("status", np.uint8),
                ("proof", np.uint8),
                ("q", np.float64, (len(joint_names),)),
                *((name, np.float64) for name in ERRORS),
            ]
        )
        self._parts: list[Any] = []

    def write(self, batch: BatchResult, q: FloatArray) -> None:
        """Keep rows, with joint values (N, dof) in the user's unit."""
        part = np.empty(len(batch), self._type)
        part["q"] = q
        for name in ("status", "proof", *ERRORS):
            part[name] = getattr(batch, name)
        self._parts.append(part)

    def close(self) -> None:
        """Write the array."""
        # Through memory: what np.save() would ask of a file, a pipe does not have.
        content = io.BytesIO()
        np.save(content, np.concatenate(self._parts), allow_pickle=False)
        self._file.write(content.getvalue())


FORMATS: dict[str, type[Answers]] = {
    "csv": CsvAnswers,
    "jsonl": JsonAnswers,
    "npy": NpyAnswers,
}


def _rows(batch: BatchResult, q: FloatArray) -> Any:
    """Rows as plain data: names of status and proof, q and errors; None for NaN."""
    has_joints = np.logical_and.reduce(np.isfinite(q), axis=1).tolist()
    return zip(
        (Status(status).name for status in batch.status),
        (Proof(proof).name for proof in batch.proof),
        (row if yes else None for row, yes in zip(q.tolist(), has_joints, strict=True)),
        *(plain(getattr(batch, name)) for name in ERRORS),
        strict=True,
    )
