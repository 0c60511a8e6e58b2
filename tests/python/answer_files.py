# SPDX-License-Identifier: BSD-3-Clause
"""Files of answers as the command line writes them."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import numpy as np

import iksel

FEW = ["--samples", "500"]


def read(path: Path) -> tuple[list[str], list[str], np.ndarray, np.ndarray]:
    """Statuses, proofs, joint values and errors of a file of answers, NaN for none."""

    def numbers(rows) -> np.ndarray:
        values = [[np.nan if x in (None, "") else float(x) for x in r] for r in rows]
        return np.array(values)

    if path.suffix == ".npy":
        array = np.load(path)
        statuses = [iksel.Status(x).name for x in array["status"]]
        proofs = [iksel.Proof(x).name for x in array["proof"]]
        errors = np.stack([array["position_error"], array["rotation_error"]], axis=1)
        return statuses, proofs, array["q"], errors
    text = path.read_text("utf-8")
    if path.suffix == ".csv":
        _, *rows = csv.reader(io.StringIO(text))
        q = numbers(row[2:-2] for row in rows)
        errors = numbers(row[-2:] for row in rows)
        return [r[0] for r in rows], [r[1] for r in rows], q, errors
    objects = [json.loads(line) for line in text.splitlines()]
    q = numbers(o["q"] or [None] * 6 for o in objects)
    errors = numbers((o["position_error"], o["rotation_error"]) for o in objects)
    return [o["status"] for o in objects], [o["proof"] for o in objects], q, errors
