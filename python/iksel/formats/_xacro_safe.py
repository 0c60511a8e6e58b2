# SPDX-License-Identifier: BSD-3-Clause
"""The package xacro with those parts replaced that run what a file says.

It keeps what it works on in its module, and so do its replacements: they stand there
while a file is expanded.
"""

from __future__ import annotations

import contextlib
import os
import re
import xml.dom.minidom
from pathlib import Path
from typing import TYPE_CHECKING, Any

from iksel._base.files import read_bytes
from iksel.formats import _safe_yaml
from iksel.formats._bounds import Budget, RefusedError, check_length, size_of
from iksel.formats._xacro_eval import evaluate

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

# What is not closed goes on to the end, so that it is looked through only once.
_PART = re.compile(r"\$\$+[{(]|\$\{[^}]*(?:\}|\Z)|\$\([^)]*(?:\)|\Z)|[^$]+|\$")
_CLOSED = {"${": "}", "$(": ")"}
_WILD = "*[?"  # in names of files
_ELEMENT = 400  # steps for an element, which take as long as it does
_SHOWN = 60  # characters of an expression in an error
_LARGEST_FILE = 1 << 23  # bytes; the largest of real robots has 200,000
_UNITS = {
    "!radians": 1.0,
    "!degrees": 0.017453292519943295,
    "!meters": 1.0,
    "!millimeters": 1e-3,
    "!foot": 0.3048,
    "!inches": 0.0254,
}
# A parameter of a macro with a default; without nested repetition, as the package's
# own pattern never ends on some texts.
_DEFAULT = r"""\$\{[^}]*\}|\$\([^)]*\)|(?:'[^']*'|"[^"]*"|[^\s'"])+|"""
_PARAMETER = re.compile(
    r"\s*([^\s:=]+)\s*:?=\s*(\^\|?)?(" + _DEFAULT + r")(?:\s+|\Z)(.*)", re.DOTALL
)


@contextlib.contextmanager
def replaced_parts(package: Any, find: Callable[[str], str]) -> Iterator[None]:
    """Put the replacements into the package for a while.

    Args:
        package: The module xacro.
        find: Gives the folder of a ROS package.

    Raises:
        RefusedError: A version of the package that lacks what has to be replaced.
    """
    files = _Files(package, find)
    parts: dict[str, Any] = {
        "eval_text": files.eval_text,
        "safe_eval": _unreached,
        "eval_extension": _unreached,
        "load_yaml": _unreached,
        "parse": files.parse,
        "get_include_files": files.include_files,
        "parse_macro_arg": _parse_parameter,
        "eval_all": files.counting(package.eval_all),
        "_global_symbols": {},
    }
    lacking = [name for name in parts if not hasattr(package, name)]
    if lacking:
        msg = (
            f"the package xacro has no {', '.join(lacking)}, so that it cannot be kept "
            "from running Python: pip install 'xacro>=2.1'"
        )
        raise RefusedError(msg)
    before = {name: getattr(package, name) for name in parts}
    vars(package).update(parts)
    try:
        yield
    finally:
        vars(package).update(before)


class _PlacedError(Exception):
    """An error whose text begins with the place in the file."""


class _PlacedRefusedError(_PlacedError, RefusedError):
    """A refusal whose text begins with the place in the file."""


def _unreached(*_arguments: Any, **_options: Any) -> Any:
    """Stands for what nothing calls any more."""
    msg = "the package xacro evaluates in a way that is not known"
    raise RefusedError(msg)


