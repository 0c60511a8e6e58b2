# SPDX-License-Identifier: BSD-3-Clause
"""The page of wrong inputs says what is said, and every message is one to read."""

from __future__ import annotations

import re

import pytest
import wrong_inputs

UNREADABLE = (
    "incompatible function arguments",
    "incompatible constructor arguments",
    "Invoked with",
    "Traceback",
    "std::",
    "iksel_cpp.",
)


@pytest.fixture(scope="module")
def answers() -> list[tuple[str, str, str]]:
    return list(wrong_inputs.answers())


def test_the_page_is_up_to_date(monkeypatch, answers) -> None:
    monkeypatch.setattr(wrong_inputs, "answers", lambda: iter(answers))
    page = wrong_inputs.PAGE.read_text(encoding="utf-8")
    assert wrong_inputs.make_page() == page, "run: python tests/python/wrong_inputs.py"


def test_forty_and_more_are_covered(answers) -> None:
    assert len(answers) >= 40


def test_messages_can_be_read(answers) -> None:
    for _, line, message in answers:
        assert message, line
        assert len(message) < 1000, line
        for word in UNREADABLE:
            assert word not in message, (line, message)
        assert not re.search(r"/(tmp|home|work)/", message), (line, message)
        if line.startswith("$ "):
            assert re.match(
                r"iksel: (error|warning): .*\n\[exit status [012]\]", message
            )
        elif not line.startswith("print"):
            assert re.match(r"\w+(Error|Warning): .", message), (line, message)
