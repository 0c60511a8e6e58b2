# SPDX-License-Identifier: BSD-3-Clause
"""The command line: every command, its text and its JSON."""

from __future__ import annotations

import importlib.metadata
import io
import math
import re
import shlex
from collections.abc import Iterable
from pathlib import Path

import iksel_cpp
import numpy as np
import pytest
from command_line import Run, assert_good

import iksel
from iksel import cli
from iksel.cli._output import Progress

COMMANDS = ["robots", "info", "fk", "jacobian", "solve", "path", "plot", "view"]
COMMANDS += ["build", "evaluate", "reach", "dataset"]
EVALUATE_FIELDS = """
    robot preset targets seed solved false_success success_percent mean_us std_us
    min_us max_us median_us p99_us kdl_fk_jac_us ratio position_tolerance
    rotation_tolerance threads simd
"""
STAGES = ["query_us", "rank_us", "iterate_us", "reselect_us"]
FAR = ["--pose", "9 0 0 0 0 0"]
Q = ["0.1", "-1", "1", "0.2", "0.3", "-0.4"]
FEW = ["--samples", "500"]


@pytest.fixture
def urdf(tmp_path: Path) -> Path:
    path = tmp_path / "my arm.urdf"
    path.write_text(iksel.load_robot("ur3").urdf, encoding="utf-8")
    return path


def texts(numbers: Iterable[float]) -> list[str]:
    return [repr(float(number)) for number in numbers]


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
    """The examples of all help texts that need no file of the user's, and no extra."""
    # Theirs are tried in test_reach_cli.py and test_view_cli.py.
    with_extra = (cli.reach, cli.dataset, cli.view)
    commands = [command for command in cli.COMMANDS if command not in with_extra]
    texts = [cli.EXAMPLES, *(command.EXAMPLES for command in commands)]
    lines = [line.strip() for text in texts for line in text.splitlines()]
    return [
        line.removeprefix("iksel ")
        for line in lines
        if line.startswith("iksel ")
        and not re.search(r"\.urdf|\.xml|rd:|\.zarr|iksel view", line)
    ]


