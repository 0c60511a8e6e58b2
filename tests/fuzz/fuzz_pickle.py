# SPDX-License-Identifier: BSD-3-Clause
"""Pickles of every bound class, damaged: an exception, or an object that works.

The first byte of an input says how: an even one is followed by a pickle; else the rest
chooses an object and damages its state. No method of what comes out may kill the
interpreter. Only the names that sound pickles hold are looked up, and numpy's arrays
are rebuilt with checks of our own: what they do with damage is not the question here.
"""

from __future__ import annotations

import contextlib
import copy
import io
import math
import pickle
import pickletools
import sys
from pathlib import Path
from typing import Any

import atheris
import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from pickle_samples import POSE, make_samples

import iksel

SAMPLES = make_samples()
CLASSES = {type(sample) for sample in SAMPLES}
PICKLES = [pickle.dumps(sample, 4) for sample in SAMPLES]


def names_in(pickled: bytes) -> set[tuple[str, str]]:
    """The names that a sound pickle looks up."""
    found = set()

    class Names(pickle.Unpickler):
        def find_class(self, module: str, name: str) -> Any:
            found.add((module, name))
            return super().find_class(module, name)

    Names(io.BytesIO(pickled)).load()
    return found


NAMES = set().union(*map(names_in, PICKLES))

DTYPES = {"f8", "i8", "i4", "u1", "b1", "f4", "O8"}


class Kind:
    """In place of a dtype."""

    def __init__(self, name: object = "f8", *_: object) -> None:
        assert name in DTYPES
        self.dtype = np.dtype(str(name))

    def __setstate__(self, state: object) -> None:
        """All that is in it is the byte order."""


class Array(np.ndarray):
    """An array that takes only a state that fits together."""

    def __setstate__(self, state: Any) -> None:
        _, shape, kind, fortran, content = state
        size = math.prod(int(n) for n in shape) * kind.dtype.itemsize
        assert isinstance(content, bytes)
        assert size == len(content) < 100_000
        assert not kind.dtype.hasobject
        super().__setstate__((1, shape, kind.dtype, bool(fortran), content))


def find(module: str, name: str) -> Any:
    """What a name in a pickle stands for."""
    if (module, name) not in NAMES:
        raise pickle.UnpicklingError(f"{module}.{name} is in no sound pickle")
    if module.startswith("numpy"):
        if name == "dtype":
            return Kind
        return {
            "ndarray": Array,
            "_reconstruct": lambda *_: np.ndarray.__new__(Array, (0,)),
            "scalar": lambda kind, raw: np.frombuffer(raw, kind.dtype)[0],
        }[name]
    value = __import__(module, fromlist=[name])
    for part in name.split("."):
        value = getattr(value, part)
    return value


# The one in C makes room for any number of memos that a damaged pickle asks for.
class Unpickler(pickle._Unpickler):
    """Looks up only what sound pickles do."""

    # Each operation counts as covered; not that which makes room before it looks
    # whether there is as much to read.
    dispatch = {  # noqa: RUF012
        code: atheris.instrument_func(load)
        for code, load in pickle._Unpickler.dispatch.items()
        if code != pickle.BYTEARRAY8[0]
    }

    def find_class(self, module: str, name: str) -> Any:
        return find(module, name)


ODD: list[Any] = [
    *(None, True, 0, -1, 1, 2, 7, 2**31, 2**64, -(2**70), 0.0, -1.0, 1e-320),
    *(1e308, math.nan, math.inf, "", "x", "solved", "\ud800", b"", b"\0", (), [], {}),
    *({"x": 1}, ((),), np.zeros(0), np.full(2, math.nan), np.zeros((2, 3), "i4")),
    *(np.array(["a", None], object), np.zeros(1), 1j, object(), *SAMPLES),
]


@atheris.instrument_func
def damage_items(items: list[Any], how: int, dice: atheris.FuzzedDataProvider) -> None:
    """One item less, one more, or one damaged."""
    at = dice.ConsumeIntInRange(0, len(items) - 1)
    if how == 1:
        del items[at]
    elif how == 2:
        items.insert(at, dice.PickValueInList(ODD))
    else:
        items[at] = damage(items[at], dice)


@atheris.instrument_func
def damage_fields(
    fields: dict[Any, Any], how: int, dice: atheris.FuzzedDataProvider
) -> None:
    """One field less, one more, or one damaged."""
    key = dice.PickValueInList(list(fields))
    if how == 1:
        del fields[key]
    elif how == 2:
        fields[dice.PickValueInList(["x", 1, None, key])] = None
    else:
        fields[key] = damage(fields[key], dice)


