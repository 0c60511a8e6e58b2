# SPDX-License-Identifier: BSD-3-Clause
"""What reachability maps cost, and that every engine writes the same ones.

python -m bench.reach PART ... prints figures; the parts:

  cost      what a cell costs, by robot
  fine      a map of ur5e, 1 cm x 100,000 orientations, reduced by symmetry
  time      a map of ur5e, 5 cm x 1,000 orientations, by one process per core: time,
            memory, and what it takes beside solve_batch alone
  speedup   the same by one process and by two
  engines   by processes, a Dask LocalCluster and shares: the same bytes
  killed    workers and the scheduler killed on the way: the same bytes
  full      a disk that is full: an error, and the map still opens
  cells     10,000 random cells against poses solved one by one; with symmetry against
            the same cells turned at random
  place     where a base may stand to reach 30 poses in a shelf
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from bench.reach.cells import show_cells
from bench.reach.cost import show_cost, show_fine, show_speedup, show_time
from bench.reach.engines import show_engines, show_full, show_killed
from bench.reach.place import show_place

PARTS = {
    "cost": show_cost,
    "fine": show_fine,
    "time": show_time,
    "speedup": show_speedup,
    "engines": show_engines,
    "killed": show_killed,
    "full": show_full,
    "cells": show_cells,
}


def main() -> None:
    """Print the figures of the parts that the command line names."""
    parser = argparse.ArgumentParser(
        prog="python -m bench.reach",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("parts", nargs="+", choices=[*PARTS, "place"], metavar="PART")
    parser.add_argument(
        "--folder", type=Path, help="where maps are written (default: a temporary one)"
    )
    parser.add_argument("--picture", type=Path, help="of the part place, to write")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(dir=arguments.folder) as name:
        for part in arguments.parts:
            folder = Path(name) / part
            folder.mkdir()
            print(f"-- {part}", flush=True)
            if part == "place":
                show_place(folder, arguments.picture)
            else:
                PARTS[part](folder)


if __name__ == "__main__":
    main()
