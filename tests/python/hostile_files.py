# SPDX-License-Identifier: BSD-3-Clause
"""Files of somebody who wants to do harm, and a program that reads them all.

Run by itself, `python hostile_files.py FOLDER`, it writes the files, gives each to
every reader that its name is for, and prints a line of JSON for each of these calls:
what was raised, and what else happened meanwhile (processes, files written,
connections).
"""

from __future__ import annotations

import contextlib
import importlib
import io
import json
import os
import struct
import sys
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

CANARY = "iksel_was_here"
"""Name of the file that hostile code would make."""
WIKI = "http://www.ros.org/wiki/xacro"
LIBRARIES = ("xacro", "yaml", "mujoco", "trimesh", "coal", "collada")
MEMORY = 4 << 30  # bytes that the program may have

_SYSTEM = (
    "[c for c in ().__class__.__base__.__subclasses__() if c.__name__=='_wrap_close']"
    f"[0].__init__.__globals__['system']('touch {CANARY}')"
)
_LINKS = '<link name="a"/><link name="b"/>'
_JOINT = (
    '<joint name="j" type="revolute"><parent link="a"/><child link="b"/>'
    '<origin xyz="{} 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/>'
    "</joint>"
)


def _xacro(body: str) -> str:
    return f'<robot xmlns:xacro="{WIKI}" name="r">{body}</robot>'


def _macro(name: str, body: str, params: str = "") -> str:
    text = f'<xacro:macro name="{name}" params="{params}">{body}</xacro:macro>'
    return text.replace("\n", " ")


def _property(name: str, value: str) -> str:
    return f'<xacro:property name="{name}" value="{value}"/>'


def _in_joint(expression: str) -> str:
    return _xacro(_LINKS + _JOINT.format(f"${{{expression}}}"))


_LAUGHS = "".join(_macro(f"m{i}", f"<xacro:m{i - 1}/>" * 10) for i in range(1, 12))
_ENTITIES = '<!DOCTYPE robot [<!ENTITY a0 "aaaaaaaaaa">' + "".join(
    f'<!ENTITY a{i} "{f"&a{i - 1};" * 10}">' for i in range(1, 12)
)
_MJ_BODY = '<body><geom size="1"/></body>'


def _mjcf(before: str) -> str:
    """MJCF of a body, with something before it."""
    return f"<mujoco>{before}<worldbody>{_MJ_BODY}</worldbody></mujoco>"


_REPLICAS = '<replicate count="1000">' * 3 + _MJ_BODY + "</replicate>" * 3

