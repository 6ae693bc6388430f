"""The kernel of a wrench effect: compile it alone, and inspect its code and its helpers."""

import dis
import inspect
from functools import cache
from types import FunctionType, ModuleType
from typing import Any, Callable, Iterator


@cache
def compiled_alone(cls: Any) -> Any:
    """Compile the kernel of an effect by itself, callable from Python, with bounds checks.

    An index out of bounds raises an error in the kernel, but not in helpers that it calls.
    """
    import numba

    from rovsim.dynamics.engine.compiled import MATHS

    return numba.njit(boundscheck=True, **MATHS)(cls.wrench)


@cache
def says(kernel: Callable, name: str) -> bool:
    """Whether a kernel, or a helper that it calls directly or indirectly, contains this name."""
    return any(name in function.__code__.co_names for function in _written_for(kernel))


@cache
def line_that_raises(kernel: Callable) -> int | None:
    """First line where a kernel or a helper that it calls raises or asserts; None if none does."""
    for function in _written_for(kernel):
        for one in dis.get_instructions(function):
            if one.opname == "RAISE_VARARGS" and one.positions is not None:
                return one.positions.lineno
    return None


def _written_for(kernel: Callable) -> list[FunctionType]:
    """A kernel and all helpers that it calls, directly or indirectly, as Python functions."""
    found = [_written(kernel)]
    for function in found:
        found += [helper for helper in _helpers(function) if helper not in found]
    return found


def _written(function: Any) -> Any:
    """The Python function of one that Numba compiles."""
    return getattr(function, "py_func", function)


def _helpers(function: Callable) -> Iterator[Callable]:
    """Functions that a function refers to, compiled or not, by name or as members of a module."""
    used = inspect.getclosurevars(function)
    named = [*used.globals.values(), *used.nonlocals.values()]
    for module in [one for one in named if isinstance(one, ModuleType)]:
        named += [vars(module).get(name) for name in function.__code__.co_names]
    yield from {one for one in map(_written, named) if isinstance(one, FunctionType)}
