# SPDX-License-Identifier: BSD-3-Clause
"""The command line: every command, its JSON, and one line for everything wrong."""

from __future__ import annotations

import importlib.metadata
import json
import math
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

import iksel
import iksel_cpp
from iksel import cli
from iksel.cli._output import Progress

COMMANDS = ["robots", "info", "solve", "build", "evaluate"]
EVALUATE_FIELDS = (
    "robot preset targets seed solved false_success success_percent mean_us std_us "
    "min_us max_us median_us p99_us kdl_fk_jac_us ratio position_tolerance "
    "rotation_tolerance threads simd"
).split()
STAGES = ["query_us", "rank_us", "iterate_us", "reselect_us"]
POSE = "0.2 0.15 0.3 0 3.1416 0"
FEW = ["--samples", "500"]


class Output(NamedTuple):
    code: int
    out: str
    err: str

    def json(self) -> Any:
        def refuse(constant: str) -> None:
            raise AssertionError(f"{constant} is no JSON")

        return json.loads(self.out, parse_constant=refuse)


Run = Callable[..., Output]


@pytest.fixture
def run(capfd: pytest.CaptureFixture[str]) -> Run:
    """Run the command line in this process; one string is split as a shell would."""

    def run_(*arguments: object) -> Output:
        words = [str(word) for word in arguments]
        if len(words) == 1:
            words = shlex.split(words[0])
        capfd.readouterr()
        code = cli.main(words)
        out, err = capfd.readouterr()
        return Output(code, out, err)

    return run_


@pytest.fixture
def urdf(tmp_path: Path) -> Path:
    path = tmp_path / "my arm.urdf"
    path.write_text(iksel.load_robot("ur3").urdf, encoding="utf-8")
    return path


def assert_good(output: Output, code: int = 0) -> Output:
    assert output.err == ""
    assert output.code == code
    return output


def assert_bad(output: Output, culprit: str) -> None:
    assert output.code == 2
    assert output.out == ""
    assert output.err.startswith("iksel: error: ")
    assert output.err.endswith("\n")
    assert output.err.count("\n") == 1
    assert re.search(culprit, output.err), output.err


def pose_words(pose: np.ndarray) -> list[str]:
    return [repr(x) for x in pose.ravel().tolist()]


def test_version(run: Run) -> None:
    assert assert_good(run("--version")).out == f"iksel {iksel.__version__}\n"


def test_entry_point_is_this_one() -> None:
    (entry,) = importlib.metadata.entry_points(group="console_scripts", name="iksel")
    assert entry.load() is cli.main


@pytest.mark.parametrize("command", ["", *COMMANDS])
def test_help_has_examples(run: Run, command: str) -> None:
    output = assert_good(run(f"{command} --help"))
    assert output.out.startswith("usage: iksel ")
    examples = output.out.partition("examples:\n")[2]
    assert f"iksel {command}".rstrip() in examples


def examples() -> list[str]:
    """The examples of all help texts that need no file of the user's."""
    texts = [cli.EXAMPLES, *(command.EXAMPLES for command in cli.COMMANDS)]
    lines = [line.strip() for text in texts for line in text.splitlines()]
    return [
        line.removeprefix("iksel ")
        for line in lines
        if line.startswith("iksel ") and ".urdf" not in line
    ]


