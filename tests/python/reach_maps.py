# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of reachability maps share."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from iksel import reach

pytest.importorskip("zarr", minversion="3", reason="pip install iksel[reach]")


def computed(path: Path, robot, **settings) -> Path:
    """A map that has been planned and computed by one worker."""
    reach.create(reach.plan(robot, **settings), path)
    reach.run(path, workers=1)
    return path


def random_cells(shape: tuple[int, ...], n: int, seed: int) -> np.ndarray:
    """Indices of n cells, (n, axes)."""
    rng = np.random.default_rng(seed)
    return np.stack([rng.integers(0, size, n) for size in shape], axis=-1)
