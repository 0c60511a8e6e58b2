# SPDX-License-Identifier: BSD-3-Clause
"""Arms that are nobody's: drawn at random, so that no constant can be tuned on them.

A build says how the axes of an arm lie; lengths, limits and tools are random. The
numbers of an arm may be rounded as people round them in files, or be off by a little,
so that axes that should be parallel or meet are only nearly so.
"""

from __future__ import annotations

import re
import zlib
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

import iksel
from bench.arms import arm_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from bench.arms import Arm

RIGHT = np.pi / 2


@dataclass(frozen=True)
class Joint:
    """A joint about the z axis of its frame, or along it."""

    xyz: tuple[float, float, float]
    rpy: tuple[float, float, float]
    lower: float = -np.pi
    upper: float = np.pi
    kind: str = "revolute"


@dataclass(frozen=True)
class Sketch:
    """The numbers of an arm before they are written to a file."""

    joints: tuple[Joint, ...]
    tool_xyz: tuple[float, float, float]
    tool_rpy: tuple[float, float, float]

    def scaled(self, factor: float) -> Sketch:
        """The arm so many times as large."""

        def larger(joint: Joint) -> Joint:
            xyz = _three(factor * np.array(joint.xyz))
            if joint.kind != "prismatic":
                return replace(joint, xyz=xyz)
            lower, upper = float(factor * joint.lower), float(factor * joint.upper)
            return replace(joint, xyz=xyz, lower=lower, upper=upper)

        tool = _three(factor * np.array(self.tool_xyz))
        return Sketch(tuple(map(larger, self.joints)), tool, self.tool_rpy)

    def urdf(self, write: Callable[[float], str] = repr) -> str:
        """Its URDF; `write` says how a length or an angle of an origin is written."""

        def words(values: tuple[float, ...]) -> str:
            return " ".join(write(float(value)) for value in values)

        def element(i: int, joint: Joint) -> str:
            limit = (
                f'<limit lower="{joint.lower!r}" upper="{joint.upper!r}"'
                ' velocity="1" effort="1"/>'
                if joint.kind != "continuous"
                else '<limit velocity="1" effort="1"/>'
            )
            return (
                f'<joint name="j{i + 1}" type="{joint.kind}"><parent link="l{i}"/>'
                f'<child link="l{i + 1}"/><origin xyz="{words(joint.xyz)}" '
                f'rpy="{words(joint.rpy)}"/><axis xyz="0 0 1"/>{limit}</joint>'
            )

        n = len(self.joints)
        links = "".join(f'<link name="l{i}"/>' for i in range(n + 1))
        joints = "".join(element(i, joint) for i, joint in enumerate(self.joints))
        tip = (
            f'<link name="tip"/><joint name="tool" type="fixed"><parent link="l{n}"/>'
            f'<child link="tip"/><origin xyz="{words(self.tool_xyz)}" '
            f'rpy="{words(self.tool_rpy)}"/></joint>'
        )
        return f'<robot name="random">{links}{joints}{tip}</robot>'


def _length(random: np.random.Generator) -> float:
    return float(random.uniform(0.1, 0.5))


def _offset(random: np.random.Generator) -> float:
    sign = 1 if random.random() < 0.5 else -1
    return sign * float(random.uniform(0.02, 0.2))


def _turn(random: np.random.Generator) -> float:
    return RIGHT if random.random() < 0.5 else -RIGHT


def _angle(random: np.random.Generator) -> float:
    return float(random.uniform(0.3, np.pi - 0.3)) * (
        1 if random.random() < 0.5 else -1
    )


Frame = tuple[tuple[float, float, float], tuple[float, float, float]]


def _across(random: np.random.Generator, x: float = 0.0, z: float = 0.0) -> Frame:
    """The next axis at a right angle: meeting this one where x is 0."""
    return (x, 0.0, z), (_turn(random), 0.0, 0.0)


def _parallel(random: np.random.Generator, z: float = 0.0) -> Frame:
    return (_length(random), 0.0, z), (0.0, 0.0, float(random.uniform(-3, 3)))


