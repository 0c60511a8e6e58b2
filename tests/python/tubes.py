# SPDX-License-Identifier: BSD-3-Clause
"""An arm of simple shapes: six joints, seven tubes."""

from __future__ import annotations


def link(name: str, length: float) -> str:
    if not length:
        return f'<link name="{name}"/>'
    return f"""<link name="{name}"><collision>
      <origin xyz="0 0 {length / 2}"/>
      <geometry><cylinder radius="0.04" length="{length}"/></geometry>
    </collision></link>"""


def joint(name: str, parent: str, child: str, z: float, axis: str) -> str:
    return f"""<joint name="{name}" type="revolute">
      <parent link="{parent}"/><child link="{child}"/>
      <origin xyz="0 0 {z}"/><axis xyz="{axis}"/>
      <limit lower="-2.9" upper="2.9" effort="1" velocity="1"/></joint>"""


TUBE = '<cylinder radius="0.04" length="0.4"/>'
LENGTHS = [0.15, 0.1, 0.4, 0.35, 0.1, 0.1, 0.05]
AXES = ["0 0 1", "0 1 0", "0 1 0", "0 0 1", "0 1 0", "0 0 1"]
NAMES = [f"l{i}" for i in range(7)]
URDF = (
    '<robot name="tubes">'
    + "".join(link(n, z) for n, z in zip(NAMES, LENGTHS, strict=True))
    + "".join(
        joint(f"j{i}", NAMES[i], NAMES[i + 1], LENGTHS[i], AXES[i]) for i in range(6)
    )
    + "</robot>"
)
