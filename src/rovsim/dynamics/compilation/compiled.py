"""Decorators that compile functions with Numba and cache them on disk (`compilation.cache`)."""

from contextlib import contextmanager
from pathlib import Path
from typing import Any, Callable, Iterator

import numba
from filelock import FileLock
from numba.core.compiler_lock import global_compiler_lock

from rovsim.dynamics.compilation.cache import cache_folder

MATHS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract", "nsz"}}
# Wrappers that make a function callable from outside take half of the time of its compilation.
FROM_PYTHON: dict[str, Any] = {"no_cfunc_wrapper": True}  # callable from Python, but not from C
INTERNAL: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}


def keep(**options: Any) -> Callable[[Callable], Any]:
    """Return a decorator that compiles a function with Numba and caches the result on disk.

    The functions that it calls must be in the folders `cache.COMPILED_FOLDERS` or in the module
    of a wrench effect: the cache notices changes of these files alone.

    Args:
        options: of `numba.njit`.
    """

    def decorate(function: Callable) -> Any:
        with _kept_there():
            return _compiled_once(numba.njit(cache=True, **options)(function))

    return decorate


def keep_address(signature: Any, **options: Any) -> Callable[[Callable], Any]:
    """Return a decorator for a function that is passed to compiled functions as an argument.

    It is compiled for one signature, cached on disk, and called by its address; so the functions
    that it is passed to need not be compiled again for it.
    """

    def decorate(function: Callable) -> Any:
        with _kept_there(), global_compiler_lock, FileLock(_lock_file(function)):
            return numba.cfunc(signature, cache=True, **options)(function)

    return decorate


@contextmanager
def _kept_there() -> Iterator[None]:
    """Within this context, Numba caches functions that are decorated in our folder."""
    previous, numba.config.CACHE_DIR = numba.config.CACHE_DIR, str(cache_folder())  # type: ignore[attr-defined]
    try:
        yield
    finally:
        numba.config.CACHE_DIR = previous  # type: ignore[attr-defined]


def _compiled_once(function: Any) -> Any:
    """Lock the compilation of a function, so that one process compiles and others load the result.

    Numba's index of its cache loses or mixes up entries that two processes write at the same time.
    There is no deadlock: while a function is compiled, its process waits only for the locks of
    functions that it calls.
    """
    compile_it, lock_path = function.compile, lock_file(function)

    def compile_alone(signature: Any) -> Any:
        if signature in function.overloads:
            return compile_it(signature)
        # always in this order; the file lock is made anew, so that no lock is inherited by a fork
        with global_compiler_lock, FileLock(lock_path):
            return compile_it(signature)

    function.compile = compile_alone
    return function


def lock_file(function: Any) -> Path:
    """The file that a process locks while it compiles a cached function."""
    return _lock_file(function.py_func)


def _lock_file(function: Any) -> Path:
    return cache_folder() / f"{function.__module__}.{function.__name__}.lock"


kept = keep(nogil=True, **MATHS, **FROM_PYTHON)  # callable from Python, in any thread
# Functions that are the same in every engine, inlined where they are called.
inline_shared = keep(forceinline=True, **MATHS, **FROM_PYTHON)
inline_internal = keep(forceinline=True, **MATHS, **INTERNAL)  # not called from Python
internal = keep(**MATHS, **INTERNAL)  # too large or too rare to be inlined
# Functions that depend on the effects: compiled anew with each engine, and cached as part of it. A
# function with an argument `extra` must be inlined, because the address of `extra` is different in
# each process, so that the function could not be cached by itself.
inlined = numba.njit(forceinline=True, **MATHS)  # helpers of an effect's kernel
inline_anew = numba.njit(forceinline=True, **MATHS, **INTERNAL)
entry = numba.njit(inline="always", **MATHS)  # the bodies of the functions that an engine caches