def _spherical(random: np.random.Generator) -> list[Frame]:
    """Three axes that meet, the first of which the frame before has placed."""
    return [_across(random), _across(random)]


def _spherical_wrist(random: np.random.Generator) -> list[Frame]:
    base: Frame = ((0, 0, _length(random)), (0, 0, 0))
    kind = random.integers(4)
    if kind == 0:  # 2 and 3 are parallel
        arm = [_across(random, _offset(random)), _parallel(random, _offset(random))]
    elif kind == 1:  # 1 and 2 meet
        arm = [_across(random), ((_length(random), 0, 0), (_angle(random), 0, 0))]
    elif kind == 2:  # 2 and 3 meet
        arm = [((_length(random), 0.1, 0), (_angle(random), 0, 0)), _across(random)]
    else:  # 1 and 2 are parallel
        arm = [_parallel(random, _offset(random)), _across(random, _length(random))]
    last = _across(random, _offset(random), _length(random))
    return [base, *arm, last, *_spherical(random)]


def _offset_wrist(random: np.random.Generator) -> list[Frame]:
    base: Frame = ((0, 0, _length(random)), (0, 0, 0))
    arm = [_across(random, _offset(random)), _parallel(random, _offset(random))]
    elbow = _across(random, _offset(random), _length(random))
    first, second = _across(random, _offset(random)), _across(random)
    wrist = [first, second] if random.random() < 0.5 else [second, first]
    return [base, *arm, elbow, *wrist]


def _general(random: np.random.Generator) -> list[Frame]:
    def frame() -> Frame:
        x, y, z = random.uniform(-0.3, 0.3, 3)
        roll, pitch, yaw = random.uniform(-3, 3, 3)
        return (float(x), float(y), float(z)), (float(roll), float(pitch), float(yaw))

    return [frame() for _ in range(6)]


def _three_parallel(random: np.random.Generator) -> list[Frame]:
    base: Frame = ((0, 0, _length(random)), (0, 0, 0))
    arm = [
        _across(random, _offset(random) * (random.random() < 0.5)),
        _parallel(random, _offset(random)),
        _parallel(random, _offset(random)),
    ]
    return [base, *arm, _across(random, 0.0, _offset(random)), _across(random)]


def _middle_sphere(random: np.random.Generator) -> list[Frame]:
    """Axes 2, 3 and 4 meet, and 5 is parallel to 4."""
    base: Frame = ((0, 0, _length(random)), (0, 0, 0))
    shoulder = [_across(random, _length(random)), *_spherical(random)]
    return [base, *shoulder, _parallel(random), _across(random, _length(random))]


def _right_angles(random: np.random.Generator, count: int) -> list[Frame]:
    """Axes in steps of 90 degrees; most links are zero, or along an axis."""
    frames: list[Frame] = []
    for _ in range(count):
        xyz = [0.0, 0.0, 0.0]
        if random.random() < 0.6:
            xyz[random.integers(3)] = float(random.choice([0.1, 0.2, 0.3, 0.4]))
        roll, yaw = RIGHT * random.integers(-1, 2), RIGHT * random.integers(-1, 3)
        frames.append(((xyz[0], xyz[1], xyz[2]), (float(roll), 0.0, float(yaw))))
    return frames


def _seven(
    random: np.random.Generator, *, shoulder: bool, elbow: bool, wrist: bool
) -> list[Frame]:
    """Of an S-R-S arm, each of its three parts with an offset or without."""

    def x(*, has: bool) -> float:
        return _offset(random) if has else 0.0

    base: Frame = ((0, 0, _length(random)), (0, 0, 0))
    upper = _length(random)
    return [
        base,
        _across(random, x(has=shoulder)),
        _across(random),
        _across(random, x(has=elbow), upper),
        _across(random, x(has=elbow), 0.0),
        ((0, 0, _length(random)), (_turn(random), 0, 0)),
        _across(random, x(has=wrist)),
    ]


