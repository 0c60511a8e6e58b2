# SPDX-License-Identifier: BSD-3-Clause
"""Which pairs of links never collide, or always: by proof and in samples."""

from __future__ import annotations

import contextlib
import json
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from iksel._base.files import read_text, write_file
from iksel.collision._proof import PairProver
from iksel.collision._shapes import place

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from iksel_cpp import Robot

    from iksel._base.arrays import FloatArray
    from iksel.collision._arm_links import ArmLinks
    from iksel.collision._pairs import Pair
    from iksel.collision._shapes import Shapes

METHOD = "pairs 1"
"""To be changed with how verdicts are found."""
VERDICTS = ("apart", "always", "close", "never")
"""Proven to stay farther apart than the margin; touching in all samples; within the
margin in all, and touching in some; farther apart in all."""

# A pair that never came nearer than this in any sample [m] never collides: what the
# samples miss between them is less than that.
_CLEARANCE = 0.02


class PairSearch(NamedTuple):
    """How pairs of links are looked at."""

    margin: float
    """Links that are nearer than this collide [m]."""
    samples: int
    """Configurations; 0: none, and proofs alone."""
    seed: int
    """Of these."""
    never: bool
    """Whether samples say which pairs never collide."""

    def run(
        self,
        shapes: Shapes,
        links: ArmLinks,
        robot: Robot,
        pairs: Sequence[Pair],
        progress: Callable[[int, int], Any] | None,
    ) -> dict[Pair, str]:
        """Look at pairs.

        Args:
            shapes: Of all links.
            links: Where they are.
            robot: Whose joints move them.
            pairs: Of links.
            progress: Called with the number of looks done and in all, two at a pair.

        Returns:
            For those about which there is something to say, one of VERDICTS.
        """
        found: dict[Pair, str] = {}
        report = progress or (lambda _done, _total: None)
        total = 2 * len(pairs)
        proofs = PairProver(shapes, links, robot).look(pairs, self.margin)
        for done, (pair, apart) in enumerate(proofs, start=1):
            if apart:
                found[pair] = "apart"
            report(done, total)
        left = [pair for pair in pairs if pair not in found] if self.samples else []
        report(total - len(left), total)
        if not left:
            return found
        q = robot.random_configurations(self.samples, seed=self.seed)
        sampler = PairSampler(shapes, links, q)
        for done, pair in enumerate(left, start=total - len(left) + 1):
            verdict = sampler.look(pair, self.margin, never=self.never)
            if verdict is not None:
                found[pair] = verdict
            report(done, total)
        return found


class PairSampler:
    """Looks at pairs of links in sampled configurations."""

    def __init__(self, shapes: Shapes, links: ArmLinks, q: FloatArray) -> None:
        self._shapes = shapes
        self._chunks = list(place(shapes, links, q))

    def look(self, pair: Pair, margin: float, *, never: bool) -> str | None:
        """What samples say of a pair of links.

        Args:
            pair: Of links.
            margin: Links that are nearer than this collide [m].
            never: Whether it is asked for pairs that never do.

        Returns:
            "always" if they touch in all samples, "close" if they are within the margin
            in all, "never" if in none, else None.
        """
        if self._always(pair, 0.0):
            return "always"
        if margin and self._always(pair, margin):
            return "close"
        return "never" if never and not self._ever(pair, margin + _CLEARANCE) else None

    def _always(self, pair: Pair, margin: float) -> bool:
        """Whether the links are within margin in all samples."""
        parts = self._shapes.parts(pair)
        return all(
            any(
                self._shapes.touch(placed, n, parts[k], margin)
                for k in np.flatnonzero(row)
            )
            for placed in self._chunks
            for n, row in enumerate(placed.near(np.array(parts), margin))
        )

    def _ever(self, pair: Pair, margin: float) -> bool:
        """Whether the links' hulls are within margin in any sample."""
        parts = self._shapes.parts(pair)
        return any(
            self._shapes.touch(placed, n, parts[k], margin, hulls=True)
            for placed in self._chunks
            for n, k in np.argwhere(placed.near(np.array(parts), margin))
        )


def load_verdicts(path: Path, pairs: Sequence[Pair]) -> dict[Pair, str] | None:
    """What save_verdicts() wrote of these pairs; None: not there, or damaged."""
    with contextlib.suppress(OSError, ValueError, TypeError, KeyError, RecursionError):
        data = json.loads(read_text(path))
        found = {(str(a), str(b)): str(verdict) for a, b, verdict in data["pairs"]}
        if found.keys() <= set(pairs) and set(found.values()) <= set(VERDICTS):
            return found
    return None


def save_verdicts(path: Path, found: dict[Pair, str]) -> None:
    """Write verdicts to a file, whose folder is made if there is none.

    Raises:
        InvalidArgumentError: It cannot be written.
    """
    with contextlib.suppress(OSError):  # which writing will tell
        path.parent.mkdir(parents=True, exist_ok=True)
    rows = [[*pair, verdict] for pair, verdict in found.items()]
    write_file(path, json.dumps({"pairs": rows}).encode())