@pytest.mark.parametrize("example", sorted(set(examples())))
def test_examples_work(
    run: Run, example: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    pose = iksel.load_robot("ur3").fk([0.3, -1.2, 1.4, -0.6, 1.2, 0.2])
    for name in ("poses.txt", "poses.csv", "poses.jsonl"):
        Path(name).write_text(" ".join(texts(pose.ravel())), encoding="utf-8")
    if example.startswith("evaluate"):
        example = re.sub(r" --targets \d+", "", example) + " --targets 20"
        if "panda" in example:
            example += " --scale small"
    is_no = "--diagnose" in example or "--closest" in example
    assert_good(run(example), 1 if is_no else 0)


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
    assert f"structure   {robot.structure.description}\n" in text
    assert info["structure"] == {
        "kind": robot.structure.kind.name,
        "description": robot.structure.description,
    }
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
    position = pose[:3, 3]
    words = {
        "euler": texts([*position, *iksel.euler_from_pose(pose)]),
        "quaternion": texts([*position, *iksel.quaternion_from_pose(pose)]),
        "matrix": texts(pose.ravel()),
        "text": [str(pose.tolist())],
        "commas": [",".join(texts(pose.ravel()))],
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
    assert answer["proof"] == "answer"
    assert answer["joint_names"] == iksel.load_robot("ur3").joint_names
    assert len(answer["q"]) == 6
    assert answer["attempts"] >= 1
    assert answer["time_us"] > 0
    text = assert_good(run("solve ur3 --from-q 0.1 -1 1 0.2 0.3 -0.4")).out
    for word in ("solved", "rad", "deg", "wrist_3_joint", "us", "position error"):
        assert word in text
    assert "proof" not in text


def test_solve_from_a_seed(run: Run) -> None:
    q = "0.1 -1 1 0.2 0.3 -0.4"
    answer = run(f"solve ur3 --from-q {q} --seed-q {q} --json").json()
    assert answer["attempts"] == 1
    answer = run(f"solve ur3 --from-q {q} --seed-q {q} --near {q} --json").json()
    np.testing.assert_allclose(answer["q"], [0.1, -1, 1, 0.2, 0.3, -0.4], atol=1e-9)
    found = run(f"solve ur3 --from-q {q} --seed-q {q} --all --json").json()
    assert len(found["q"]) > 1
    words = f"solve ur3 --from-q {q} --seed-q 1 1 1 1 1 1 --max-iterations 1 --json"
    assert run(words).json()["success"]
    alone = run(f"{words} --no-database-seeds").json()
    assert (alone["success"], alone["attempts"]) == (False, 1)


def test_solve_without_solution(run: Run) -> None:
    output = run("solve", "ur3", *FAR, *FEW)
    assert_good(output, code=1)
    assert "out_of_reach" in output.out
    assert "proof       reach: certainly there is no solution\n" in output.out
    answer = run("solve", "ur3", *FAR, *FEW, "--json")
    assert answer.code == 1
    assert answer.json()["q"] is None
    assert answer.json()["position_error"] is None
    assert answer.json()["success"] is False
    assert answer.json()["proof"] == "reach"


def test_solve_with_a_file_of_ones_own(run: Run, urdf: Path) -> None:
    words = shlex.split("--base base_link --tip tool0 --tcp 0 0 0.1 0 0 0")
    answer = run("solve", urdf, *words, "--from-q", *Q, *FEW, "--json")
    assert_good(answer)
    assert answer.json()["success"]


def test_every_option_is_a_flag(run: Run) -> None:
    words = ["solve", "ur3", "--from-q", *Q, "--json", "--strategy", "paper"]
    database = iksel.DatabaseOptions(samples=0, scale="small")
    options = iksel.SolverOptions(database=database).to_dict()
    strategy = iksel.Paper().to_dict()
    renamed = {
        ("solver", "seed"): "--solver-seed",
        ("database", "seed"): "--database-seed",
        ("database", "pinv_cutoff"): "--database-pinv-cutoff",
        ("database", "threads"): "--database-threads",
    }
    for group, fields in (
        ("solver", options),
        ("strategy", strategy),
        ("database", options["database"]),
    ):
        for field, value in fields.items():
            if isinstance(value, dict):
                continue
            flag = renamed.get((group, field), "--" + field.replace("_", "-"))
            if isinstance(value, bool):
                words.append(flag if value else flag.replace("--", "--no-", 1))
            else:
                words += [flag, str(value)]
    assert assert_good(run(*words)).json()["success"]


def test_flags_that_the_strategy_does_not_read_are_refused(run: Run) -> None:
    words = ["solve", "ur3", "--from-q", *Q]
    answer = run(*words, "--ranking", "nearest")
    assert answer.code == 2
    assert "--ranking: the strategy 'lanes' does not read it" in answer.err
    assert "--strategy paper" in answer.err
    assert_good(run(*words, "--strategy", "paper", "--ranking", "nearest"))
    assert_good(run(*words, "--preset", "paper", "--ranking", "nearest"))
    assert_good(run(*words, "--neighbours", "100", "--damping", "0.01"))
    answer = run(*words, "--preset", "paper", "--limit-margin", "0.2")
    assert answer.code == 2
    assert "limit_margin: only read by iteration 'cwln' and 'cwpi'" in answer.err


def test_solve_near(run: Run, made) -> None:
    here = [0.1, -1, 1, 0.2, 0.3, -0.4 + 2 * math.pi]
    words = ["solve", "ur3", "--from-q", *Q, "--near", *texts(here)]
    answer = assert_good(run(*words, "--json")).json()
    np.testing.assert_allclose(answer["q"], here, atol=1e-4)
    assert answer["move"] < 1e-3
    assert "move" in assert_good(run(*words)).out
    assert run("solve", "ur3", "--from-q", *Q, "--json").json()["move"] is None


def test_solve_all_by_an_objective(run: Run) -> None:
    words = ["solve", "ur3", "--from-q", *Q, "--all", "--json"]
    plain = assert_good(run(*words)).json()
    assert plain["cost"] == [None] * 8
    for objective in ("limits", "manipulability"):
        found = assert_good(run(*words, "--objective", objective)).json()
        assert len(found["q"]) == 8
        assert found["cost"] == sorted(found["cost"])


def test_solve_all(run: Run, made) -> None:
    words = ["solve", "ur3", "--from-q", *Q, "--all"]
    answer = assert_good(run(*words, "--json")).json()
    target = np.array(answer["target"])
    assert answer["success"] is True
    assert len(answer["q"]) == len(answer["position_error"]) == 8
    for q in answer["q"]:
        assert iksel.pose_error(made.robot("ur3").fk(q), target)[0] <= 1e-6 + 1e-12
    near = assert_good(run(*words, "--near", *Q, "--json")).json()
    np.testing.assert_allclose(near["q"][0], [float(x) for x in Q], atol=1e-4)
    assert near["move"] == sorted(near["move"])
    text = assert_good(run(*words)).out
    assert "solutions  8" in text
    assert answer["proof"] in {"answer", "closed_form"}
    assert "wrist_3_joint" in text
    nothing = assert_good(run("solve", "ur3", *FAR, "--all", "--json"), code=1).json()
    assert (nothing["q"], nothing["status"]) == ([], "out_of_reach")
    assert nothing["proof"] == "reach"
    assert "wrist_3" not in run("solve", "ur3", *FAR, "--all").out


# path


@pytest.fixture
def poses(tmp_path: Path, made) -> Path:
    """A file of 20 poses from Q, 2 mm apart, in several forms."""
    lines = ["# a straight line", ""]
    pose = made.robot("ur3").fk([float(x) for x in Q])
    for i in range(20):
        pose[2, 3] += 0.002
        position, angles = pose[:3, 3], iksel.euler_from_pose(pose)
        quaternion = iksel.quaternion_from_pose(pose)
        form = [pose.ravel(), [*position, *angles], [*position, *quaternion]][i % 3]
        lines.append((" " if i % 2 else ", ").join(texts(form)))
    path = tmp_path / "poses.txt"
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def test_path_of_a_file(run: Run, made, poses: Path) -> None:
    robot = made.robot("ur3")
    words = ["path", "ur3", poses, "--start", *Q, "--dt", "0.01"]
    answer = assert_good(run(*words, "--json")).json()
    assert answer["success"] is True
    assert answer["first_unreachable"] is None
    assert answer["joint_names"] == robot.joint_names
    q = np.array(answer["q"])
    assert q.shape == (20, 6)
    steps = np.abs(np.diff(q, axis=0, prepend=[[float(x) for x in Q]]))
    assert (steps <= robot.velocity_limit * 0.01 * (1 + 1e-8)).all()
    assert answer["largest_step"] == steps.max()
    heights = robot.fk(q)[:, 2, 3]
    np.testing.assert_allclose(np.diff(heights), 0.002, atol=3e-6)
    text = assert_good(run(*words)).out
    for word in ("waypoints     20", "solved", "largest step", "wrist_3_joint"):
        assert word in text
    assert "first unreachable" not in text


def test_path_with_settings(run: Run, poses: Path, tmp_path: Path) -> None:
    file = tmp_path / "ur3.iksel"
    assert_good(run("build", "ur3", "-o", file, *FEW))
    words = ["path", "ur3", poses, "--json"]
    assert_good(run(*words, "--database", file, "--position-tolerance", "1e-5"))
    assert_good(run(*words, "--database", file, "--mmap"))
    assert "absent" in run(*words, "--database", tmp_path / "absent").err
    assert_good(run(*words, "--preset", "paper", "--scale", "small"))


def test_path_that_breaks(run: Run, poses: Path) -> None:
    with poses.open("a", encoding="utf-8") as file:
        file.write("\n9 0 0 0 0 0\n")
    answer = assert_good(run("path", "ur3", poses, "--json"), code=1).json()
    assert (answer["first_unreachable"], answer["status"]) == (20, "out_of_reach")
    assert len(answer["q"]) == 20
    text = assert_good(run("path", "ur3", poses), code=1).out
    assert "first unreachable" in text
    assert "waypoint 20 (from 0)" in text


def test_path_that_is_too_fast(run: Run, made, poses: Path) -> None:
    """It says which joint, how fast it would have to be, and a time step that does."""
    robot = made.robot("ur3")
    far = [0.5, *map(float, Q[1:])]
    words = ["path", "ur3", poses, "--start", *map(repr, far)]
    output = assert_good(run(*words, "--dt", "0.01", "--json"), code=1)
    answer = output.json()
    assert (answer["status"], answer["first_unreachable"]) == ("too_fast", 0)
    why = answer["too_fast"]
    joint = robot.joint_names.index(why["joint"])
    assert (why["joint"], why["waypoint"]) == ("shoulder_pan_joint", 0)
    turn = abs(float(Q[0]) - 0.5)
    assert why["speed"] == pytest.approx(turn / 0.01, rel=0.05)
    assert why["velocity_limit"] == robot.velocity_limit[joint]
    step = repr(why["dt"])
    assert_good(run(*words, "--dt", step))
    assert_good(run(*words, "--dt", repr(0.97 * why["dt"])), code=1)
    text = assert_good(run(*words, "--dt", "0.01"), code=1).out
    assert f"in time with       --dt {why['dt']:g}" in text
    assert re.search(r"too fast +shoulder_pan_joint would .* rad/s to waypoint 0", text)
    assert "joint values" not in text


def test_path_from_stdin(
    run: Run, poses: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stdin = io.TextIOWrapper(io.BytesIO(poses.read_bytes()), "utf-8")
    monkeypatch.setattr("sys.stdin", stdin)
    assert len(assert_good(run("path ur3 - --json")).json()["q"]) == 20


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


@pytest.mark.parametrize("preset", ["default", "paper"])
def test_a_named_scale_is_the_papers_grid(
    run: Run, tmp_path: Path, preset: str
) -> None:
    path = tmp_path / "file"
    words = ["build", "cvr038", "-o", path, "--preset", preset, "--scale", "small"]
    report = assert_good(run(*words, "--json")).json()
    assert report["samples"] == 12_000
    assert report["options"]["sampling"] == "grid"
    assert report["options"]["key_scheme"] == "full"
    assert iksel.Database.load(path).key_dimension == 6
    # The default preset solves over it too, one seed after another.
    q = ["--from-q", *"001000", "--json"]
    answer = assert_good(run("solve", "cvr038", "--database", path, *q)).json()
    assert answer["success"]
    other = run(*words, "--sampling", "low_discrepancy", "--json").json()
    assert other["samples"] == 12_000
    assert other["options"]["sampling"] == "low_discrepancy"


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
    assert set(EVALUATE_FIELDS.split()) <= set(report)
    assert not set(STAGES) & set(report)
    assert report["robot"] == "cvr038"
    assert report["preset"] == preset
    assert (report["targets"], report["seed"], report["threads"]) == (200, 3, 1)
    assert report["false_success"] == 0
    assert report["success_percent"] == pytest.approx(report["solved"] / 2)
    assert report["solved"] > 100
    times = [report[f"{name}_us"] for name in ("min", "median", "p99", "max")]
    assert times == sorted(times)
    assert report["ratio"] == pytest.approx(report["mean_us"] / report["kdl_fk_jac_us"])
    assert report["mean_attempts"] >= 1
    assert report["mean_iterations"] > 0
    assert report["build_s"] > 0
    paper = preset == "paper"
    assert report["position_tolerance"] == (1e-4 if paper else 1e-6)
    assert report["database_samples"] == (40_320 if paper else 2_000)
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


def test_evaluate_of_the_newer_selection(run: Run) -> None:
    words = "evaluate cvr038 --preset paper2026 --targets 100 --kmeans-pool 20000"
    report = assert_good(run(words + " --json")).json()
    assert report["preset"] == "paper2026"
    assert report["database_samples"] == 2048
    assert report["overrides"] == {"database.kmeans_pool": 20_000}
    assert report["solved"] > 90
    shown = assert_good(run("evaluate --help")).out
    assert "default: 2000, paper2026: 2048" in " ".join(shown.split())


def test_build_by_kmeans(run: Run, tmp_path: Path) -> None:
    words = "--sampling kmeans --kmeans-pool 2000 --kmeans-rounds 3 --samples 50"
    path = tmp_path / "file"
    assert_good(run("build", "cvr038", "-o", path, *words.split()))
    options = iksel.Database.load(path).options
    assert options.sampling is iksel.Sampling.kmeans
    assert (options.kmeans_pool, options.kmeans_rounds) == (2000, 3)


def test_evaluate_with_a_file(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "file"
    run("build", "ur3", "-o", path, *FEW)
    words = ["evaluate", "ur3", "--targets", "50", "--database", path]
    report = assert_good(run(*words, "--json")).json()
    assert report["database_samples"] == 500
    assert report["build_s"] is None
    assert "from file" in assert_good(run(*words)).out


def test_simd_is_what_the_core_says(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(iksel_cpp, "simd_level", lambda: "avx512")
    words = ["evaluate", "ur3", "--targets", "10", *FEW, "--json"]
    assert run(*words).json()["simd"] == "avx512"
