# SPDX-License-Identifier: BSD-3-Clause
"""Which pairs of links self-collision looks at."""

from __future__ import annotations

import numpy as np
import pytest
from tubes import LENGTHS, TUBE, URDF, joint, link

import iksel

pytest.importorskip("coal")
collision = pytest.importorskip("iksel.collision")


@pytest.fixture(scope="module")
def arm() -> iksel.Robot:
    return iksel.Robot.from_urdf(URDF, base_link="l0", tip_link="l6")


def hand(finger: float) -> str:
    """The arm with two fingers of that width [m], 0.1 m apart, each on a slide."""
    fingers = ""
    for side, y in (("left", 0.05), ("right", -0.05)):
        fingers += f"""<link name="{side}"><collision>
          <geometry><box size="0.02 {finger} 0.08"/></geometry></collision></link>
        <joint name="{side}_slide" type="prismatic">
          <parent link="l6"/><child link="{side}"/>
          <origin xyz="0 {y} 0.1"/><axis xyz="0 1 0"/>
          <limit lower="0" upper="0.04" effort="1" velocity="1"/></joint>"""
    return URDF.replace("</robot>", fingers + "</robot>")


def test_what_the_arm_does_not_move_against_each_other_is_ignored(arm) -> None:
    without = collision.SelfCollision(URDF, arm, samples=0)
    free = collision.SelfCollision(hand(0.15), arm, samples=0)
    assert free.ignored["left", "right"] == "fixed"
    assert free.ignored["l6", "left"] == "fixed"
    assert free.ignored["l5", "l6"] == "adjacent"
    assert not set(free.pairs) & set(free.ignored)
    q = arm.random_configurations(100, seed=8)
    assert without(q).sum() > 5
    assert 5 < free(q).sum() < 100
    kept = collision.SelfCollision(
        hand(0.15), arm, samples=99, keep=[("right", "left")]
    )
    assert ("left", "right") in kept.pairs
    assert not kept(q).any()
    assert kept.colliding_links(np.zeros(6)) == ("left", "right")


def srdf(*tags: str) -> str:
    return f'<robot name="tubes">{"".join(f"<{tag}/>" for tag in tags)}</robot>'


def test_pairs_that_an_srdf_disables(arm, tmp_path) -> None:
    text = srdf(
        'disable_collisions link1="l4" link2="l0" reason="Never"',
        'disable_collisions link1="l1" link2="l0" reason="Adjacent"',
        'disable_collisions link1="l0" link2="camera" reason="Never"',
        'disable_default_collisions link="l6"',
        'enable_collisions link1="l6" link2="l1"',
    )
    path = tmp_path / "arm.srdf"
    path.write_text(text, encoding="utf-8")
    everything = collision.SelfCollision(URDF, arm, samples=0)
    for source in (text, path, str(path)):
        free = collision.SelfCollision(URDF, arm, srdf=source)
        by_srdf = {pair for pair, why in free.ignored.items() if why[:4] == "srdf"}
        assert by_srdf == {
            ("l0", "l4"),
            ("l0", "l6"),
            *((f"l{i}", "l6") for i in (2, 3, 4)),
        }
        assert free.ignored["l0", "l4"] == "srdf: Never"
        assert free.ignored["l0", "l1"] == "adjacent"
        assert set(free.pairs) == set(everything.pairs) - by_srdf
    kept = collision.SelfCollision(URDF, arm, srdf=text, keep=[("l4", "l0")])
    assert ("l0", "l4") in kept.pairs
    # The verdict is that of the pairs that are left.
    first = [
        everything.colliding_links(q) for q in arm.random_configurations(200, seed=1)
    ]
    assert any(pair in by_srdf for pair in first)
    q = arm.random_configurations(200, seed=1)
    ignoring = collision.SelfCollision(URDF, arm, samples=0, ignore=by_srdf)
    assert ignoring(q).tolist() == free(q).tolist()
    assert (free(q) > everything(q)).any()


def test_errors_of_an_srdf_say_what_is_wrong(arm) -> None:
    other = srdf('disable_collisions link1="shoulder" link2="elbow"')
    with pytest.raises(iksel.UrdfError, match=r"srdf: of another robot.*elbow.*l0, l1"):
        collision.SelfCollision(URDF, arm, srdf=other)
    with pytest.raises(iksel.UrdfError, match="srdf: expected <robot>, got <sdf>"):
        collision.SelfCollision(URDF, arm, srdf="<sdf/>")
    with pytest.raises(iksel.UrdfError, match=r"srdf: .*absent\.srdf"):
        collision.SelfCollision(URDF, arm, srdf="absent.srdf")
    with pytest.raises(iksel.UrdfError, match="srdf: "):
        collision.SelfCollision(URDF, arm, srdf="<robot")


