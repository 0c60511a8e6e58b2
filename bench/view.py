# SPDX-License-Identifier: BSD-3-Clause
"""A finished report, and how its text and plots look things up in it."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from bench.size import Size
from bench.store import key_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from bench.store import Settings

Report = dict[str, Any]
"""machine, command, seconds, size, versions, missing, failures, and cells: settings,
result."""


class View:
    """The results of a report by their settings."""

    def __init__(self, report: Report) -> None:
        """Index the cells."""
        self.report = report
        fields: dict[str, Any] = {
            name: tuple(value) if isinstance(value, list) else value
            for name, value in report["size"].items()
        }
        self.size = Size(**fields)
        self._results = {
            key_of(cell["settings"]): cell["result"] for cell in report["cells"]
        }

    def get(self, settings: Settings) -> dict[str, Any] | None:
        """The result of a cell; None where it was not measured or cannot be."""
        result = self._results.get(key_of(settings))
        return None if result is None or "unsupported" in result else result

    def why_not(self, settings: Settings) -> str:
        """Why a cell has no result."""
        result = self._results.get(key_of(settings))
        return "not measured" if result is None else result.get("unsupported", "")

    def has_any(self, cell: str) -> bool:
        """Whether anything of that kind was measured."""
        return any(entry["settings"]["cell"] == cell for entry in self.report["cells"])

    def machine(self, section: str) -> dict[str, Any]:
        """What a section was measured on."""
        part = self.report.get("parts", {}).get(section, self.report)
        facts: dict[str, Any] = part["machine"]
        return facts

    def robots(self, cell: str) -> list[str]:
        """The robots that cells of that kind were measured on, in the plan's order."""
        settings = [entry["settings"] for entry in self.report["cells"]]
        return list(dict.fromkeys(s["robot"] for s in settings if s["cell"] == cell))


def tell_section(text: str, *, wrong: Iterable[str] = (), failed: bool) -> int:
    """Print a section, and what is wrong; the exit status is 1 if anything is."""
    bad = [f"WRONG: {line}\n" for line in wrong]
    sys.stdout.writelines([text + "\n", *bad])
    return 1 if bad or failed else 0
