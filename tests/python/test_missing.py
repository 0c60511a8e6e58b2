# SPDX-License-Identifier: BSD-3-Clause
"""An import that fails says what to install."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import iksel
from iksel._base.missing import explain

LOADER = "{}: cannot open shared object file: No such file or directory"


@pytest.mark.parametrize(
    ("library", "package"),
    [
        ("liborocos-kdl.so.1.5", "liborocos-kdl-dev"),
        ("liburdfdom_model.so.3.0", "liburdfdom-dev"),
        ("liburdfdom_world.so.4.0", "liburdfdom-dev"),
        ("libconsole_bridge.so.1.0", "libconsole-bridge-dev"),
        ("libtinyxml2.so.9", "libtinyxml2-dev"),
        ("libtinyxml.so.2.6.2", "libtinyxml-dev"),
        ("libstdc++.so.6", "libstdc++6"),
    ],
)
def test_a_missing_library_is_named_with_its_package(library, package) -> None:
    text = explain(LOADER.format(library))
    assert f"the shared library {library}," in text
    assert f"'apt-get install {package}'" in text


def test_other_libraries_are_named() -> None:
    text = explain("/opt/libfoo.so.3: undefined symbol: bar")
    assert "libfoo.so.3" in text
    assert "undefined symbol" in text


def test_an_extension_that_is_not_built_is_named() -> None:
    assert "pip install ." in explain("No module named 'iksel_cpp'")


def test_its_own_library_comes_with_the_package() -> None:
    text = explain(LOADER.format("libiksel.so.0.1"))
    assert "libiksel.so.0.1" in text
    assert "pip install ." in text
    assert "apt" not in text


@pytest.mark.parametrize("library", ["liborocos-kdl.so.1.5", "liburdfdom_model.so.3.0"])
def test_importing_iksel_says_it(tmp_path: Path, library: str) -> None:
    message = LOADER.format(library)
    (tmp_path / "iksel_cpp.py").write_text(f"raise ImportError({message!r})\n")
    source = Path(iksel.__file__).parents[1]
    program = f"import sys; sys.path[:0] = {[str(tmp_path), str(source)]}; import iksel"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert f"ImportError: iksel needs the shared library {library}" in done.stderr
    assert "apt-get install" in done.stderr


def test_an_interrupt_while_it_is_imported_is_one(tmp_path: Path) -> None:
    """The extension module makes an ImportError of it, as all do."""
    failing = "try: raise KeyboardInterrupt\nexcept BaseException as e: {}\n".format(
        "raise ImportError('initialization failed') from e"
    )
    (tmp_path / "iksel_cpp.py").write_text(failing)
    source = Path(iksel.__file__).parents[1]
    program = f"import sys; sys.path[:0] = {[str(tmp_path), str(source)]}; import iksel"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert done.stderr.rstrip().endswith("KeyboardInterrupt")
