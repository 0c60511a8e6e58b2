# SPDX-License-Identifier: BSD-3-Clause
"""Every chain in other people's files: reachable poses are solved, and rightly.

scripts/chain_files.sh downloads the files and runs this; IKSEL_CHAIN_FILES is the
folder of the packages, and report.txt in it says what was found, lost and refused.
"""

from __future__ import annotations

import os
import re
import tarfile
import zipfile
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pytest

import iksel
from iksel.description import read_description

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from chain_reference import ReferenceChain

if TYPE_CHECKING:
    from collections.abc import Iterator

HERE = Path(__file__).parent
FOLDER = Path(
    os.environ.get("IKSEL_CHAIN_FILES", HERE.parents[1] / "build/chain_files")
).absolute()
SEED = int(os.environ.get("IKSEL_TEST_SEED", "1"))
MOST_JOINTS = 10
FARTHEST = 10.0
"""How far slides are drawn [m]: files say 1e6 of mobile bases."""
TEXT = (".urdf", ".xacro", ".xml", ".yaml", ".srdf")  # meshes are left in the packages
ARCHIVES = sorted([*FOLDER.glob("*.whl"), *FOLDER.glob("*.tar.gz")])
pytestmark = [
    pytest.mark.slow,
    pytest.mark.urdf_files,
    pytest.mark.skipif(
        not ARCHIVES, reason="needs packages with robots' files: scripts/chain_files.sh"
    ),
]


class Found(NamedTuple):
    """A chain, and where it is from."""

    name: str
    robot: iksel.Robot


def extract(archive: Path, folder: Path) -> None:
    """The text files of a package."""
    if archive.suffix == ".whl":
        with zipfile.ZipFile(archive) as file:
            names = [name for name in file.namelist() if name.endswith(TEXT)]
            file.extractall(folder, names)
        return
    with tarfile.open(archive) as file:
        members = [m for m in file if m.isfile() and m.name.endswith(TEXT)]
        file.extractall(folder, members, filter="data")


def is_robot(path: Path) -> bool:
    """Whether a file is to be read: of MJCF those with bodies, of xacro no macros."""
    if path.suffix == ".urdf":
        return True
    data = path.read_bytes()
    if path.suffix == ".xml":
        return b"<mujoco" in data and b"<body" in data
    return path.suffix == ".xacro" and b"<robot" in data


def below_free_joint(urdf: str | Path, tip: str, message: str) -> iksel.Robot:
    """The chain behind a joint of the base that lets it float."""
    base = re.search(r"free joint of body (.+?)' is floating", message)
    if base is None:
        raise iksel.UrdfError(message)
    return iksel.Robot.from_urdf(urdf, base_link=base[1], tip_link=tip)


def chains_of(path: Path, name: str, refused: list[str]) -> Iterator[Found]:
    """The chains to the ends of a file's links."""
    try:
        urdf = read_description(path).urdf  # once: xacro and MuJoCo take their time
        tips = iksel.LinkTree.from_urdf(urdf).tips
    except iksel.Error as error:
        refused.append(f"{name}: {error}")
        return
    for tip, joints in tips:
        if joints == 0:
            continue
        try:
            robot = iksel.Robot.from_urdf(urdf, tip_link=tip)
        except iksel.UrdfError as error:
            try:
                robot = below_free_joint(urdf, tip, str(error))
            except iksel.UrdfError as second:
                refused.append(f"{name} to {tip}: {second}")
                continue
        if robot.dof <= MOST_JOINTS:
            yield Found(f"{name}: {robot.base_link} to {tip}", robot)


def numbers(found: Found) -> tuple:
    """What the chain is to inverse kinematics: how its joints lie, and their limits."""
    robot = found.robot
    between = ReferenceChain(robot).between.round(6) + 0.0
    types = tuple(kind.name for kind in robot.joint_types)
    limits = np.concatenate([robot.lower, robot.upper]).round(6)
    return types, between.tobytes(), limits.tobytes()


@pytest.fixture(scope="module")
def report() -> Iterator[list[str]]:
    """Lines that are written to a file in the end."""
    lines: list[str] = []
    yield lines
    (FOLDER / "report.txt").write_text("\n".join([*lines, ""]), encoding="utf-8")


@pytest.fixture(scope="module")
def elsewhere(tmp_path_factory) -> Iterator[None]:
    """Be in an empty folder, for MuJoCo writes its warnings to where it is."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("elsewhere"))
        yield


@pytest.fixture(scope="module")
def chains(tmp_path_factory, report, elsewhere) -> list[Found]:
    """All chains that differ in more than names and what is fixed at their ends."""
    different: dict[tuple, Found] = {}
    refused: list[str] = []
    files = of_files = 0
    for archive in ARCHIVES:
        folder = tmp_path_factory.mktemp("package")
        extract(archive, folder)
        before = len(different)
        for path in sorted(folder.rglob("*")):
            if not (path.is_file() and is_robot(path)):
                continue
            files += 1
            name = f"{archive.name.split('-')[0]}/{path.relative_to(folder)}"
            # Other links behind the same joints are no other chains.
            found = {
                tuple(f.robot.joint_names): f for f in chains_of(path, name, refused)
            }
            of_files += len(found)
            for one in found.values():
                different.setdefault(numbers(one), one)
        report.append(f"{archive.name}: {len(different) - before} chains")
    report.append(
        f"together: {files} files with {of_files} chains, {len(different)} of them "
        "different"
    )
    report += [f"  refused: {line}" for line in refused]
    return list(different.values())


def test_reachable_poses_are_solved_on_every_chain(chains, cases, report) -> None:
    kinds: Counter[str] = Counter()
    lost: Counter[str] = Counter()
    wrong = 0
    for found in chains:
        robot = found.robot
        kind = robot.structure.kind.name
        kinds[kind] += 1
        reference = ReferenceChain(robot)
        slides = np.array([kind.name == "prismatic" for kind in robot.joint_types])
        q = robot.random_configurations(cases, seed=SEED)
        q = np.where(slides, q.clip(-FARTHEST, FARTHEST), q)
        q = q.clip(robot.lower, robot.upper)
        targets = reference.fk(q)
        batch = iksel.Solver(robot).solve_batch(targets)
        done = batch.success
        errors = np.abs(iksel.pose_error(targets[done], reference.fk(batch.q[done])))
        inside = (batch.q[done] >= robot.lower) & (batch.q[done] <= robot.upper)
        # Large slides cost digits.
        slack = 1e-9 + 1e-14 * np.abs(targets[:, :3, 3]).max()
        bad = (errors.max(axis=0) > 1e-6 + slack) | ~inside.all(axis=1)
        wrong += int(bad.sum())
        if not done.all():
            proofs = Counter(map(iksel.Proof, batch.proof[~done].tolist()))
            told = ", ".join(f"{n} by {proof.name}" for proof, n in proofs.items())
            report.append(f"  lost: {found.name} ({robot.dof} joints, {kind}): {told}")
            first = q[np.flatnonzero(~done)[:3]].tolist()
            report.append(f"    at q = {first}, seed {SEED}")
            lost[kind] += int((~done).sum())
        if bad.any():
            report.append(f"  wrong: {found.name}: {int(bad.sum())}")
    report.append(
        f"{len(chains) * cases} poses: {dict(lost) or 0} lost, {wrong} wrong; chains: "
        f"{dict(kinds)}"
    )
    assert len(chains) > 300
    assert wrong == 0
    assert set(lost) <= {"searched"}
