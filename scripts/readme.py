# SPDX-License-Identifier: BSD-3-Clause
"""Fills the marked blocks of README.md: examples, the robots, measured results.

A block stands between `<!-- NAME -->` and `<!-- end NAME -->`. Nothing between the two
marks is written by hand. With --check, nothing is changed and a stale block is an
error.
"""

import argparse
import json
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).resolve().parents[1]


def code(path: str, language: str) -> str:
    """A source file without its licence line."""
    text = (ROOT / path).read_text(encoding="utf-8")
    text = re.sub(r"^.*SPDX-License-Identifier.*\n", "", text)
    return f"```{language}\n{text.strip()}\n```"


def robots() -> str:
    """One row per robot of the manifest."""
    manifest = tomllib.loads((ROOT / "cpp/robots/robots.toml").read_text("utf-8"))
    rows = [
        "| name | maker | joints | numbers from | licence |",
        "|---|---|---|---|---|",
    ]
    for name, robot in manifest["robots"].items():
        source = robot["source"].split(" @ ")[0].split(":")[0]
        rows.append(
            f"| `{name}` | {robot['maker']} | {robot['dof']} | {source} "
            f"| {robot['licence']} |"
        )
    return "\n".join(rows)


ANALYTIC = ("EAIK", "IK-Geo")


def results() -> str:
    """The default preset beside its rivals, from what `python -m bench report` kept."""
    path = ROOT / "bench" / "results" / "report.json"
    report: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    cells: dict[str, dict[str, dict[str, Any]]] = {}
    for cell in report["cells"]:
        settings, result = cell["settings"], cell["result"]
        if settings["cell"] == "rival" and settings["kind"] == "uniform":
            by_solver = cells.setdefault(settings["robot"], {})
            if result.get("right"):
                by_solver[settings["rival"]] = result
    rows = [
        "| robot | success | mean | p99 | next fastest numerical solver | analytic |",
        "|---|---|---|---|---|---|",
    ]
    rows += [f"| `{robot}` | {beside(found)} |" for robot, found in cells.items()]
    facts = report["machine"]
    count = next(iter(cells.values()))["IKSel"]["count"]
    conditions = (
        f"{count:,} targets per robot (fewer for the slower solvers), uniform in the "
        "joint limits; one pose at a time from Python (KDL's and SLSQP's from C++); "
        "every answer checked to 1e-5 m, 1e-5 rad and the limits; failures included in "
        f"the times; SIMD level {facts['simd']}, {facts['cpu']} ({facts['cores']} "
        f"cores). Made by `{report['command']}`."
    )
    plot = "![Share of targets solved over time](bench/plots/success_over_time.svg)"
    return "\n".join([plot, "", *rows, "", conditions])


def beside(found: dict[str, dict[str, Any]]) -> str:
    """One robot's row."""
    ours = found["IKSel"]
    numerical = {
        name: result
        for name, result in found.items()
        if not name.startswith("IKSel") and name not in ANALYTIC
    }
    name = min(numerical, key=lambda solver: float(numerical[solver]["mean_us"]))
    mean = numerical[name]["mean_us"]
    analytic = ", ".join(
        f"{solver} {found[solver]['mean_us']:.1f} µs"
        for solver in ANALYTIC
        if solver in found
    )
    return (
        f"{100.0 * ours['right'] / ours['count']:.3f} % | {ours['mean_us']:.2f} µs "
        f"| {ours['p99_us']:.2f} µs "
        f"| {name} {mean:.0f} µs, {mean / ours['mean_us']:.0f} times "
        f"| {analytic or 'none'}"
    )


BLOCKS: dict[str, Callable[[], str]] = {
    "python example": lambda: code("python/examples/01_solve.py", "python"),
    "cpp example": lambda: code("cpp/examples/01_solve.cpp", "cpp"),
    "robots": robots,
    "results": results,
}


def fill(text: str) -> str:
    """The text with every block made anew."""
    for name, make in BLOCKS.items():
        pattern = re.compile(f"(<!-- {name} -->\n).*?(<!-- end {name} -->)", re.DOTALL)
        if not pattern.search(text):
            sys.exit(f"README.md has no block '{name}'")
        content = make()
        text = pattern.sub(lambda m, c=content: f"{m[1]}{c}\n{m[2]}", text)
    return text


def main() -> None:
    """Entry point."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true")
    check = parser.parse_args().check
    readme = ROOT / "README.md"
    text = readme.read_text(encoding="utf-8")
    filled = fill(text)
    if filled == text:
        return
    if check:
        sys.exit("README.md: stale block; run `python scripts/readme.py`")
    readme.write_text(filled, encoding="utf-8")


if __name__ == "__main__":
    main()