def test_the_pairs_found_are_saved_as_an_srdf(arm, tmp_path) -> None:
    found = collision.SelfCollision(BUMPED, arm, samples=300)
    assert set(found.ignored.values()) == {"fixed", "adjacent", "always", "apart"}
    found.save_srdf(tmp_path / "found.srdf")
    again = collision.SelfCollision(BUMPED, arm, srdf=tmp_path / "found.srdf")
    assert again.pairs == found.pairs
    assert {why.removeprefix("srdf: ") for why in again.ignored.values()} == set(
        found.ignored.values()
    )


# A sphere around the second joint, on l2, is always in l0; a bead on l5 never is.
BALL = '<collision><geometry><sphere radius="0.3"/></geometry></collision>'
BUMPED = URDF.replace('<link name="l2">', f'<link name="l2">{BALL}').replace(
    link("l6", LENGTHS[6]),
    link("l6", LENGTHS[6]) + '<link name="bead">'
    '<collision><geometry><sphere radius="0.01"/></geometry></collision></link>'
    '<joint name="glue" type="fixed"><parent link="l5"/><child link="bead"/></joint>',
)


def test_pairs_that_always_or_never_touch_are_found(arm) -> None:
    q = arm.random_configurations(200, seed=9)
    assert not collision.SelfCollision(BUMPED, arm, samples=0)(q).any()
    free = collision.SelfCollision(BUMPED, arm, samples=500)
    assert free.ignored["l0", "l2"] == "always"
    assert free.ignored["l3", "bead"] == "apart"
    assert ("l1", "l6") in free.pairs
    assert 20 < free(q).sum() < 200
    again = collision.SelfCollision(BUMPED, arm, samples=500, seed=0)
    assert again.ignored == free.ignored
    # An SRDF says what never touches; what always does is still found.
    listed = srdf('disable_collisions link1="l0" link2="l4" reason="Never"')
    listed = collision.SelfCollision(BUMPED, arm, srdf=listed)
    assert listed.ignored["l0", "l2"] == "always"
    assert "never" not in listed.ignored.values()
    kept = collision.SelfCollision(BUMPED, arm, samples=500, keep=[("l0", "l2")])
    assert not kept(q).any()
    # What never touches does not in the samples of others either.
    never = [pair for pair, why in free.ignored.items() if why in {"apart", "never"}]
    only = collision.SelfCollision(
        BUMPED, arm, samples=0, ignore=free.pairs, keep=never
    )
    assert all(only.colliding_links(one) not in never for one in q)
    with pytest.raises(iksel.InvalidArgumentError, match="samples: -1"):
        collision.SelfCollision(URDF, arm, samples=-1)
    with pytest.raises(iksel.InvalidArgumentError, match="ignore: l0 and l2 .*keep"):
        collision.SelfCollision(URDF, arm, ignore=[("l0", "l2")], keep=[("l2", "l0")])
    with pytest.raises(iksel.UnknownNameError, match="keep: .*'elbow'.*l0, l1"):
        collision.SelfCollision(URDF, arm, keep=[("l0", "elbow")])


def orbit(distance: float, axes: int) -> str:
    """Two balls of 0.1 m, one around the other on some axes, and a bead between."""
    names = ["sun", *(f"dust{i}" for i in range(1, axes)), "moon"]
    balls = "".join(
        f'<link name="{name}"><collision><origin xyz="{x} 0 0"/>'
        f'<geometry><sphere radius="{r}"/></geometry></collision></link>'
        for name, x, r in (("sun", 0, 0.1), ("dust1", 9, 0.01), ("moon", distance, 0.1))
    )
    balls += "".join(f'<link name="{name}"/>' for name in names[2:-1])
    joints = "".join(
        joint(f"j{i}", names[i], names[i + 1], 0, ("0 0 1", "0 1 0")[i % 2])
        for i in range(axes)
    )
    return f'<robot name="orbit">{balls}{joints}</robot>'


@pytest.mark.parametrize(
    ("gap", "axes", "why"),
    [
        (-1e-3, 2, "always"),
        (1e-3, 2, None),
        (0.03, 2, "apart"),
        (-1e-3, 3, "always"),
        (0.01, 3, None),
        (0.03, 3, "never"),
    ],
)
def test_a_pair_that_comes_near_is_looked_at(gap, axes, why) -> None:
    """Samples that are free do not prove that those between them are."""
    text = orbit(0.2 + gap, axes)
    robot = iksel.Robot.from_urdf(text, base_link="sun", tip_link="moon")
    free = collision.SelfCollision(text, robot, samples=300)
    assert free.ignored.get(("sun", "moon")) == why


