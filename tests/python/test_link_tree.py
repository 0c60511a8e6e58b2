# SPDX-License-Identifier: BSD-3-Clause
"""What a URDF holds before a chain is chosen, and names that it does not have."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from command_line import Run, assert_bad, assert_good
from urdf_text import arm, joint, link, robot

import iksel

HANDS = robot(
    link("base", "arm", "left", "right", "camera"),
    joint("shoulder", "base", "arm"),
    joint("a_wrist", "arm", "left"),
    joint("b_wrist", "arm", "right", kind="prismatic"),
    joint("c_mount", "base", "camera", kind="fixed"),
)


def test_a_tree_is_read(tmp_path: Path) -> None:
    path = tmp_path / "hands.urdf"
    path.write_text(HANDS, encoding="utf-8")
    for source in (HANDS, path, str(path)):
        tree = iksel.LinkTree.from_urdf(source)
        assert tree.robot_name == "test"
        assert sorted(tree.links) == ["arm", "base", "camera", "left", "right"]
        assert tree.links[0] == "base"
        assert {j.name: (j.type, j.parent_link, j.child_link) for j in tree.joints} == {
            "shoulder": ("revolute", "base", "arm"),
            "a_wrist": ("revolute", "arm", "left"),
            "b_wrist": ("prismatic", "arm", "right"),
            "c_mount": ("fixed", "base", "camera"),
        }
        assert dict(tree.tips) == {"left": 2, "right": 2, "camera": 0}


def test_a_tree_is_drawn() -> None:
    assert str(iksel.LinkTree.from_urdf(HANDS)).splitlines() == [
        "base",
        "  camera  (c_mount, fixed)",
        "  arm  (shoulder, revolute)",
        "    left  (a_wrist, revolute)",
        "    right  (b_wrist, prismatic)",
    ]


def test_a_robot_knows_all_links(made) -> None:
    hand = iksel.Robot.from_urdf(HANDS, tip_link="left")
    assert hand.link_names == iksel.LinkTree.from_urdf(HANDS).links
    for name in iksel.robot_names():
        built_in = made.robot(name)
        assert {built_in.base_link, built_in.tip_link} <= set(built_in.link_names)
        assert len(set(built_in.link_names)) == len(built_in.link_names)


def test_several_tips_are_explained() -> None:
    with pytest.raises(iksel.UrdfError) as caught:
        iksel.Robot.from_urdf(HANDS)
    assert re.search(
        "tip link .* several .*LinkTree.*: camera, left, right", str(caught.value)
    )
    assert sorted(caught.value.available) == ["camera", "left", "right"]


@pytest.mark.parametrize(
    ("given", "meant"),
    [
        ("elbo", "elbow"),
        ("Elbow", "elbow"),
        ("elbow_link", "elbow"),
        ("hnad", None),
        ("han", "hand"),
        ("bse", "base"),
        ("zebra", None),
        ("", None),
    ],
)
def test_a_name_that_is_alike_is_offered(given: str, meant: str | None) -> None:
    if not given:
        assert iksel.Robot.from_urdf(arm(), tip_link=given).tip_link == "hand"
        return
    for role in ("tip_link", "base_link"):
        with pytest.raises(iksel.UnknownNameError) as caught:
            iksel.Robot.from_urdf(arm(), **{role: given})
        message = str(caught.value)
        assert (f"did you mean '{meant}'" in message) == (meant is not None)
        assert ("did you mean" in message) == (meant is not None)
        assert "has: base, elbow, hand" in message
        assert caught.value.available == ("base", "elbow", "hand")


def test_joint_names_are_offered_too() -> None:
    with pytest.raises(iksel.UnknownNameError, match="did you mean 'second'") as caught:
        iksel.Robot.from_urdf(arm(), locked_joints={"secnd": 0.0})
    assert caught.value.available == ("first", "second")


def test_long_lists_are_whole_where_they_are_asked_for() -> None:
    names = [f"link_number_{i}" for i in range(100)]
    joints = [joint(f"j{i}", names[0], name) for i, name in enumerate(names[1:])]
    xml = robot(link(*names), *joints)
    with pytest.raises(iksel.UnknownNameError) as caught:
        iksel.Robot.from_urdf(xml, tip_link="link_number_1000")
    assert "and 80 more" in str(caught.value)
    assert len(str(caught.value)) < 700
    assert sorted(caught.value.available) == sorted(names)
    assert "link_number_10" in str(caught.value)
    with pytest.raises(iksel.UrdfError, match="and 79 more") as several:
        iksel.Robot.from_urdf(xml)
    assert len(several.value.available) == 99


def test_errors_without_a_choice_have_no_names() -> None:
    with pytest.raises(iksel.UrdfError) as caught:
        iksel.Robot.from_urdf("<robot")
    assert caught.value.available == ()
    with pytest.raises(iksel.UnknownNameError) as unknown:
        iksel.load_robot("ur33")
    assert unknown.value.available == tuple(iksel.robot_names())


@pytest.mark.parametrize("where", ["tip_link", "base_link"])
def test_none_means_the_default(where: str) -> None:
    made = iksel.Robot.from_urdf(arm(), **{where: None})
    assert (made.base_link, made.tip_link) == ("base", "hand")
    with pytest.raises(iksel.InvalidArgumentError, match=f"{where}: expected a str"):
        iksel.Robot.from_urdf(arm(), **{where: 3})


def test_links_with_two_parents_are_refused_at_once() -> None:
    """Sixty diamonds have 2^60 ways down."""
    links = ["base"]
    joints = []
    for i in range(60):
        top, a, b, bottom = links[-1], f"a{i}", f"b{i}", f"c{i}"
        joints += [joint(f"{a}{x}{y}", x, y) for x, y in ((top, a), (top, b))]
        joints += [joint(f"{b}{x}{y}", x, y) for x, y in ((a, bottom), (b, bottom))]
        links += [a, b, bottom]
    with pytest.raises(iksel.UrdfError, match="is the child of two joints"):
        iksel.LinkTree.from_urdf(robot(link(*links), *joints))


CIRCLES = [
    robot(link("a", "b"), joint("i", "a", "b"), joint("j", "b", "a")),
    robot(link("a"), joint("i", "a", "a")),
    robot(
        link("root", "tool", "a", "b"),
        joint("good", "root", "tool"),
        joint("i", "a", "b"),
        joint("j", "b", "a"),
    ),
]


@pytest.mark.parametrize("xml", CIRCLES)
def test_circles_are_named(xml: str) -> None:
    for tip in (None, "a"):
        with pytest.raises(iksel.UrdfError, match="joint '[ij]' .* circle of links"):
            iksel.Robot.from_urdf(xml, tip_link=tip)
    with pytest.raises(iksel.UrdfError, match="circle"):
        iksel.LinkTree.from_urdf(xml)


@pytest.mark.parametrize("xml", [*CIRCLES, "<robot", arm(xyz="0 0 x")])
def test_refused_files_lose_no_memory(xml: str) -> None:
    resource = pytest.importorskip("resource")

    def refuse(times: int) -> int:
        for _ in range(times):
            with pytest.raises(iksel.UrdfError):
                iksel.Robot.from_urdf(xml)
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    # urdfdom alone loses 700 bytes and more for each circle [KiB].
    before = refuse(200)
    assert refuse(2000) - before < 1000


def test_info_draws_the_tree(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "hands.urdf"
    path.write_text(HANDS, encoding="utf-8")
    text = assert_good(run("info", path)).out
    assert str(iksel.LinkTree.from_urdf(HANDS)) in text
    assert "--tip" in text
    lines = [line.split() for line in text.splitlines()]
    for tip, moving in (("left", "2"), ("right", "2"), ("camera", "0")):
        assert [tip, moving] in lines
    tree = assert_good(run("info", path, "--json")).json()
    assert tree["tips"] == {"left": 2, "right": 2, "camera": 0}
    assert tree["joints"][0] == {
        "name": "c_mount",
        "type": "fixed",
        "parent_link": "base",
        "child_link": "camera",
    }
    assert run("info", path, "--tip", "left", "--json").json()["dof"] == 2
    words = ["solve", path, "--from-q", "0", "0"]
    assert_bad(
        run(*words), r"several .*iksel info .*hands\.urdf --tree.*: camera, left.*--tip"
    )


def test_info_takes_the_only_tip(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(arm(), encoding="utf-8")
    info = assert_good(run("info", path, "--json")).json()
    assert (info["tip_link"], info["dof"]) == ("hand", 2)


def test_the_tree_is_drawn_on_request(run: Run, tmp_path: Path) -> None:
    tree = str(iksel.LinkTree.from_urdf(iksel.load_robot("ur3").urdf))
    assert assert_good(run("info ur3 --tree")).out.startswith(tree)
    path = tmp_path / "many.urdf"
    names = [f"l{i}" for i in range(50)]
    joints = [joint(f"j{i}", names[0], name) for i, name in enumerate(names[1:])]
    path.write_text(robot(link(*names), *joints), encoding="utf-8")
    output = run("info", path, "--tip", "tool")
    assert_bad(output, r"and 30 more \('iksel info .*many\.urdf --tree' shows all\)")
    assert len(run("info", path, "--tree", "--json").json()["links"]) == 50