@atheris.instrument_func
def damage_array(
    array: np.ndarray, how: int, dice: atheris.FuzzedDataProvider
) -> np.ndarray:
    """Another shape, another type, or another number."""
    if how == 1:
        return array.ravel()[1:]
    if how == 2:
        # An earlier damage may have put words among the numbers.
        with contextlib.suppress(ValueError, TypeError, OverflowError):
            return array.astype(dice.PickValueInList(["f4", "i8", "O", "U9", "?"]))
    changed = array.copy()
    number = dice.PickValueInList([0, 1, 2, math.nan, 1e308])
    at = dice.ConsumeIntInRange(0, array.size - 1)
    changed.flat[at] = number if array.dtype.kind == "f" else 1
    return changed


@atheris.instrument_func
def damage(value: Any, dice: atheris.FuzzedDataProvider) -> Any:
    """The value with something in it changed."""
    how = dice.ConsumeIntInRange(0, 9)
    changed = dice.PickValueInList(ODD)
    empty = isinstance(value, np.ndarray) and not value.size
    if how == 0 or empty:
        pass
    elif isinstance(value, np.ndarray):
        changed = damage_array(value, how, dice)
    elif isinstance(value, (tuple, list)) and value:
        items = list(value)
        damage_items(items, how, dice)
        changed = type(value)(items)
    elif isinstance(value, dict) and value:
        changed = dict(value)
        damage_fields(changed, how, dice)
    elif isinstance(value, (bytes, str)) and value:
        at = dice.ConsumeIntInRange(0, len(value) - 1)
        put = dice.ConsumeBytes(4)
        rest = value[at + len(put) :] if how != 1 else value[:0]
        changed = value[:at] + (put if isinstance(value, bytes) else str(put)) + rest
    return changed


@atheris.instrument_func
def damaged_object(data: bytes) -> Any:
    """An object made of a damaged state, or of none."""
    dice = atheris.FuzzedDataProvider(data)
    sample = dice.PickValueInList(SAMPLES)
    thing = type(sample).__new__(type(sample))
    if dice.ConsumeIntInRange(0, 9) == 0:
        return thing
    state = copy.copy(sample.__reduce_ex__(4)[2])
    for _ in range(dice.ConsumeIntInRange(1, 3)):
        state = damage(state, dice)
    # An object that refused its state is one without a state.
    with contextlib.suppress(Exception):
        thing.__setstate__(state)
    return thing


@atheris.instrument_func
def survive(call: Any, *arguments: Any) -> Any:
    """The value of a call, or its exception unless it tells of a broken interpreter."""
    try:
        return call(*arguments)
    except (SystemError, MemoryError):
        raise
    except Exception as error:  # noqa: BLE001
        return error


@atheris.instrument_func
def use(thing: Any) -> None:
    """Ask an object for all that it has."""
    for call in (repr, str, len, iter, hash, bool, copy.copy, pickle.dumps):
        survive(call, thing)
    survive(lambda: thing == thing)  # noqa: PLR0124
    survive(lambda: thing[0])
    if isinstance(thing, iksel.Solver):
        solve(thing)
    for name in dir(type(thing)):
        if name.startswith("__"):
            continue
        value = survive(getattr, thing, name)
        # Solvers work for long where their options say so.
        if callable(value) and not isinstance(thing, (iksel.Solver, type)):
            for arguments in ((), (POSE,), ([0.1, 0.2],), (POSE, 0.1), (1, 2)):
                survive(value, *arguments)


@atheris.instrument_func
def solve(solver: iksel.Solver) -> None:
    """No success that is none."""
    result = survive(lambda: solver.solve(POSE, deadline=0.05))
    if not isinstance(result, iksel.Result) or not result.success:
        return
    error = iksel.pose_error(POSE, solver.robot.fk(result.q))
    assert np.linalg.norm(error[:3]) <= solver.options.position_tolerance + 1e-12
    assert np.linalg.norm(error[3:]) <= solver.options.rotation_tolerance + 1e-12


@atheris.instrument_func
def one_input(data: bytes) -> None:
    """Load and use one damaged object."""
    if not data:
        return
    if data[0] % 2:
        use(damaged_object(data[1:]))
        return
    thing = survive(lambda: Unpickler(io.BytesIO(data[1:])).load())
    if type(thing) in CLASSES:
        use(thing)


def write_corpus(folder: Path) -> None:
    """The sound pickles as inputs."""
    for sample, pickled in zip(SAMPLES, PICKLES, strict=True):
        name = type(sample).__name__
        short = pickletools.optimize(pickled)
        (folder / f"{name}-{len(short)}").write_bytes(b"\0" + short)


if sys.argv[1:2] == ["--write-corpus"]:
    write_corpus(Path(sys.argv[2]))
else:
    atheris.Setup(sys.argv, one_input)
    atheris.Fuzz()
