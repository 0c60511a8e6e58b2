# SPDX-License-Identifier: BSD-3-Clause
"""Where C++ programs find the library, and what is said where it is not."""

from __future__ import annotations

from pathlib import Path

import pytest

import iksel
from iksel._base import cmake


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package's folder with its C++ library."""
    config = tmp_path / "lib/cmake/iksel/ikselConfig.cmake"
    config.parent.mkdir(parents=True)
    config.touch()
    monkeypatch.setattr(cmake, "__file__", str(tmp_path / "_base" / "cmake.py"))
    return tmp_path


def test_it_is_the_folder_of_the_config_file(package: Path) -> None:
    assert iksel.cmake_dir() == package / "lib/cmake/iksel"


def test_printed_it_is_what_cmake_takes(package: Path) -> None:
    assert str(iksel.cmake_dir()) == f"{package}/lib/cmake/iksel"


def test_a_package_without_the_library_says_what_to_do(package: Path) -> None:
    (package / "lib/cmake/iksel/ikselConfig.cmake").unlink()
    with pytest.raises(iksel.Error, match="ikselConfig.cmake") as raised:
        iksel.cmake_dir()
    assert isinstance(raised.value, FileNotFoundError)
    for needed in (str(package), "pip install", "CMAKE_PREFIX_PATH"):
        assert needed in str(raised.value)


def test_the_installed_package_has_it_or_says_so() -> None:
    installed = Path(iksel.__file__).resolve().parent / "lib/cmake/iksel"
    if installed.is_dir():
        files = {file.name for file in iksel.cmake_dir().iterdir()}
        assert {"ikselConfig.cmake", "ikselTargets.cmake"} <= files
    else:
        with pytest.raises(iksel.Error, match="without its C\\+\\+ library"):
            iksel.cmake_dir()
