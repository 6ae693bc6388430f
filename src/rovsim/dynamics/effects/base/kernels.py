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

    from rovsim.dynamics.compilation.compiled import MATHS

    return numba.njit(boundscheck=True, **MATHS)(cls.wrench)


@cache
def mentions(kernel: Callable, name: str) -> bool:
    """Whether a kernel, or a helper that it calls directly or indirectly, contains this name."""
    return any(name in function.__code__.co_names for function in _written_for(kernel))


@cache
def line_that_raises(kernel: Callable) -> int | None:
    """First line where a kernel or a helper that it calls raises or asserts; None if none does."""
    for function in _written_for(kernel):
        for instruction in dis.get_instructions(function):
            if instruction.opname == "RAISE_VARARGS" and instruction.positions is not None:
                return instruction.positions.lineno
    return None


def _written_for(kernel: Callable) -> list[FunctionType]:
    """A kernel and all helpers that it calls, directly or indirectly, as Python functions."""
    functions = [_written(kernel)]
    for function in functions:
        functions += [helper for helper in _helpers(function) if helper not in functions]
    return functions


def _written(function: Any) -> Any:
    """The Python function of one that Numba compiles."""
    return getattr(function, "py_func", function)


def _helpers(function: Callable) -> Iterator[Callable]:
    """Functions that a function refers to, compiled or not, by name or as members of a module."""
    closure = inspect.getclosurevars(function)
    objects = [*closure.globals.values(), *closure.nonlocals.values()]
    for module in [item for item in objects if isinstance(item, ModuleType)]:
        objects += [vars(module).get(name) for name in function.__code__.co_names]
    yield from {item for item in map(_written, objects) if isinstance(item, FunctionType)}
