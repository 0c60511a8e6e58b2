# SPDX-License-Identifier: BSD-3-Clause
"""What is in the wheels of a folder: dist, or $IKSEL_WHEELS.

Not among the tests of the package: scripts/packages.sh runs it.
"""

from __future__ import annotations

import email
import os
import re
import subprocess
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FOLDER = Path(os.environ.get("IKSEL_WHEELS", ROOT / "dist"))
WHEELS = sorted(FOLDER.glob("iksel-*.whl"))

BUNDLED = {
    "liborocos-kdl": "orocos-kdl",
    "liburdfdom_model": "urdfdom",
    "libconsole_bridge": "console_bridge",
    "libtinyxml": "tinyxml",  # of urdfdom 3
    "libtinyxml2": "tinyxml2",  # of urdfdom 4
}
"""Libraries that may lie in the wheels, and the names of their licences."""
HEADERS = {"eigen", "nanoflann", "pybind11", "xsimd", "xxhash"}
"""Libraries of headers, which are compiled into ours."""

# What every Linux for desktops and servers has; manylinux allows them.
SYSTEM = re.compile(
    r"(libstdc\+\+|libm|libgcc_s|libc|libpthread|ld-linux-[\w-]+)\.so\.\d"
)
LIMIT = 4_000_000
"""Bytes of a wheel; they have 1.9 MB."""


def test_there_are_wheels() -> None:
    assert WHEELS, f"no wheel in {FOLDER}: scripts/wheels.sh"


@pytest.fixture(params=WHEELS, ids=lambda path: path.name)
def wheel(request: pytest.FixtureRequest) -> Path:
    return request.param


@pytest.fixture
def unpacked(wheel: Path, tmp_path: Path) -> Path:
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path)
    return tmp_path


@pytest.fixture
def metadata(unpacked: Path) -> email.message.Message:
    (file,) = unpacked.glob("iksel-*.dist-info/METADATA")
    return email.message_from_string(file.read_text(encoding="utf-8"))


def binaries(folder: Path) -> list[Path]:
    return [
        file
        for file in folder.rglob("*")
        if file.is_file() and file.read_bytes()[:4] == b"\x7fELF"
    ]


