# SPDX-License-Identifier: BSD-3-Clause
"""Which pairs of links an SRDF says cannot collide, or may."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING

from iksel_cpp import UrdfError

if TYPE_CHECKING:
    from collections.abc import Sequence

Pair = tuple[str, str]


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


def _ends(element: ET.Element) -> frozenset[str]:
    return frozenset((element.get("link1", ""), element.get("link2", "")))