def wrist(rng: np.random.Generator) -> str:
    """Two boxes that two skew axes move against each other, and a link between."""

    def place() -> str:
        xyz, rpy = rng.uniform(-0.2, 0.2, 3), rng.uniform(-3, 3, 3)
        return f'<origin xyz="{vector(xyz)}" rpy="{vector(rpy)}"/>'

    def box(name: str) -> str:
        shape = f'<box size="{vector(rng.uniform(0.02, 0.3, 3))}"/>'
        return f"""<link name="{name}"><collision>{place()}
        <geometry>{shape}</geometry></collision></link>"""

    def axis(name: str, parent: str, child: str) -> str:
        kind = rng.choice(["revolute", "continuous", "prismatic"], p=[0.6, 0.2, 0.2])
        low = rng.uniform(-1.5, 0.5)
        return f"""<joint name="{name}" type="{kind}"><parent link="{parent}"/>
        <child link="{child}"/>{place()}<axis xyz="{vector(rng.normal(size=3))}"/>
        <limit lower="{low}" upper="{low + rng.uniform(0.1, 1.5)}" effort="1"
        velocity="1"/></joint>"""

    boxes = box("upper") + f'<link name="cross">{BEAD}</link>' + box("lower")
    joints = axis("x", "upper", "cross") + axis("y", "cross", "lower")
    return f'<robot name="wrist">{boxes}{joints}</robot>'


def vector(values: np.ndarray) -> str:
    return " ".join(f"{x:.6f}" for x in values)


# Solid, or the two links would be neighbours; far from both.
BEAD = (
    '<collision><origin xyz="50 0 0"/><geometry><sphere radius="0.01"/></geometry>'
    "</collision>"
)


@pytest.mark.parametrize("margin", [0.0, 0.02])
def test_pairs_that_are_proven_apart_are(margin) -> None:
    """Dense samples find no collision of them, and a proof for most that have none."""
    rng = np.random.default_rng(1)
    pair = ("upper", "lower")
    proven = clear = 0
    for _ in range(60):
        text = wrist(rng)
        robot = iksel.Robot.from_urdf(text, base_link="upper", tip_link="lower")
        found = collision.SelfCollision(text, robot, margin=margin, samples=0)
        all_pairs = collision.SelfCollision(
            text, robot, margin=margin, samples=0, keep=[pair]
        )
        grid = np.meshgrid(
            *(np.linspace(*ends, 31) for ends in ends_of(robot)), indexing="ij"
        )
        q = np.stack(grid, axis=-1).reshape(-1, 2)
        touches = [all_pairs.colliding_links(one) == pair for one in q]
        is_proven = found.ignored.get(pair) == "apart"
        assert not (is_proven and any(touches))
        proven += is_proven
        clear += not any(touches)
    assert clear >= 15
    assert proven >= 0.9 * clear


def ends_of(robot: iksel.Robot) -> np.ndarray:
    return np.column_stack(
        [np.maximum(robot.lower, -np.pi), np.minimum(robot.upper, np.pi)]
    )


def test_a_pair_that_cannot_keep_the_margin_is_held_to_none(arm) -> None:
    # l1, 0.1 m long, is all that is between l0 and l2.
    free = collision.SelfCollision(URDF, arm, margin=0.12, samples=500)
    assert ("l0", "l2") in free.pairs
    q = arm.random_configurations(300, seed=10)
    assert 5 < free(q).sum() < 300
    bent = [0, 2.9, 0, 0, 0, 0]
    assert collision.SelfCollision(URDF, arm).colliding_links(bent) == ("l0", "l2")
    assert free.colliding_links(bent) == ("l0", "l2")


def universal(solid: str) -> str:
    """Two solid links with a joint of two axes and a flange between them."""
    empty = "".join(f'<link name="{name}"/>' for name in ("cross", "flange"))
    fixed = """<joint name="bolts" type="fixed">
      <parent link="flange"/><child link="lower"/></joint>"""
    return (
        f'<robot name="u"><link name="upper">{solid}</link>{empty}'
        f'<link name="lower">{solid}</link>{fixed}'
        + joint("x", "upper", "cross", 0.02, "1 0 0")
        + joint("y", "cross", "flange", 0, "0 1 0")
        + "</robot>"
    )


def test_links_around_a_joint_of_several_axes_are_adjacent() -> None:
    text = universal(TUBE.join(("<collision><geometry>", "</geometry></collision>")))
    robot = iksel.Robot.from_urdf(text, base_link="upper", tip_link="lower")
    free = collision.SelfCollision(text, robot, samples=0)
    assert free.ignored == {("upper", "lower"): "adjacent"}
    assert free(robot.random_configurations(20, seed=1)).all()
