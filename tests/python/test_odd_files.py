# SPDX-License-Identifier: BSD-3-Clause
"""Files with faults load as if they had none, or are refused with a remedy."""

from __future__ import annotations

import importlib.util
import os
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import odd_files
import pytest
from iksel_cpp import mend_xml
from odd_files import BASE, FAULTS, TIP, plain

import iksel
from iksel.collision import SelfCollision
from iksel.view.visuals import read_pieces

SEED = int(os.environ.get("IKSEL_TEST_SEED", "1"))
FILES = 20
FOUND = Path(__file__).parents[3] / "shared" / "found"
EACH = pytest.mark.parametrize(
    "rng",
    [(SEED, i) for i in range(FILES)],
    indirect=True,
    ids=lambda drawn: f"seed{drawn[0]}-file{drawn[1]}",
)


@pytest.fixture
def rng(request: pytest.FixtureRequest) -> np.random.Generator:
    """Random numbers of a file, whose seed is in the test's name."""
    return np.random.default_rng(request.param)


def written(folder: Path, made: str | bytes, name: str = "odd.urdf") -> Path:
    path = folder / name
    path.write_bytes(made if isinstance(made, bytes) else made.encode())
    return path


def load(source: Path | str, **changes: object) -> iksel.Robot:
    return iksel.load_robot(source, base_link=BASE, tip_link=TIP, **changes)


def assert_same(made: iksel.Robot, expected: iksel.Robot) -> None:
    assert made.joint_names == expected.joint_names
    np.testing.assert_array_equal(made.lower, expected.lower)
    np.testing.assert_array_equal(made.upper, expected.upper)
    np.testing.assert_array_equal(made.velocity_limit, expected.velocity_limit)
    for q in expected.random_configurations(3, seed=SEED):
        np.testing.assert_allclose(made.fk(q), expected.fk(q), rtol=0, atol=1e-14)
        np.testing.assert_allclose(
            made.link_poses(q), expected.link_poses(q), rtol=0, atol=1e-14
        )


def assert_read_by_all(path: Path, made: iksel.Robot) -> None:
    """What draws links, joins robots and looks for collisions reads the file too."""
    assert ET.fromstring(made.urdf).tag == "robot"
    assert iksel.LinkTree.from_urdf(path, BASE).links == made.link_names
    if importlib.util.find_spec("trimesh"):
        pieces, lost = read_pieces(path, None, None)
        assert {piece.link for piece in pieces} >= set(made.link_names)
        assert not lost
    two = iksel.attach(made.urdf, made.urdf, at=TIP, prefixes=("a_", "b_"))
    chain = {"base_link": f"a_{BASE}", "tip_link": f"b_{TIP}"}
    assert iksel.Robot.from_urdf(two, **chain).dof == 2 * made.dof


def assert_collides_alike(path: Path, plain_path: Path, robot: iksel.Robot) -> None:
    pytest.importorskip("coal")
    q = robot.random_configurations(20, seed=SEED)
    made, expected = (SelfCollision(p, robot, samples=0)(q) for p in (path, plain_path))
    np.testing.assert_array_equal(made, expected)


@EACH
@pytest.mark.parametrize("kind", FAULTS)
def test_faults_change_nothing(
    rng: np.random.Generator, kind: str, tmp_path: Path
) -> None:
    text = plain(rng)
    good = written(tmp_path, text, "plain.urdf")
    odd = written(tmp_path, FAULTS[kind](rng, text))
    made = load(odd)
    assert_same(made, load(good))
    assert_same(iksel.Robot.from_urdf(made.urdf, BASE, TIP), made)
    assert_read_by_all(odd, made)
    if rng.random() < 0.1 and kind != "version":  # which changes the bodies
        assert_collides_alike(odd, good, made)


@EACH
def test_many_faults_change_nothing(rng: np.random.Generator, tmp_path: Path) -> None:
    others = [kind for kind in FAULTS if kind not in {"version", "encoding"}]
    text = plain(rng)
    kinds = set(rng.permutation(others)[:5])
    odd: str | bytes = text
    for kind in filter(kinds.__contains__, FAULTS):
        odd = FAULTS[kind](rng, str(odd))
    if rng.random() < 0.5:
        odd = FAULTS["encoding"](rng, str(odd))
    path = written(tmp_path, odd)
    made = load(path)
    assert_same(made, load(text))
    assert_read_by_all(path, made)


