# SPDX-License-Identifier: BSD-3-Clause
"""Expressions of xacro files: what is evaluated, what is refused, and what it costs."""

from __future__ import annotations

import importlib
import math
import random
from pathlib import Path

import pytest

import iksel
from iksel.description import read_description
from iksel.formats._bounds import Budget, RefusedError
from iksel.formats._xacro_eval import evaluate

pytest.importorskip("xacro")

WIKI = "http://www.ros.org/wiki/xacro"

VALUES = [
    ("1 + 2 * 3 - 4 / 8", 6.5),
    ("-(7 // 2) ** 2 % 5", 1),
    ("1 if 2 > 1 >= 1 and not False else 0", 1),
    ("radians(180) - pi", 0.0),
    ("math.sin(math.pi / 2) + sqrt(4)", 3.0),
    ("max(1, *[])", None),
    ("'a' + 'b' * 3", "abbb"),
    ("'%03d_%s' % (7, 'x')", "007_x"),
    ("x['joints'][0].limit", 2.5),
    ("x.joints[-1]['limit'] + len(x.joints)", 3.5),
    ("x.get('absent', 'none')", "none"),
    ("list(map(float, '1 2'.split()))", [1.0, 2.0]),
    ("[1, 2, 3][1:]", [2, 3]),
    ("{'a': (1, 2)}['a'][1]", 2),
    ("'left' in 'left_arm' and name != ''", True),
    ("name.replace('_', '-').upper()", "LEFT-ARM"),
    ("sorted([3, 1, 2])[0] + sum(range(4))", 7),
    ("1 << 10 | 3 & 1 ^ 2", 1027),
    ("round(2.567, 1) + abs(-1) + int('3')", 6.6),
]
NAMES = {"x": {"joints": [{"limit": 2.5}]}, "name": "left_arm"}


@pytest.mark.parametrize(("text", "value"), [v for v in VALUES if v[1] is not None])
def test_expressions_have_the_values_of_python(text: str, value: object) -> None:
    found = evaluate(text, NAMES, Budget(), {})
    assert found == (pytest.approx(value) if isinstance(value, float) else value)


def test_random_arithmetic_has_the_values_of_python() -> None:
    seed = random.randrange(1 << 30)
    print(f"seed {seed}")  # noqa: T201
    rng = random.Random(seed)

    def draw(depth: int) -> str:
        if depth == 0:
            return rng.choice(["1", "2.5", "pi", "a", "0", "(1, 2)[1]", "'3'"])
        one, other = draw(depth - 1), draw(depth - 1)
        operator = rng.choice(["+", "-", "*", "/", "//", "%", "<", "==", "and", "or"])
        word = f"({one} {operator} {other})"
        return rng.choice([word, word, f"abs({one})", f"({one} if {word} else 1)"])

    for _ in range(2_000):
        text = draw(rng.randrange(4))
        try:
            expected = eval(text, {"pi": math.pi, "a": -7})
        except (TypeError, ZeroDivisionError) as error:
            with pytest.raises(type(error)):
                evaluate(text, {"a": -7}, Budget(), {})
            continue
        assert evaluate(text, {"a": -7}, Budget(), {}) == expected, text


REFUSED = [
    "().__class__",
    "(1).real",
    "''.join",
    "'{0.__class__}'.format(1)",
    "[i for i in (1,)]",
    "{i for i in (1,)}",
    "(lambda: 1)()",
    "(x := 1)",
    "f'{1}'",
    "__import__('os')",
    "__builtins__",
    "x.__class__",
    "open('/etc/passwd')",
    "eval('1')",
    "getattr(1, 'real')",
    "type(1)",
    "vars()",
    "math.__loader__",
    "python.__dict__",
    "max(*[1, 2])",
    "max(1, **{})",
    "len.__self__",
    "list(map(open, ['a']))",
    "'%(a)s' % 1",
    "'%1000000d' % 1",
    "b'a'",
    "...",
    "1j",
    "(-8) ** 0.5",
    "9 ** 9 ** 9",
    "1 << 10 ** 9",
    "'a' * 10 ** 9",
    "[1] * 10 ** 9",
    "10 ** 9 * 'a'",
    "[[[1] * 300] * 300] * 300",
    "range(10 ** 9)",
    "factorial(10 ** 6)",
    "factorial(1000)",
    "round(5, -10 ** 9)",
    "math.prod([2.0, 2] + [2 ** 4000, 2 ** 4000])",
    "'a' * 1000 + 'b' * 10 ** 5",
    ("'" + "a" * 600 + "'").join(["("] * 1) + ").replace('a', 'b' * 1000)",
    "1 @ 2",
    "1+" * 5000 + "1",
]


