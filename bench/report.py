# SPDX-License-Identifier: BSD-3-Clause
"""Collects results into one file, and makes the text and the plots of it."""

from __future__ import annotations

import contextlib
import importlib.util
import json
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from bench import machine, provenance
from bench.markdown import contents
from bench.plots import draw_all
from bench.rivals import ENUMERATORS, RIVALS
from bench.rivals.base import UnsupportedError
from bench.sections import (
    absent,
    analytic,
    ikgeo,
    learned,
    no,
    paper,
    random_builds,
    requests,
    rivals,
    robots,
    seed_makers,
    tails,
)
from bench.store import key_of, write_json
from bench.view import View

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from bench.rivals.base import Rival
    from bench.size import Job, Size
    from bench.store import Store
    from bench.view import Report

PLOTTED = "uniform"
"""Targets whose distributions are kept for the plots."""

ORIGIN = (
    "Generated. Figures are of the runs named here, but for those that the text calls "
    "published, and rows that say to be of another run. *Proven* is what IKSel says of "
    "its own no; *brute force* is made of IKSel's own calls: its iteration from many "
    "seeds, all that `solve_all` gives, `self_motion` from end to end. Where another "
    "solver's answers are held against IKSel's, that solver is named."
)
"""Where figures come from, and whose word the words are."""

DIGITS = 6
"""Significant digits of the figures that are kept."""


def collect(
    jobs: list[Job], store: Store, size: Size, *, command: str, seconds: float
) -> Report:
    """All results of some jobs as plain data, and what they were made on."""
    cells = {}
    for job in jobs:
        for settings in job.cells:
            result = store.load(settings)
            if result is not None and settings["cell"] != "targets":
                key = key_of(settings)
                if settings.get("kind", PLOTTED) != PLOTTED:
                    result = _without_quantiles(result)
                cells[key] = {"settings": settings, "result": _rounded(result)}
    return {
        "machine": machine.facts(),
        "command": command,
        "seconds": round(seconds),
        "size": asdict(size),
        "versions": store.versions,
        "missing": missing_rivals(),
        "failures": {},
        "cells": list(cells.values()),
    }


def merged(
    old: Report, new: Report, wanted: list[Job], sections: Iterable[str]
) -> Report:
    """A report with some sections measured anew, on whatever they were measured.

    Args:
        old: Has the others.
        new: Has those sections.
        wanted: The jobs of a whole report: cells that are of none are left out.
        sections: Which ones.
    """
    cells = {key_of(cell["settings"]): cell for cell in [*old["cells"], *new["cells"]]}
    keys = [key_of(cell) for job in wanted for cell in job.cells]
    part = {name: new[name] for name in ("machine", "command", "seconds")}
    return {
        **old,
        "size": new["size"],
        "versions": {**old["versions"], **new["versions"]},
        "missing": new["missing"],
        "failures": new["failures"],
        "parts": {**old.get("parts", {}), **dict.fromkeys(sections, part)},
        "cells": [cells[key] for key in dict.fromkeys(keys) if key in cells],
    }


def installed_rivals() -> dict[str, str]:
    """Versions of the solvers that can be had here, by name."""
    versions = {}
    for name, rival in _every_rival().items():
        with contextlib.suppress(UnsupportedError):
            versions[name] = rival.version()
    return versions


def missing_rivals() -> dict[str, str]:
    """Why the others cannot be had, by name."""
    reasons = {}
    for name, rival in _every_rival().items():
        try:
            rival.version()
        except UnsupportedError as reason:
            reasons[name] = str(reason)
    return reasons


def _every_rival() -> dict[str, type[Rival]]:
    return {**ENUMERATORS, **RIVALS}


def save_report(report: Report, folder: Path) -> None:
    """Write results/report.json."""
    write_json(folder / "results" / "report.json", report)


def load_report(folder: Path) -> Report:
    """Read what save_report wrote."""
    path = folder / "results" / "report.json"
    report: Report = json.loads(path.read_text(encoding="utf-8"))
    return report


def render(report: Report, folder: Path) -> None:
    """Write RESULTS.md and the plots."""
    view = View(report)
    text = "\n\n".join(
        part
        for part in (
            rivals.text(view),
            no.text(view),
            analytic.text(view),
            absent.text(view),
            random_builds.text(view),
            tails.text(view),
            paper.text(view),
            ikgeo.text(view),
            learned.text(view),
            seed_makers.text(view),
            robots.text(view),
            requests.text(view),
            _tail(report),
        )
        if part
    )
    text = "\n\n".join([_head(report), contents(text), text])
    drawn = draw_all(view, folder / "plots")
    text = "\n".join(
        line
        for line in text.splitlines()
        if not line.startswith("![") or any(f"({plot})" in line for plot in drawn)
    )
    if not drawn and importlib.util.find_spec("matplotlib") is None:
        text += "\n\nNo plots: matplotlib is not installed.\n"
    (folder / "RESULTS.md").write_text(text.rstrip() + "\n", encoding="utf-8")


def _head(report: Report) -> str:
    lines = [_made(report)]
    for section, part in report.get("parts", {}).items():
        lines.append(f"Section `{section}`: {_made(part)}")
    doubts = provenance.doubts(report["machine"])
    if doubts:
        lines.insert(0, f"**Not to be published**: {'; '.join(doubts)}.")
    return "\n\n".join(["# Results", ORIGIN, *lines])


def _made(part: dict[str, Any]) -> str:
    """How a report, or a section that was measured by itself, was made."""
    facts = part["machine"]
    return (
        f"Made by `{part['command']}` in {part['seconds']} s (results that were "
        "there already, and what ssik builds once, not counted), with IKSel "
        f"{facts['iksel']} (lanes: "
        f"{facts['simd']}) at commit {facts['commit']}, Python {facts['python']}, "
        f"numpy {facts['numpy']}, on {facts['cpu']}, {facts['cores']} cores, "
        f"{facts['system']}{machine.load_text(facts)}."
        f"{machine.others_text(facts)} Times move from machine to machine; what is "
        "compared here was timed in the same run."
    )


def _tail(report: Report) -> str:
    failures = report["failures"]
    if not failures:
        return ""
    lines = [f"- {name}: {reason}" for name, reason in failures.items()]
    return "\n".join(["## Failed", "", *lines])


def _without_quantiles(result: dict[str, Any]) -> dict[str, Any]:
    return {k: v for k, v in result.items() if not k.endswith("quantiles_us")}


def _rounded(value: Any) -> Any:
    """Floats with DIGITS significant digits, to keep the file small."""
    if isinstance(value, dict):
        return {name: _rounded(item) for name, item in value.items()}
    if isinstance(value, list):
        return [_rounded(item) for item in value]
    if isinstance(value, float):
        return float(f"{value:.{DIGITS}g}")
    return value
