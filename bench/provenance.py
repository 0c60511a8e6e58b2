# SPDX-License-Identifier: BSD-3-Clause
"""Whether figures are of the sources that are here: else nobody can make them again."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bench.machine import MEASURING, UNKNOWN, git

if TYPE_CHECKING:
    from collections.abc import Callable

    from bench.view import Report

SOURCES = (
    "CMakeLists.txt",
    "cmake",
    "cpp",
    "python",
    *(f":(glob)bench/{pattern}" for pattern in MEASURING),
)
"""What a figure depends on."""
SHOWN = 8
"""Files that an error names."""


class ProvenanceError(Exception):
    """A report that is not of one commit, or of another than the sources here."""


def check(report: Report) -> None:
    """Raise ProvenanceError unless every part of a report is of the sources here."""
    if found := reasons(report, doubts):
        raise ProvenanceError("; ".join(found))


def reasons(report: Report, of: Callable[[dict[str, Any]], list[str]]) -> list[str]:
    """What `doubts` or `unfit` say of every part of a report."""
    parts = {"the report": report}
    parts |= {f"section {name}": part for name, part in report.get("parts", {}).items()}
    return [
        f"{name}: {reason}"
        for name, part in parts.items()
        for reason in of(part["machine"])
    ]


def doubts(facts: dict[str, Any]) -> list[str]:
    """Why figures with these facts of bench.machine are not of the sources here."""
    found = unfit(facts)
    commit = str(facts.get("commit", UNKNOWN)).rstrip("+")
    if commit == UNKNOWN:
        return found
    if not git("cat-file", "-t", commit):
        return [*found, f"made at commit {commit}, which is not in this repository"]
    changed = git("diff", "--name-only", commit, "--", *SOURCES).splitlines()
    if changed:
        more = len(changed) - SHOWN
        names = ", ".join(changed[:SHOWN]) + (f" and {more} more" if more > 0 else "")
        found.append(f"changed since its commit {commit}: {names}")
    return found


def unfit(facts: dict[str, Any]) -> list[str]:
    """Why figures are of no sources at all: they can never have been published."""
    commit = str(facts.get("commit", UNKNOWN))
    if commit == UNKNOWN:
        return ["made at an unknown commit"]
    found = []
    if commit.endswith("+"):
        found.append(f"made of a tree that differs from its commit {commit[:-1]}")
    if facts.get("stale"):
        found.append("made by an IKSel that is older than its sources")
    return found
