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
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

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


def load_results(name: str) -> dict[str, Any]:
    """A file written by bench/evaluate.py."""
    path = ROOT / "bench" / "results" / f"{name}.json"
    report: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return report


def conditions(report: dict[str, Any]) -> str:
    """The line that says how the figures came about."""
    row = report["rows"][0]
    return (
        f"{row['targets']:,} targets per robot, seed {row['seed']}, uniform in the "
        f"joint limits; tolerance {row['position_tolerance']:g} m and "
        f"{row['rotation_tolerance']:g} rad; failures included in the times; "
        f"{row['threads']} thread, SIMD level {row['simd']}, {report['cpu']} "
        f"({report['cores']} cores). Made by `{report['command']}`."
    )


PUBLISHED = {"cvr038": 87.59, "cvrb1213": 86.75, "ur3_wrs": 73.17, "irb14050": 95.67}


def paper_results() -> str:
    """The paper's four robots beside the published success."""
    report = load_results("paper")
    rows = [
        "| robot | success | published | mean | p99 | ratio | query / rank / iterate |",
        "|---|---|---|---|---|---|---|",
    ]
    rows += [
        f"| `{row['robot']}` | {row['success_percent']:.2f} % "
        f"| {PUBLISHED[row['robot']]:.2f} % | {row['mean_us']:.0f} µs "
        f"| {row['p99_us']:.0f} µs | {row['ratio']:.0f} "
        f"| {row['query_us']:.0f} / {row['rank_us']:.0f} / {row['iterate_us']:.0f} µs |"
        for row in report["rows"]
        if row["robot"] in PUBLISHED
    ]
    return "\n".join([*rows, "", conditions(report)])


def default_results() -> str:
    """Every robot with the default preset."""
    report = load_results("default")
    rows = [
        "| robot | joints | success | mean | median | p99 | ratio |",
        "|---|---|---|---|---|---|---|",
    ]
    manifest = tomllib.loads((ROOT / "cpp/robots/robots.toml").read_text("utf-8"))
    for row in report["rows"]:
        dof = manifest["robots"][row["robot"]]["dof"]
        rows.append(
            f"| `{row['robot']}` | {dof} | {row['success_percent']:.3f} % "
            f"| {row['mean_us']:.2f} µs | {row['median_us']:.2f} µs "
            f"| {row['p99_us']:.2f} µs | {row['ratio']:.2f} |"
        )
    return "\n".join([*rows, "", conditions(report)])


BLOCKS: dict[str, Callable[[], str]] = {
    "python example": lambda: code("python/examples/01_solve.py", "python"),
    "cpp example": lambda: code("cpp/examples/01_solve.cpp", "cpp"),
    "robots": robots,
    "paper results": paper_results,
    "default results": default_results,
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