def dynamic(file: Path, tag: str) -> list[str]:
    """The entries of that tag in the dynamic section, as readelf writes them."""
    out = subprocess.run(
        ["readelf", "--dynamic", "--wide", file],
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    return re.findall(rf"\({tag}\).*\[(.*)\]", out)


def test_it_is_small_and_for_many_linuxes(wheel: Path) -> None:
    assert wheel.stat().st_size < LIMIT
    assert re.search(r"-manylinux_2_\d+_(x86_64|aarch64)\.whl$", wheel.name)


def test_all_files_of_the_package_are_there(unpacked: Path) -> None:
    sources = {
        *ROOT.glob("python/iksel/**/*.py"),
        *ROOT.glob("python/iksel/py.typed"),
        *ROOT.glob("python/iksel_cpp-stubs/*.pyi"),
    }
    for source in sources:
        there = unpacked / source.relative_to(ROOT / "python")
        assert there.read_bytes() == source.read_bytes()
    for source in (*ROOT.glob("cpp/robots/*.urdf"), ROOT / "cpp/robots/robots.toml"):
        assert (unpacked / "iksel/robots" / source.name).is_file()
    for source in ROOT.glob("cpp/include/iksel/*.hpp"):
        assert (unpacked / "iksel/include/iksel" / source.name).is_file()
    for name in ("export.hpp", "version.hpp"):
        assert (unpacked / "iksel/include/iksel" / name).is_file()
    for name in ("Config", "ConfigVersion", "Targets", "Targets-release"):
        assert (unpacked / f"iksel/lib/cmake/iksel/iksel{name}.cmake").is_file()


def test_nothing_else_is_there(unpacked: Path) -> None:
    (extension,) = unpacked.glob("iksel_cpp.cpython-*.so")
    (metadata,) = unpacked.glob("iksel-*.dist-info")
    names = {path.name for path in unpacked.iterdir()}
    ours = {"iksel", "iksel.libs", "iksel_cpp-stubs"}
    assert names == {*ours, extension.name, metadata.name}
    names = {path.name for path in (unpacked / "iksel").iterdir()}
    sources = {path.name for path in (ROOT / "python/iksel").iterdir()}
    assert names - sources == {"include", "lib", "robots"}


def test_kdl_is_a_library_of_its_own_that_others_may_replace(unpacked: Path) -> None:
    (kdl,) = unpacked.glob("iksel.libs/liborocos-kdl-*")
    assert dynamic(kdl, "SONAME") == [kdl.name]
    assert kdl.name in dynamic(unpacked / "iksel/lib/libiksel.so.0.1", "NEEDED")


def test_every_library_is_found_in_the_wheel_or_on_any_system(unpacked: Path) -> None:
    files = binaries(unpacked)
    names = {path.name for path in files}
    assert "libiksel.so.0.1" in names
    assert len(files) == 2 + 4
    for file in files:
        (path,) = dynamic(file, "RPATH") or [""]
        folders = [
            Path(folder.replace("$ORIGIN", str(file.parent))).resolve()
            for folder in path.split(":")
            if folder
        ]
        for folder in folders:
            assert unpacked in folder.parents
        for needed in dynamic(file, "NEEDED"):
            there = any((folder / needed).is_file() for folder in folders)
            assert there or SYSTEM.fullmatch(needed), f"{file.name} needs {needed}"


def test_no_file_names_the_machine_it_was_built_on(unpacked: Path) -> None:
    build = re.compile(rb"/(?:root|home|tmp|build|project|work|srv|__w)/[\w.-]+")
    checked = [
        *binaries(unpacked),
        *unpacked.rglob("*.cmake"),
        *unpacked.rglob("*.hpp"),
    ]
    for file in checked:
        assert not build.findall(file.read_bytes()), file.name


def test_symbols_of_the_library_are_its_own(unpacked: Path) -> None:
    out = subprocess.run(
        ["readelf", "--dyn-syms", "--wide", unpacked / "iksel/lib/libiksel.so.0.1"],
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    defined = re.findall(r"(?:GLOBAL|WEAK) +DEFAULT +\d+ (\S+)", out)
    assert any(name.startswith("_ZN5iksel6Solver") for name in defined)
    # Besides instances of std's templates, which every program has of its own.
    foreign = re.compile(r"_ZNK?(?:3KDL|4urdf|5Eigen|9nanoflann|5xsimd)|XXH")
    assert not [name for name in defined if foreign.match(name)]


def test_licences_of_all_that_is_in_it(unpacked: Path, metadata) -> None:
    (folder,) = unpacked.glob("iksel-*.dist-info/licenses")
    texts = {file.stem for file in folder.glob("packaging/licenses/*.txt")}
    assert texts == {*BUNDLED.values(), *HEADERS}
    for name in metadata.get_all("License-File"):
        assert (folder / name).stat().st_size > 500
    lgpl = (folder / "packaging/licenses/orocos-kdl.txt").read_text(encoding="utf-8")
    assert "GNU LESSER GENERAL PUBLIC LICENSE" in lgpl
    assert "iksel.libs/liborocos-kdl-*.so.*" in lgpl
    for file in unpacked.glob("iksel.libs/*"):
        assert file.name.rsplit("-", 1)[0] in BUNDLED


def test_links_of_the_page_lead_somewhere(metadata) -> None:
    page = metadata.get_payload()
    links = re.findall(r"\]\(([^)]*)\)", page)
    assert len(links) > 5
    for link in links:
        assert link.startswith("https://")
    home = dict(url.split(", ") for url in metadata.get_all("Project-URL"))["Homepage"]
    for link in links:
        path = re.match(rf"{home}/blob/main/([^#]*)", link)
        assert path is None or (ROOT / path[1]).exists()


def test_its_python_is_the_one_that_it_names(wheel: Path, metadata) -> None:
    minor = int(re.search(r"-cp3(\d+)-", wheel.name)[1])
    assert metadata["Requires-Python"] == ">=3.10"
    assert minor >= 10
    classifiers = metadata.get_all("Classifier")
    assert f"Programming Language :: Python :: 3.{minor}" in classifiers