@pytest.mark.parametrize("example", sorted(set(examples())))
def test_examples_work(
    run: Run, example: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    if example.startswith("evaluate"):
        example = re.sub(r" --targets \d+", "", example) + " --targets 20"
        if "panda" in example:
            example += " --scale small"
    assert_good(run(example))


# robots, info


def test_robots_lists_all(run: Run) -> None:
    lines = assert_good(run("robots")).out.splitlines()
    assert lines[0].split()[:4] == ["name", "dof", "maker", "licence"]
    assert [line.split()[0] for line in lines[1:]] == iksel.robot_names()
    listed = {robot["name"]: robot for robot in run("robots --json").json()["robots"]}
    assert list(listed) == iksel.robot_names()
    gen3 = listed["gen3_6dof"]
    assert gen3["dof"] == 6
    assert gen3["lower"][0] is None
    assert gen3["upper"][1] == iksel.load_robot("gen3_6dof").upper[1]
    assert all(robot["licence"] and robot["maker"] for robot in listed.values())


@pytest.mark.parametrize("name", iksel.robot_names())
def test_info_shows_every_robot(run: Run, made, name: str) -> None:
    robot = made.robot(name)
    text = assert_good(run("info", name)).out
    for joint in robot.joint_names:
        assert joint in text
    info = run("info", name, "--json").json()
    assert info["name"] == name
    assert info["dof"] == robot.dof
    assert [joint["name"] for joint in info["joints"]] == robot.joint_names
    assert (info["base_link"], info["tip_link"]) == (robot.base_link, robot.tip_link)
    np.testing.assert_array_equal(info["tcp"], robot.tcp)
    assert info["reach"] == robot.reach
    for i, joint in enumerate(info["joints"]):
        assert joint["type"] == robot.joint_types[i].name
        upper = None if math.isinf(robot.upper[i]) else robot.upper[i]
        assert joint["upper"] == upper
    assert info["source"] == iksel.robot_info(name).source


def test_info_of_a_file(run: Run, urdf: Path) -> None:
    info = run("info", urdf, "--base", "base_link", "--tip", "tool0", "--json").json()
    assert info["dof"] == 6
    assert "source" not in info
    locked = run(
        "info", urdf, "--tip", "tool0", "--lock", "wrist_3_joint=-1e-1", "--json"
    ).json()
    assert locked["dof"] == 5


def test_info_with_a_tool(run: Run) -> None:
    tool = run("info ur3 --tcp -1e-3,0,0.1,0,0,0 --json").json()["tcp"]
    expected = iksel.pose_from_euler([-1e-3, 0, 0.1], [0, 0, 0])
    np.testing.assert_array_equal(tool, expected)
    for words in ("info ur3 --tcp '0 0 .1 1 0 0 0' --json", "info cvr038 --tcp none"):
        assert_good(run(words))
    assert "tcp         none" in run("info cvr038 --tcp none").out
    soft = run("info panda --soft-limits --json").json()["joints"]
    assert soft[0]["upper"] == soft[0]["soft_upper"]


# solve


@pytest.mark.parametrize("form", ["euler", "quaternion", "matrix", "text", "commas"])
def test_solve_takes_each_form_of_a_pose(run: Run, made, form: str) -> None:
    robot = made.robot("ur3")
    pose = robot.fk([-0.3, -1.2, 1.5, -0.4, 0.9, 0.1])
    position = pose[:3, 3].tolist()
    words = {
        "euler": [*map(repr, position), *map(repr, iksel.euler_from_pose(pose).tolist())],
        "quaternion": [
            *map(repr, position),
            *map(repr, iksel.quaternion_from_pose(pose).tolist()),
        ],
        "matrix": pose_words(pose),
        "text": [str(pose.tolist())],
        "commas": [",".join(pose_words(pose))],
    }[form]
    answer = assert_good(run("solve", "ur3", "--pose", *words, *FEW, "--json")).json()
    np.testing.assert_allclose(answer["target"], pose, rtol=0, atol=1e-14)
    reached = robot.fk(answer["q"])
    position_error, rotation_error = iksel.pose_error(pose, reached)
    assert position_error <= 1e-6 + 1e-12
    assert rotation_error <= 1e-6 + 1e-12


def test_solve_reports_everything(run: Run) -> None:
    answer = run("solve ur3 --from-q 0.1 -1 1 0.2 0.3 -4e-1 --json").json()
    assert answer["success"] is True
    assert answer["status"] == "solved"
    assert answer["joint_names"] == iksel.load_robot("ur3").joint_names
    assert len(answer["q"]) == 6
    assert answer["attempts"] >= 1
    assert answer["time_us"] > 0
    text = assert_good(run("solve ur3 --from-q 0.1 -1 1 0.2 0.3 -0.4")).out
    for word in ("solved", "rad", "deg", "wrist_3_joint", "us", "position error"):
        assert word in text


def test_solve_from_a_seed(run: Run) -> None:
    q = "0.1 -1 1 0.2 0.3 -0.4"
    answer = run(f"solve ur3 --from-q {q} --seed-q {q} --json").json()
    np.testing.assert_allclose(answer["q"], [0.1, -1, 1, 0.2, 0.3, -0.4], atol=1e-9)


def test_solve_without_solution(run: Run) -> None:
    output = run("solve", "ur3", "--pose", *"9 0 0 0 0 0".split(), *FEW)
    assert_good(output, code=1)
    assert "out_of_reach" in output.out
    answer = run("solve", "ur3", "--pose", *"9 0 0 0 0 0".split(), *FEW, "--json")
    assert answer.code == 1
    assert answer.json()["q"] is None
    assert answer.json()["position_error"] is None
    assert answer.json()["success"] is False


def test_solve_with_a_file_of_ones_own(run: Run, urdf: Path) -> None:
    words = ["--base", "base_link", "--tip", "tool0", "--tcp", "0", "0", "0.1", "0", "0"]
    q = ["0.1", "-1", "1", "0.2", "0.3", "-0.4"]
    answer = run("solve", urdf, *words, "0", "--from-q", *q, *FEW, "--json")
    assert_good(answer)
    assert answer.json()["success"]


def test_every_option_is_a_flag(run: Run) -> None:
    words = ["solve", "ur3", "--from-q", *"0.1 -1 1 0.2 0.3 -0.4".split(), "--json"]
    options = iksel.SolverOptions(database=iksel.DatabaseOptions(samples=500)).to_dict()
    renamed = {
        ("solver", "seed"): "--solver-seed",
        ("database", "seed"): "--database-seed",
        ("database", "pinv_cutoff"): "--database-pinv-cutoff",
        ("database", "threads"): "--database-threads",
    }
    for group, fields in (("solver", options), ("database", options["database"])):
        for field, value in fields.items():
            if isinstance(value, dict):
                continue
            flag = renamed.get((group, field), "--" + field.replace("_", "-"))
            if isinstance(value, bool):
                words.append(flag if value else flag.replace("--", "--no-", 1))
            else:
                words += [flag, str(value)]
    assert assert_good(run(*words)).json()["success"]


# build, evaluate


def test_build_writes_what_it_says(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "ur3.iksel"
    words = ["build", "ur3", "-o", path, "--sampling", "random", "--samples", "700"]
    report = assert_good(run(*words, "--database-seed", "9", "--json")).json()
    database = iksel.Database.load(path)
    assert report["samples"] == len(database) == 700
    assert report["bytes"] == path.stat().st_size
    assert report["options"]["sampling"] == database.options.sampling.name == "random"
    assert database.options.seed == 9
    text = assert_good(run(*words)).out
    assert "700" in text
    assert "MB" in text
    answer = run("solve", "ur3", "--database", path, "--from-q", *"000000", "--json")
    assert assert_good(answer).json()["success"]


def test_build_by_the_paper(run: Run, tmp_path: Path) -> None:
    words = ["build", "cvr038", "-o", tmp_path / "file", "--preset", "paper", "--json"]
    assert run(*words).json()["samples"] == 40_320
    assert run(*words, "--scale", "small").json()["samples"] == 12_000


def test_progress_is_shown_if_asked_for(run: Run, tmp_path: Path) -> None:
    words = ["build", "ur3", "-o", tmp_path / "file", *FEW]
    assert run(*words).err == ""
    assert run(*words, "--no-progress").err == ""
    shown = run(*words, "--progress")
    assert shown.code == 0
    assert shown.err.endswith("100%\n")
    words = ["evaluate", "ur3", "--targets", "50", *FEW, "--progress", "--json"]
    shown = run(*words)
    assert "solving" in shown.err
    assert shown.json()["targets"] == 50


def test_progress_draws_a_bar(capfd: pytest.CaptureFixture[str]) -> None:
    with Progress("working", show=True) as tell:
        assert tell is not None
        tell(0, 4)
        tell(4, 4)
    assert capfd.readouterr().err.replace("\r", "\n").splitlines() == [
        "",
        f"working [{' ' * 30}]   0%",
        f"working [{'#' * 30}] 100%",
    ]
    with Progress("working", show=None) as tell:
        assert tell is None
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize("preset", ["default", "paper"])
def test_evaluate_prints_the_fields(run: Run, preset: str) -> None:
    words = f"evaluate cvr038 --preset {preset} --targets 200 --seed 3 --json"
    report = assert_good(run(words)).json()
    assert set(EVALUATE_FIELDS) <= set(report)
    assert not set(STAGES) & set(report)
    assert report["robot"] == "cvr038"
    assert report["preset"] == preset
    assert (report["targets"], report["seed"], report["threads"]) == (200, 3, 1)
    assert report["false_success"] == 0
    assert report["success_percent"] == pytest.approx(report["solved"] / 2)
    assert report["solved"] > 100
    assert report["min_us"] <= report["median_us"] <= report["p99_us"] <= report["max_us"]
    assert report["ratio"] == pytest.approx(report["mean_us"] / report["kdl_fk_jac_us"])
    assert report["mean_attempts"] >= 1
    assert report["mean_iterations"] > 0
    assert report["build_s"] > 0
    paper = preset == "paper"
    assert report["position_tolerance"] == (1e-4 if paper else 1e-6)
    assert report["database_samples"] == (40_320 if paper else 10_000)
    assert report["overrides"] == {}
    # The counts do not depend on the run, only the times do.
    again = run(words).json()
    for field in ("solved", "mean_attempts", "mean_iterations"):
        assert again[field] == report[field]


def test_evaluate_with_stages_and_changes(run: Run, tmp_path: Path) -> None:
    words = (
        "evaluate cvr038 --preset paper --targets 100 --stages --iteration cwln "
        "--max-attempts 6 --sampling cvt --samples 3000 --cvt-updates 5000"
    )
    report = assert_good(run(words + " --json")).json()
    assert all(report[stage] >= 0 for stage in STAGES)
    assert report["query_us"] > 0
    assert report["overrides"] == {
        "iteration": "cwln",
        "max_attempts": 6,
        "database.sampling": "cvt",
        "database.samples": 3000,
        "database.cvt_updates": 5000,
    }
    assert report["database_samples"] == 3000
    text = assert_good(run(words)).out
    for word in ("solved", "ratio", "query", "iteration=cwln", "median time", "KDL"):
        assert word in text


def test_evaluate_with_a_file(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "file"
    run("build", "ur3", "-o", path, *FEW)
    words = ["evaluate", "ur3", "--targets", "50", "--database", path]
    report = assert_good(run(*words, "--json")).json()
    assert report["database_samples"] == 500
    assert report["build_s"] is None
    assert "from file" in assert_good(run(*words)).out


def test_simd_is_what_the_core_says(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(iksel_cpp, "simd_level", "avx512", raising=False)
    words = ["evaluate", "ur3", "--targets", "10", *FEW, "--json"]
    assert run(*words).json()["simd"] == "avx512"


# What goes wrong

BAD = [
    ("", "COMMAND"),
    ("sovle ur3", "sovle.*robots.*info.*solve.*build.*evaluate"),
    ("--frobnicate", "COMMAND|frobnicate"),
    ("robots ur3", "unrecognized arguments: ur3"),
    ("info", "ROBOT"),
    ("info ur33", "no built-in robot 'ur33'; did you mean ur3.*panda.*URDF file"),
    ("info absent.urdf", r"absent\.urdf"),
    ("info ./absent", "'absent'"),
    ("info arm.urdf.xacro", r"xacro arm\.urdf\.xacro"),
    ("info ur3 --tip hand", "'hand'.*tool0"),
    ("info ur3 --base hand", "'hand'.*base_link"),
    ("info ur3 --tip base_link", "base_link"),
    ("info ur3 --tcp 1 2 3", "--tcp: expected 6 numbers.*got 3"),
    ("info ur3 --tcp 0 0 0 1 1 1 1", "--tcp: quaternion_wxyz: expected norm 1"),
    ("info ur3 --tcp a", "--tcp: not all numbers in 'a'"),
    ("info ur3 --lock elbow", "--lock: expected JOINT=VALUE, got 'elbow'"),
    ("info ur3 --lock =1", "--lock: expected JOINT=VALUE, got '=1'"),
    ("info ur3 --lock elbow_joint=", "--lock: expected JOINT=VALUE"),
    ("info ur3 --lock elbow_joint=x", "--lock elbow_joint=x: not all numbers"),
    ("info ur3 --lock elbow_joint=nan", "elbow_joint"),
    ("info ur3 --lock elbow=1", "'elbow'.*elbow_joint"),
    ("info ur3 --jso", "--jso"),
    ("solve ur3", "--pose.*--from-q"),
    ("solve ur3 --pose", "--pose"),
    (f"solve ur3 --pose {POSE} --from-q 0 0 0 0 0 0", "not allowed with"),
    ("solve ur3 --pose 1 2 3 4 5", "--pose: expected 6 numbers.*7.*16.*got 5"),
    ("solve ur3 --pose 1 2 3 4 5 x", "--pose: not all numbers in '1 2 3 4 5 x'"),
    ("solve ur3 --pose 1 2 3 4 5 nan", "--pose: rpy: not finite: nan"),
    ("solve ur3 --pose -inf 2 3 4 5 6", "--pose: position: not finite: -inf"),
    ("solve ur3 --pose 0 0 0 1 0 0 1", "--pose: quaternion_wxyz: .*1.414"),
    ("solve ur3 --pose" + " 1" * 16, "--pose: pose: not rigid"),
    ("solve ur3 --from-q 1 2 3", "--from-q: expected 6 numbers.*elbow_joint.*got 3"),
    ("solve ur3 --from-q 1 2 3 4 5 inf", "q"),
    (f"solve ur3 --pose {POSE} --seed-q 1", "--seed-q: expected 6 numbers.*got 1"),
    (f"solve ur3 --pose {POSE} --preset fast", "fast.*default.*paper"),
    (f"solve ur3 --pose {POSE} --iteration newton", "newton.*dls.*pinv.*cwln.*lm"),
    (f"solve ur3 --pose {POSE} --sampling sobol", "sobol.*grid.*cvt.*random"),
    (f"solve ur3 --pose {POSE} --max-attempts many", "--max-attempts.*'many'"),
    (f"solve ur3 --pose {POSE} --max-attempts 0", "max_attempts"),
    (f"solve ur3 --pose {POSE} --max-attempts {10**30}", "max_attempts"),
    (f"solve ur3 --pose {POSE} --position-tolerance -1", "position_tolerance"),
    (f"solve ur3 --pose {POSE} --position-tolerance nan", "position_tolerance"),
    (f"solve ur3 --pose {POSE} --solver-seed -1", "seed"),
    (f"solve ur3 --pose {POSE} --samples -1", "samples"),
    (f"solve ur3 --pose {POSE} --database absent.iksel", r"absent\.iksel"),
    (
        f"solve ur3 --pose {POSE} --database x --samples 9 --scale small",
        "--samples, --scale: cannot be used with --database",
    ),
    ("build ur3", "-o/--output"),
    ("build ur3 -o absent/file --samples 50", "absent/file.*No such file"),
    ("build ur3 -o . --samples 50", "database '.'"),
    ("build ur3 -o x --max-attempts 3", "unrecognized arguments"),
    ("build ur3 -o x --rotation-weight 0", "rotation_weight"),
    ("evaluate ur3 --targets 0", "--targets: 0 is less than 1"),
    ("evaluate ur3 --targets 1.5", "--targets"),
    ("evaluate ur3 --seed -1", "--seed: -1 is not between 0 and"),
    (f"evaluate ur3 --seed {2**64}", "--seed"),
]


@pytest.mark.parametrize(("words", "culprit"), BAD)
def test_bad_input_is_one_line(
    run: Run,
    words: str,
    culprit: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert_bad(run(words), culprit)
    assert list(tmp_path.iterdir()) == []


def test_bad_files_are_one_line(run: Run, tmp_path: Path, urdf: Path) -> None:
    assert_bad(run("info", urdf, "--tip", "hand"), "hand")
    broken = tmp_path / "broken.urdf"
    broken.write_text("<robot", encoding="utf-8")
    assert_bad(run("info", broken), "URDF does not parse")
    database = tmp_path / "other.iksel"
    run("build", "panda", "-o", database, *FEW)
    words = ["solve", "ur3", "--pose", *POSE.split(), "--database", database]
    assert_bad(run(*words), "another chain")
    database.write_bytes(database.read_bytes()[:-1])
    assert_bad(run(*words), r"other\.iksel.*truncated")
    database.write_bytes(b"")
    assert_bad(run(*words), r"other\.iksel.*truncated")


def test_line_breaks_in_names_stay_inside_the_line(run: Run) -> None:
    assert_bad(run("info", "a\nb"), "robot")
    assert_bad(run("info", "ur3", "--tip", "a\nb"), "link")


def test_no_memory_is_one_line(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(_: object) -> int:
        raise MemoryError

    monkeypatch.setattr(cli.robots, "run", fail)
    assert_bad(run("robots"), "memory")


def test_interruption_is_quiet(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(_: object) -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr(cli.robots, "run", interrupt)
    assert run("robots") == Output(130, "", "")


def start(*words: str, **settings: Any) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "iksel", *words],
        stderr=subprocess.PIPE,
        text=True,
        **settings,
    )


def test_module_is_the_command_line() -> None:
    process = start("robots", "--json", stdout=subprocess.PIPE)
    out, err = process.communicate()
    assert (process.returncode, err) == (0, "")
    assert len(json.loads(out)["robots"]) == len(iksel.robot_names())
    process = start("info", "nobody", stdout=subprocess.PIPE)
    out, err = process.communicate()
    assert_bad(Output(process.returncode, out, err), "nobody")


def test_a_reader_that_goes_away_is_no_error() -> None:
    reading, writing = os.pipe()
    os.close(reading)
    process = start("robots", "--json", stdout=writing)
    os.close(writing)
    _, err = process.communicate()
    assert err == ""
    assert process.returncode == 141


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_output_that_cannot_be_written_is_an_error() -> None:
    with Path("/dev/full").open("w", encoding="utf-8") as full:
        process = start("robots", stdout=full)
        _, err = process.communicate()
    assert_bad(Output(process.returncode, "", err), "cannot write the output: .*space")
