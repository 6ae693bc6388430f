"""What is compiled, and kept on disk (`rovsim.dynamics.engine.cache`).

An engine is a small module among what is kept, written for a list of wrench effects: it names their
kernels, chains them, and hands the chain to the functions of `integration` and `observer`.
"""

import importlib.util
import inspect
import sys
import textwrap
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, Callable, Sequence

import numba
from filelock import FileLock
from numba.core.compiler_lock import global_compiler_lock

from rovsim.core.files import write_text
from rovsim.dynamics.engine.cache import DYNAMICS, cache_folder, digest

MATHS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract", "nsz"}}
# What makes a function callable from outside takes half of the time that it takes to compile.
FROM_PYTHON: dict[str, Any] = {"no_cfunc_wrapper": True}  # from there, but not from C
UNSEEN: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}


def keep(**options: Any) -> Callable[[Callable], Any]:
    """Compile a function that Python or a kept function calls, and keep what comes of it.

    What it calls may lie in `cache.ROOMS`, or in the module of a wrench effect.
    """

    def decorate(function: Callable) -> Any:
        before, numba.config.CACHE_DIR = numba.config.CACHE_DIR, str(cache_folder())  # type: ignore[attr-defined]
        try:
            return _compiled_once(numba.njit(cache=True, **options)(function))
        finally:
            numba.config.CACHE_DIR = before  # type: ignore[attr-defined]

    return decorate


def _compiled_once(function: Any) -> Any:
    """Let one process compile it, and others wait for what comes of it, or load it.

    Numba's own index of what is kept loses what two processes write at once, or takes one's for the
    other's. Who compiles waits only for what is called, so no two wait for each other.
    """
    compile_it, lock = function.compile, FileLock(lock_file(function))

    def compile_alone(signature: Any) -> Any:
        if signature in function.overloads:
            return compile_it(signature)
        with global_compiler_lock, lock:  # in this order, whichever thread comes first
            return compile_it(signature)

    function.compile = compile_alone
    return function


def lock_file(function: Any) -> Path:
    """Locked by the process that compiles a kept function."""
    return cache_folder() / f"{function.py_func.__module__}.{function.py_func.__name__}.lock"


kept = keep(nogil=True, **MATHS, **FROM_PYTHON)  # what Python calls, from any thread
# Parts that are the same in every engine.
inline_shared = keep(forceinline=True, **MATHS, **FROM_PYTHON)
inline_internal = keep(forceinline=True, **MATHS, **UNSEEN)  # not called from Python
internal = keep(**MATHS, **UNSEEN)  # too large or too rare to be inlined
# Parts that depend on the effects: compiled anew for each engine, and kept as parts of it. What is
# handed `extra` must be inlined: a call would need its address, which no other process knows.
inlined = numba.njit(forceinline=True, **MATHS)  # helpers of an effect's kernel
inline_anew = numba.njit(forceinline=True, **MATHS, **UNSEEN)
entry = numba.njit(inline="always", **MATHS)  # the body of what an engine keeps


def engine(wrenches: Sequence[Any]) -> ModuleType:
    """The compiled equation of motion with these wrench effects, in this order."""
    return _engine(tuple(wrenches))


@cache
def _engine(wrenches: tuple[Any, ...]) -> ModuleType:
    text = _engine_text(wrenches)
    files = {str(inspect.getsourcefile(wrench)) for wrench in wrenches}
    foreign = sorted(f for f in files if not Path(f).is_relative_to(DYNAMICS))
    name = f"rovsim_engine_{digest(text.encode(), *(Path(f).read_bytes() for f in foreign))}"
    path = cache_folder() / f"{name}.py"
    with FileLock(path.with_suffix(".lock")):
        if not path.exists():
            write_text(path, text)
        return _imported(name, path)