@pytest.mark.parametrize("text", REFUSED)
def test_what_is_outside_the_grammar_is_refused(text: str) -> None:
    with pytest.raises(RefusedError):
        evaluate(text, {"x": {}}, Budget(), {})


def write(folder: Path, body: str, name: str = "arm.urdf") -> Path:
    path = folder / name
    path.write_text(f'<robot xmlns:xacro="{WIKI}" name="r">\n{body}\n</robot>')
    return path


def expanded(path: Path) -> str:
    return str(read_description(path).urdf)


def test_refused_expressions_have_a_place(tmp_path: Path) -> None:
    path = write(tmp_path, '<link name="a"/>\n<link name="${[i for i in (1,)]}"/>')
    with pytest.raises(iksel.UrdfError, match="line 3: .*comprehension.*trusted=True"):
        expanded(path)
    assert '"[1]"' in str(read_description(path, trusted=True).urdf)


def test_the_packages_own_evaluation_is_never_reached(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    xacro = importlib.import_module("xacro")

    def refuse(*_arguments: object, **_options: object) -> None:
        pytest.fail("the package evaluates")

    for name in ("safe_eval", "eval_text", "eval_extension", "load_yaml"):
        monkeypatch.setattr(xacro, name, refuse)
    (tmp_path / "a.yaml").write_text("a: {b: [!degrees 90, !meters 2 * 3]}")
    (tmp_path / "part.xacro").write_text(
        f'<r xmlns:xacro="{WIKI}"><xacro:property name="z" value="7"/></r>'
    )
    path = write(
        tmp_path,
        """<xacro:arg name="side" default="left"/>
        <xacro:include filename="$(dirname)/p*.xacro" ns="part"/>
        <xacro:property name="y" value="${xacro.load_yaml('a.yaml')}"/>
        <xacro:property name="z" value="${y.a.b[1] * 2}"/>
        <xacro:macro name="m" params="a b:=${z} c:='it is' *block">
          <link name="${a}_${b}_${c}"/><xacro:insert_block name="block"/>
        </xacro:macro>
        <xacro:m a="$(arg side)"><link name="${part.z}"/></xacro:m>
        <link name="7$${x}"/>
        <xacro:if value="${y['a']['b'][0] > 1.5 and xacro.arg('side') == 'left'}">
          <link name="if$(optenv IKSEL_UNSET none)"/></xacro:if>
        <xacro:unless value="true"><link name="unless"/></xacro:unless>""",
    )
    text = expanded(path)
    for name in ("left_12.0_it is", "7${x}", "ifnone"):
        assert f'name="{name}"' in text
    assert "unless" not in text


@pytest.mark.parametrize("command", ["eval 1", "cwd", "export A", "env", "find a b"])
def test_other_substitutions_are_refused(tmp_path: Path, command: str) -> None:
    path = write(tmp_path, f'<link name="$({command})"/>')
    with pytest.raises(iksel.UrdfError, match="line 2: .*possible are find, arg, env"):
        expanded(path)


def test_urdf_with_a_dollar_is_no_xacro(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text('<robot name="r"><link name="${1}"/></robot>')
    with pytest.raises(iksel.UrdfError, match=r"\$\{1\}.*not evaluated.*xmlns:xacro"):
        iksel.load_robot(path)
    with pytest.raises(iksel.UrdfError, match="not evaluated"):
        iksel.load_robot(path, trusted=True)


def test_tags_of_yaml_run_nothing_after_a_xacro_file(tmp_path: Path) -> None:
    """The package adds constructors that evaluate to PyYAML's own loader."""
    yaml = pytest.importorskip("yaml")
    (tmp_path / "a.yaml").write_text("a: !degrees 90")
    expanded(write(tmp_path, "<link name=\"${xacro.load_yaml('a.yaml').a}\"/>"))
    with pytest.raises(yaml.YAMLError):
        yaml.safe_load("!degrees 90")
