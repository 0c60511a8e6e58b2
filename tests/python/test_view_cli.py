# SPDX-License-Identifier: BSD-3-Clause
"""iksel view, and iksel reach view --browser: a process that serves until Ctrl-C."""

from __future__ import annotations

import shlex
import signal
import subprocess
import sys
import urllib.request

import pytest
import reach_maps  # noqa: F401 (skips without the extra)
from command_line import assert_bad
from reach_maps import computed
from test_view import free_port
from trees import two_arms_on_torso

import iksel
from iksel import cli

pytest.importorskip("viser", reason="pip install iksel[view]")


def served(line: str, folder) -> str:
    """What a command serves at the address that it prints, until it is interrupted."""
    command = [sys.executable, "-m", "iksel", *shlex.split(line)]
    # A shell's background job, as CI may be, would pass on that it ignores Ctrl-C.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    process = subprocess.Popen(
        command,
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    signal.signal(signal.SIGINT, before)
    try:
        said = process.stdout.readline()
        assert said.endswith(" (Ctrl-C ends)\n"), process.stderr.read()
        with urllib.request.urlopen(said.split()[0], timeout=20) as page:
            text = page.read().decode()
    finally:
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=20)
    assert (process.returncode, out, err) == (0, "", "")
    return text


def examples() -> list[str]:
    """Those of the help texts that need no file of the user's."""
    lines = [*cli.view.EXAMPLES.splitlines(), *cli.reach.EXAMPLES.splitlines()]
    found = [line.strip().removeprefix("iksel ") for line in lines if "iksel " in line]
    return [
        line
        for line in found
        if (line.startswith("view") or "--browser" in line) and ".urdf" not in line
    ]


@pytest.fixture(scope="module")
def folder(tmp_path_factory, made):
    """A folder with the map of the examples."""
    path = tmp_path_factory.mktemp("view")
    computed(path / "ur5e.zarr", made.robot("ur5e"), spacing=0.3, orientations=72)
    return path


@pytest.mark.parametrize("line", examples())
def test_examples_are_served_until_interrupted(line, folder):
    assert len(examples()) == 5
    if "--port" not in line:
        line += f" --port {free_port()}"
    assert "<html" in served(line, folder)


def test_a_robot_with_several_tips_is_served(folder, made):
    path = folder / "torso.urdf"
    path.write_text(two_arms_on_torso(made.robot("ur5e")))
    tips = "--tip l_tool0 --tip r_tool0 --task position_only"
    q = " ".join(["0.1"] * 14)
    line = f"view torso.urdf {tips} --q {q} --port {free_port()}"
    assert "<html" in served(line, folder)


def test_an_interrupt_ends_it_as_soon_as_the_address_is_known(capsys):
    class Interrupted:
        url = "http://127.0.0.1:8080"

        def wait(self):
            """As if Ctrl-C came before it waits."""
            raise KeyboardInterrupt

    cli.view.announce(Interrupted())
    assert capsys.readouterr().out == "http://127.0.0.1:8080 (Ctrl-C ends)\n"


def test_what_cannot_be_shown_is_named(run, folder):
    port = f"--port {free_port()}"
    path = folder / "ur5e.zarr"
    assert_bad(run(f"view panda --map {path} {port}"), "map: it is of ur5e, .* panda")
    tool = "--tcp 0 0 0.1 0 0 0"
    assert_bad(run(f"view ur5e --map {path} {port} {tool}"), "map: its tool is another")
    torso = folder / "two.urdf"
    torso.write_text(two_arms_on_torso(iksel.load_robot("ur3")))
    both = f"{torso} --tip l_tool0 --tip r_tool0 --map {path}"
    assert_bad(run(f"view {both} {port}"), "map: it is of ur5e, .* l_tool0, r_tool0")
    assert_bad(run(f"view ur5e --map {path}x {port}"), "ur5e.zarrx")
    assert_bad(run(f"view ur5e --q 1 2 {port}"), "--q: expected 6 numbers")
    assert_bad(run("view ur5e --port 0"), "--port: 0 is not between 1 and 65535")
    assert_bad(run("view ur5e --port x"), "--port: x is not between 1 and 65535")
    assert_bad(run("view ur7e"), "no built-in robot 'ur7e'")
    assert_bad(run(f"view ur5e {port} --host 256.0.0.1"), "host: .*256.0.0.1")
    both = f"reach view {path} --browser --slice z=0.3 {port}"
    assert_bad(run(both), "--browser: shows spheres")
    assert_bad(run(f"reach view {path}"), "-o/--output --browser")


def test_without_the_extra_it_is_named(run, monkeypatch):
    monkeypatch.setitem(sys.modules, "viser", None)
    assert_bad(run("view ur5e"), r"pip install 'iksel\[view\]'")
    assert issubclass(iksel.view.MissingExtraError, iksel.Error)
