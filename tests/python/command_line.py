# SPDX-License-Identifier: BSD-3-Clause
"""What a run of the command line gave, and what it is to give."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from typing import Any, NamedTuple


class Output(NamedTuple):
    code: int
    out: str
    err: str

    def json(self) -> Any:
        """The output as JSON, without the NaN and Infinity that only Python knows."""

        def refuse(constant: str) -> None:
            raise AssertionError(f"{constant} is no JSON")

        return json.loads(self.out, parse_constant=refuse)


Run = Callable[..., Output]


def assert_good(output: Output, code: int = 0) -> Output:
    assert output.err == ""
    assert output.code == code
    return output


def assert_bad(output: Output, culprit: str) -> None:
    assert output.code == 2
    assert output.out == ""
    assert output.err.startswith("iksel: error: ")
    assert output.err.endswith("\n")
    assert output.err.count("\n") == 1
    assert re.search(culprit, output.err), output.err
