# SPDX-License-Identifier: BSD-3-Clause
"""The C++ library that lies in the package, for programs of others."""

from __future__ import annotations

from pathlib import Path

from iksel_cpp import Error


class NoCMakeFilesError(Error, FileNotFoundError):
    """This iksel was installed without its C++ library."""


def cmake_dir() -> Path:
    """Folder with ikselConfig.cmake, for find_package(iksel) of C++ programs.

        cmake -S . -B build -DCMAKE_PREFIX_PATH="$(python -c '...')"

    with `import iksel; print(iksel.cmake_dir())` for the dots. What is found is the
    library that this package itself runs on; it needs Eigen 3.4 and nothing else.

    Raises:
        NoCMakeFilesError: The package has no C++ library: one made by
            scripts/bootstrap.sh, for example, where it is a part of the extension.
            It is an iksel.Error and a FileNotFoundError.
    """
    folder = Path(__file__).resolve().parents[1] / "lib" / "cmake" / "iksel"
    if not (folder / "ikselConfig.cmake").is_file():
        raise NoCMakeFilesError(
            f"{folder} has no ikselConfig.cmake: this iksel was installed without its "
            "C++ library. Install a wheel of it, or from the source "
            "('pip install .' at the top of the repository, not editable), or the "
            "library alone by CMake, and give its prefix to CMAKE_PREFIX_PATH"
        )
    return folder
