# SPDX-License-Identifier: BSD-3-Clause
"""Where the package example-robot-data, from PyPI, has its robots."""

from __future__ import annotations

import os
import sysconfig
from pathlib import Path

PACKAGE = "example-robot-data"
VARIABLE = "EXAMPLE_ROBOT_DATA"
"""Names its folder `robots`, where that is another."""


def robots_folder() -> Path:
    """Its folder `robots`, whether that is there or not."""
    given = os.environ.get(VARIABLE)
    inside = Path("cmeel.prefix", "share", PACKAGE, "robots")
    return Path(given) if given else Path(sysconfig.get_path("purelib")) / inside
