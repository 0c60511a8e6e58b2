# SPDX-License-Identifier: BSD-3-Clause
"""Where a program has set a locale with a decimal comma, texts are the same."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

PROGRAM = """
    import locale
    import sys

    import iksel
    from iksel import cli

    locale.setlocale(locale.LC_ALL, sys.argv[1])
    comma = locale.localeconv()["decimal_point"] == ","
    assert comma == (sys.argv[1] != "C")

    robot = iksel.load_robot("ur3")
    options = iksel.SolverOptions(position_tolerance=1.5e-6, database={"samples": 300})
    solver = iksel.Solver(robot, options)
    result = solver.solve(robot.fk([0.3, -1.2, 1.4, -0.6, 1.2, 0.25]))
    print(robot, robot._repr_html_(), robot.lower, options, result, result.q)
    far = iksel.pose_from_euler([1.5, 0.25, 0], [0, 0.5, 0])
    print(result._repr_html_(), solver.diagnose(far).message)
    for wrong in (
        lambda: iksel.Solver(robot, options.replace(position_tolerance=-0.25)),
        lambda: solver.solve(robot.fk(result.q), deadline=-0.25),
        lambda: robot.inverse_jacobian(result.q, -0.25),
        lambda: iksel.Robot.from_urdf(robot.urdf, default_limits=(1.5, 0.25)),
    ):
        try:
            wrong()
        except iksel.Error as error:
            print(error)
        else:
            raise AssertionError
    cli.main(["info", "ur3"])
    cli.main(["info", "ur3", "--json", "--tcp", "0.125 0 0 0.5 0.25 0"])
"""


def output(name: str, folder: Path) -> str:
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(PROGRAM), name],
        env={**os.environ, "LOCPATH": str(folder), "PYTHONUTF8": "1"},
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_a_decimal_comma_changes_nothing(tmp_path: Path) -> None:
    localedef = shutil.which("localedef")
    sources = Path("/usr/share/i18n/locales/de_DE")
    if localedef is None or not sources.exists():
        pytest.skip("needs localedef and its sources (Debian: locales)")
    target = tmp_path / "de_DE.UTF-8"
    command = [localedef, "-i", "de_DE", "-f", "UTF-8", str(target)]
    subprocess.run(command, check=False, capture_output=True)
    text = output("de_DE.UTF-8", tmp_path)
    assert text == output("C", tmp_path)
    assert "0.25" in text
