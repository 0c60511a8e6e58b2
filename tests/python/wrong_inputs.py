# SPDX-License-Identifier: BSD-3-Clause
"""What newcomers try, and the page of the messages that they get.

python tests/python/wrong_inputs.py    # writes tests/data/wrong_inputs.md anew
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import shlex
import sys
import tempfile
import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from urdf_text import arm, joint, link, robot

import iksel
from iksel import cli

PAGE = Path(__file__).parents[1] / "data" / "wrong_inputs.md"

HEAD = """\
# Wrong inputs and their messages

What newcomers try, and what they read then. Made by
`python tests/python/wrong_inputs.py`; a test keeps it up to date. `ur3` is a built-in
robot with a solver `solver`, `q` a configuration of it and `pose` the pose there;
`hands` is a robot with the tips of `hands.urdf`; in
the folder are `hands.urdf` (two hands and a camera), `plain.urdf` (limits 0, 0),
`arm.urdf.xacro` (not expanded), `floating.urdf`, `broken.urdf` (cut off), `ur3.iksel`,
`panda.iksel` (databases), `cut.iksel` (half a database) and `notes.txt`.
"""

# Heading: lines of Python, or of a shell where they begin with "$ ".
TABLE: dict[str, tuple[str, ...]] = {
    "A robot": (
        'iksel.load_robot("ur33")',
        'iksel.load_robot("UR3")',
        'iksel.Robot("ur3")',
        'iksel.Solver("ur3")',
        'iksel.Robot.from_urdf("my_arm.urdf")',
        'iksel.Robot.from_urdf(".")',
        'iksel.Robot.from_urdf("notes.txt")',
        'iksel.Robot.from_urdf("/dev/zero")',
        'iksel.Robot.from_urdf("hands.urdf", tip_link="\\udcff")',
        'iksel.Robot.from_urdf("broken.urdf")',
        'iksel.Robot.from_urdf("arm.urdf.xacro")',
        "iksel.Robot.from_urdf(None)",
        'iksel.Robot.from_urdf("hands.urdf")',
        'iksel.Robot.from_urdf("hands.urdf", tip_link="left_hnd")',
        'iksel.Robot.from_urdf("hands.urdf", base_link="lift", tip_link="lift")',
        'iksel.Robot.from_urdf("plain.urdf")',
        'iksel.Robot.from_urdf("floating.urdf")',
        'iksel.load_robot({"robot": "ur3"})',
        'iksel.load_robot(iksel.load_robot("ur3"))',
        "iksel.Robot.from_dh([0, 1], [0], [0, 0])",
        'iksel.Robot.from_dh([0], [0], [0], types=["prismatic"])',
        'iksel.Robot.from_dh([0], [0], [0], convention="craig")',
        'iksel.load_robot("ur3", locked_joints={"elbow": 1.0})',
        'iksel.load_robot("ur3", locked_joints=["elbow_joint"])',
        'iksel.load_robot("ur3", tcp=[0, 0, 0.1])',
        'iksel.load_robot("vs060", coupled_limits=[{"joint_2": 1, "joint_3": 1}])',
        (
            'iksel.load_robot("vs060", '
            'coupled_limits=[iksel.CoupledLimit({"elbow": 1}, 0, 1)])'
        ),
        (
            'iksel.load_robot("vs060", '
            'coupled_limits=[iksel.CoupledLimit({"joint_2": 1}, 5, 6)])'
        ),
        'iksel.load_robot("vs060", mimic_curves=[{"joint_3": "joint_2"}])',
        (
            'iksel.load_robot("vs060", '
            'mimic_curves=[iksel.MimicCurve("joint_3", "crank", [], [])])'
        ),
        'ur3.fk("home")',
        "ur3.fk([0.1, 0.2, 0.3])",
        "ur3.fk([0, -90, 90, 0, 0, np.nan])",
        "ur3.random_configurations(-1)",
    ),
    "A pose": (
        "solver.solve([0.2, 0.15, 0.3])",
        "solver.solve([0.2, 0.15, 0.3, 0, 3.14, 0])",
        "solver.solve(None)",
        "solver.solve(np.zeros((4, 4)))",
        "solver.solve(np.full((4, 4), np.nan))",
        "solver.solve(pose.T)",
        "solver.solve(1000 * pose)",
        "solver.solve(pose * [[1, 1, -1, 1]])",
        "solver.solve([pose, pose])",
        "iksel.pose_from_euler([0.2, 0.15, 0.3], [0, 180, 0])",
        "iksel.pose_from_euler([0.2, 0.15, 0.3, 0, 3.14, 0])",
        "iksel.pose_from_quaternion([0.2, 0.15, 0.3], [1, 0, 0, 1])",
        'iksel.pose_from_quaternion([0.2, 0.15, 0.3], [0, 0, 1, 0], order="xywz")',
        "iksel.pose_from_matrix([0.2, 0.15, 0.3], np.ones((3, 3)))",
    ),
    "A request": (
        "solver.solve(pose, q_init=q)",
        'solver.solve(pose, seeds="home")',
        "solver.solve(pose, near=[0, 0, 0])",
        "solver.solve(pose, seeds=np.full(6, np.nan))",
        "solver.solve(pose, seed=q)",
        "solver.solve(pose, q)",
        "solver.solve(pose, deadline=0)",
        "solver.solve(pose, filter=lambda q: None)",
        "solver.solve(pose, scene=[])",
        "iksel.Scene(ur3)",
        "iksel.Scene(ur3, iksel.RobotSpheres({}))",
        'iksel.RobotSpheres({"forearm_link": [[0, 0, 0, -0.1]]})',
        'iksel.Scene(ur3, iksel.RobotSpheres({"forarm_link": [[0, 0, 0, 0.1]]}))',
        'solver.solve(pose, objective="manipulabilty")',
        'solver.solve(pose, objective=lambda q: float("nan"))',
        'solver.solve(pose, task="position_only")',
        "solver.solve_batch(pose)",
        "solver.solve_batch([pose, None])",
        "solver.solve_path(pose)",
        "print(solver.solve(far))",
    ),
    "Several tips": (
        'iksel.Robot.from_urdf("hands.urdf", tip_links="left_hand")',
        'iksel.Robot.from_urdf("hands.urdf", tip_links=["left_hand", "right_hnd"])',
        'iksel.Robot.from_urdf("hands.urdf", tip_links=["left_hand", "left_hand"])',
        'iksel.Robot.from_urdf("hands.urdf", tip_links=["left_hand", "camera"])',
        "hands.tip_link",
        "hands.fk([0.1])",
        "iksel.Solver(hands).solve(pose)",
        "iksel.Solver(hands).solve([pose, pose], in_frame_of=[1, 0])",
        "iksel.Solver(hands).solve([pose, pose], tasks=[iksel.Task()])",
        "iksel.Solver(hands).database",
    ),
    "Settings and databases": (
        "iksel.SolverOptions(max_atempts=5)",
        "iksel.SolverOptions(tolerance=1e-3)",
        'iksel.SolverOptions(iteration="dls")',
        'iksel.SolverOptions(strategy="newton")',
        'iksel.Paper(iteration="newton")',
        "iksel.Paper(limit_margin=0.2)",
        "iksel.SolverOptions(max_attempts=1.5)",
        "iksel.Solver(ur3, iksel.SolverOptions(position_tolerance=-1))",
        'iksel.Database.load("ur3.iks")',
        'iksel.Database.load("cut.iksel")',
        'iksel.Database.load("notes.txt")',
        'iksel.Solver(ur3, database=iksel.Database.load("panda.iksel"))',
        'iksel.Solver(ur3, database="ur3.iksel")',
    ),
    "The command line": (
        "$ iksel",
        "$ iksel sovle ur3",
        "$ iksel info ur33",
        "$ iksel info my_arm.urdf",
        "$ iksel info arm.urdf.xacro",
        "$ iksel solve hands.urdf --from-q 0 0",
        "$ iksel info plain.urdf",
        "$ iksel info ur3 --tip tol0",
        "$ iksel solve ur3",
        "$ iksel solve ur3 --pose 0.2 0.15 0.3",
        "$ iksel solve ur3 --pose 0,2 0,15 0,3 0 3,14 0",
        "$ iksel solve ur3 --pose 0.2 0.15 0.3 0 180 0 --json",
        "$ iksel solve ur3 --pose 0.2 0.15 0.3 0 0 0 0",
        "$ iksel solve ur3 --from-q 0 0 0",
        "$ iksel solve ur3 --from-q home",
        "$ iksel solve ur3 --pose 0.2 0.15 0.3 0 3.14 0 --preset fast",
        "$ iksel solve ur3 --pose 0.2 0.15 0.3 0 3.14 0 --max-attempts many",
        "$ iksel solve ur3 --pose 0.2 0.15 0.3 0 3.14 0 --database panda.iksel",
        "$ iksel solve ur3 --pose 0.2 0.15 0.3 0 3.14 0 --task position",
        "$ iksel info ur3 --lock elbow=1",
        "$ iksel fk ur3 0 -90 90",
        "$ iksel fk ur3 0 -90 90 0 -90 0 --matrix",
        "$ iksel solve ur3 --poses poses.csv",
        "$ iksel solve ur3 --poses notes.txt",
        "$ iksel solve ur3 --poses notes.txt -o answers.txt",
        "$ iksel solve ur3 --poses notes.txt --json",
        "$ iksel plot ur3 -o ur3.jpg",
        "$ iksel plot ur3 branches -o ur3.png",
        "$ iksel path ur3 poses.txt",
        "$ iksel build ur3",
        "$ iksel evaluate ur3 --targets 0",
    ),
}


def make_files(folder: Path) -> None:
    """The files that the table speaks of."""
    limit = '<limit lower="0" upper="0" velocity="1" effort="1"/>'
    texts = {
        "hands.urdf": robot(
            link("base", "shoulder", "left_hand", "right_hand", "camera"),
            joint("lift", "base", "shoulder"),
            joint("left", "shoulder", "left_hand"),
            joint("right", "shoulder", "right_hand"),
            joint("mount", "base", "camera", kind="fixed"),
        ),
        "plain.urdf": arm(inside=limit),
        "floating.urdf": arm(kind="floating"),
        "broken.urdf": arm()[:200],
        "arm.urdf.xacro": robot('<xacro:include filename="links.xacro"/>'),
        "notes.txt": "buy milk\n" * 100,
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    for name in ("ur3", "panda"):
        few = iksel.DatabaseOptions(samples=200)
        iksel.Database.build(iksel.load_robot(name), few).save(folder / f"{name}.iksel")
    content = (folder / "ur3.iksel").read_bytes()
    (folder / "cut.iksel").write_bytes(content[: len(content) // 2])


def answer_of_shell(line: str) -> str:
    """What a command writes to stderr, and its status."""
    err = io.StringIO()
    out = io.TextIOWrapper(io.BytesIO(), "utf-8")
    with contextlib.redirect_stderr(err), contextlib.redirect_stdout(out):
        status = cli.main(shlex.split(line)[1:])
    return f"{err.getvalue().strip()}\n[exit status {status}]"


def answer_of_python(line: str, names: dict[str, object]) -> str:
    """The error or warning of a line of Python, or what it prints."""
    out = io.StringIO()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            with contextlib.redirect_stdout(out):
                exec(line, names)
        except Exception as error:  # noqa: BLE001 (whatever a newcomer meets)
            return f"{type(error).__name__}: {error}"
    texts = [f"{warning.category.__name__}: {warning.message}" for warning in caught]
    return "\n".join([*texts, out.getvalue().strip()]).strip()


def answers() -> Iterator[tuple[str, str, str]]:
    """Heading, line and message of each row of the table."""
    ur3 = iksel.load_robot("ur3")
    solver = iksel.Solver(ur3, iksel.SolverOptions(database={"samples": 500}))
    q = [0.3, -1.2, 1.4, -0.6, 1.2, 0.2]
    pose = ur3.fk(q)
    far = iksel.pose_from_euler([9, 0, 0], [0, 0, 0])
    names = {"iksel": iksel, "np": np, "ur3": ur3, "solver": solver, "q": q}
    names |= {"pose": pose, "far": far}
    here = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        make_files(Path(folder))
        os.chdir(folder)
        try:
            names["hands"] = iksel.Robot.from_urdf(
                "hands.urdf", tip_links=["left_hand", "right_hand"]
            )
            for heading, lines in TABLE.items():
                for line in lines:
                    shell = line.startswith("$ ")
                    text = (
                        answer_of_shell(line[2:])
                        if shell
                        else answer_of_python(line, dict(names))
                    )
                    yield heading, line, portable(text)
        finally:
            os.chdir(here)


NOT_PORTABLE = (
    (r"(?<=hash )[0-9a-f]{16}\b", "<hash>"),
    (r"\d+ bytes instead of \d+", "<n> bytes instead of <n>"),
    (r"\d+ truth values for the \(\d+,", "<n> truth values for the (<n>,"),
    (r"(?<=at q = )\[[^\]]*\]", "<q>"),
    (r"choose from '([^)]*)'", r"choose from \1"),  # newer Pythons have no quotes
    (r"(?<=\w)', '(?=\w)", ", "),
)


def portable(text: str) -> str:
    """The message without what differs from machine to machine."""
    for pattern, replacement in NOT_PORTABLE:
        text = re.sub(pattern, replacement, text)
    return text


def make_page() -> str:
    """The whole page."""
    parts = [HEAD]
    last = ""
    for heading, line, message in answers():
        if heading != last:
            parts.append(f"## {heading}\n")
            last = heading
        kind = "console" if line.startswith("$ ") else "python"
        parts.append(f"```{kind}\n{line}\n```\n\n```text\n{message}\n```\n")
    return "\n".join(parts)


if __name__ == "__main__":
    PAGE.parent.mkdir(exist_ok=True)
    PAGE.write_text(make_page(), encoding="utf-8")
    sys.stdout.write(f"{PAGE.name}: {sum(map(len, TABLE.values()))} inputs\n")
