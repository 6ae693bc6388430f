"""How functions are compiled, and kept on disk (`rovsim.dynamics.engine.cache`)."""

from contextlib import contextmanager
from pathlib import Path
from typing import Any, Callable, Iterator

import numba
from filelock import FileLock
from numba.core.compiler_lock import global_compiler_lock

from rovsim.dynamics.engine.cache import cache_folder

MATHS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract", "nsz"}}
# What makes a function callable from outside takes half of the time that it takes to compile.
FROM_PYTHON: dict[str, Any] = {"no_cfunc_wrapper": True}  # from there, but not from C
UNSEEN: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}


def keep(**options: Any) -> Callable[[Callable], Any]:
    """Compile a function that Python or a kept function calls, and keep what comes of it.

    What it calls may lie in `cache.ROOMS`, or in the module of a wrench effect.
    """

    def decorate(function: Callable) -> Any:
        with _kept_there():
            return _compiled_once(numba.njit(cache=True, **options)(function))

    return decorate


def keep_address(signature: Any, **options: Any) -> Callable[[Callable], Any]:
    """Compile a function of one signature that compiled ones get as an argument, and keep it.

    They call it by its address, so none of them is compiled anew for it.
    """

    def decorate(function: Callable) -> Any:
        with _kept_there(), global_compiler_lock, FileLock(_lock_file(function)):
            return numba.cfunc(signature, cache=True, **options)(function)

    return decorate


@contextmanager
def _kept_there() -> Iterator[None]:
    """Numba keeps what is decorated meanwhile in our folder."""
    before, numba.config.CACHE_DIR = numba.config.CACHE_DIR, str(cache_folder())  # type: ignore[attr-defined]
    try:
        yield
    finally:
        numba.config.CACHE_DIR = before  # type: ignore[attr-defined]


def _compiled_once(function: Any) -> Any:
    """Let one process compile it, and others wait for what comes of it, or load it.

    Numba's own index of what is kept loses what two processes write at once, or takes one's for the
    other's. Who compiles waits only for what is called, so no two wait for each other.
    """
    compile_it, locked = function.compile, lock_file(function)

    def compile_alone(signature: Any) -> Any:
        if signature in function.overloads:
            return compile_it(signature)
        # in this order, whichever thread comes first; a lock made anew: none goes through a fork
        with global_compiler_lock, FileLock(locked):
            return compile_it(signature)

    function.compile = compile_alone
    return function


def lock_file(function: Any) -> Path:
    """Locked by the process that compiles a kept function."""
    return _lock_file(function.py_func)


def _lock_file(function: Any) -> Path:
    return cache_folder() / f"{function.__module__}.{function.__name__}.lock"


kept = keep(nogil=True, **MATHS, **FROM_PYTHON)  # what Python calls, from any thread
# Parts that are the same in every engine.
inline_shared = keep(forceinline=True, **MATHS, **FROM_PYTHON)
inline_internal = keep(forceinline=True, **MATHS, **UNSEEN)  # not called from Python
internal = keep(**MATHS, **UNSEEN)  # too large or too rare to be inlined
# Parts that depend on the effects: compiled anew for each engine, and kept as parts of it. What is
# handed `extra` must be inlined: it is no argument, and its address no other process knows.
inlined = numba.njit(forceinline=True, **MATHS)  # helpers of an effect's kernel
inline_anew = numba.njit(forceinline=True, **MATHS, **UNSEEN)
entry = numba.njit(inline="always", **MATHS)  # the body of what an engine keeps
