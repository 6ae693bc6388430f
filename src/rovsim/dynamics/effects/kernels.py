"""The kernel of an effect: compiled alone, and what it and its helpers say."""

import dis
import inspect
from functools import cache
from types import FunctionType, ModuleType
from typing import Any, Callable, Iterator


@cache
def compiled_alone(cls: Any) -> Any:
    """The kernel of an effect, by itself: callable from Python, indices beyond arrays refused.

    Those in its helpers are not.
    """
    import numba

    from rovsim.dynamics.engine.compiled import MATHS

    return numba.njit(boundscheck=True, **MATHS)(cls.wrench)


@cache
def says(kernel: Callable, name: str) -> bool:
    """Whether a kernel, or a helper that it calls, however deep, has this name in its code."""
    return any(name in function.__code__.co_names for function in _written_for(kernel))


@cache
def line_that_raises(kernel: Callable) -> int | None:
    """The line in which a kernel, or a helper that it calls, raises or asserts; None: nowhere."""
    for function in _written_for(kernel):
        for one in dis.get_instructions(function):
            if one.opname == "RAISE_VARARGS" and one.positions is not None:
                return one.positions.lineno
    return None


def _written_for(kernel: Callable) -> list[FunctionType]:
    """A kernel and the helpers that it calls, however deep."""
    found = [_written(kernel)]
    for function in found:
        found += [helper for helper in _helpers(function) if helper not in found]
    return found


def _written(function: Any) -> Any:
    """The function behind one that Numba compiles."""
    return getattr(function, "py_func", function)


def _helpers(function: Callable) -> Iterator[Callable]:
    """Functions that stand in a function's code, compiled or not, also by way of a module."""
    used = inspect.getclosurevars(function)
    named = [*used.globals.values(), *used.nonlocals.values()]
    for module in [one for one in named if isinstance(one, ModuleType)]:
        named += [vars(module).get(name) for name in function.__code__.co_names]
    yield from {one for one in map(_written, named) if isinstance(one, FunctionType)}
