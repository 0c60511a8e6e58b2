# SPDX-License-Identifier: BSD-3-Clause
"""Arms whose joints share limits: a parallel linkage, or a cable through the wrist."""

import numpy as np

import iksel

FULL_TURN = 2 * np.pi


def joint(
    number: int, xyz: str, axis: str, lower: float, upper: float, *, mimics: str = ""
) -> str:
    """Joint `number`, from link n-1 to link n."""
    return f"""
  <joint name="joint_{number}" type="revolute">
    <parent link="link_{number - 1}"/><child link="link_{number}"/>
    <origin xyz="{xyz}"/><axis xyz="{axis}"/>
    <limit lower="{lower}" upper="{upper}" effort="1" velocity="3"/>{mimics}
  </joint>"""


def urdf(name: str, joints: list[str], tip: str = "0 0 0.08") -> str:
    """A chain of these joints, and a fixed flange behind."""
    links = "".join(f'<link name="link_{i}"/>' for i in range(len(joints) + 1))
    last = len(joints)
    return f"""<robot name="{name}">{links}<link name="flange"/>{"".join(joints)}
  <joint name="flange_joint" type="fixed">
    <parent link="link_{last}"/><child link="flange"/><origin xyz="{tip}"/>
  </joint>
</robot>"""


def palletiser() -> str:
    """Four joints; a parallel linkage keeps the hand upright (a mimic joint each)."""
    level = '<mimic joint="joint_{}" multiplier="-1"/>'.format
    return urdf(
        "palletiser",
        [
            joint(1, "0 0 0.5", "0 0 1", -2.9, 2.9),
            joint(2, "0.2 0 0.3", "0 1 0", -0.8, 1.5),
            # Joint 3 is where the motor is: the elbow turns by joint 3 less joint 2.
            joint(3, "0 0 0.9", "0 1 0", -9, 9, mimics=level(2)),
            joint(4, "0 0 0", "0 1 0", -0.4, 2.0),
            joint(5, "0.9 0 0", "0 1 0", -9, 9, mimics=level(4)),
            joint(6, "0.1 0 0", "0 0 1", -5.0, 5.0),
        ],
        tip="0 0 -0.2",
    )


def fanuc_like(elbow: tuple[float, float] = (-2.4, 3.6)) -> str:
    """Six joints of an LR Mate's size, with a spherical wrist.

    Args:
        elbow: Limits of joint 3; beyond a whole turn it has several images.
    """
    return urdf(
        "fanuc_like",
        [
            joint(1, "0 0 0.33", "0 0 1", -2.96, 2.96),
            joint(2, "0.05 0 0", "0 1 0", -1.74, 2.53),
            joint(3, "0 0 0.33", "0 -1 0", *elbow),
            joint(4, "0.09 0 0.035", "-1 0 0", -3.31, 3.31),
            joint(5, "0.245 0 0", "0 -1 0", -2.18, 2.18),
            joint(6, "0 0 0", "-1 0 0", -6.3, 6.3),
        ],
        tip="0.08 0 0",
    )


ELBOW = iksel.CoupledLimit({"joint_2": 1, "joint_3": 1}, lower=-1.2, upper=2.0)
WRIST = iksel.CoupledLimit({"joint_4": 1, "joint_6": 1}, lower=-5.0, upper=5.0)


def searched() -> str:
    """Six joints whose axes lie anyhow: no closed form."""
    return urdf(
        "searched",
        [
            joint(1, "0 0 0.3", "0 0 1", -2.8, 2.8),
            joint(2, "0.1 0.05 0.1", "0.1 1 0.05", -1.8, 1.8),
            joint(3, "0.05 0 0.4", "0.1 1 0.2", -2.4, 2.4),
            joint(4, "0.3 0.05 0", "1 0.1 0.2", -2.8, 2.8),
            joint(5, "0.2 0 0.05", "0.1 1 0.3", -2.0, 2.0),
            joint(6, "0.1 0.02 0", "1 0.2 0.1", -2.9, 2.9),
        ],
        tip="0.1 0 0",
    )


def sums(robot: iksel.Robot, q: np.ndarray) -> np.ndarray:
    """The sums that the robot's coupled limits bound, one per row of q and limit."""
    q = np.atleast_2d(q)
    columns = [
        sum(
            coefficient * q[:, robot.joint_names.index(name)]
            for name, coefficient in limit.coefficients.items()
        )
        for limit in robot.coupled_limits
    ]
    return np.stack(columns, axis=1)


def is_inside(robot: iksel.Robot, q: np.ndarray, slack: float = 0.0) -> np.ndarray:
    """Whether each row of q lies inside all limits: counted here, not by IKSel."""
    q = np.atleast_2d(q)
    lower = [limit.lower for limit in robot.coupled_limits]
    upper = [limit.upper for limit in robot.coupled_limits]
    of_joints = (q >= robot.lower - slack) & (q <= robot.upper + slack)
    of_sums = sums(robot, q)
    coupled = (of_sums >= np.array(lower) - slack) & (
        of_sums <= np.array(upper) + slack
    )
    return of_joints.all(axis=1) & coupled.all(axis=1)
