# SPDX-License-Identifier: BSD-3-Clause
"""Fails where a folder of cpp/src includes one that stands above it.

Usage: check_layers.py [FOLDER]    (default: cpp/src)

The same for KDL and urdfdom, which only the folders that translate them may name.
"""

import re
import sys
from collections.abc import Iterator
from pathlib import Path

# Each may include itself and those before it.
LAYERS = [
    "base",
    "options",
    "urdf",
    "kinematics",
    "simd",
    "scene",
    "structure",
    "goal",
    "database",
    "refine",
    "seeds",
    "search",
    "solver",
    "evaluation",
]
# Headers of KDL and urdfdom, and who may include them.
FOREIGN = re.compile(r"(kdl|urdf_\w+|urdfdom\w*)/")
TRANSLATORS = {"urdf", "kinematics"}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def findings(root: Path) -> Iterator[str]:
    """What is wrong with the sources below root, a line each."""
    for path in sorted(root.rglob("*.[ch]pp")):
        name = path.relative_to(root).as_posix()
        folder = name.split("/")[0]
        if folder not in LAYERS:
            yield f"{name}: '{folder}' is no folder of {', '.join(LAYERS)}"
            continue
        for bracket, header in INCLUDE.findall(path.read_text(encoding="utf-8")):
            other = header.split("/")[0]
            if FOREIGN.match(header):
                if folder not in TRANSLATORS:
                    yield f"{name}: {header} may be named in urdf and kinematics only"
            elif bracket == "<" or other == "iksel":
                continue
            elif other not in LAYERS:
                yield f"{name}: {header} is in no folder of {', '.join(LAYERS)}"
            elif LAYERS.index(other) > LAYERS.index(folder):
                yield f"{name}: {folder} stands below {other}, and includes {header}"


def main() -> int:
    """Print what is wrong; exit status 1 if something is."""
    root = Path(__file__).resolve().parents[1] / "cpp" / "src"
    if len(sys.argv) > 1:
        root = Path(sys.argv[1])
    lines = list(findings(root))
    print(*lines, sep="\n", end="\n" if lines else "")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
