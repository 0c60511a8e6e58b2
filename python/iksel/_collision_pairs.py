# SPDX-License-Identifier: BSD-3-Clause
"""Which pairs of links cannot collide, or always do: from an SRDF and from samples."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from iksel_cpp import UrdfError

from iksel._collision_shapes import place

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from iksel._arm_links import ArmLinks
    from iksel._arrays import FloatArray
    from iksel._collision_shapes import Shapes

Pair = tuple[str, str]

# A pair that never came nearer than this in any sample [m] never collides: what the
# samples miss between them is less than that.
_CLEARANCE = 0.02


class Sampled(NamedTuple):
    """What samples say of pairs of links."""

    always: set[Pair]  # touch in all samples
    close: set[Pair]  # touch in some, and are within the margin in all
    never: set[Pair]


def srdf_pairs(root: ET.Element, links: Sequence[str]) -> dict[frozenset[str], str]:
    """The pairs that an SRDF disables, with its reasons.

    Raises:
        UrdfError: No SRDF, or one of another robot: it disables pairs and none of them
            is of these links.
    """
    if root.tag != "robot":
        raise UrdfError(f"srdf: expected <robot>, got <{root.tag}>")
    found, known = {}, set(links)
    for element in root.findall("disable_default_collisions"):
        link = element.get("link", "")
        reason = element.get("reason", "disabled by default")
        found.update({frozenset((link, other)): reason for other in links})
    for element in root.findall("disable_collisions"):
        found[_ends(element)] = element.get("reason", "disabled")
    for element in root.findall("enable_collisions"):
        found.pop(_ends(element), None)
    if found and not any(pair <= known for pair in found):
        named = sorted(set().union(*found))
        raise UrdfError(
            f"srdf: of another robot; it disables collisions of {', '.join(named)}; "
            f"the URDF has: {', '.join(links)}"
        )
    return found


def srdf_text(name: str, ignored: dict[Pair, str]) -> str:
    """An SRDF that disables the pairs."""
    root = ET.Element("robot", name=name)
    for (a, b), reason in ignored.items():
        ET.SubElement(root, "disable_collisions", link1=a, link2=b, reason=reason)
    ET.indent(root)
    return ET.tostring(root, "unicode") + "\n"


class PairSampler:
    """Looks at pairs of links in sampled configurations."""

    def __init__(self, shapes: Shapes, links: ArmLinks, q: FloatArray) -> None:
        self._shapes = shapes
        self._chunks = list(place(shapes, links, q))

    def look(self, pairs: Iterable[Pair], margin: float, *, never: bool) -> Sampled:
        """Find the pairs that always touch and, if asked for, those that never do."""
        pairs = list(pairs)
        close = {pair for pair in pairs if self._always(pair, margin)}
        always = {pair for pair in close if not margin or self._always(pair, 0.0)}
        rest = [pair for pair in pairs if pair not in close] if never else []
        apart = {pair for pair in rest if not self._ever(pair, margin + _CLEARANCE)}
        return Sampled(always, close - always, apart)

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


def _ends(element: ET.Element) -> frozenset[str]:
    return frozenset((element.get("link1", ""), element.get("link2", "")))
