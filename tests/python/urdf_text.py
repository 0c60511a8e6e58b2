# SPDX-License-Identifier: BSD-3-Clause
"""Small URDFs, put together from parts that a test may change."""

from __future__ import annotations

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


def mimic(source: str = "first", extra: str = 'multiplier="-2" offset="0.1"') -> str:
    return f'{LIMIT}<mimic joint="{source}" {extra}/>'
