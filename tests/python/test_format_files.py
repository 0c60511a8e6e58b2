# SPDX-License-Identifier: BSD-3-Clause
"""xacro and MJCF files of other people: all load, or are refused with a reason.

scripts/urdf_files.sh downloads the files and runs this, see test_urdf_files.py; what is
found, and each refusal, is in formats.txt beside its report.
"""

from __future__ import annotations

import os
import re
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pytest
from mjcf_reference import MjcfFile

import iksel

if TYPE_CHECKING:
    from collections.abc import Iterator

HERE = Path(__file__).parent
FOLDER = Path(os.environ.get("IKSEL_URDF_FILES", HERE.parents[1] / "build/urdf_files"))
SEED = int(os.environ.get("IKSEL_TEST_SEED", "1"))
NEEDED = (".xml", ".xacro", ".yaml")  # of the packages; meshes are left in them

# What a file that is no robot for IKSel is told, and with it how to go on.
REASONS = {
    "a ROS package is not there": r"packages: no folder for package '[\w-]+'; given:",
    "a file of macros": "expands to no link.*give the file that includes it",
    "an argument without a value": "xacro says: .*; values are given by xacro_args",
    "an include by package://": r"xacro says: .*; xacro includes files by \$\(find ",
    "a part of a model": "mujoco says: .*; it is a part.*: give the file that incl",
    "a fixed joint": "mujoco says: .*; leave that joint out: ",
    "global coordinates": "mujoco says: .*; save the converted model, and give that",
    "another version's": r"mujoco says: .*; mend that element.*; MuJoCo [\d.]+ is",
}

WHEELS = sorted(FOLDER.glob("*.whl"))
pytestmark = [
    pytest.mark.slow,
    pytest.mark.urdf_files,
    pytest.mark.skipif(
        not WHEELS, reason="needs packages with robots' files: scripts/urdf_files.sh"
    ),
]


class File(NamedTuple):
    """A file of a package, and the links that its chains end in."""

    name: str
    path: Path
    tips: list[str]
    refusal: str | None


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """The packages' text files."""
    made = tmp_path_factory.mktemp("files")
    for wheel in WHEELS:
        with zipfile.ZipFile(wheel) as archive:
            names = [name for name in archive.namelist() if name.endswith(NEEDED)]
            archive.extractall(made / wheel.name.split("-")[0], names)
    return made


@pytest.fixture(scope="module")
def report() -> Iterator[list[str]]:
    """Lines that are written to a file in the end."""
    lines: list[str] = []
    yield lines
    (FOLDER / "formats.txt").write_text("\n".join([*lines, ""]), encoding="utf-8")


def read(folder: Path, suffix: str, sign: bytes) -> list[File]:
    """All files of a format."""
    paths = (p for p in sorted(folder.rglob("*" + suffix)) if sign in p.read_bytes())
    return [read_one(path, str(path.relative_to(folder))) for path in paths]


def read_one(path: Path, name: str) -> File:
    try:
        tree = iksel.load_tree(path)
    except iksel.UrdfError as error:
        return File(name, path, [], str(error).replace(str(path.parent), ""))
    return File(name, path, [tip for tip, _ in tree.tips], None)


def reason(refusal: str) -> str | None:
    """Which of REASONS a refusal is."""
    return next((r for r, sign in REASONS.items() if re.search(sign, refusal)), None)


def check_refusals(files: list[File], report: list[str]) -> None:
    refused = [file for file in files if file.refusal is not None]
    report += [f"  {reason(f.refusal)}: {f.name}: {f.refusal}" for f in refused]
    assert [file for file in refused if reason(file.refusal) is None] == []


def test_mjcf_is_mujocos_on_every_chain(folder, report, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)  # where MuJoCo writes its warnings
    pytest.importorskip("mujoco")
    files = read(folder, ".xml", b"<mujoco")
    read_by_mujoco = whole = chains = refused = 0
    for file in files:
        reference = MjcfFile(file.path)
        if file.refusal is not None:
            assert not reference.parsed, file
            continue
        read_by_mujoco += 1
        whole += reference.whole
        assert reference.parsed, file
        assert set(file.tips) == set(reference.tips), file
        for tip in file.tips:
            try:
                robot = iksel.load_robot(file.path, tip_link=tip)
            except iksel.UrdfError as error:
                assert reference.cause(tip, str(error)), f"{file.name}: {error}"  # noqa: PT017
                refused += 1
                robot = below_the_free_joint(file.path, tip, str(error))
            if robot is not None:
                reference.compare(robot, SEED)
                chains += 1
    report.append(
        f"MJCF: {len(files)} files, {read_by_mujoco} that MuJoCo reads, {whole} "
        f"of them with all meshes, {chains} chains with its kinematics, {refused} from "
        "the world refused"
    )
    check_refusals(files, report)
    assert read_by_mujoco > 70
    assert chains > 100


def below_the_free_joint(path: Path, tip: str, message: str) -> iksel.Robot | None:
    """The chain from the body that a refusal names, if that has one."""
    sign = "free joint of body "
    if sign not in message:
        return None
    base = message.partition(sign)[2].partition("'")[0]
    try:
        return iksel.load_robot(path, base_link=base, tip_link=tip)
    except iksel.UrdfError:
        return None


def test_xacro_is_pinocchios_on_every_chain(folder, report, tmp_path) -> None:
    pytest.importorskip("xacro")
    pytest.importorskip(
        "pinocchio", reason="needs Pinocchio: pip install 'iksel[urdfs]'"
    )
    from urdf_reference import UrdfFile  # noqa: PLC0415 (it imports Pinocchio)

    files = read(folder, ".xacro", b"<robot")
    chains = 0
    for file in files:
        if file.refusal is not None:
            continue
        expanded = tmp_path / "expanded.urdf"
        for tip in file.tips:
            try:
                robot = iksel.load_robot(file.path, tip_link=tip)
            except iksel.UrdfError as error:
                assert UrdfFile(expanded).cause(tip, str(error)), file  # noqa: PT017
                continue
            expanded.write_text(robot.urdf, encoding="utf-8")
            # Mobile bases turn by 1e6 rad, whose last bit is 1e-10, and slide by 1e6 m.
            q = robot.random_configurations(5, seed=SEED).clip(-10, 10)
            poses = UrdfFile(expanded).poses(robot, q)
            where = f"{file.name} to {tip}, seed {SEED}"
            np.testing.assert_allclose(
                robot.fk(q), poses, rtol=0, atol=1e-9, err_msg=where
            )
            chains += 1
    loaded = sum(file.refusal is None for file in files)
    report.append(f"xacro: {len(files)} files, {loaded} load, {chains} chains")
    check_refusals(files, report)
    assert loaded > 20
    assert chains > 60
