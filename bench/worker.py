# SPDX-License-Identifier: BSD-3-Clause
"""Measures the cells of one job: a process of its own, fed by bench.run.

A solver that crashes takes this process with it and nothing else, and no solver shares
a process with another's libraries.
"""

from __future__ import annotations

import json
import sys
import time
import warnings
from pathlib import Path


def main() -> None:
    """Read a job from standard input, measure what has no file yet."""
    job = json.load(sys.stdin)
    # Rivals warn about their own dependencies.
    warnings.simplefilter("ignore")

    from bench.cells import CELLS  # noqa: PLC0415 - after the filter
    from bench.store import Store  # noqa: PLC0415

    store = Store(Path(job["folder"]), job["fingerprint"], job["versions"])
    for settings in job["cells"]:
        if not store.has(settings):
            begin = time.monotonic()
            result = CELLS[settings["cell"]](settings)
            store.save(settings, result, seconds=time.monotonic() - begin)


if __name__ == "__main__":
    main()