TEXTS: dict[str, str] = {
    # Code in expressions.
    "attribute.urdf": f'<robot name="r">{_LINKS}{_JOINT.format("${" + _SYSTEM + "}")}'
    "</robot>",
    "comprehension.xacro": _in_joint(f"[{_SYSTEM} for i in [0]][0]"),
    "lambda.xacro": _in_joint(f"(lambda: {_SYSTEM})()"),
    "property.xacro": _xacro(_property("x", f"${{{_SYSTEM}}}") + '<link name="${x}"/>'),
    "argument.xacro": _xacro(
        f'<xacro:arg name="x" default="${{{_SYSTEM}}}"/><link name="$(arg x)"/>'
    ),
    "eval.xacro": _xacro(f'<link name="$(eval {_SYSTEM})"/>'),
    "format.xacro": _in_joint("'{0.real}'.format(1)".replace("}", "&#125;")),
    "import.xacro": _in_joint(f"__import__('os').system('touch {CANARY}')"),
    "function.xacro": _in_joint("len.__self__"),
    "tag.xacro": _xacro("<link name=\"${xacro.load_yaml('tag.yaml')}\"/>"),
    "unit.xacro": _xacro("<link name=\"${xacro.load_yaml('unit.yaml')}\"/>"),
    # Work without an end.
    "power.xacro": _in_joint("9**9**9"),
    "shift.xacro": _in_joint("1 &lt;&lt; 10**12"),
    "long_text.xacro": _in_joint("'a' * 10**10"),
    "long_list.xacro": _in_joint("len([0] * 10**10)"),
    "rounded.xacro": _in_joint("round(7, -10**10)"),
    "factorial.xacro": _in_joint("factorial(10**8)"),
    "format_width.xacro": _in_joint("'%1000000000d' % 1"),
    "doubling.xacro": _xacro(
        _property("p0", "aaaaaaaaaa")
        + "".join(_property(f"p{i}", f"${{p{i - 1}}}" * 10) for i in range(1, 12))
        + '<link name="${p11}"/>'
    ),
    "laughing_macros.xacro": _xacro(
        _macro("m0", '<link name="a"/>') + _LAUGHS + "<xacro:m11/>"
    ),
    "many_substitutions.xacro": _xacro(f'<link name="{"$(arg" * 300_000}"/>'),
    "calls_itself.xacro": _xacro(_macro("m", "<xacro:m/>") + "<xacro:m/>"),
    "names_itself.xacro": _xacro(
        _property("p", "${q}") + _property("q", "${p}") + '<link name="${p}"/>'
    ),
    "includes_itself.xacro": _xacro(
        '<xacro:include filename="includes_itself.xacro"/>'
    ),
    "backtracking.xacro": _xacro(_macro("m", "", "a:=" + "b" * 60 + "'")),
    "every_folder.xacro": _xacro('<xacro:include filename="/*/*/*/*/*/*/*"/>'),
    "device.xacro": _xacro('<xacro:include filename="/dev/zero"/>'),
    "pipe.xacro": _xacro('<xacro:include filename="pipe"/>'),
    "pipe_of_yaml.xacro": _xacro("<link name=\"${xacro.load_yaml('pipe')}\"/>"),
    # XML.
    "entities.xacro": _ENTITIES + "]>" + _xacro('<link name="&a11;"/>'),
    "entities.urdf": _ENTITIES + ']><robot name="&a11;"><link name="&a11;"/></robot>',
    "external.urdf": '<!DOCTYPE robot [<!ENTITY a SYSTEM "file:///etc/passwd">]>'
    '<robot name="r"><link name="&a;"/>',
    "external.xacro": '<!DOCTYPE robot [<!ENTITY a SYSTEM "file:///etc/passwd">]>'
    + _xacro('<link name="&a;"/>'),
    "deep.urdf": '<robot name="r">' + "<a>" * 100_000,
    # MJCF.
    "replicas.xml": f"<mujoco><worldbody>{_REPLICAS}</worldbody></mujoco>",
    "warned_of.xml": "<mujoco><worldbody><body pos='nan 0 0'>"
    "<joint/><geom size='1'/></body></worldbody></mujoco>",
    "keys.xml": _mjcf('<size nkey="1000000000"/>'),
    "user_data.xml": _mjcf('<size nuser_jnt="500000000"/>'),
    "arena.xml": _mjcf('<size memory="1E"/>'),
    "height_field.xml": _mjcf(
        '<asset><hfield name="h" nrow="50000" ncol="50000" size="1 1 1 1"/></asset>'
    ),
    "built_mesh.xml": _mjcf(
        '<asset><mesh name="m" builtin="supersphere" params="100000 1 1"/></asset>'
    ),
    "in_itself.xml": '<mujoco><include file="in_itself.xml"/></mujoco>',
    "pipe.xml": '<mujoco><include file="pipe"/></mujoco>',
    "plugin.xml": '<mujoco><extension><plugin plugin="os.system"/></extension>'
    f"<worldbody>{_MJ_BODY}</worldbody></mujoco>",
    # SRDF.
    "entities.srdf": _ENTITIES + ']><robot name="&a11;"><group name="&a11;"/>',
    "deep.srdf": "<robot>" + "<group>" * 100_000,
    # Spheres.
    "tag.yaml": f"!!python/object/apply:os.system ['touch {CANARY}']",
    "unit.yaml": f'!degrees "{_SYSTEM}"',
    "anchors.yaml": "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n"
    + "".join(f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]\n" for i in range(1, 12))
    + "collision_spheres: {a: *a11}\n",
    "in_itself.yaml": "collision_spheres: &a {a: *a}\n",
    "pipe.yaml": "collision_spheres: pipe\n",
    "deep.yaml": "[" * 5_000,
    "deep.json": "[" * 100_000,
}
"""By name; most are run by the ending of the name."""


