# SPDX-License-Identifier: BSD-3-Clause
"""Reachability maps."""

from __future__ import annotations

from iksel.reach._plan import Plan, plan
from iksel.reach._run import Progress, merge, run, status
from iksel.reach._store import create

__all__ = ["Plan", "Progress", "create", "merge", "plan", "run", "status"]
