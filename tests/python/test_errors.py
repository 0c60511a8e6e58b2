# SPDX-License-Identifier: BSD-3-Clause
"""URDFs that make no sense: errors are typed, name the culprit, and are not printed."""

from __future__ import annotations

import math
import re
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest
from urdf_text import arm, joint, link, mimic, robot

import iksel


@pytest.fixture(autouse=True)
def silence(capfd: pytest.CaptureFixture[str]):
    """Nothing in this file may make the core print."""
    yield
    out, err = capfd.readouterr()
    assert out == ""
    assert err == ""


def refuse(xml: object, match: str, error=iksel.UrdfError, **settings: object) -> str:
    with pytest.raises(error, match=match) as caught:
        iksel.Robot.from_urdf(xml, **settings)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_missing_files_are_named(tmp_path: Path) -> None:
    for path in (tmp_path / "absent.urdf", "absent.urdf", tmp_path):
        refuse(path, re.escape(str(path)))


def test_paths_that_no_file_can_have_are_named() -> None:
    wrong = iksel.InvalidArgumentError
    refuse("a\0.urdf", r"path_or_xml: expected a path, got 'a\\x00.urdf'", wrong)
    refuse(Path("a\0.urdf"), "path_or_xml: expected a path", wrong)
    with pytest.raises(wrong, match="path: expected a path"):
        iksel.Database.load("a\0.iksel")


def test_paths_in_no_utf8_are_named(tmp_path: Path) -> None:
    missing = f"{tmp_path}/y\udcff"
    broken = Path(f"{tmp_path}/bad\udcff.urdf")
    broken.write_text("<robot><link/></robot>", encoding="utf-8")
    for path in (missing, broken, tmp_path):
        for read in (iksel.load_robot, iksel.LinkTree.from_urdf):
            with pytest.raises(iksel.UrdfError, match=re.escape(str(tmp_path))):
                read(path)
    with pytest.raises(iksel.DatabaseIoError, match="y\ufffd"):
        iksel.Database.load(missing)


def test_names_too_long_for_a_file_are_named() -> None:
    for suffix, error in (("", iksel.UnknownNameError), (".urdf", iksel.UrdfError)):
        with pytest.raises(error, match="aaa"):
            iksel.load_robot("a" * 300 + suffix)


@pytest.mark.parametrize("letter", ["é", "关", "𝄞"])
def test_no_letter_of_a_message_is_cut(letter: str) -> None:
    for start in ("", "x", "xy", "xyz"):
        text = start + letter * 600
        assert "\ufffd" not in refuse(arm(axis=text), letter)
        with pytest.raises(iksel.InvalidArgumentError, match=f"'{start}{letter}+\\."):
            iksel.SolverOptions(seed=text)


@pytest.mark.parametrize("given", [None, 3, ["a.urdf"]])
def test_what_is_neither_path_nor_text_is_refused(given: object) -> None:
    with pytest.raises((iksel.InvalidArgumentError, TypeError)):
        iksel.Robot.from_urdf(given)


@pytest.mark.parametrize(
    "xml",
    [
        "<",
        "<robot",
        "<robot name='a'>",
        "<robot name='a'></robt>",
        "<html><body/></html>",
        "<robot/>",
        "<robot name='a'/>",
        "<?xml version='1.0'?>",
        robot(link("a", "a")),
        robot(joint("j", "a", "b")),
        robot(link("a", "b"), joint("j", "a", "b"), joint("j", "a", "b")),
        robot(link("a", "b"), joint("i", "a", "b"), joint("j", "b", "a")),
        robot(link("a"), joint("j", "a", "a")),
        robot(link("a", "b"), '<joint name="j"><parent link="a"/></joint>'),
        robot(link("a", "b"), joint("j", "a", "b", kind="ball")),
        arm(xyz="0 0"),
        arm(xyz="0 0 x"),
        arm(rpy="0 0 0 0"),
        arm(axis="z"),
        arm(inside='<limit lower="a" upper="1" velocity="1" effort="1"/>'),
        "<robot name='a'>" * 2000,
        "<robot name='\x00'/>",
        "<robot name='a'>" + "\xff\xfe" + "</robot>",
    ],
    ids=lambda xml: re.sub(r"\s+", " ", repr(xml))[:40],
)
def test_broken_urdfs_are_refused(xml: str) -> None:
    refuse(xml, ".")


