# SPDX-License-Identifier: BSD-3-Clause
"""Runs `iksel evaluate` over many robots and keeps the results as a file.

The tables of README.md are made of these files by scripts/readme.py.
"""

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import iksel


def cpu_name() -> str:
    """The processor as the system calls it."""
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        return platform.processor()
    for line in text.splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def evaluate(
    robot: str, preset: str, targets: int, seed: int, flags: list[str]
) -> dict[str, Any]:
    """One run of the command line, in a process of its own."""
    command = [sys.executable, "-m", "iksel", "evaluate", robot, "--preset", preset]
    command += ["--targets", str(targets), "--seed", str(seed), "--json", "--stages"]
    done = subprocess.run(command + flags, check=True, capture_output=True, text=True)
    result: dict[str, Any] = json.loads(done.stdout)
    return result


def main() -> None:
    """Entry point."""
    parser = argparse.ArgumentParser(
        description=__doc__.splitlines()[0] if __doc__ else None,
        epilog="Other options are passed on to `iksel evaluate`.",
    )
    parser.add_argument("robots", nargs="*", help="default: all with at least 6 joints")
    parser.add_argument("--preset", default="paper", choices=["paper", "default"])
    parser.add_argument("--targets", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-o", "--output", type=Path, required=True)
    args, flags = parser.parse_known_args()

    robots = args.robots or [
        name for name in iksel.robot_names() if iksel.robot_info(name).dof >= 6
    ]
    rows = []
    for robot in robots:
        row = evaluate(robot, args.preset, args.targets, args.seed, flags)
        print(
            f"{robot:26} {row['success_percent']:7.2f} %  "
            f"{row['mean_us']:8.2f} us  ratio {row['ratio']:6.2f}",
            flush=True,
        )
        rows.append(row)
    report = {
        "command": " ".join(["python", "bench/evaluate.py", *sys.argv[1:]]),
        "version": iksel.__version__,
        "cpu": cpu_name(),
        "cores": os.cpu_count(),
        "rows": rows,
    }
    args.output.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile(
        "w", dir=args.output.parent, suffix=".json", delete=False, encoding="utf-8"
    ) as file:
        json.dump(report, file, indent=1)
        file.write("\n")
    Path(file.name).chmod(0o644)
    Path(file.name).replace(args.output)


if __name__ == "__main__":
    main()