def test_whatever_is_mended_every_reader_takes() -> None:
    """Also where it is no robot any more."""
    rng = np.random.default_rng(SEED)
    marks = rb"< > & ' / = : ! [ -- xmlns:a= <? ]]> <![CDATA[ &#38;".split()
    marks += [b'"', b"\x00", b"\xff", b"\xef\xbf\xbf"]
    taken = 0
    for _ in range(600):
        made = FAULTS[str(rng.choice(list(FAULTS)))](rng, plain(rng))
        data = bytearray(made if isinstance(made, bytes) else made.encode())
        for _ in range(int(rng.integers(1, 3))):
            at = int(rng.integers(len(data)))
            data[at : at + int(rng.integers(0, 3))] = marks[rng.integers(len(marks))]
        try:
            text = mend_xml(bytes(data))
        except iksel.UrdfError:
            continue
        taken += 1
        ET.fromstring(text)
        assert mend_xml(text.encode()) == text
    assert taken > 100


@EACH
@pytest.mark.parametrize("limit", ["", "0 0", "inf", "1e9", "1e16"])
def test_followers_need_no_limits(rng: np.random.Generator, limit: str) -> None:
    text = plain(rng)
    source, follower = re.findall('joint name="(j[0-9])"', text)[:2]
    ends = {"": "", "0 0": 'lower="0" upper="0"'}.get(
        limit, f'lower="-{limit}" upper="{limit}"'
    )
    mimic = f'<mimic joint="{source}" multiplier="{rng.uniform(-2, 2)}"/>'

    def follows(ends: str, text: str = text, at: str = follower) -> str:
        limit = f'<limit {ends} effort="1" velocity="0"/>{mimic}'
        pattern = f'(name="{at}".*?)<limit[^>]*>'
        return re.sub(pattern, lambda m: m[1] + limit, text, flags=re.DOTALL)

    wide = follows('lower="-1e4" upper="1e4"')
    assert_same(load(follows(ends)), load(wide))


@EACH
@pytest.mark.parametrize("limit", ["inf", "1e9", "1e16"])
def test_limits_without_end_are_none(rng: np.random.Generator, limit: str) -> None:
    text = plain(rng)
    kinds = dict(re.findall('joint name="(j[0-9])" type="(.*?)"', text))
    name = str(rng.choice(list(kinds)))
    pattern = f'(name="{name}".*?)lower="[^"]*" upper="[^"]*"'
    endless = re.sub(
        pattern, rf'\1lower="-{limit}" upper="{limit}"', text, flags=re.DOTALL
    )
    at = list(kinds).index(name)
    if kinds[name] == "revolute":
        made = load(endless)
        assert made.joint_types[at] == iksel.JointType.continuous
        free = text.replace(f'"{name}" type="revolute"', f'"{name}" type="continuous"')
        assert_same(made, load(free))
        return
    with pytest.raises(iksel.UrdfError, match=f"'{name}' has no limits.*default_lim"):
        load(endless)
    made = load(endless, default_limits=(-0.3, 0.4))
    assert (made.lower[at], made.upper[at]) == (-0.3, 0.4)
    one = re.sub(pattern, rf'\1lower="-{limit}" upper="0.5"', text, flags=re.DOTALL)
    with pytest.raises(iksel.UrdfError, match=f"'{name}' has no lower limit"):
        load(one)
    made = load(one, default_limits=(-0.3, 0.4))
    assert (made.lower[at], made.upper[at]) == (-0.3, 0.5)