def test_broken_files_are_named(tmp_path: Path) -> None:
    path = tmp_path / "broken.urdf"
    path.write_text(arm()[:100], encoding="utf-8")
    refuse(path, r"broken\.urdf")
    path.write_text(arm(axis="0 0 0"), encoding="utf-8")
    refuse(path, "'second'")


@pytest.mark.parametrize("xml", ["<robot name='a'>", arm()[:200], "<robot><link "])
def test_text_that_was_cut_off_is_said_to_be(xml: str) -> None:
    refuse(xml, "cut off")


def test_text_without_xml_is_said_to_be(tmp_path: Path) -> None:
    path = tmp_path / "notes.txt"
    for text in ("", "buy milk"):
        path.write_text(text, encoding="utf-8")
        refuse(path, r"notes\.txt.*no XML element")


def test_deep_nesting_is_refused_and_not_followed() -> None:
    program = """
        import iksel

        try:
            iksel.Robot.from_urdf("<robot name='a'>" + "<a>" * 300_000)
        except iksel.UrdfError:
            print("refused")
    """
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(program)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "refused\n", "")


def test_truncated_urdfs_never_crash() -> None:
    xml = arm()
    for end in range(1, len(xml) - len("</robot>")):
        with pytest.raises(iksel.UrdfError):
            iksel.Robot.from_urdf(xml[:end])


@pytest.mark.parametrize(
    ("settings", "match"),
    [
        ({"tip_link": "gripper"}, "tip link 'gripper' .* has: base, elbow, hand"),
        ({"base_link": "floor"}, "base link 'floor' .* has: base, elbow, hand"),
        ({"locked_joints": {"third": 0.0}}, "'third' .* has: first, second"),
    ],
    ids=str,
)
def test_unknown_names_are_listed(settings: dict[str, object], match: str) -> None:
    refuse(arm(), match, iksel.UnknownNameError, **settings)


@pytest.mark.parametrize(
    ("locked", "match"),
    [
        ({"first": math.nan}, "first"),
        ({"first": "a"}, "first"),
        ({"first": None}, "first"),
        ([("first", 0.0)], "locked_joints"),
        ({1: 0.0}, "locked_joints"),
    ],
    ids=str,
)
def test_bad_locks_are_named(locked: object, match: str) -> None:
    refuse(arm(), match, iksel.InvalidArgumentError, locked_joints=locked)


@pytest.mark.parametrize(
    ("xml", "remedy"),
    [
        ("notes", "give the path of a URDF file, or its text"),
        ("<robot><link/></robot>", "give each <link> a name"),
        (arm().replace('name="second"', ""), "give each <joint> a name"),
        (arm().replace('name="elbow"', 'name="hand2"'), "joint 'first' needs <parent"),
        (arm(link("base")), "give each a name of its own"),
        ("<robot name='a'/>", "it needs a <link> for each body"),
        (arm(kind="spherical"), "a joint is revolute, continuous, prismatic, fixed"),
        (arm(xyz="0 0 0 1"), "give as many numbers as are expected"),
        (arm(xyz="0, 0 1"), "write numbers as in xyz="),
        (arm(inside='<limit lower="-1.5." upper="1"/>'), "write the number as in"),
        (arm(kind="floating"), "choose a base link behind it"),
    ],
)
def test_what_is_broken_comes_with_what_to_do(
    tmp_path: Path, xml: str, remedy: str
) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(xml, encoding="utf-8")
    refuse(path, f"[;:] {remedy}")


def test_links_of_two_trees_are_not_connected() -> None:
    xml = robot(link("a", "b", "c", "d"), joint("i", "a", "b"), joint("j", "c", "d"))
    refuse(xml, ".", base_link="a", tip_link="d")


