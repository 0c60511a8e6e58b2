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


OURS = "IKSel"
SEED = 1
"""Of the rivals' targets: `SEED` of bench/size.py."""
ANALYTIC = ("EAIK", "IK-Geo")
LOOPS = ("pink", "mink")
"""Of the solvers that `python -m bench analytic` asks those that do not enumerate."""
UNREACHED = "any_rotation"
"""The targets of which many have no answer."""
NONE = "\N{EN DASH}"

Result = dict[str, Any]


def load_report() -> dict[str, Any]:
    """What `python -m bench report` kept."""
    path = ROOT / "bench" / "results" / "report.json"
    report: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return report


def by_solver(report: dict[str, Any], cell: str, kind: str) -> dict[str, Result]:
    """The results of a kind of cell on one kind of targets, by robot and solver."""
    found: dict[str, dict[str, Result]] = {}
    for entry in report["cells"]:
        settings, result = entry["settings"], entry["result"]
        of_kind = settings["cell"] == cell and settings.get("kind") == kind
        # Rows at another SIMD level stand beside those of the report only.
        if of_kind and "simd" not in settings:
            by_name = found.setdefault(settings["robot"], {})
            if "unsupported" not in result:
                by_name[settings.get("rival", OURS)] = result
    return found


def machine(report: dict[str, Any], section: str) -> str:
    """What a section was measured on, and by which command."""
    part = report.get("parts", {}).get(section, report)
    facts = part["machine"]
    load = f", load average {facts['load']:g}" if "load" in facts else ""
    return (
        f"SIMD level {facts['simd']}, {facts['cpu']} ({facts['cores']} cores{load}). "
        f"Made by `{part['command']}`."
    )


def results() -> str:
    """The default preset beside its rivals."""
    report = load_report()
    cells = by_solver(report, "rival", "uniform")
    noes = by_solver(report, "no", UNREACHED)
    asked = by_solver(report, "asked", "uniform")
    header = "| robot | success | mean | p99 | next fastest numerical solver | analytic"
    rows = [f"{header} | no |", "|---|---|---|---|---|---|---|"]
    rows += [
        f"| `{robot}` | {beside(found)} | {enumerating(found, asked.get(robot))} "
        f"| {a_no(noes.get(robot, {}))} |"
        for robot, found in cells.items()
    ]
    count = next(iter(cells.values()))[OURS]["count"]
    conditions = (
        f"{count:,} targets per robot (fewer for the slower solvers), uniform in the "
        f"joint limits, seed {SEED}; one pose at a time from Python (KDL's and "
        "SLSQP's from C++); every answer checked to 1e-5 m, 1e-5 rad and the limits; "
        f"failures included in the times; {machine(report, 'rivals')} *analytic*: the "
        "fastest solver that enumerates, for one answer or, where it says so, all "
        "branches. *no*: mean time to say that a pose has no answer, then the fastest "
        "numerical solver's, which is the cut-off that it was given, and an analytic "
        "one's; measured as [below](#when-there-is-no-answer)."
    )
    plot = "![Share of targets solved over time](bench/plots/success_over_time.svg)"
    return "\n".join([plot, "", *rows, "", conditions])


def beside(found: dict[str, Result]) -> str:
    """One robot's row."""
    ours = found[OURS]
    name, mean = fastest(found)
    return (
        f"{100.0 * ours['right'] / ours['count']:.3f} % | {ours['mean_us']:.2f} µs "
        f"| {ours['p99_us']:.2f} µs "
        f"| {name} {mean:.0f} µs, {mean / ours['mean_us']:.0f} times"
    )


def enumerating(found: dict[str, Result], asked: dict[str, Result] | None) -> str:
    """The fastest of the solvers that `python -m bench analytic` asks.

    Without its results what the section on rivals has of such solvers.

    Args:
        found: The robot's results of cells "rival".
        asked: Those of cells "asked"; None: not measured.
    """
    if asked is None:
        known = [
            f"{name} {found[name]['mean_us']:.1f} µs (all)"
            for name in ANALYTIC
            if found.get(name, {}).get("right")
        ]
        return ", ".join(known) or "not measured"
    rows = {}
    for name, result in asked.items():
        figures = result.get("one") or result.get("every")
        if name.startswith(OURS) or name in LOOPS or not figures or not figures["us"]:
            continue
        if figures["missed"] < figures["count"]:
            rows[name] = figures
    if not rows:
        return "none of those asked"
    name = min(rows, key=lambda solver: float(rows[solver]["us"][0]))
    missed, count = rows[name]["missed"], rows[name]["count"]
    notes = [] if asked[name].get("one") else ["all"]
    notes += [f"misses {missed:,} of {count:,}"] if missed else []
    return f"{name} {microseconds(rows[name]['us'][0])} µs" + (
        f" ({', '.join(notes)})" if notes else ""
    )


def fastest(found: dict[str, Result]) -> tuple[str, float]:
    """The numerical rival with the least mean, of those that solve any."""
    means = {
        name: float(result["mean_us"])
        for name, result in found.items()
        if not name.startswith(OURS) and name not in ANALYTIC and result["right"]
    }
    name = min(means, key=lambda solver: means[solver])
    return name, means[name]


def mean_no(result: Result | None) -> float | None:
    """Mean time of a no [us]; None of none."""
    times = None if result is None else result["no_us"]
    return None if times is None else float(times[0])


def microseconds(value: float | None) -> str:
    """A time with as many digits as mean something."""
    if value is None:
        return NONE
    return f"{value:,.{2 if value < 10 else 1 if value < 100 else 0}f}"


