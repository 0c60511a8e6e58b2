# SPDX-License-Identifier: BSD-3-Clause
"""300 URDF files of other people: kinematics as Pinocchio's, every refusal explained.

scripts/urdf_files.sh downloads the files and runs this; IKSEL_URDF_FILES is the folder
of the packages, and report.txt in it says what was found and what is refused.
"""

from __future__ import annotations

import os
import time
import zipfile
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pytest

import iksel

if TYPE_CHECKING:
    from collections.abc import Iterator

HERE = Path(__file__).parent
FOLDER = Path(os.environ.get("IKSEL_URDF_FILES", HERE.parents[1] / "build/urdf_files"))
SEED = int(os.environ.get("IKSEL_TEST_SEED", "1"))
OBJECTS = "random_urdfs/"  # of pybullet: a thousand objects of one link
CONFIGURATIONS = 5
TARGETS = 80

pytest.importorskip("pinocchio", reason="needs Pinocchio: pip install 'iksel[urdfs]'")
from urdf_reference import UrdfFile  # noqa: E402 (it imports Pinocchio)

WHEELS = sorted(FOLDER.glob("*.whl"))
pytestmark = [
    pytest.mark.slow,
    pytest.mark.urdf_files,
    pytest.mark.skipif(
        not WHEELS, reason="needs packages with URDF files: scripts/urdf_files.sh"
    ),
]


# How to go on, which every refusal says.
REMEDIES = (
    "choose links with one between them",
    "give default_limits for such joints, or hold it at a value by locked_joints",
    "a joint that does not move is held by locked_joints",
    "choose a base link behind it",
    "did you mean '",
    "a joint that turns freely is 'continuous'",
    "give the <robot> a name",
    "it needs a <link> for each body",
    "each of them a <link>",
    "To fix this problem you can",
    "give the path of a URDF file, or its text",
    "a joint is revolute, continuous, prismatic, fixed, planar or floating",
    "give as many numbers as are expected",
    'write numbers as in xyz="',
    "write the number as in -1.57",
    "in Python iksel.load_robot",
)


class Refusal(NamedTuple):
    """What IKSel does not take, what it says, and what in the file bears it out."""

    name: str
    message: str
    cause: str | None


class Package:
    """The URDF files of a package, and the robots of all their chains."""

    def __init__(self, wheel: Path, folder: Path) -> None:
        self.files: list[UrdfFile] = []
        self.chains: list[tuple[UrdfFile, iksel.Robot]] = []
        self.refusals: list[Refusal] = []
        with zipfile.ZipFile(wheel) as archive:
            for name in archive.namelist():
                if name.endswith(".urdf") and OBJECTS not in name:
                    self._read(UrdfFile(Path(archive.extract(name, folder))), name)

    def _read(self, file: UrdfFile, name: str) -> None:
        self.files.append(file)
        # A file without a base has to be refused before any link is looked up.
        for tip in file.tips if file.base else ["any"]:
            self._try(file, f"{name} to {tip}", file.base or "any", tip)

    def _try(self, file: UrdfFile, name: str, base: str, tip: str) -> None:
        try:
            robot = iksel.Robot.from_urdf(file.path, base_link=base, tip_link=tip)
        except iksel.UrdfError as error:  # UnknownNameError for a mimic's
            message = str(error).replace(str(file.path), file.path.name)
            self.refusals.append(Refusal(name, message, file.cause(tip, message)))
        else:
            self.chains.append((file, robot))


@pytest.fixture(scope="module")
def packages(tmp_path_factory) -> dict[str, Package]:
    """All packages by their names."""
    return {
        wheel.name.split("-")[0]: Package(wheel, tmp_path_factory.mktemp("urdf"))
        for wheel in WHEELS
    }


@pytest.fixture(scope="module")
def report() -> Iterator[list[str]]:
    """Lines that are written to a file in the end."""
    lines: list[str] = []
    yield lines
    (FOLDER / "report.txt").write_text("\n".join([*lines, ""]), encoding="utf-8")


def test_forward_kinematics_is_pinocchios_on_every_chain(packages, report) -> None:
    rng = np.random.default_rng(SEED)
    files = chains = 0
    for name, package in packages.items():
        for file, robot in package.chains:
            q = robot.random_configurations(
                CONFIGURATIONS, seed=int(rng.integers(2**31))
            )
            where = f"{name}: {file.path} to {robot.tip_link}, seed {SEED}"
            assert file.parsed, where
            np.testing.assert_allclose(
                robot.fk(q), file.poses(robot, q), rtol=0, atol=1e-9, err_msg=where
            )
        files += len(package.files)
        chains += len(package.chains)
        report.append(
            f"{name}: {len(package.files)} files, {len(package.chains)} chains with "
            f"Pinocchio's kinematics, {len(package.refusals)} refused"
        )
    report.append(f"together: {files} files, {chains} chains")
    assert files >= 300
    assert chains > 2500


