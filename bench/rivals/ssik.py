# SPDX-License-Identifier: BSD-3-Clause
"""ssik: branches of arms of six and seven joints, by the artifact that it builds."""

from __future__ import annotations

import contextlib
import functools
import hashlib
import importlib
import importlib.util
import io
import os
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from bench.rivals.base import UnsupportedError
from bench.rivals.enumerator import Enumerator, Request
from bench.settings import WORK

if TYPE_CHECKING:
    from pathlib import Path
    from types import ModuleType

    from bench.arms import Arm
    from bench.chain import Array

MADE = "made_ik.py"
SLOW = "jointlock.seven_r"
"""Its name of the class of redundant arms without a shape that it knows."""
TRIED_MINUTES = 25
"""How long `ssik build` was given for an arm of that class, by hand, and was not done:
it writes derivations, and then C++ wants the like of it once more."""
FOLDER = WORK / "ssik"
"""Where artifacts are kept: some take minutes to build."""


class Ssik(Enumerator):
    """What `ssik build` makes of the chain's URDF, which calls C++.

    Its README (8.2.0) has this as what to deploy, faster than the class Manipulator.
    """

    name = "ssik"
    distribution = "ssik"
    settings = (
        "artifact by `ssik build` of the same URDF with the tensors for C++ that its "
        "prebuilt arms have, limits respected, FK closure 1e-5 (its default, the only "
        "one that C++ has); one: max_solutions 1; all: one whole turn a branch; "
        "nearest: wrap_l2; building is not timed"
    )

    rescue: ClassVar[bool] = True
    """Its allow_rescue: search around poses without an answer that are in reach."""

    def ways(self, arm: Arm) -> dict[str, Request]:
        """All three; the posture is its q_seed."""
        solve = functools.partial(_artifact(arm).solve, allow_rescue=self.rescue)

        def both(pose: Array, near: Array) -> tuple[Any, ...]:
            return np.ascontiguousarray(pose), np.ascontiguousarray(near)

        def nearest(pose: Array, near: Array) -> Any:
            return solve(pose, max_solutions=1, q_seed=near, seed_metric="wrap_l2")

        one = functools.partial(solve, max_solutions=1)
        every = functools.partial(solve, enumerate_windings=False)
        return {
            "one": Request(_pose_alone, one, _values),
            "every": Request(_pose_alone, every, _values),
            "nearest": Request(both, nearest, _values),
        }

    def so_many(self, arm: Arm, number: int) -> Request:
        """Its max_solutions, one whole turn a branch."""
        words = {"max_solutions": number, "enumerate_windings": False}
        solve = functools.partial(
            _artifact(arm).solve, allow_rescue=self.rescue, **words
        )
        return Request(_pose_alone, solve, _values)


class SsikWithoutRescue(Ssik):
    """The same as its README has it for an answer by algebra alone."""

    name = "ssik, no rescue"
    settings = "the same with allow_rescue=False: a no is said without its search"
    rescue = False


def _pose_alone(pose: Array, near: Array) -> tuple[Any, ...]:
    del near
    return (np.ascontiguousarray(pose),)


def _values(returned: Any) -> list[Array]:
    return [np.asarray(solution.q) for solution in returned]


def build(arm: Arm) -> None:
    """Make what an arm needs, if it is none that ssik refuses and it is not there."""
    with contextlib.suppress(UnsupportedError):
        _made(arm)


def _artifact(arm: Arm) -> ModuleType:
    """The module that is built for an arm."""
    return _module(_made(arm) / MADE)


def _made(arm: Arm) -> Path:
    """Where it is, built once for its URDF and the version."""
    if arm.chain.dof not in {6, 7}:
        raise UnsupportedError(f"6 or 7 joints only; {arm.name} has {arm.chain.dof}")
    key = hashlib.sha256(f"{Ssik.version()} {arm.urdf}".encode()).hexdigest()[:12]
    folder = FOLDER / f"{arm.name}_{key}"
    if not folder.exists():
        _check_class(arm)
        part = folder.with_name(f"{folder.name}.{os.getpid()}.part")
        _build(arm, part)
        part.rename(folder)
    return folder


def _check_class(arm: Arm) -> None:
    """Refuse the class whose tensors for C++ take it more than half an hour.

    Its README: "7-20 min for non-SRS 7R". Without them a call takes 0.1 s and more.
    """
    ssik = importlib.import_module("ssik")
    urdf = _written(arm, FOLDER / "classified" / arm.name)
    ends = {"base": arm.base_link, "ee": arm.tip_link}
    if ssik.Manipulator.from_urdf(urdf, **ends).solver_name == SLOW:
        raise UnsupportedError(
            f"solved by {SLOW}, whose build takes too long: one was ended after "
            f"{TRIED_MINUTES} minutes"
        )


def _written(arm: Arm, folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    urdf = folder / "chain.urdf"
    urdf.write_text(arm.urdf, encoding="utf-8")
    return urdf


def _module(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"ssik_{path.parent.stem}", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _build(arm: Arm, folder: Path) -> None:
    """Have the artifact written, and beside it what C++ needs of general arms.

    The prebuilt arms have such files; `ssik build` (8.2.0) writes none, and without
    them an artifact runs its Python.
    """
    os.environ.setdefault("SSIK_DERIVATION_CACHE", str(FOLDER / "derivations"))
    cli = importlib.import_module("ssik.cli")
    native = importlib.import_module("ssik._native")
    urdf = _written(arm, folder)
    words = ["build", str(urdf), "--base", arm.base_link, "--ee", arm.tip_link]
    words += ["--out", str(folder / MADE), "--no-validate"]
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        status = cli.main(words)
    if status or not (folder / MADE).exists():
        last = said.getvalue().strip().splitlines()[-1:] or ["no reason given"]
        raise UnsupportedError(f"ssik build: {last[0]}")
    made = _module(folder / MADE)
    beside = MADE.removesuffix("_ik.py")
    if made.SOLVER_NAME == "ikgeo.general_6r":
        native.bake_rr_tensor_npz(made._KB, str(folder / f"{beside}_rr.npz"))  # noqa: SLF001