def _imported(name: str, path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


ENGINE = '''\
"""The equation of motion with {names}.

Written by rovsim.dynamics.engine.compiled, so that Numba can keep what it compiles.
"""

{imports}{kernels}

@inline_anew
def extra(at, p, body, acting):
    """Wrench of these effects; each has in p (k,) whether it acts, then its parameters."""
    tau = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
{pushes}    return tau


@kept
def integrate(jobs, time, stride, bodies, inputs, p, data, site, out):
    integration.integrate(extra, jobs, time, stride, bodies, inputs, p, data, site, out)


@kept
def advance(state, memory, t, h, bodies, inputs, p, data, site):
    integration.advance(extra, state, memory, t, h, bodies, inputs, p, data, site)


@kept
def heun(state, memory, t, h, pushes, bodies, inputs, p, data, site, out):
    integration.heun(extra, state, memory, t, h, pushes, bodies, inputs, p, data, site, out)


@kept
def accelerations(times, states, memory, bodies, inputs, p, data, site, out):
    integration.accelerations(extra, times, states, memory, bodies, inputs, p, data, site, out)


@kept
def observe(
    jobs, time, ends, bodies, inputs, p, site, readings, row, seen, known, gains, decay,
    by_velocity, out,
):
    observer.observe(
        extra, jobs, time, ends, bodies, inputs, p, site, readings, row, seen, known, gains, decay,
        by_velocity, out,
    )
'''
READING_IMPORT = """\
from rovsim.dynamics.engine.reading import actuators_at, first_channel, reading_at
"""
IMPORTS = """\
from rovsim.dynamics.engine import integration, observer
from rovsim.dynamics.engine.compiled import inline_anew, kept
from rovsim.dynamics.engine.vectors import add6
"""
KERNEL = """
{id}_wrench = inline_anew({name}.wrench)
{id}_parameters = {name}.named_parameters()
"""
CHANNELS = "{id}_channels = {name}.named_channels()\n"
READING = "        seen = reading_at(at, actuators_at(at, body, acting), {channels})\n"
PUSH = """\
    if p[{acts}] != 0.0:
        own = {id}_parameters(
{values}
        )
{reading}        tau = add6(tau, 1.0, {id}_wrench({at}, own))
"""
COLUMNS, MARGIN = 88, " " * 12  # of the parameters in `PUSH`


def _engine_text(wrenches: Sequence[Any]) -> str:
    """Source of the module of an engine; an effect may act in it more than once."""
    known = list(dict.fromkeys(wrenches))
    pushes, acts, channel = "", 0, 0
    for wrench in wrenches:
        after = acts + 1 + len(wrench.parameters)
        values = textwrap.fill(", ".join(f"p[{k}]" for k in range(acts + 1, after)), COLUMNS)
        pushes += PUSH.format(
            id=wrench.id, acts=acts, values=textwrap.indent(values, MARGIN),
            at="seen" if wrench.reads() else "at",
            reading=_reading(wrench, channel) if wrench.reads() else "",
        )  # fmt: skip
        acts, channel = after, channel + len(wrench.channels)
    imports = {f"from {w.__module__} import {w.__name__}{_alias(w, known)}\n" for w in known}
    imports |= {READING_IMPORT} if any(w.reads() for w in known) else set()
    return ENGINE.format(
        names=", ".join(wrench.id for wrench in known) or "no further effects",
        imports="".join(sorted(imports | set(IMPORTS.splitlines(keepends=True)))),
        kernels="".join(_kernel(w, known) for w in known),
        pushes=pushes,
    )


def _kernel(wrench: Any, known: Sequence[Any]) -> str:
    """The kernel of an effect, and the types of what it is handed."""
    name = _name(wrench, known)
    types = CHANNELS.format(id=wrench.id, name=name) if wrench.channels else ""
    return KERNEL.format(id=wrench.id, name=name) + types


def _reading(wrench: Any, first: int) -> str:
    """What an effect reads, its channels from this one on."""
    own = [f"acting[first_channel(body) + {first + k}]" for k in range(len(wrench.channels))]
    return READING.format(channels=f"{wrench.id}_channels({', '.join(own)})" if own else "0.0")


def _name(wrench: Any, known: Sequence[Any]) -> str:
    """What a class is called in an engine: two of one name go by their ids."""
    alike = [one for one in known if one.__name__ == wrench.__name__]
    return wrench.__name__ if len(alike) == 1 else f"{wrench.__name__}_{wrench.id}"


def _alias(wrench: Any, known: Sequence[Any]) -> str:
    name = _name(wrench, known)
    return "" if name == wrench.__name__ else f" as {name}"
