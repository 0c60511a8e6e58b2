# SPDX-License-Identifier: BSD-3-Clause
"""Files of strangers run nothing, end, and are refused by one line."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

import hostile_files
import pytest
from hostile_files import CANARY

for _module in hostile_files.LIBRARIES:
    pytest.importorskip(_module)

Report = tuple[str, int, str, str, list[str]]

HARMLESS = {"entities.urdf", "entities.xacro", "external.xacro"} | {
    "arena.xml",
    "keys.xml",
    "user_data.xml",
}
"""Files whose trees of links may be read, as what is hostile in them is left out."""


@pytest.fixture(scope="module")
def reports(tmp_path_factory: pytest.TempPathFactory) -> list[Report]:
    """What each reader said of each file; the program has an end, or the test none."""
    folder = tmp_path_factory.mktemp("hostile")
    done = subprocess.run(
        [sys.executable, hostile_files.__file__, folder],
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        timeout=1_800,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-2_000:]
    assert not list(folder.rglob(CANARY)), "code was run"
    assert not Path(CANARY).exists()
    return [tuple(json.loads(line)) for line in done.stdout.splitlines()]


def test_each_file_is_read(reports: list[Report]) -> None:
    read = Counter(name for name, *_ in reports)
    assert len(read) >= 20
    assert set(hostile_files.TEXTS) <= set(read)


def test_nothing_is_started_written_or_asked(reports: list[Report]) -> None:
    seen = {(name, reader): events for name, reader, _, _, events in reports if events}
    assert not seen


def test_each_ends_in_a_typed_error_of_one_line(reports: list[Report]) -> None:
    wrong = [
        (name, reader, kinds[:60], said[:200])
        for name, reader, kinds, said, _ in reports
        if not ("Error" in kinds.split() and said and "\n" not in said)
        and (kinds or name not in HARMLESS)
    ]
    assert not wrong