def test_a_chain_needs_a_joint_that_moves() -> None:
    xml = arm(kind="fixed")
    message = refuse(xml, "no movable joint", base_link="elbow", tip_link="hand")
    assert "elbow" in message
    assert "hand" in message
    refuse(arm(), "base", base_link="base", tip_link="base")
    locked = {"first": 0.0, "second": 0.0}
    refuse(arm(), "no movable joint", locked_joints=locked)


def test_several_tips_are_listed() -> None:
    xml = robot(
        link("base", "left", "right"),
        joint("i", "base", "left"),
        joint("j", "base", "right"),
    )
    refuse(xml, "left, right")
    assert iksel.Robot.from_urdf(xml, tip_link="left").joint_names == ["i"]


@pytest.mark.parametrize("kind", ["floating", "planar"])
def test_joints_that_cannot_be_solved_are_named(kind: str) -> None:
    message = refuse(arm(kind=kind), f"'second' is {kind}")
    for possible in ("revolute", "continuous", "prismatic", "fixed"):
        assert possible in message
    # Beside the chain they do no harm.
    assert iksel.Robot.from_urdf(arm(kind=kind), tip_link="elbow").dof == 1


@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
@pytest.mark.parametrize(
    "limit",
    [
        "",
        '<limit lower="1" upper="-1" velocity="1" effort="1"/>',
        '<limit lower="1" upper="1" velocity="1" effort="1"/>',
        '<limit lower="nan" upper="1" velocity="1" effort="1"/>',
        '<limit lower="-1" upper="nan" velocity="1" effort="1"/>',
        '<limit lower="-1e999" upper="1" velocity="1" effort="1"/>',
        '<limit velocity="1" effort="1"/>',
    ],
)
def test_limits_that_make_no_sense_are_named(kind: str, limit: str) -> None:
    refuse(arm(kind=kind, inside=limit), "second")


@pytest.mark.parametrize("axis", ["0 0 0", "nan 0 0", "0 inf 0", "1e-20 0 0"])
def test_axes_that_make_no_sense_are_named(axis: str) -> None:
    refuse(arm(axis=axis), "second")


@pytest.mark.parametrize("origin", [{"xyz": "nan 0 0"}, {"rpy": "0 inf 0"}])
def test_origins_that_make_no_sense_are_named(origin: dict[str, str]) -> None:
    refuse(arm(**origin), "second")


def test_too_many_joints_are_counted() -> None:
    names = [f"l{i}" for i in range(34)]
    xml = robot(
        link(*names),
        *(joint(f"j{i}", names[i], names[i + 1], axis="0 1 0") for i in range(33)),
    )
    refuse(xml, "33 movable joints; at most 32")
    assert iksel.Robot.from_urdf(xml, base_link="l1").dof == 32


@pytest.mark.parametrize(
    ("inside", "match"),
    [
        (mimic("nobody"), "'second' mimics 'nobody'.* first, second"),
        (mimic("second"), "second.*circle"),
        (mimic("first", 'multiplier="nan"'), "second"),
        (mimic("first", 'multiplier="x"'), "."),
    ],
)
def test_bad_mimics_are_named(inside: str, match: str) -> None:
    refuse(arm(inside=inside), match)


def test_errors_have_a_family() -> None:
    assert issubclass(iksel.UnknownNameError, iksel.UrdfError)
    for error in (iksel.UrdfError, iksel.InvalidArgumentError, iksel.DatabaseError):
        assert issubclass(error, iksel.Error)
    for error in (
        iksel.DatabaseIoError,
        iksel.DatabaseCorruptError,
        iksel.DatabaseMismatchError,
    ):
        assert issubclass(error, iksel.DatabaseError)
    assert issubclass(iksel.InvalidArgumentError, ValueError)
    assert issubclass(iksel.Error, Exception)


def test_names_of_any_text_are_named() -> None:
    xml = arm().replace("hand", "hånd/左 1")
    refuse(xml, "'手'.*hånd/左 1", iksel.UnknownNameError, tip_link="手")
