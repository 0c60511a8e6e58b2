# SPDX-License-Identifier: BSD-3-Clause
"""Models of MuJoCo."""

from __future__ import annotations

from typing import Any

from iksel.formats import _mjcf
from iksel.formats._models import Model


def read(value: Any) -> Model:
    """The bodies and joints of an MjModel, an MjSpec, or the MjModel of an MjData."""
    if type(value).__name__ == "MjSpec":
        return Model(*_mjcf.read_spec(value))
    return Model(*_mjcf.read_model(getattr(value, "model", value)))
