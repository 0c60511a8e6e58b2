# SPDX-License-Identifier: BSD-3-Clause
"""Evaluates the expressions of xacro files, which cannot reach Python's objects.

An expression is parsed, and each node of its tree is either one of those below or
refused: nothing is compiled, and no attribute of an object is ever looked up.
"""

from __future__ import annotations

import ast
import operator
import warnings
from typing import TYPE_CHECKING, Any

from iksel.formats._bounds import RefusedError, check_bits, check_length, size_of
from iksel.formats._xacro_functions import (
    CONSTANTS,
    FUNCTIONS,
    METHODS,
    NAMESPACES,
    format_text,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from iksel.formats._bounds import Budget

LONGEST_EXPRESSION = 4000  # characters

_UNARY: dict[type, Callable[[Any], Any]] = {
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
    ast.Not: operator.not_,
    ast.Invert: operator.invert,
}
_COMPARE: dict[type, Callable[[Any, Any], Any]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
    ast.In: lambda a, b: a in b,
    ast.NotIn: lambda a, b: a not in b,
}


def _add(a: Any, b: Any) -> Any:
    if not isinstance(a, (int, float)):
        check_length(size_of(a) + size_of(b))
    return a + b


def _multiply(a: Any, b: Any) -> Any:
    for one, other in ((a, b), (b, a)):
        if isinstance(one, (str, list, tuple)) and isinstance(other, int):
            check_length(size_of(one) * other)
    return a * b


def _modulo(a: Any, b: Any) -> Any:
    return format_text(a, b) if isinstance(a, str) else a % b


def _power(a: Any, b: Any) -> Any:
    if isinstance(a, int) and isinstance(b, int):
        check_bits(a.bit_length() * abs(b))
    return a**b


def _shift(a: Any, b: Any) -> Any:
    check_bits(a.bit_length() + b)
    return a << b


_BINARY: dict[type, Callable[[Any, Any], Any]] = {
    ast.Add: _add,
    ast.Mult: _multiply,
    ast.Mod: _modulo,
    ast.Pow: _power,
    ast.LShift: _shift,
    ast.Sub: operator.sub,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.RShift: operator.rshift,
    ast.BitAnd: operator.and_,
    ast.BitOr: operator.or_,
    ast.BitXor: operator.xor,
}
_REFUSED = {
    ast.Lambda: "a lambda",
    ast.ListComp: "a comprehension",
    ast.SetComp: "a comprehension",
    ast.DictComp: "a comprehension",
    ast.GeneratorExp: "a comprehension",
    ast.JoinedStr: "an f-string",
    ast.NamedExpr: "an assignment",
    ast.Starred: "a star",
    ast.Await: "await",
    ast.Yield: "yield",
    ast.YieldFrom: "yield",
    ast.Set: "a set",
}


def evaluate(
    text: str,
    names: Mapping[str, Any],
    budget: Budget,
    functions: Mapping[str, Callable[..., Any]],
) -> Any:
    """The value of an expression.

    Args:
        text: The expression.
        names: Values of the properties and parameters that it may name.
        budget: The work that is left.
        functions: Functions of the file's surroundings, such as xacro.load_yaml.

    Raises:
        RefusedError: It is outside the grammar, or makes too much.
        Exception: What its operators and functions raise for their operands.
    """
    if len(text) > LONGEST_EXPRESSION:
        msg = f"an expression longer than {LONGEST_EXPRESSION} characters"
        raise RefusedError(msg)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of how other people write
        tree = ast.parse(text.strip(), mode="eval")
    return _Evaluation(names, budget, functions).value(tree.body)


class _Evaluation:
    """One expression's names and budget."""

    def __init__(
        self,
        names: Mapping[str, Any],
        budget: Budget,
        functions: Mapping[str, Callable[..., Any]],
    ) -> None:
        self._names = names
        self._budget = budget
        self._functions = {**FUNCTIONS, **functions}
        self._nodes: dict[type, Callable[[Any], Any]] = {
            ast.Constant: self._constant,
            ast.Name: self._name,
            ast.Attribute: self._attribute,
            ast.Subscript: self._subscript,
            ast.Call: self._call,
            ast.UnaryOp: self._unary,
            ast.BinOp: self._binary,
            ast.BoolOp: self._boolean,
            ast.Compare: self._compare,
            ast.IfExp: self._choice,
            ast.List: lambda node: [self.value(e) for e in node.elts],
            ast.Tuple: lambda node: tuple(self.value(e) for e in node.elts),
            ast.Dict: self._dict,
        }

    def value(self, node: ast.AST) -> Any:
        """The value of a node, which is of the types below and not too large."""
        take = self._nodes.get(type(node))
        if take is None:
            word = _REFUSED.get(type(node), f"Python's {type(node).__name__}")
            msg = f"{word} is no part of the expressions that are evaluated"
            raise RefusedError(msg)
        found = take(node)
        if isinstance(found, int):
            check_bits(found.bit_length())
        elif isinstance(found, (str, list, tuple, dict)):
            self._budget.spend(size_of(found))
        elif not (found is None or isinstance(found, float)):
            msg = f"a value of type {type(found).__name__}"
            raise RefusedError(msg)
        self._budget.spend(1)
        return found

    def _constant(self, node: ast.Constant) -> Any:
        return node.value

    def _name(self, node: ast.Name) -> Any:
        _check_name(node.id)
        if node.id in self._names:
            return self._names[node.id]
        if node.id in CONSTANTS:
            return CONSTANTS[node.id]
        msg = f"name {node.id!r} is not defined"
        raise NameError(msg)

    def _attribute(self, node: ast.Attribute) -> Any:
        """An item of a dictionary or namespace; objects' attributes are refused."""
        _check_name(node.attr)
        if self._is_namespace(node.value) and node.attr in CONSTANTS:
            return CONSTANTS[node.attr]
        held = self.value(node.value)
        if isinstance(held, dict):
            return held[node.attr]
        msg = f"attribute access (.{node.attr}): only dictionaries have items by a dot"
        raise RefusedError(msg)

    def _is_namespace(self, node: ast.AST) -> bool:
        return (
            isinstance(node, ast.Name)
            and node.id in NAMESPACES
            and node.id not in self._names
        )

    def _subscript(self, node: ast.Subscript) -> Any:
        held = self.value(node.value)
        if not isinstance(node.slice, ast.Slice):
            return held[self.value(node.slice)]
        ends = (node.slice.lower, node.slice.upper, node.slice.step)
        return held[slice(*(None if e is None else self.value(e) for e in ends))]

    def _call(self, node: ast.Call) -> Any:
        options = {}
        for keyword in node.keywords:
            if keyword.arg is None:
                msg = "a star is no part of the expressions that are evaluated"
                raise RefusedError(msg)
            options[keyword.arg] = self.value(keyword.value)
        name = self._function_name(node.func)
        if name == "map" and len(node.args) == 2 and not options:
            each = self._function(self._function_name(node.args[0]))
            return [each(item) for item in self.value(node.args[1])]
        values = [self.value(argument) for argument in node.args]
        if name is None and isinstance(node.func, ast.Attribute):
            held = self.value(node.func.value)
            method = METHODS.get((_kind(held), node.func.attr))
            if method is not None:
                return method(held, *values, **options)
        return self._function(name)(*values, **options)

    def _function_name(self, node: ast.AST) -> str | None:
        """The name of a function, without its namespace."""
        if isinstance(node, ast.Name):
            return node.id
        if isinstance(node, ast.Attribute) and self._is_namespace(node.value):
            return node.attr
        return None

    def _function(self, name: str | None) -> Callable[..., Any]:
        if name is None or name not in self._functions:
            called = "what is no function" if name is None else f"{name}()"
            msg = f"a call of {called}; possible are xacro's own and math's functions"
            raise RefusedError(msg)
        return self._functions[name]

    def _unary(self, node: ast.UnaryOp) -> Any:
        return _UNARY[type(node.op)](self.value(node.operand))

    def _binary(self, node: ast.BinOp) -> Any:
        operate = _BINARY.get(type(node.op))
        if operate is None:
            msg = f"the operator {type(node.op).__name__} is no part of expressions"
            raise RefusedError(msg)
        return operate(self.value(node.left), self.value(node.right))

    def _boolean(self, node: ast.BoolOp) -> Any:
        ends = isinstance(node.op, ast.Or)
        value: Any = None
        for part in node.values:
            value = self.value(part)
            if bool(value) is ends:
                break
        return value

    def _compare(self, node: ast.Compare) -> Any:
        left = self.value(node.left)
        for kind, part in zip(node.ops, node.comparators, strict=True):
            right = self.value(part)
            if not _COMPARE[type(kind)](left, right):
                return False
            left = right
        return True

    def _choice(self, node: ast.IfExp) -> Any:
        return self.value(node.body if self.value(node.test) else node.orelse)

    def _dict(self, node: ast.Dict) -> Any:
        if None in node.keys:
            msg = "a star is no part of the expressions that are evaluated"
            raise RefusedError(msg)
        keys = [self.value(key) for key in node.keys if key is not None]
        return dict(zip(keys, map(self.value, node.values), strict=True))


def _kind(value: Any) -> type:
    """The type that methods are looked up by."""
    return next((kind for kind in (str, dict) if isinstance(value, kind)), object)


def _check_name(name: str) -> None:
    if name.startswith("__"):
        msg = f"the name {name}: names with two underscores are Python's own"
        raise RefusedError(msg)
