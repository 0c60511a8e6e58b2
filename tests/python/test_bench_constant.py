# SPDX-License-Identifier: BSD-3-Clause
"""The command that tries other values of a constant. Nothing is compiled. No times."""

from __future__ import annotations

import json

import pytest

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench import command
from bench.constant import asked
from bench.constant.command import beside, compared
from bench.constant.variant import Constant, constants, find, patched


def test_all_constants_are_known():
    known = constants()
    assert len({(constant.file, constant.name) for constant in known}) > 200
    assert Constant("cpp/src/base/constants.hpp", "kMaxMovingJoints", "64") in known


def test_a_constant_is_found_by_its_name_and_file():
    constant = find("sweep.cpp:kEvery")
    assert (constant.file, constant.name) == ("cpp/src/seeds/sweep.cpp", "kEvery")


@pytest.mark.parametrize("wanted", ["kNoneSuch", "sweep.cpp:kNoneSuch"])
def test_an_unknown_constant_is_refused_with_what_there_is(wanted):
    with pytest.raises(SystemExit, match=f"no constants {wanted} .*sweep.cpp:kEvery"):
        find(wanted)


def test_a_name_of_several_is_refused_with_their_files():
    with pytest.raises(SystemExit, match=r"constants kRounds .*root_sweep.cpp:kRounds"):
        find("kRounds")


def test_one_definition_is_changed():
    text = "constexpr double kFar = 1e4;  // [rad]\nint kFarther = 1;\n"
    assert patched(text, "kFar", "2.5") == text.replace("1e4", "2.5")
    with pytest.raises(ValueError, match="0 times"):
        patched(text, "kNear", "1")


@pytest.mark.parametrize(
    ("value", "others"),
    [
        ("0.25", ["0.75", "0.0833333"]),
        ("4", ["12", "1"]),
        ("3e-4F", ["0.0009", "0.0001"]),
    ],
)
def test_three_times_and_a_third_are_tried(value, others):
    assert beside(Constant("a.cpp", "kA", value)) == others


def test_values_of_what_is_no_number_must_be_given():
    with pytest.raises(SystemExit, match="kA is 4 \\* kWidth: say which values"):
        beside(Constant("a.cpp", "kA", "4 * kWidth"))


@pytest.mark.parametrize("build", ["srs", "offset_wrist", "rail"])
def test_answers_are_the_same_again(build, capsys):
    asked.main("1", "31000", "1", build)
    first = json.loads(capsys.readouterr().out)
    asked.main("1", "31000", "1", build)
    again = json.loads(capsys.readouterr().out)
    batch = "batch, 6" if build == "offset_wrist" else "batch, 7"
    assert first[batch]["failed"] == 0
    for kind, row in first.items():
        assert row["asked"] > 0, kind
        assert again[kind] | {"cpu_s": 0} == row | {"cpu_s": 0}, kind


def test_the_table_says_what_changed():
    row = {"asked": 5, "failed": 1, "hash": "a", "cpu_s": 2.0}
    other = row | {"failed": 2, "hash": "b", "cpu_s": 3.0}
    text = compared({"near": row}, {"3": {"near": other}})
    assert text.splitlines()[-1] == "| near | 5 | 1 | 2 | yes | 1.50 |"


def test_the_command_is_known():
    options = command.parser().parse_args(["constant", "kEvery", "2", "8"])
    assert options.values == ["2", "8"]
