# SPDX-License-Identifier: BSD-3-Clause
"""Packages that only parts of iksel need, and what to do where they are missing."""

from __future__ import annotations

import importlib
from typing import Any

from iksel_cpp import Error


class MissingExtraError(Error, ImportError):
    """A package of an extra, such as iksel[reach] or iksel[view], is not installed."""


def need(module: str, *, user: str, extra: str) -> Any:
    """A module that `user` needs, from a package that an extra installs.

    Args:
        module: The module, such as "matplotlib".
        user: The part of iksel that needs it, for the message.
        extra: What to give pip, and with what, likewise.

    Raises:
        MissingExtraError: It cannot be imported.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.partition(".")[0]
        raise MissingExtraError(
            f"{user} needs {package}, which cannot be imported ({error}): "
            f"pip install {extra}"
        ) from error