def rival_noes(found: dict[str, Result]) -> tuple[str, str]:
    """The mean no of the analytic solver, and the least of the numerical ones'."""
    analytic = mean_no(found.get(ANALYTIC[0]))
    numerical = {
        name: mean
        for name, result in found.items()
        if not name.startswith(OURS) and name not in ANALYTIC
        if (mean := mean_no(result)) is not None
    }
    if not numerical:
        return microseconds(analytic), NONE
    name = min(numerical, key=lambda solver: numerical[solver])
    return microseconds(analytic), f"{name} {microseconds(numerical[name])}"


def a_no(found: dict[str, Result]) -> str:
    """A no in one cell of a table."""
    ours = mean_no(found.get(OURS))
    if ours is None:
        return "not measured"
    analytic, numerical = rival_noes(found)
    parts = [f"{microseconds(ours)} µs"]
    if numerical != NONE:
        parts.append(f"{numerical} µs")
    if analytic != NONE:
        parts.append(f"{ANALYTIC[0]} {analytic} µs")
    return "; ".join(parts)


def noes() -> str:
    """What poses without an answer cost on each robot."""
    report = load_report()
    found = by_solver(report, "no", UNREACHED)
    every = by_solver(report, "all_branches", UNREACHED)
    near = by_solver(report, "near_branches", UNREACHED)
    if not found:
        return "Not measured: `python -m bench report --only no`."
    header = (
        "| robot | structure | solved | no: proven | by sweep | searched | yes | no"
        " | no, proven"
    )
    theirs = f"| {ANALYTIC[0]}'s no | fastest numerical no"
    rows = [
        f"{header} {theirs} | `solve_all` | `near` | KDL |",
        "|---|---|" + "---:|" * 12,
    ]
    for robot, solvers in found.items():
        ours = solvers.get(OURS)
        if ours is None:
            continue
        counts = (ours[what] for what in ("yes", "proven", "swept", "searched"))
        times = (two_times(ours.get(what)) for what in ("yes_us", "no_us", "proven_us"))
        rest = (
            microseconds(cells.get(robot, {}).get(OURS, {}).get("mean_us"))
            for cells in (every, near)
        )
        columns = [
            ours["structure"].replace("_", " "),
            *(f"{count:,}" for count in counts),
            *times,
            *rival_noes(solvers),
            *rest,
            microseconds(ours["unit_us"]),
        ]
        rows.append(f"| `{robot}` | " + " | ".join(columns) + " |")
    return "\n".join([*rows, "", no_conditions(report, found)])


def two_times(times: list[float] | None) -> str:
    """Mean and median."""
    if times is None:
        return NONE
    return ", ".join(map(microseconds, times))


def no_conditions(report: dict[str, Any], found: dict[str, dict[str, Result]]) -> str:
    """How the noes were measured."""
    size = report["size"]
    reachable = [
        solvers[OURS]
        for solvers in by_solver(report, "no", "uniform").values()
        if OURS in solvers
    ]
    solved, count = (sum(one[what] for one in reachable) for what in ("yes", "count"))
    every = [one for solvers in found.values() for one in solvers.values()]
    proven = sum(one.get("proven", 0) for one in every)
    disproved = sum(one["disproved"] for one in every)
    return (
        f"{size['no']:,} targets per robot ({size['no_slow']:,} for numerical "
        f"rivals), seed {size['no_seed']}, *no, proven*: with `prove=True`, by which "
        "the proofs are counted, too; tolerances of 1e-6 m and 1e-6 rad, one "
        "thread, from Python (KDL's own solvers from C++), of each call the least time "
        "of three where that does not take long; `solve_all` and `near` over all "
        "targets, or over a tenth of them where there is no closed form; a numerical "
        f"rival's no is the cut-off that it was given; {machine(report, 'no')} "
        f"Of {count:,} targets that can be reached, uniform in the limits of these "
        f"{len(reachable)} robots, seed {size['no_seed']}, {solved:,} were solved; "
        f"of the {proven:,} proofs in the table another solver's answer refutes "
        f"{disproved}." + random_arms(report)
    )


def random_arms(report: dict[str, Any]) -> str:
    """The same on arms that no constant was chosen by, in a sentence."""
    cells = [
        entry["result"]
        for entry in report["cells"]
        if entry["settings"]["cell"] == "random_arms"
    ]
    if not cells:
        return ""
    total = {
        what: sum(cell[what] for cell in cells)
        for what in (
            *("arms", "targets", "lost", "false", "noes", "proven", "swept"),
            *("tried", "refuted", "moves", "longer"),
        )
    }
    return (
        f" On {total['arms']:,} arms drawn at random, of {len(cells)} builds, seeds "
        f"from {report['size']['random_seed']:,}, which no constant was chosen by: of "
        f"{total['targets']:,} targets that can be reached {total['lost']:,} were not "
        f"solved, and {total['false']:,} answers were false; of {total['noes']:,} noes "
        f"{total['proven']:,} were proven, {total['swept']:,} swept, and of "
        f"{total['tried']:,} tried {total['refuted']:,} proofs were refuted; of "
        f"{total['moves']:,} moves with `near` {total['longer']:,} were longer than "
        "brute force's. `python -m bench random` prints these build by build."
    )


BLOCKS: dict[str, Callable[[], str]] = {
    "python example": lambda: code("python/examples/01_solve.py", "python"),
    "cpp example": lambda: code("cpp/examples/01_solve.cpp", "cpp"),
    "robots": robots,
    "results": results,
    "no": noes,
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