BUILDS: dict[str, Callable[[np.random.Generator], list[Frame]]] = {
    "spherical_wrist": _spherical_wrist,
    "offset_wrist": _offset_wrist,
    "three_parallel": _three_parallel,
    "general": _general,
    "middle_sphere": _middle_sphere,
    "right_angles_6": lambda random: _right_angles(random, 6),
    "srs": lambda r: _seven(r, shoulder=False, elbow=False, wrist=False),
    "elbow_offset": lambda r: _seven(r, shoulder=False, elbow=True, wrist=False),
    "wrist_offset": lambda r: _seven(r, shoulder=False, elbow=False, wrist=True),
    "shoulder_offset": lambda r: _seven(r, shoulder=True, elbow=False, wrist=False),
    "shoulder_elbow_offset": lambda r: _seven(
        r, shoulder=True, elbow=True, wrist=False
    ),
    "right_angles_7": lambda random: _right_angles(random, 7),
    "rail": _three_parallel,
}
"""How the axes lie; a rail is a slide before six joints."""

SIX = tuple(BUILDS)[:6]
SEVEN = tuple(BUILDS)[6:]


def _limits(random: np.random.Generator) -> tuple[str, float, float]:
    kind = random.random()
    if kind < 0.1:
        return "continuous", -np.inf, np.inf
    if kind < 0.2:  # wider than a turn
        return (
            "revolute",
            -float(random.uniform(3.2, 6.3)),
            float(random.uniform(3.2, 6.3)),
        )
    if kind < 0.35:  # on one side of zero only
        low = float(random.uniform(0.0, 0.5))
        high = low + float(random.uniform(0.3, 2.5))
        return (
            ("revolute", low, high)
            if random.random() < 0.5
            else ("revolute", -high, -low)
        )
    return "revolute", -float(random.uniform(0.3, 3.1)), float(random.uniform(0.3, 3.1))


def sketch(build: str, seed: int) -> Sketch:
    """The random arm of that build and seed.

    Raises:
        KeyError: No such build.
    """
    random = np.random.default_rng([zlib.crc32(build.encode()), seed])
    joints = []
    for xyz, rpy in BUILDS[build](random):
        kind, lower, upper = _limits(random)
        joints.append(Joint(xyz, rpy, lower, upper, kind))
    if build == "rail":
        joints[0] = replace(joints[0], rpy=(_turn(random), 0.0, 0.0))
        joints.insert(0, Joint((0, 0, 0), (0, RIGHT, 0), -1.0, 1.0, "prismatic"))
    has_tool = random.random() < 0.7
    tool = random.uniform(-0.2, 0.2, 3) * has_tool
    turn = random.uniform(-3, 3, 3) * has_tool
    return Sketch(tuple(joints), _three(tool), _three(turn))


def _three(values: np.ndarray) -> tuple[float, float, float]:
    return float(values[0]), float(values[1]), float(values[2])


def with_numbers(urdf: str, write: Callable[[float], str]) -> str:
    """A URDF's text with the numbers of all origins written anew."""

    def again(match: re.Match[str]) -> str:
        numbers = " ".join(write(float(word)) for word in match[2].split())
        return f'{match[1]}="{numbers}"'

    def origin(match: re.Match[str]) -> str:
        return re.sub(r'(xyz|rpy)\s*=\s*"([^"]*)"', again, match[0])

    return re.sub(r"<origin\b[^>]*>", origin, urdf)


def random_arm(build: str, seed: int, write: Callable[[float], str] = repr) -> Arm:
    """The random arm of that build and seed, as its numbers are written.

    Raises:
        KeyError: No such build.
    """
    urdf = sketch(build, seed).urdf(write)
    return arm_of(f"{build}-{seed}", iksel.Robot.from_urdf(urdf, "l0", "tip"))


def written_anew(name: str, write: Callable[[float], str]) -> Arm:
    """A built-in robot whose file has its origins written so."""
    robot = iksel.load_robot(name)
    urdf = with_numbers(robot.urdf, write)
    anew = iksel.Robot.from_urdf(urdf, robot.base_link, robot.tip_link, tcp=robot.tcp)
    return arm_of(name, anew)