def test_every_refusal_has_a_cause_in_the_file_and_names_a_remedy(
    packages, report
) -> None:
    refusals = [
        refusal for package in packages.values() for refusal in package.refusals
    ]
    causes = Counter(refusal.cause or "NO CAUSE FOUND" for refusal in refusals)
    for cause, count in causes.most_common():
        report.append(f"\n{count} refused: {cause}")
        report += [
            f"  {refusal.name}: {refusal.message}"
            for refusal in refusals
            if (refusal.cause or "NO CAUSE FOUND") == cause
        ]
    assert [refusal for refusal in refusals if refusal.cause is None] == []
    stuck = [r for r in refusals if not any(word in r.message for word in REMEDIES)]
    assert stuck == []
    assert len(causes) > 3  # the files hold an example of each


def test_reachable_targets_are_solved_as_pinocchio_sees_it(packages, report) -> None:
    solved = 0
    for name, package in packages.items():
        known = set()
        for file, robot in package.chains:
            key = file.path, *file.moving(robot.tip_link)
            if key in known:  # another sensor at the end of the same joints
                continue
            known.add(key)
            where = f"{name}: {file.path} to {robot.tip_link}, seed {SEED}"
            targets = robot.fk(robot.random_configurations(TARGETS, seed=SEED))
            found = iksel.Solver(robot).solve_batch(targets)
            assert found.success.all(), f"{where}: {Counter(found.status.tolist())}"
            errors = np.abs(iksel.pose_error(targets, file.poses(robot, found.q)))
            assert errors.max() < 2e-6, where
            assert (found.q >= robot.lower).all(), where
            assert (found.q <= robot.upper).all(), where
            solved += TARGETS
    report.append(f"\n{solved} of {solved} reachable targets solved")
    assert solved > 80_000


ARMS = [
    ("panda", "urdf/panda", "srdf/panda", "panda_link0", "panda_hand_tcp"),
    ("ur", "urdf/ur5_gripper", "srdf/ur5_gripper", "base_link", "ee_link"),
    ("xarm", "urdf/xarm7", "srdf/xarm7", "world", "link_eef"),
]


@pytest.mark.parametrize("arm", ARMS, ids=[arm[0] for arm in ARMS])
def test_self_collision_is_pinocchios(tmp_path, arm) -> None:
    """Also with the pairs that samples find, in place of the SRDF's."""
    name, urdf, srdf, base, tip = arm
    collision = pytest.importorskip("iksel.collision")
    pytest.importorskip("coal")
    wheel = next(iter(FOLDER.glob("example_robot_data-*.whl")), None)
    if wheel is None:
        pytest.skip("needs the package example-robot-data")
    folder = f"cmeel.prefix/share/example-robot-data/robots/{name}_description/"
    with zipfile.ZipFile(wheel) as archive:
        members = [n for n in archive.namelist() if n.startswith(folder)]
        archive.extractall(tmp_path, members)
    urdf, srdf = (tmp_path / folder / f"{x}.{x[:4]}" for x in (urdf, srdf))
    robot = iksel.Robot.from_urdf(urdf, base_link=base, tip_link=tip)
    packages = {"example-robot-data": tmp_path / folder / "../.."}
    given = collision.SelfCollision(urdf, robot, srdf=srdf, packages=packages)
    q = robot.random_configurations(500, seed=SEED)
    start = time.process_time()
    free = given(q)
    assert (time.process_time() - start) / len(q) < 5e-3
    expected = UrdfFile(urdf).free(robot, q, srdf, tmp_path / folder / "../../..")
    assert free.tolist() == expected.tolist(), f"seed {SEED}"
    assert free.mean() > 0.5
    found = collision.SelfCollision(urdf, robot, packages=packages)
    always = [pair for pair, why in found.ignored.items() if why == "always"]
    everything = collision.SelfCollision(
        urdf, robot, packages=packages, samples=0, ignore=always
    )
    assert found(q).tolist() == everything(q).tolist(), f"seed {SEED}"
    assert found(q).mean() > 0.5
