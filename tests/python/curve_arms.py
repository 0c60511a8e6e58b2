# SPDX-License-Identifier: BSD-3-Clause
"""An arm whose shoulder a cylinder lifts and whose elbow a four-bar linkage bends."""

import numpy as np
from linkage_arms import joint, urdf

import iksel

CYLINDER = (0.42, 0.72)
"""Shortest and longest [m]."""
CRANK = (-0.9, 0.9)
"""Ends of the crank's turn [rad]."""


def shoulder(length: float) -> tuple[float, float]:
    """Angle [rad] of a hinge by the length [m] of a cylinder beside it, and its slope.

    The cylinder goes from a point 0.5 m from the hinge to one 0.3 m from it: the law of
    cosines.
    """
    a, b = 0.5, 0.3
    angle = np.arccos((a * a + b * b - length * length) / (2 * a * b))
    return angle - 1.4, length / (a * b * np.sin(angle))


def elbow(crank: float) -> tuple[float, float]:
    """Angle [rad] of a four-bar linkage's rocker by its crank's, and its slope.

    Ground 0.4 m, crank 0.15 m, coupler 0.38 m, rocker 0.2 m; the crank at 0 stands at
    90 degrees to the ground. The circles around the crank's end and the rocker's hinge
    meet where the coupler joins them.
    """
    g, a, b, c = 0.4, 0.15, 0.38, 0.2
    phi = crank + np.pi / 2
    x, y = g - a * np.cos(phi), -a * np.sin(phi)  # hinge as seen from the crank's end
    d2 = x * x + y * y
    cos_inner = (c * c + d2 - b * b) / (2 * c * np.sqrt(d2))
    # The joint is on the one side of the line from the hinge back to the crank's end.
    psi = np.arctan2(-y, -x) - np.arccos(cos_inner)
    psi = np.mod(psi, 2 * np.pi)
    # The coupler keeps its length: what moves both its ends along it is the same.
    end = np.array([a * np.cos(phi), a * np.sin(phi)])
    top = np.array([g + c * np.cos(psi), c * np.sin(psi)])
    along = top - end
    by_crank = along @ [-a * np.sin(phi), a * np.cos(phi)]
    by_rocker = along @ [-c * np.sin(psi), c * np.cos(psi)]
    return psi - 2.0, by_crank / by_rocker


def description(*, followers: bool = True) -> str:
    """The arm; without followers its shoulder and elbow are joints like others."""
    text = urdf(
        "linkage_arm",
        [
            joint(1, "0 0 0.5", "0 0 1", -2.9, 2.9),
            joint(2, "0.1 0 0.1", "0 1 0", -3.1, 3.1),
            joint(3, "0 0 0.8", "0 1 0", -3.1, 3.1),
            joint(4, "0.3 0 0.05", "1 0 0", -3.1, 3.1),
            joint(5, "0.5 0 0", "0 1 0", -2.0, 2.0),
            joint(6, "0.1 0 0.02", "1 0 0", -3.1, 3.1),
        ],
        tip="0.1 0 0",
    )
    if not followers:
        return text
    drives = """<link name="rod"/><link name="arm_of_crank"/>
  <joint name="cylinder" type="prismatic">
    <parent link="link_1"/><child link="rod"/><axis xyz="0 0 1"/>
    <limit lower="0.3" upper="0.75" effort="1" velocity="0.2"/>
  </joint>
  <joint name="crank" type="continuous">
    <parent link="link_2"/><child link="arm_of_crank"/><axis xyz="0 1 0"/>
  </joint>
</robot>"""
    return text.replace("</robot>", drives)


def curve(name: str) -> iksel.MimicCurve:
    """That of the shoulder, `joint_2`, or of the elbow, `joint_3`."""
    function, follows, ends = {
        "joint_2": (shoulder, "cylinder", CYLINDER),
        "joint_3": (elbow, "crank", CRANK),
    }[name]
    return iksel.MimicCurve.sampled(
        name, follows, *ends, lambda q: function(q)[0], lambda q: function(q)[1]
    )


def load(**options: object) -> iksel.Robot:
    """The arm by its cylinder and its crank."""
    curves = [curve("joint_2"), curve("joint_3")]
    return iksel.load_robot(
        description(), tip_link="flange", mimic_curves=curves, **options
    )


def joints_of(q: np.ndarray) -> np.ndarray:
    """Values of the arm's own six joints."""
    joints = np.array(q)
    joints[1], joints[2] = shoulder(q[1])[0], elbow(q[2])[0]
    return joints
