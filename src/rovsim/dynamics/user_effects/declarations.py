"""Check the declarations of an effect class before it is used: types and ranges."""

import keyword
from numbers import Real
from typing import Any, Iterator, Mapping, get_args

import numpy as np

from rovsim.core.errors import BadInput
from rovsim.dynamics.effects.base import Effect, Parameter, Requirement, Wrench

REQUIRED_TEXTS = ("equation", "neglects", "source")
SEE_GUIDE = "docs/your_own_effect.md shows a complete one."
PARAMETER_NUMBERS = ("low", "high", "default", "scale", "resolution")


def refused(found: str, where: object, expected: str, meant: str = "") -> BadInput:
    """The error that refuses a user's effect.

    Args:
        found: what is wrong.
        where: the file, and the line or the class.
        expected: what should be there.
        meant: a question after the name that was meant, if one is near.
    """
    return BadInput(found, where=where, expected=expected, remedy=f"{meant} {SEE_GUIDE}".lstrip())


def find_faults(cls: type[Effect]) -> Iterator[tuple[str, str]]:
    """Yield faults of a complete class: (found, expected). Callers should stop at the first."""
    yield from _find_shapes(cls)
    yield from _find_kinds(cls)
    for parameter in cls.parameters:
        yield from _find_in_parameter(parameter, [p.name for p in cls.parameters])
    if not any(p.fitted for p in cls.parameters):
        yield "no parameter is fitted", "at least one that a diagnosis may fit"
    names = {p.name for p in cls.parameters}
    for start in cls.starts:
        if not set(start) <= names:
            unknown = ", ".join(sorted(set(start) - names))
            yield f"'starts' names {unknown}", f"its parameters: {', '.join(sorted(names))}"
    yield from _find_out_of_range(cls)
    if not set(cls.telling) <= names:
        yield f"'telling' is {cls.telling}", f"some of its parameters: {', '.join(sorted(names))}"


def _find_shapes(cls: type[Effect]) -> Iterator[tuple[str, str]]:
    """Yield declarations that are not tuples (often a comma is missing) or have wrong elements."""
    if not _holds(cls.parameters, Parameter):
        yield "'parameters' holds something else", "a tuple of Parameter(name, unit, symbol, …)"
    if not cls.starts or not _holds(cls.starts, Mapping):
        yield f"'starts' is {cls.starts!r}", "a tuple of mappings: ({'name': value},)"
    if not _holds(cls.symbols, tuple) or not all(len(s) == 2 for s in cls.symbols):
        yield f"'symbols' is {cls.symbols!r}", "a tuple of pairs: (('Y', 'the force'),)"
    if not _holds(cls.telling, str):
        yield f"'telling' is {cls.telling!r}", "a tuple of names: ('name',)"
    if cls.requires not in get_args(Requirement):
        yield f"'requires' is {cls.requires!r}", f"one of {', '.join(get_args(Requirement))}"
    if issubclass(cls, Wrench):
        valid = _holds(cls.channels, str) and all(map(_is_name, cls.channels))
        if not valid:
            yield f"'channels' is {cls.channels!r}", "a tuple of names: ('voltage',)"


def _find_out_of_range(cls: type[Effect]) -> Iterator[tuple[str, str]]:
    """Yield values of `starts` that are out of the range of their parameter."""
    for p in cls.parameters:
        for value in [start[p.name] for start in cls.starts if p.name in start]:
            if not (isinstance(value, Real) and np.isfinite(value) and p.low <= value <= p.high):
                expected = f"a number {p.range_in_words}"
                yield f"'starts' has {p.name} at {value!r}", expected


def _find_kinds(cls: type[Effect]) -> Iterator[tuple[str, str]]:
    """Yield wrong types among the declarations that are not tuples."""
    if not cls.equation.strip():
        yield "'equation' is empty", "LaTeX that says what it does"
    for name in ("cause", "revealed_by"):
        if not isinstance(getattr(cls, name), str):
            yield f"'{name}' is {getattr(cls, name)!r}", "a sentence"
    if not isinstance(cls.rank, Real):
        yield f"'rank' is {cls.rank!r}", "a number"


def _holds(value: Any, kind: type) -> bool:
    """Whether a value is a tuple of elements of a type."""
    return isinstance(value, tuple) and all(isinstance(element, kind) for element in value)


def _is_name(text: str) -> bool:
    """Whether a text can be the name of a field of a named tuple."""
    return text.isidentifier() and not keyword.iskeyword(text) and not text.startswith("_")


def _find_in_parameter(p: Parameter, names: list[str]) -> Iterator[tuple[str, str]]:
    """Yield faults of one parameter; `names` are those of all parameters."""
    texts = all(isinstance(text, str) and text for text in (p.name, p.unit, p.symbol))
    values = [getattr(p, name) for name in PARAMETER_NUMBERS]
    if not texts or not all(isinstance(value, Real) for value in values):
        expected = "texts for name, unit ('1' for none) and symbol, and numbers"
        yield f"parameter '{p.name}' is {p}", expected
        return
    if not (_holds(p.tried, Real) and all(p.low <= value <= p.high for value in p.tried)):
        yield f"parameter '{p.name}' tries {p.tried!r}", "a tuple of values in its range"
    in_range = np.isnan(p.default) or (np.isfinite(p.default) and p.low <= p.default <= p.high)
    scaled = 0.0 < p.scale < np.inf
    if not (_is_name(p.name) and in_range and scaled) or names.count(p.name) > 1:
        expected = "a name of its own, low <= default <= high, and a finite scale above 0"
        yield f"parameter '{p.name}' is {p}", expected
