"""The kernel of an effect: compiled alone, and what it and its helpers say."""

import inspect
from functools import cache
from types import FunctionType, ModuleType
from typing import Any, Callable, Iterator


@cache
def compiled_alone(cls: Any) -> Any:
    """The kernel of an effect, by itself: callable from Python, and as fast as in an engine."""
    from rovsim.dynamics.engine.compiled import inlined

    return inlined(cls.wrench)


@cache
def says(kernel: Callable, name: str) -> bool:
    """Whether a kernel, or a helper that it calls, however deep, has this name in its code."""
    found = [_written(kernel)]
    for function in found:
        found += [helper for helper in _helpers(function) if helper not in found]
    return any(name in function.__code__.co_names for function in found)


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