@EACH
def test_orientations_that_would_be_left_out_are_refused(
    rng: np.random.Generator,
) -> None:
    odd = odd_files.quaternion(rng, plain(rng), known=False)
    with pytest.raises(iksel.UrdfError, match=r'quat_xyzw.*<robot version="1.1">'):
        load(odd)
    known = re.sub('(<robot)( version="[^"]*")?', r'\1 version="1.1"', odd)
    both = known.replace("quat_xyzw", 'rpy="1 0 0" quat_xyzw')
    with pytest.raises(iksel.UrdfError, match="both rpy and quat_xyzw: take one"):
        load(both)
    none = re.sub('quat_xyzw="[^"]*"', 'quat_xyzw="0 0 0 0"', known)
    with pytest.raises(iksel.UrdfError, match="expected four numbers"):
        load(none)
    drawn = plain(rng).replace("<visual>", '<visual><origin quat_xyzw="1 0 0 0"/>')
    assert "quat_xyzw, which URDF knows from" in read_pieces(drawn, None, None)[1][0]


@EACH
def test_several_trees_are_refused_without_links(
    rng: np.random.Generator, tmp_path: Path
) -> None:
    path = written(tmp_path, str(odd_files.strays(rng, plain(rng))))
    words = "several trees, whose roots are .*stray0.*give base_link and tip_link"
    for read in (iksel.load_robot, iksel.LinkTree.from_urdf):
        with pytest.raises(iksel.UrdfError, match=words) as caught:
            read(path)
        assert {BASE, "stray0"} <= set(caught.value.available)
    assert load(path).dof == iksel.load_robot(path, tip_link=TIP).dof
    with pytest.raises(iksel.UrdfError, match="'stray0' are not connected: they hang"):
        iksel.load_robot(path, base_link=BASE, tip_link="stray0")


@EACH
def test_faults_of_xml_have_a_line(rng: np.random.Generator, tmp_path: Path) -> None:
    faults = {
        r'="[^"\n]*"(?=/>$)': (r'="0', "has no closing quote"),
        r"=(?=\"[^\n]*/>$)": ("", "is missing: write"),
        r'="(\w+)"(?=/>$)': (r"=\1", "has no quotes"),
        r"</joint>": ("</link>", "</link> where <joint> of line"),
        r"<parent": ("<parent link='a' link='b'", "a second attribute 'link'"),
    }
    text = plain(rng)
    pattern, (made, words) = list(faults.items())[rng.integers(len(faults))]
    found = list(re.finditer(pattern, text, flags=re.MULTILINE))
    place = found[int(rng.integers(len(found)))]
    odd = text[: place.start()] + place.expand(made) + text[place.end() :]
    line = text[: place.start()].count("\n") + 1
    for source in (odd, written(tmp_path, odd)):
        with pytest.raises(iksel.UrdfError, match=f"line {line}: .*{words}"):
            load(source)
    cut = text[: int(rng.integers(100, len(text) - 20))]
    with pytest.raises(iksel.UrdfError, match=f"line {cut.count(chr(10)) + 1}: "):
        load(cut)


@EACH
@pytest.mark.parametrize(
    ("start", "end", "words"),
    [
        (
            "<sdf version='1.9'><model name='a'>",
            "</model></sdf>",
            "is SDF; .*convert it",
        ),
        ("<!DOCTYPE html>\n<html><body><br>", "</body></html>", "a web page; download"),
        ("<html lang=en><pre>", "</pre></html>", "a web page; download the file"),
        ("<Robot name='a'>", "</Robot>", r"<robot> \(in small letters"),
        ("<u:robot xmlns:u='http://u'>", "</u:robot>", "without a prefix"),
        ("<mujoco>", "<a/></mujoco>", "MJCF"),
        ("<robot name='a'>", "</robot><robot/>", "line .*behind the end of <robot>"),
    ],
)
def test_other_formats_are_named(
    rng: np.random.Generator, start: str, end: str, words: str, tmp_path: Path
) -> None:
    inside = re.sub(r"<\?.*\n|</?robot.*\n", "", plain(rng))
    odd = f"{rng.choice(['', ' ', '<!-- a -->'])}{start}{inside}{end}"
    with pytest.raises(iksel.UrdfError, match=words):
        iksel.load_robot(odd)
    if "mujoco" not in start:
        with pytest.raises(iksel.UrdfError, match=words):
            load(written(tmp_path, odd))


