"""Checks of the arguments of public functions: an error names the argument and what is legal."""

from __future__ import annotations

import functools
import inspect
import reprlib
from collections.abc import Callable, Mapping, Sequence
from numbers import Integral, Real
from os import PathLike
from types import UnionType
from typing import Any, NamedTuple, ParamSpec, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import ArrayLike, NDArray

P = ParamSpec("P")
R = TypeVar("R")

_MOST = 2**63 - 1  # of the whole numbers that the core takes


class _Kind(NamedTuple):
    """A kind of values that an annotation asks for."""

    words: str
    holds: Callable[[Any], bool]


def checked(function: Callable[P, R]) -> Callable[P, R]:
    """Makes a function check its arguments by their annotations each time it is called.

    Whole numbers, numbers, texts, paths, lists of texts and objects of RTG are checked, others are
    not. It then raises TypeError for a value of another kind, ValueError for a whole number that is
    negative or too large.
    """
    parameters = inspect.signature(function).parameters.values()
    by_place = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    names = [one.name for one in parameters if one.kind in by_place]

    @functools.cache
    def kinds() -> Mapping[str, list[_Kind]]:
        # not before the first call: annotations may name a class that is being made
        hints = get_type_hints(function)
        return {name: kinds for name in hints if (kinds := _kinds(hints[name]))}

    @functools.wraps(function)
    def call(*args: P.args, **kwargs: P.kwargs) -> R:
        known = kinds()
        for name, value in (*zip(names, args, strict=False), *kwargs.items()):
            if name in known:
                _check(name, value, known[name])
        return function(*args, **kwargs)

    return call


def _check(name: str, value: Any, kinds: list[_Kind]) -> None:
    legal = " or ".join(kind.words for kind in kinds)
    if not any(kind.holds(value) for kind in kinds):
        raise TypeError(f"{name} {reprlib.repr(value)}; legal: {legal}")
    if isinstance(value, Integral) and not 0 <= int(value) <= _MOST:
        raise ValueError(f"{name} {value}; legal: {legal}")


def _kinds(hint: Any) -> list[_Kind]:
    """Returns the kinds of values of an annotation; none if one of them is not checked."""
    if get_origin(hint) in (Union, UnionType):
        found = [_kinds(part) for part in get_args(hint)]
        return [kind for part in found for kind in part] if all(found) else []
    if hint is type(None):
        return [_Kind("None", lambda value: value is None)]
    if hint is int:
        return [_Kind("a whole number from 0 on", lambda value: isinstance(value, Integral))]
    if hint is float:
        return [_Kind("a number", lambda value: isinstance(value, Real))]
    if hint is str:
        return [_Kind("a text", lambda value: isinstance(value, str))]
    if hint == Sequence[str]:
        return [_Kind('a list of texts, such as ["search.breadth=20"]', _are_texts)]
    known = hint if inspect.isclass(hint) else get_origin(hint)
    if inspect.isclass(known) and issubclass(known, PathLike):
        return [_Kind("a path", lambda value: isinstance(value, PathLike))]
    if inspect.isclass(known) and known.__module__.partition(".")[0] == "rtg":
        words = f"an object of class {known.__name__}"
        return [_Kind(words, lambda value: isinstance(value, known))]
    return []


def _are_texts(value: Any) -> bool:
    is_list = isinstance(value, Sequence) and not isinstance(value, str | bytes)
    return is_list and all(isinstance(one, str) for one in value)


def numbers(name: str, given: ArrayLike, shape: Sequence[int | None]) -> NDArray[np.float64]:
    """Returns an array of numbers of a shape, in which None stands for any length.

    `name`: that of the argument. Raises ValueError for another shape, and for no numbers.
    """
    legal = ", ".join("N" if length is None else str(length) for length in shape)
    try:
        array = np.asarray(given, np.float64)
    except (TypeError, ValueError):
        wrong = f"{name} {reprlib.repr(given)}"
        raise ValueError(f"{wrong}; legal: an array of numbers [{legal}]") from None
    fits = len(shape) == array.ndim and all(
        length in (None, found) for found, length in zip(array.shape, shape, strict=True)
    )
    if not fits:
        raise ValueError(f"{name} of shape {list(array.shape)}; legal: [{legal}]")
    return np.ascontiguousarray(array)


def indices(name: str, given: ArrayLike, end: int) -> NDArray[np.int64]:
    """Returns whole numbers from 0 to `end` - 1 as an array [N], a single one as [1].

    `name`: that of one of them. Raises ValueError for others.
    """
    column = np.atleast_1d(np.asarray(given))
    if column.ndim != 1 or (column.dtype.kind not in "iu" and column.size):
        raise ValueError(f"{name}s of type {column.dtype}; legal: whole numbers, [N]")
    if column.size and not 0 <= column.min() <= column.max() < end:
        wrong = column[(column < 0) | (column >= end)]
        raise ValueError(f"{name} {int(wrong[0])}; legal: 0 to {end - 1}")
    return column.astype(np.int64)
