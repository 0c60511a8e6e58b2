# SPDX-License-Identifier: BSD-3-Clause
"""Small URDFs, put together from parts that a test may change."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

LIMIT = '<limit lower="-1" upper="2" velocity="3" effort="0"/>'


def link(*names: str) -> str:
    return "".join(f'<link name="{name}"/>' for name in names)


def joint(
    name: str,
    parent: str,
    child: str,
    *,
    kind: str = "revolute",
    xyz: str = "0 0 0.5",
    rpy: str = "0 0 0",
    axis: str = "0 0 1",
    inside: str = LIMIT,
) -> str:
    return f"""
      <joint name="{name}" type="{kind}">
        <parent link="{parent}"/><child link="{child}"/>
        <origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>{inside}
      </joint>"""


def robot(*parts: str) -> str:
    return f'<?xml version="1.0"?><robot name="test">{"".join(parts)}</robot>'


def arm(middle: str = "", **changes: str) -> str:
    """Three links in a row; `changes` apply to the joint between the last two."""
    return robot(
        link("base", "elbow", "hand"),
        joint("first", "base", "elbow", axis="0 1 0"),
        joint("second", "elbow", "hand", **changes),
        middle,
    )


def limits(lower: object, upper: object) -> str:
    return f'<limit lower="{lower}" upper="{upper}" velocity="1" effort="1"/>'


def mimic(
    source: str = "first",
    extra: str = 'multiplier="-2" offset="0.1"',
    limit: str = LIMIT,
) -> str:
    return f'{limit}<mimic joint="{source}" {extra}/>'


def random_tree(rng: np.random.Generator, links: int, solid: str = "") -> str:
    """Links on random joints, many of which follow others, up to all in a row."""
    text = '<link name="n0"/>'
    movers: list[str] = []
    for i in range(1, links):
        kind = rng.choice(["revolute", "prismatic", "continuous", "fixed"])
        xyz, rpy, axis = rng.normal(size=(3, 3))
        mimic = ""
        if movers and kind != "fixed" and rng.random() < 0.6:
            factor, offset = rng.uniform(-1.5, 1.5, 2)
            mimic = (
                f'<mimic joint="{rng.choice(movers)}" multiplier="{factor}" '
                f'offset="{offset}"/>'
            )
        if kind != "fixed":
            movers.append(f"m{i}")
        text += f"""<link name="n{i}">{solid}</link><joint name="m{i}" type="{kind}">
          <parent link="n{rng.integers(max(0, i - 3), i)}"/><child link="n{i}"/>
          <origin xyz="{" ".join(map(str, xyz))}" rpy="{" ".join(map(str, rpy))}"/>
          <axis xyz="{" ".join(map(str, axis))}"/>{mimic}
          <limit lower="-9" upper="9" effort="1" velocity="1"/></joint>"""
    return f'<robot name="tree">{text}</robot>'