def write_all(folder: Path) -> list[Path]:
    """Write the files, and those that some of them name."""
    paths = []
    for name, text in TEXTS.items():
        paths.append(folder / name)
        paths[-1].write_text(text, encoding="utf-8")
    os.mkfifo(folder / "pipe")
    _write_archive(folder / "bomb.zae", "doc.dae", b" " * (1 << 20), 600)
    _write_archive(folder / "bomb.npz", "spheres.npy", b"\0" * (1 << 20), 600)
    _write_pickle(folder / "pickle.npz")
    _write_huge(folder / "huge.npz")
    mesh = (
        '<link name="a"><{0}><geometry><mesh filename="{1}"/></geometry></{0}></link>'
    )
    for name in ("bomb.zae", "/dev/zero", "pipe"):
        body = mesh.format("visual", name) + mesh.format("collision", name)
        path = folder / f"mesh_{Path(name).stem}.urdf"
        path.write_text(
            f'<robot name="r">{body}<link name="b"/>{_JOINT.format(0)}</robot>',
            encoding="utf-8",
        )
        paths.append(path)
    return paths + [folder / f"{name}.npz" for name in ("bomb", "pickle", "huge")]


def _write_archive(path: Path, name: str, block: bytes, count: int) -> None:
    with (
        zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive,
        archive.open(name, "w", force_zip64=True) as member,
    ):
        for _ in range(count):
            member.write(block)


def _npy(header: str, data: bytes) -> bytes:
    padded = header.encode().ljust(117) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(padded)) + padded + data


def _write_pickle(path: Path) -> None:
    code = f"cposix\nsystem\n(S'touch {CANARY}'\ntR.".encode()
    header = "{'descr': '|O', 'fortran_order': False, 'shape': (1,)}"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("format.npy", _npy(header, code))


def _write_huge(path: Path) -> None:
    header = "{'descr': '<f8', 'fortran_order': False, 'shape': (10000000000000,)}"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("format.npy", _npy(header, b"\0" * 80))


def readers() -> dict[str, list[Callable[[Path], Any]]]:
    """What reads files, by the ending of their names."""
    import iksel  # noqa: PLC0415 (after the limit of memory)
    from iksel import cli, collision, spheres  # noqa: PLC0415
    from iksel.view.visuals import read_pieces  # noqa: PLC0415

    for module in LIBRARIES:  # some start processes when they are imported
        importlib.import_module(module)
    robot = iksel.load_robot("ur5e")

    def look(path: Path) -> None:
        lost = read_pieces(path, None, None)[1]
        if lost:
            raise iksel.UrdfError(lost[0])

    def info(path: Path) -> None:
        said = io.StringIO()
        with contextlib.redirect_stderr(said), contextlib.redirect_stdout(said):
            code = cli.main(["info", str(path)])
        if code:
            raise iksel.Error(said.getvalue().strip())

    robots = [
        iksel.load_robot,
        iksel.load_tree,
        info,
        look,
        lambda path: collision.SelfCollision(path, robot),
        lambda path: iksel.attach("ur5e", path),
    ]
    covers = [spheres.from_curobo, spheres.from_json]
    return {
        **dict.fromkeys((".urdf", ".xacro", ".xml"), robots),
        ".srdf": [iksel.Srdf],
        ".yaml": covers,
        ".json": covers,
        ".npz": [spheres.load],
    }


_WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
_PROCESSES = ("subprocess.Popen", "os.system", "os.exec", "os.posix_spawn", "os.fork")


def watch(events: list[str]) -> None:
    """Note from now on which processes are started, files written, hosts asked."""

    def note(event: str, arguments: tuple[Any, ...]) -> None:
        if event == "open":
            name, _, flags = arguments
            if flags & _WRITES and "__pycache__" not in str(name):
                events.append(f"open {name}")
        elif event.startswith(_PROCESSES) or event in ("socket.connect", "os.spawn"):
            events.append(f"{event} {arguments}")

    sys.addaudithook(note)


def main(folder: Path) -> None:
    """Write, read and report; see above."""
    import resource  # noqa: PLC0415 (not on every system)

    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    paths = write_all(folder)
    known = readers()
    events: list[str] = []
    watch(events)
    os.chdir(folder)
    before = set(folder.rglob("*"))
    for path in paths:
        for number, read in enumerate(known[path.suffix]):
            events.clear()
            raised, said = "", ""
            try:
                read(path)
            except Exception as error:  # noqa: BLE001 (which is looked at)
                raised = " ".join(kind.__name__ for kind in type(error).__mro__)
                said = str(error)
            # Libraries in C write without a word to Python.
            events += [f"new {new}" for new in set(folder.rglob("*")) - before]
            report = [path.name, number, raised, said, events]
            print(json.dumps(report), flush=True)  # noqa: T201 (its output)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