@EACH
def test_the_tips_that_a_message_names_are_taken(rng: np.random.Generator) -> None:
    """Of a group of a chain and more links."""
    text = plain(rng)
    links = re.findall('<link name="(l[0-9])"', text)
    base = str(rng.choice([BASE, *links[:-1]]))
    parts = [f'<chain base_link="{base}" tip_link="{TIP}"/>']
    parts += [f'<link name="{name}"/>' for name in ("finger", "camera")]
    srdf = "".join(rng.permutation(parts))
    srdf = f'<robot name="odd"><group name="arm">{srdf}</group></robot>'
    chosen = {"srdf": srdf, "group": "arm"}
    with pytest.raises(iksel.UrdfError, match="choose one by tip_link: ") as caught:
        iksel.load_robot(text, **chosen)
    tips = str(caught.value).rpartition(": ")[2].split(", ")
    assert set(tips) == {TIP, "finger", "camera"}
    for tip in tips:
        made = iksel.load_robot(text, **chosen, tip_link=tip)
        assert (made.base_link, made.tip_link) == (base, tip)
    with pytest.raises(iksel.UrdfError, match="choose one by tip_link"):
        iksel.load_robot(text, **chosen, tip_link=links[0])


@EACH
@pytest.mark.parametrize("kind", ["early comment", "dashes", "default namespace"])
def test_mjcf_with_faults_is_mjcf(
    rng: np.random.Generator, kind: str, tmp_path: Path
) -> None:
    pytest.importorskip("mujoco")
    text = """<robot><worldbody><body name="a"><joint name="j" range="-2 2"/>
      <geom size=".02"/><body name="b" pos="0 0 .3"><geom size=".02"/></body></body>
      </worldbody></robot>"""
    odd = str(FAULTS[kind](rng, text)).replace("robot", "mujoco")
    odd = odd.replace("warning: deprecated", "").replace("<?tool?>", "")
    made = iksel.load_robot(written(tmp_path, odd, "odd.xml"))
    assert (made.dof, made.tip_link) == (1, "b")


@pytest.mark.skipif(not FOUND.is_dir(), reason="files of other people, not kept here")
@pytest.mark.parametrize(
    ("name", "settings", "words"),
    [
        ("urdf11_quat", {}, None),
        ("urdf11_capsule", {}, None),
        ("inf_off_the_chain", {}, None),
        ("material_twice", {}, None),
        ("dynamics_empty_off_the_chain", {}, None),
        ("two_roots_camera", {}, None),
        ("tab_in_xyz", {}, None),
        ("doctype_with_subset", {}, None),
        ("utf16", {}, None),
        ("follower_without_limits", {}, None),
        ("prismatic_1e9", {}, "no limits .*default_limits"),
        ("prismatic_1e9", {"default_limits": (-1, 1)}, None),
        ("urdf10_quat_ignored", {}, r'write <robot version="1.1">, or rpy'),
        ("readers_comment_first", {}, None),
        ("readers_default_ns", {}, None),
        ("readers_drake_unbound", {}, None),
        ("srdf_two_ends", {"srdf": FOUND / "srdf_two_ends.srdf", "group": "arm"}, None),
    ],
)
def test_files_that_were_found(name: str, settings: dict, words: str | None) -> None:
    def loaded(name: str, **more: object) -> iksel.Robot:
        path = FOUND / f"{name}.urdf"
        return iksel.load_robot(path, base_link="l0", tip_link="l6", **more)

    if words is not None:
        with pytest.raises(iksel.UrdfError, match=words):
            loaded(name, **settings)
        return
    made, expected = loaded(name, **settings), loaded("plain6")
    assert made.dof == (5 if name == "follower_without_limits" else 6)
    read_pieces(FOUND / f"{name}.urdf", None, None)
    ET.fromstring(made.urdf)
    q = made.random_configurations(5, seed=SEED)
    if name == "urdf11_quat":  # the first joint is turned by a quarter
        q[:, 0] += np.pi / 2
        for row in q:
            turned = row - [np.pi / 2, 0, 0, 0, 0, 0]
            np.testing.assert_allclose(made.fk(turned), expected.fk(row), atol=1e-14)
    elif made.dof == expected.dof and name != "prismatic_1e9":
        for row in q:
            np.testing.assert_array_equal(made.fk(row), expected.fk(row))
