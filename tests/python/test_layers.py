# SPDX-License-Identifier: BSD-3-Clause
"""The check that folders of cpp/src include only what stands below them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / "scripts" / "check_layers.py"


@pytest.fixture
def check(tmp_path: Path):
    """What the script says of sources that are given by their includes."""

    def check_(**includes: str) -> str:
        for name, line in includes.items():
            file = tmp_path / name.replace("__", "/").replace("_cpp", ".cpp")
            file.parent.mkdir(exist_ok=True)
            file.write_text(f"// A comment.\n#include {line}\n", encoding="utf-8")
        done = subprocess.run(
            [sys.executable, SCRIPT, tmp_path],
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == (1 if done.stdout else 0), done.stderr
        return done.stdout

    return check_


@pytest.mark.parametrize(
    "line",
    ['"base/hash.hpp"', '"search/x.hpp"', '"iksel/solver.hpp"', "<Eigen/Core>"],
)
def test_what_stands_below_is_allowed(check, line: str) -> None:
    assert check(search__a_cpp=line) == ""


@pytest.mark.parametrize("line", ['"solver/x.hpp"', '"evaluation/x.hpp"'])
def test_what_stands_above_is_found(check, line: str) -> None:
    found = check(search__a_cpp=line)
    assert found.startswith("search/a.cpp: search stands below ")


def test_folders_without_a_place_are_found(check) -> None:
    assert "'util' is no folder of base," in check(util__a_cpp="<vector>")
    assert "'a.cpp' is no folder" in check(a_cpp="<vector>")
    assert "util/x.hpp is in no folder" in check(base__a_cpp='"util/x.hpp"')


@pytest.mark.parametrize("line", ["<kdl/chain.hpp>", "<urdf_model/joint.h>"])
def test_kdl_and_urdfdom_have_their_place(check, line: str) -> None:
    assert check(urdf__a_cpp=line, kinematics__a_cpp=line) == ""
    assert "urdf and kinematics only" in check(database__a_cpp=line)
