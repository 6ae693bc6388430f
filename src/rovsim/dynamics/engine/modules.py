"""Compiled modules for lists of wrench effects, written among what is kept on disk.

`engine` has the equation of motion with some effects, whose kernels it names, chains, and hands to
the functions of `integration` and `observer`: ten seconds to compile, and then the fastest. What
`attached` compiles is a chain alone, in less than one, which an engine calls by its address, 0.05
us a call. So engines are for what the package brings, and a user's own effects are attached to one.
"""

import importlib.util
import inspect
import sys
import textwrap
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, Sequence

from filelock import FileLock

from rovsim.core.files import write_text
from rovsim.dynamics.engine.cache import DYNAMICS, cache_folder, digest

ENGINE = '''\
"""The equation of motion with {names}.

Written by rovsim.dynamics.engine.modules, so that Numba can keep what it compiles.
"""

from rovsim.dynamics.engine import integration, observer
from rovsim.dynamics.engine.compiled import inline_anew, kept
{imports}{kernels}

@inline_anew
def extra(at, parameters, body, acting):
    """Wrench of these effects; each has in p (k,) whether it acts, then its parameters."""
    p, layout = parameters.values, layout_of(body)
    tau = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
{pushes}{attached}    return tau


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
ATTACHED_PUSH = """\
    tau = add6(tau, 1.0, parameters.attached(at, p[{count}:], layout, acting))
"""
ATTACHED = '''\
"""The wrench of {names}, for engines that lack it.

Written by rovsim.dynamics.engine.modules, so that Numba can keep what it compiles.
"""

from rovsim.dynamics.engine.compiled import MATHS, inline_anew, keep_address
from rovsim.dynamics.engine.reading import BY_ADDRESS
{imports}{kernels}

@keep_address(BY_ADDRESS, **MATHS)
def attached(at, p, layout, acting):
    tau = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
{pushes}    return tau
'''
IMPORTS = """\
from rovsim.dynamics.engine.reading import actuators_at, first_channel, layout_of, reading_at
from rovsim.dynamics.engine.vectors import add6
"""
KERNEL = """
{id}_wrench = inline_anew({name}.wrench)
{id}_parameters = {name}.named_parameters()
"""
CHANNELS = "{id}_channels = {name}.named_channels()\n"
READING = "        seen = reading_at(at, actuators_at(at, layout, acting), {channels})\n"
PUSH = """\
    if p[{acts}] != 0.0:
        own = {id}_parameters(
{values}
        )
{reading}        tau = add6(tau, 1.0, {id}_wrench({at}, own))
"""
COLUMNS, MARGIN = 88, " " * 12  # of the parameters in `PUSH`


def engine(wrenches: Sequence[Any], attachable: bool = False) -> ModuleType:
    """The compiled equation of motion with these wrench effects, in this order.

    Where others can be attached, each parameter set brings their values behind those of its own.
    """
    return _engine(tuple(wrenches), attachable)


def attached(wrenches: Sequence[Any], channel: int) -> Any:
    """The compiled wrench of these effects, in this order; `channel` is the first of theirs."""
    return _attached(tuple(wrenches), channel)


@cache
def _engine(wrenches: tuple[Any, ...], attachable: bool) -> ModuleType:
    parts = _parts(wrenches, 0)
    count = sum(1 + len(wrench.parameters) for wrench in wrenches)
    push = ATTACHED_PUSH.format(count=count) if attachable else ""
    return _module("engine", ENGINE.format(**parts, attached=push), wrenches)


@cache
def _attached(wrenches: tuple[Any, ...], channel: int) -> Any:
    return _module("attached", ATTACHED.format(**_parts(wrenches, channel)), wrenches).attached


def _module(kind: str, text: str, wrenches: tuple[Any, ...]) -> ModuleType:
    files = {str(inspect.getsourcefile(wrench)) for wrench in wrenches}
    foreign = sorted(f for f in files if not Path(f).is_relative_to(DYNAMICS))
    name = f"rovsim_{kind}_{digest(text.encode(), *(Path(f).read_bytes() for f in foreign))}"
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


def _parts(wrenches: Sequence[Any], channel: int) -> dict[str, str]:
    """What the templates are filled with; an effect may act in a chain more than once."""
    known = list(dict.fromkeys(wrenches))
    pushes, acts = "", 0
    for wrench in wrenches:
        after = acts + 1 + len(wrench.parameters)
        values = textwrap.fill(", ".join(f"p[{k}]" for k in range(acts + 1, after)), COLUMNS)
        pushes += PUSH.format(
            id=wrench.id,
            acts=acts,
            values=textwrap.indent(values, MARGIN),
            at="seen" if wrench.reads() else "at",
            reading=_reading(wrench, channel) if wrench.reads() else "",
        )
        acts, channel = after, channel + len(wrench.channels)
    imports = {f"from {w.__module__} import {w.__name__}{_alias(w, known)}\n" for w in known}
    return {
        "names": ", ".join(wrench.id for wrench in known) or "no further effects",
        "imports": "".join(sorted(imports | set(IMPORTS.splitlines(keepends=True)))),
        "kernels": "".join(_kernel(w, known) for w in known),
        "pushes": pushes,
    }


def _kernel(wrench: Any, known: Sequence[Any]) -> str:
    """The kernel of an effect, and the types of what it is handed."""
    name = _name(wrench, known)
    types = CHANNELS.format(id=wrench.id, name=name) if wrench.channels else ""
    return KERNEL.format(id=wrench.id, name=name) + types


def _reading(wrench: Any, first: int) -> str:
    """What an effect reads, its channels from this one on."""
    own = [f"acting[first_channel(layout) + {first + k}]" for k in range(len(wrench.channels))]
    return READING.format(channels=f"{wrench.id}_channels({', '.join(own)})" if own else "0.0")


def _name(wrench: Any, known: Sequence[Any]) -> str:
    """What a class is called in an engine: two of one name go by their ids."""
    alike = [one for one in known if one.__name__ == wrench.__name__]
    return wrench.__name__ if len(alike) == 1 else f"{wrench.__name__}_{wrench.id}"


def _alias(wrench: Any, known: Sequence[Any]) -> str:
    name = _name(wrench, known)
    return "" if name == wrench.__name__ else f" as {name}"
