# SPDX-License-Identifier: BSD-3-Clause
"""Packages that only parts of iksel need, and what to do where they are missing."""

from __future__ import annotations

import importlib
from typing import Any

from iksel_cpp import Error


class MissingExtraError(Error, ImportError):
    """A package of an extra, such as iksel[reach] or iksel[view], is not installed."""


def need(module: str, *, user: str, how: str) -> Any:
    """A module of an extra.

    Args:
        module: Its name.
        user: The part of iksel that needs it, for the message.
        how: What installs it, likewise.

    Raises:
        MissingExtraError: It cannot be imported.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.partition(".")[0]
        raise MissingExtraError(
            f"{user} needs {package}, which cannot be imported ({error}): {how}"
        ) from error