class _Files:
    """What is known of a file and those that it includes, while it is expanded."""

    def __init__(self, package: Any, find: Callable[[str], str]) -> None:
        self._package = package
        self._find = find
        self._budget = Budget()
        self._texts: dict[str, str] = {}
        self._functions: dict[str, Callable[..., Any]] = {
            "load_yaml": self._load_yaml,
            "abs_filename": self._beside,
            "arg": self._argument,
        }

    def counting(self, eval_all: Callable[..., None]) -> Callable[..., None]:
        """The package's loop over an element, which counts its elements."""

        def counted(node: Any, macros: Any, symbols: Any) -> None:
            self._budget.spend(_ELEMENT)
            eval_all(node, macros, symbols)

        return counted

    def parse(self, inp: Any, filename: str | None = None) -> Any:
        """The document of a file, of elements and text alone."""
        if filename is None or inp is not None:
            return _unreached()
        text = self._read(filename, _LARGEST_FILE)
        if "<!ENTITY" in text:
            msg = f"{filename}: an <!ENTITY>; write in its place what it stands for"
            raise RefusedError(msg)
        document = xml.dom.minidom.parseString(text.encode())  # noqa: S318 (no entities)
        _drop_others(document.documentElement)
        self._texts[filename] = text
        return document

    def include_files(self, name: str, symbols: Any) -> Iterator[str]:
        """Files that an <xacro:include> names, with wildcards in the name alone."""
        path = self._beside(str(self.eval_text(name, symbols)))
        if not any(c in path for c in _WILD):
            yield path
            return
        folder = Path(path).parent
        if any(c in str(folder) for c in _WILD):
            msg = f"include {name!r}: wildcards in the name of a folder"
            raise RefusedError(msg)
        yield from sorted(map(str, folder.glob(Path(path).name)))

    def eval_text(self, text: str, symbols: Any) -> Any:
        """A text with the values of all `${...}` and `$(...)` in it."""
        results: list[Any] = []
        for part in _PART.findall(text):
            if part[:2] in _CLOSED and part[-1] != _CLOSED[part[:2]]:
                msg = f"{part[:_SHOWN]}: {part[:2]} is not closed"
                raise RefusedError(msg)
            if part.startswith("${"):
                results.append(self._evaluate(part, symbols))
            elif part.startswith("$("):
                inner = str(self.eval_text(part[2:-1], symbols))
                results.append(self._substitute(part, inner))
            else:
                results.append(part[1:] if part.startswith("$$") else part)
            self._budget.spend(size_of(results[-1]))
        if len(results) == 1:
            return results[0]
        words = [str(result) for result in results]
        check_length(sum(map(len, words)))
        return "".join(words)

    def _evaluate(self, part: str, symbols: Any) -> Any:
        try:
            text = str(self.eval_text(part[2:-1], symbols))
            return evaluate(text, symbols, self._budget, self._functions)
        except Exception as error:  # noqa: BLE001 (of operators and functions)
            raise self._placed(error, part) from None

    def _placed(self, error: Exception, part: str) -> Exception:
        """An error with the place of the text that it is of."""
        if isinstance(error, _PlacedError):
            return error
        shown = part if len(part) <= _SHOWN else part[: _SHOWN - 4] + " ..."
        reason = str(error) or type(error).__name__
        if isinstance(error, RecursionError):
            reason = "it is nested too deep"
        text = f"{self._place(part)}{shown}: {reason}"
        if isinstance(error, RefusedError):
            return _PlacedRefusedError(text)
        return _PlacedError(text)

    def _place(self, part: str) -> str:
        """File and line of the first place where a text stands."""
        now = [str(file) for file in reversed(self._package.filestack or [])]
        for name in dict.fromkeys([*now, *self._texts]):
            at = self._texts.get(name, "").find(part)
            if at >= 0:
                line = self._texts[name].count("\n", 0, at) + 1
                return f"{Path(name).name}, line {line}: "
        return ""

    def _substitute(self, part: str, inner: str) -> str:
        """What a `$(...)` stands for."""
        command, *words = inner.split() or [""]
        try:
            return self._command(command, words)
        except Exception as error:  # noqa: BLE001 (of operators and functions)
            raise self._placed(error, part) from None

    def _command(self, command: str, words: list[str]) -> str:
        if command == "dirname" and not words:
            return str(self._here().absolute())
        if command == "optenv" and words:
            return os.environ.get(words[0], " ".join(words[1:]))
        if command in {"find", "arg", "env", "anon"} and len(words) == 1:
            (word,) = words
            if command == "find":
                return self._find(word)
            if command == "arg":
                return str(self._argument(word))
            if command == "anon":
                return f"{word}_anon"
            if word not in os.environ:
                msg = f"the environment has no variable {word!r}"
                raise ValueError(msg)
            return os.environ[word]
        msg = (
            f"$({command} ...) with {len(words)} words; possible are find, arg, env, "
            "anon (one word), optenv (one or two) and dirname"
        )
        raise RefusedError(msg)

    def _argument(self, name: str) -> Any:
        given = self._package.substitution_args_context["arg"]
        if name not in given:
            msg = f"undefined arg {name!r}"
            raise ValueError(msg)
        return given[name]

    def _load_yaml(self, name: str) -> Any:
        path = self._beside(name)
        text = self._read(path, _LARGEST_FILE)
        tags = {tag: self._unit(size) for tag, size in _UNITS.items()}
        try:
            return _safe_yaml.load(text, tags)
        except ImportError:
            msg = "load_yaml() needs PyYAML: pip install pyyaml"
            raise ValueError(msg) from None

    def _unit(self, size: float) -> Callable[[str], float]:
        """What makes a number [m or rad] of an expression in a unit."""
        return lambda text: float(evaluate(text, {}, self._budget, {})) * size

    def _read(self, name: str, largest: int) -> str:
        """The text of a file that another one names."""
        path = Path(name)
        try:
            if path.exists() and not path.is_file():
                msg = f"{name}: it is no regular file"
                raise RefusedError(msg)
            text = read_bytes(path, largest).decode()
        except OSError as error:
            named = OSError(error.errno, error.strerror, name)
            raise self._package.XacroException(exc=named) from None
        self._budget.spend(len(text))
        return text

    def _here(self) -> Path:
        """The folder of the file that is being expanded."""
        return Path(self._package.filestack[-1]).parent

    def _beside(self, name: str) -> str:
        return os.path.join(self._here(), name)  # noqa: PTH118 (keeps package://)


def _drop_others(node: Any) -> None:
    """Drop comments and the like, which make no robot and are copied with macros."""
    left = [node]
    while left:
        parent = left.pop()
        for child in list(parent.childNodes):
            if child.nodeType == child.ELEMENT_NODE:
                left.append(child)
            elif child.nodeType != child.TEXT_NODE:
                parent.removeChild(child)


def _parse_parameter(
    text: str,
) -> tuple[str, tuple[str | None, str | None] | None, str]:
    """The first of a macro's parameters, its default, and the parameters behind it."""
    check_length(len(text))
    match = _PARAMETER.match(text)
    if match is None:
        words = [*text.split(None, 1), "", ""]
        return words[0], None, words[1]
    name, forward, default, rest = match.groups()
    return name, (name if forward else None, default or None), rest
