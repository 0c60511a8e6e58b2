# SPDX-License-Identifier: BSD-3-Clause
"""URDFs drawn at random, and what people and exporters do to such files.

A fault leaves the kinematics as they are. It takes the random numbers and the text, and
gives the text of the file or, where it is one of encoding, its bytes.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from iksel.pose import pose_from_euler, quaternion_from_pose

if TYPE_CHECKING:
    from collections.abc import Callable

    Fault = Callable[[np.random.Generator, str], str | bytes]

BASE, TIP = "base", "tool"
_BOX = '<geometry><box size="0.02 0.03 0.25"/></geometry>'
_SOLID = f"\n  <visual>{_BOX}</visual>\n  <collision>{_BOX}</collision>\n"


def numbers(rng: np.random.Generator, scale: float = 1.0) -> str:
    return " ".join(repr(float(x)) for x in rng.normal(0, scale, 3))


def joint(name: str, kind: str, ends: tuple[str, str], place: str, inside: str) -> str:
    return f"""<joint name="{name}" type="{kind}">
  <parent link="{ends[0]}"/>
  <child link="{ends[1]}"/>
  <origin {place}/>
  <axis xyz="0 {"1 0" if name[-1] in "135" else "0 1"}"/>
  {inside}
</joint>
"""


def plain(rng: np.random.Generator) -> str:
    """An arm of three to seven joints with a camera and a finger, a tag a line."""
    dof = int(rng.integers(3, 8))
    links = [BASE, *(f"l{i}" for i in range(1, dof)), TIP]
    text = '<?xml version="1.0"?>\n<robot name="odd">\n'
    for name in (*links, "camera", "finger"):
        text += f'<link name="{name}">{_SOLID}</link>\n'
    for i in range(dof):
        kind = rng.choice(["revolute", "revolute", "revolute", "prismatic"])
        low, high = rng.uniform(-2, -0.5), rng.uniform(0.5, 2)
        limit = f'<limit lower="{low}" upper="{high}" effort="5" velocity="2"/>'
        place = f'xyz="{numbers(rng, 0.3)}" rpy="{numbers(rng)}"'
        text += joint(f"j{i}", kind, (links[i], links[i + 1]), place, limit)
    place = f'xyz="{numbers(rng, 0.1)}" rpy="{numbers(rng)}"'
    text += joint("mount", "fixed", (TIP, "camera"), place, "")
    limit = '<limit lower="0" upper="0.04" effort="5" velocity="2"/>'
    text += joint("grip", "prismatic", (TIP, "finger"), place, limit)
    return text + "</robot>\n"


def put_into_joints(rng: np.random.Generator, text: str, what: list[str]) -> str:
    """One of `what` at the end of about half of the joints, of one at least."""
    ends = [m.start() for m in re.finditer("</joint>", text)]
    chosen = {rng.choice(ends), *(e for e in ends if rng.random() < 0.5)}
    for end in sorted(chosen, reverse=True):
        text = f"{text[:end]}{rng.choice(what)}\n{text[end:]}"
    return text


def change(
    rng: np.random.Generator, text: str, pattern: str, made: Callable[[re.Match], str]
) -> str:
    """What `made` gives for about half of the matches, for one at least."""
    found = list(re.finditer(pattern, text))
    chosen = {int(rng.integers(len(found)))}
    chosen |= {i for i in range(len(found)) if rng.random() < 0.5}
    for i in sorted(chosen, reverse=True):
        text = text[: found[i].start()] + made(found[i]) + text[found[i].end() :]
    return text


def behind_root(rng: np.random.Generator, text: str, what: str) -> str:
    """Something at the top level of the robot, first or last."""
    if rng.random() < 0.5:
        return text.replace("</robot>", f"{what}\n</robot>")
    return re.sub("(<robot[^>]*>)", lambda m: f"{m[0]}\n{what}", text)


def version(rng: np.random.Generator, text: str) -> str:
    kept = rng.choice(["1.0", "1.1", "1.2", "2.3", "7", "beta"])
    text = text.replace("<robot", f'<robot version="{kept}"')
    if rng.random() < 0.5:
        text = text.replace("<limit", '<limit acceleration="9" jerk="inf"')
    capsule = '<capsule radius="0.02" length="0.2"/>'
    return text.replace(_BOX, f"<geometry>{capsule}</geometry>")


def quaternion(rng: np.random.Generator, text: str, *, known: bool = True) -> str:
    def turned(match: re.Match) -> str:
        rpy = [float(number) for number in match[1].split()]
        w, x, y, z = quaternion_from_pose(pose_from_euler([0, 0, 0], rpy))
        scale = rng.choice([1, -1, 2])
        return 'quat_xyzw="{!r} {!r} {!r} {!r}"'.format(
            *(float(v * scale) for v in (x, y, z, w))
        )

    kept = rng.choice(["1.1", "1.2"] if known else ["1.0", "1", "0.9", "x"])
    if known or rng.random() < 0.7:
        text = text.replace("<robot", f'<robot version="{kept}"')
    return change(rng, text, 'rpy="([^"]*)"', turned)


def infinite(rng: np.random.Generator, text: str) -> str:
    big = ["inf", "+inf", "Infinity", "INF", "1e16", "1e308"]
    # Off the chain: the finger's.
    lower, upper, velocity = rng.choice(["-inf", "-1e9"]), *rng.choice(big, 2)
    text = text.replace(
        'lower="0" upper="0.04" effort="5" velocity="2"',
        f'lower="{lower}" upper="{upper}" effort="5" velocity="{velocity}"',
    )
    return change(rng, text, 'effort="5"', lambda _: f'effort="{rng.choice(big)}"')


def materials(rng: np.random.Generator, text: str) -> str:
    colour = '<color rgba="1 0 0 1"/>'
    for _ in range(int(rng.integers(2, 4))):
        inside = rng.choice([colour, "", '<color rgba="1 1"/>', "<texture/>"])
        text = behind_root(rng, text, f'<material name="grey">{inside}</material>')
    return text


def needless(rng: np.random.Generator, text: str) -> str:
    """What urdfdom insists on, and kinematics do not need."""
    dynamics = ["<dynamics/>", '<dynamics damping="1,5"/>', '<dynamics damping="nan"/>']
    safety = ["<safety_controller/>", '<safety_controller k_position="100"/>']
    calibration = ['<calibration rising="?"/>', '<calibration falling=""/>']
    text = put_into_joints(rng, text, dynamics + calibration)
    text = put_into_joints(rng, text, safety)
    text = change(
        rng, text, ' effort="[^"]*"', lambda _: rng.choice(["", " effort=''"])
    )
    bad = ["<inertial/>", '<inertial><mass value="much"/></inertial>', "<gazebo/>"]
    return change(rng, text, r'<link name="camera">', lambda m: m[0] + rng.choice(bad))


def strays(rng: np.random.Generator, text: str) -> str:
    """Links that nothing joins to the arm."""
    for i in range(int(rng.integers(1, 4))):
        name = f"stray{i}"
        extra = f'<link name="{name}">{_SOLID}</link>'
        if rng.random() < 0.5:
            extra += f'<link name="on {name}"/>'
            extra += joint(f"of {name}", "fixed", (name, f"on {name}"), "", "")
        text = behind_root(rng, text, extra)
    return text


def blanks(rng: np.random.Generator, text: str) -> str:
    def spread(match: re.Match) -> str:
        between = ["\t", "\n", "  ", " \t ", "\r\n", "&#9;", "&#10;", " "]
        gap = [str(rng.choice(between)) for _ in range(4)]
        a, b, c = match[2].split()
        around = (str(rng.choice(["", " ", "\n", "\t"])) for _ in range(2))
        return f'{match[1]}="{next(around)}{a}{gap[0]}{b}{gap[1]}{c}{next(around)}"'

    return change(rng, text, r'(xyz|rpy)="(\S+ \S+ \S+)"', spread)


def doctype(rng: np.random.Generator, text: str) -> str:
    bombs = "".join(
        f'<!ENTITY a{i + 1} "&a{i};&a{i};&a{i};&a{i};&a{i};&a{i};">\n'
        for i in range(20)
    )
    kinds = [
        "<!DOCTYPE robot>",
        '<!DOCTYPE robot SYSTEM "urdf.dtd">',
        '<!DOCTYPE robot PUBLIC "-//x//y" "http://localhost/none.dtd">',
        '<!DOCTYPE robot [<!ENTITY pi "3.14">]>',
        "<!DOCTYPE robot [\n<!ELEMENT robot (link|joint)*> <!-- it's > ] -->\n]>",
        f'<!DOCTYPE robot [<!ENTITY a0 "ha">{bombs}]>',
        '<!DOCTYPE robot [<!ENTITY file SYSTEM "file:///etc/passwd">]>',
    ]
    text = text.replace("?>\n", f"?>\n{rng.choice(kinds)}\n", 1)
    return behind_root(rng, text, rng.choice(["", "&a19;", "<gazebo x='&file;'/>"]))


def encoding(rng: np.random.Generator, text: str) -> bytes:
    text = text.replace('name="odd"', 'name="oddø"')
    codec = str(rng.choice(["utf-16", "utf-16-le", "utf-16-be", "utf-32", "utf-8-sig"]))
    if rng.random() < 0.2:
        codec = "latin-1"
    declared = rng.choice([f'"1.0" encoding="{codec}"', '"1.0"', '"1.0" encoding="x"'])
    return text.replace('"1.0"', str(declared), 1).encode(codec, "replace")


def prefixes(rng: np.random.Generator, text: str) -> str:
    text = change(rng, text, "<limit", lambda m: f'{m[0]} drake:acceleration="1"')
    odd = [
        '<drake:joint name="j0"><drake:x/></drake:joint>',
        '<a:b xmlns:a="http://a.org" c:d="1"/><a:e/>',
        '<x xmlns:gazebo="http://g.org" gazebo:y="" xml:space="preserve"/>',
        '<x a:y="1" b:y="2" xmlns:a="u:u" xmlns:b="u:u"/>',
        '<x xmlns:p="" xmlns:xmlns="http://www.w3.org/2000/xmlns/"/>',
    ]
    return behind_root(rng, text, str(rng.choice(odd)))


def early_comment(rng: np.random.Generator, text: str) -> str:
    early = [
        "<!-- by a tool -->",
        "\n",
        "warning: deprecated\n",
        "\ufeff",
        "<?tool?>\n",
    ]
    return f"{rng.choice(early)}{rng.choice(early)}{text}"


def dashes(rng: np.random.Generator, text: str) -> str:
    inside = [
        "a -- b",
        "---- joints ----",
        "<link name='base'/> --",
        "-",
        "a--&b",
        " > ",
    ]
    for _ in range(3):
        text = behind_root(rng, text, f"<!--{rng.choice(inside)} -->")
    return text


def ampersands(rng: np.random.Generator, text: str) -> str:
    raw = ["R&D", "a && b", "&", "& co;", "&nbsp;", "&#0;", "&#xD800;", "&amp", "a < b"]
    noise = str(rng.choice(raw))
    text = text.replace("</robot>", f"{noise}\n</robot>")
    value = noise.replace("<", "&lt;")
    return behind_root(rng, text, f'<author name="{value}">{rng.choice(raw)}</author>')


def default_namespace(rng: np.random.Generator, text: str) -> str:
    name = rng.choice(["http://www.ros.org", "urdf", "http://drake.mit.edu", ""])
    return text.replace("<robot", f'<robot xmlns="{name}"')


FAULTS: dict[str, Fault] = {
    "version": version,
    "quaternion": quaternion,
    "infinite": infinite,
    "materials": materials,
    "needless": needless,
    "strays": strays,
    "blanks": blanks,
    "doctype": doctype,
    "encoding": encoding,
    "prefixes": prefixes,
    "early comment": early_comment,
    "dashes": dashes,
    "ampersands": ampersands,
    "default namespace": default_namespace,
}
