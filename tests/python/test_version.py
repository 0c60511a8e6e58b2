# SPDX-License-Identifier: BSD-3-Clause
"""One version everywhere, and a package that exports what it says."""

from __future__ import annotations

import importlib.metadata
import re
import subprocess
import sys
from pathlib import Path

import iksel_cpp
import pytest

import iksel

ROOT = Path(__file__).parents[2]

# Where each file says the version, first match.
PLACES = {
    "CMakeLists.txt": r"project\(iksel VERSION ([0-9.]+)",
    "CHANGELOG.md": r"(?m)^## \[?([0-9][0-9.]*)",
    "CITATION.cff": r"(?m)^version: [\"']?([0-9.]+)",
    "ros/ros1/iksel_ros/package.xml": r"<version>([0-9.]+)</version>",
    "ros/ros2/iksel_ros/package.xml": r"<version>([0-9.]+)</version>",
    "ros/ros2/iksel_moveit/package.xml": r"<version>([0-9.]+)</version>",
    "packaging/debian/changelog": r"^iksel \(([0-9.]+)\)",
}


def test_package_extension_and_metadata_agree() -> None:
    assert re.fullmatch(r"\d+\.\d+\.\d+", iksel.__version__)
    assert iksel_cpp.__version__ == iksel.__version__
    assert importlib.metadata.version("iksel") == iksel.__version__


@pytest.mark.parametrize("name", PLACES)
def test_files_agree(name: str) -> None:
    path = ROOT / name
    if not path.is_file():
        pytest.skip(f"no {name} beside the tests")
    found = re.search(PLACES[name], path.read_text(encoding="utf-8"))
    assert found, f"{name} says no version"
    assert found[1] == iksel.__version__


def test_ros_1_and_2_have_the_same_service() -> None:
    packages = [ROOT / "ros/ros1/iksel_ros", ROOT / "ros/ros2/iksel_ros"]
    if not packages[0].is_dir():
        pytest.skip("no ros beside the tests")
    one, two = [(package / "srv/SolveIK.srv").read_text() for package in packages]
    assert one == two


def test_the_debian_package_has_the_name_of_its_library() -> None:
    path = ROOT / "packaging/debian/control"
    if not path.is_file():
        pytest.skip("no packaging beside the tests")
    control = path.read_text(encoding="utf-8")
    (version,) = re.findall(r"(?m)^Package: libiksel([0-9.]+)$", control)
    assert version == ".".join(iksel.__version__.split(".")[:2])


HOMES = {
    "pyproject.toml": r'(?m)^Homepage = "(.*)"$',
    "packaging/debian/control": r"(?m)^Homepage: (.*)$",
    "packaging/debian/copyright": r"(?m)^Source: (.*)$",
}


def test_the_address_of_the_project_is_one() -> None:
    if not (ROOT / "packaging").is_dir():
        pytest.skip("no packaging beside the tests")
    found = {
        home
        for name, pattern in HOMES.items()
        for home in re.findall(pattern, (ROOT / name).read_text("utf-8"))
    }
    (home,) = found
    project = (ROOT / "pyproject.toml").read_text("utf-8")
    owner = home.removeprefix("https://github.com/")
    addresses = re.findall(r"https://(?:raw\.)?github[\w.]*/([\w-]+/[\w-]+)", project)
    assert set(addresses) == {owner}


def test_all_is_there_sorted_and_complete() -> None:
    assert list(iksel.__all__) == sorted(set(iksel.__all__))
    for name in iksel.__all__:
        assert getattr(iksel, name) is not None
    errors = {
        name
        for name in dir(iksel_cpp)
        if isinstance(getattr(iksel_cpp, name), type)
        and issubclass(getattr(iksel_cpp, name), Exception)
    }
    assert errors <= set(iksel.__all__)


def test_every_public_thing_is_documented() -> None:
    for name in iksel.__all__:
        thing = getattr(iksel, name)
        if name != "__version__":
            assert thing.__doc__, name


def test_a_missing_extension_is_explained() -> None:
    program = "import sys; sys.modules['iksel_cpp'] = None; import iksel"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert "iksel needs its compiled extension module iksel_cpp" in done.stderr
    assert "pip install" in done.stderr
