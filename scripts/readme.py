# SPDX-License-Identifier: BSD-3-Clause
"""Fills the marked blocks of README.md: examples, the robots, measured results.

A block stands between `<!-- NAME -->` and `<!-- end NAME -->`. Nothing between the two
marks is written by hand. With --check, nothing is changed and a stale block is an
error.

Measured results are rendered only of a report that is of the sources that are here, as
RESULTS.md is. Where sources have changed since, those that README has are left as they
are, until the report is made again: then --check says so and goes on.
"""

import argparse
import re
import sys
from collections.abc import Callable
from pathlib import Path

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).resolve().parents[1]
BENCH = ROOT / "bench"
sys.path.insert(0, str(ROOT))

from bench import provenance  # noqa: E402 - from the checkout
from bench.report import load_report  # noqa: E402
from bench.sections import readme as section  # noqa: E402
from bench.view import View  # noqa: E402


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


BLOCKS: dict[str, Callable[[], str]] = {
    "python example": lambda: code("python/examples/01_solve.py", "python"),
    "cpp example": lambda: code("cpp/examples/01_solve.cpp", "cpp"),
    "robots": robots,
}
"""What sources give."""
FIGURES: dict[str, Callable[[View], str]] = {
    "results": section.results,
    "no": section.noes,
}
"""What the report gives."""


def put(text: str, name: str, content: str) -> str:
    """The text with a block made anew."""
    pattern = re.compile(f"(<!-- {name} -->\n).*?(<!-- end {name} -->)", re.DOTALL)
    if not pattern.search(text):
        sys.exit(f"README.md has no block '{name}'")
    return pattern.sub(lambda m: f"{m[1]}{content}\n{m[2]}", text)


def fill(text: str, *, check: bool) -> tuple[str, str]:
    """The text with every block made anew that can be; why figures cannot.

    Args:
        text: README.md.
        check: A report that never can be published ends the program.
    """
    for name, make in BLOCKS.items():
        text = put(text, name, make())
    report = load_report(BENCH)
    if check and (unfit := provenance.reasons(report, provenance.unfit)):
        sys.exit(f"README.md: its figures are of no report: {'; '.join(unfit)}")
    if reasons := provenance.reasons(report, provenance.doubts):
        return text, "; ".join(reasons)
    view = View(report)
    for name, show in FIGURES.items():
        text = put(text, name, show(view))
    return text, ""


def main(arguments: list[str] | None = None) -> None:
    """Entry point."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true")
    check = parser.parse_args(arguments).check
    readme = ROOT / "README.md"
    text = readme.read_text(encoding="utf-8")
    filled, why_not = fill(text, check=check)
    if filled != text:
        if check:
            sys.exit("README.md: stale block; run `python scripts/readme.py`")
        readme.write_text(filled, encoding="utf-8")
    if why_not:
        left = f"README.md: figures left as they are: {why_not}\n"
        sys.stderr.write(left)
        if not check:
            sys.exit(1)


if __name__ == "__main__":
    main()
