# SPDX-License-Identifier: BSD-3-Clause
"""Robots with several tips: built-in arms on a torso of a few joints."""

from __future__ import annotations

import re

import iksel


def prefixed(urdf: str, prefix: str) -> str:
    """The links and joints of a URDF, their names prefixed."""
    urdf = re.sub(r"<!--.*?-->", "", urdf, flags=re.DOTALL)
    inside = re.sub(r"^.*?<robot[^>]*>|</robot>.*$", "", urdf, flags=re.DOTALL)
    return re.sub(r'(name|link|joint)="', rf'\1="{prefix}', inside)


def two_arms_on_torso(arm: iksel.Robot) -> str:
    """Left and right, on a torso that lifts and turns."""
    text = '<robot name="torso"><link name="base"/><link name="lifted"/>'
    text += '<link name="chest"/>'
    for name, kind, parent, child, upper in (
        ("lift", "prismatic", "base", "lifted", 0.35),
        ("turn", "revolute", "lifted", "chest", 1.5),
    ):
        lower = 0.0 if kind == "prismatic" else -upper
        text += f"""<joint name="{name}" type="{kind}"><parent link="{parent}"/>
            <child link="{child}"/><origin xyz="0 0 0.3"/><axis xyz="0 0 1"/>
            <limit lower="{lower}" upper="{upper}" effort="1" velocity="1"/></joint>"""
    for side, y, roll in (("l_", 0.2, -0.8), ("r_", -0.2, 0.8)):
        text += prefixed(arm.urdf, side)
        text += f"""<joint name="{side}mount" type="fixed"><parent link="chest"/>
            <child link="{side}{arm.link_names[0]}"/>
            <origin xyz="0 {y} 0.2" rpy="{roll} 0 0"/></joint>"""
    return text + "</robot>"


def two_armed(arm: iksel.Robot) -> iksel.Robot:
    """The robot, its tips those of the arms."""
    tips = ["l_" + arm.tip_link, "r_" + arm.tip_link]
    return iksel.Robot.from_urdf(two_arms_on_torso(arm), tip_links=tips)
