"""Write and import compiled modules for lists of wrench effects, in the folder of the cache.

`engine` writes a module with the equation of motion and a list of effects: it sums the wrenches of
their kernels in a function `extra`, and passes that to the functions of `integration` and
`observer`. It compiles in ten seconds, and runs fastest. `attached` compiles only the sum of the
wrenches of some effects, in less than a second; an engine calls it by its address, at 0.05 us a
call. So the package's own effects are compiled into engines, and a user's effects are attached.
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
from rovsim.dynamics.compilation.cache import DYNAMICS_FOLDER, cache_folder, digest

ENGINE_TEMPLATE = '''\
"""The equation of motion with {names}.

Written by rovsim.dynamics.engine.modules, so that Numba can keep what it compiles.
"""

from rovsim.dynamics.engine import integration, observer
from rovsim.dynamics.compilation.compiled import inline_anew, kept
{imports}{kernels}

@inline_anew
def extra(at, parameters, body, acting):
    """Wrench of these effects; each has in p (k,) whether it acts, then its parameters."""
    p, layout = parameters.values, layout_of(body)
    tau = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
{wrench_calls}{attached}    return tau


@kept
def integrate(jobs, time, stride, world, out):
    integration.integrate(extra, jobs, time, stride, world, out)


@kept
def advance(state, memory, t, h, world):
    integration.advance(extra, state, memory, t, h, world)


@kept
def heun(state, memory, t, h, disturbances, world, out):
    integration.heun(extra, state, memory, t, h, disturbances, world, out)


@kept
def accelerations(times, states, memory, world, out):
    integration.accelerations(extra, times, states, memory, world, out)


@kept
def observe(jobs, world, correction, out):
    observer.observe(extra, jobs, world, correction, out)
'''
ATTACHED_CALL = """\
    tau = add6(tau, 1.0, parameters.attached(at, p[{count}:], layout, acting))
"""
ATTACHED_TEMPLATE = '''\
"""The wrench of {names}, for engines that lack it.

Written by rovsim.dynamics.engine.modules, so that Numba can keep what it compiles.
"""

from rovsim.dynamics.compilation.compiled import MATHS, inline_anew, keep_address
from rovsim.dynamics.engine.kernel_inputs import ATTACHED_SIGNATURE
{imports}{kernels}

@keep_address(ATTACHED_SIGNATURE, **MATHS)
def attached(at, p, layout, acting):
    tau = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
{wrench_calls}    return tau
'''
KERNEL_IMPORTS = """\
from rovsim.dynamics.engine.kernel_inputs import actuators_at, first_channel, layout_of, reading_at
from rovsim.dynamics.engine.vectors import add6
"""
KERNEL_TEMPLATE = """
{id}_wrench = inline_anew({name}.wrench)
{id}_parameters = {name}.named_parameters()
"""
CHANNELS_TEMPLATE = "{id}_channels = {name}.named_channels()\n"
READING_CALL = "        reading = reading_at(at, actuators_at(at, layout, acting), {channels})\n"
WRENCH_TEMPLATE = """\
    if p[{acts}] != 0.0:
        effect_parameters = {id}_parameters(
{values}
        )
{reading}        tau = add6(tau, 1.0, {id}_wrench({at}, effect_parameters))
"""
MAX_COLUMNS, INDENT = 88, " " * 12  # of the parameters in `WRENCH_TEMPLATE`


def engine(wrenches: Sequence[Any], attachable: bool = False) -> ModuleType:
    """Return the module of the compiled equation of motion with these wrench effects.

    Args:
        wrenches: classes of effects, in the order of their values in `WrenchParameters`.
        attachable: whether further effects can be attached. The values of each parameter set then
            end with those of the attached effects.
    """
    return _engine(tuple(wrenches), attachable)


def attached(wrenches: Sequence[Any], channel: int) -> Any:
    """Return the compiled sum of the wrenches of these effects, to be attached to an engine.

    Args:
        wrenches: classes of effects, in the order of their values.
        channel: index of their first channel: the number of channels of the engine's effects.
    """
    return _attached(tuple(wrenches), channel)


@cache
def _engine(wrenches: tuple[Any, ...], attachable: bool) -> ModuleType:
    parts = _parts(wrenches, 0)
    count = sum(1 + len(wrench.parameters) for wrench in wrenches)
    attached_call = ATTACHED_CALL.format(count=count) if attachable else ""
    return _module("engine", ENGINE_TEMPLATE.format(**parts, attached=attached_call), wrenches)


@cache
def _attached(wrenches: tuple[Any, ...], channel: int) -> Any:
    return _module(
        "attached", ATTACHED_TEMPLATE.format(**_parts(wrenches, channel)), wrenches
    ).attached


def _module(kind: str, text: str, wrenches: tuple[Any, ...]) -> ModuleType:
    """Import the module of a source text, from a file in the cache that is written if missing.

    Its name is a digest of the text and of the files of effects outside this package, so that
    another version of them makes another module.
    """
    files = {str(inspect.getsourcefile(wrench)) for wrench in wrenches}
    foreign = sorted(f for f in files if not Path(f).is_relative_to(DYNAMICS_FOLDER))
    name = f"rovsim_{kind}_{digest(text.encode(), *(Path(f).read_bytes() for f in foreign))}"
    path = cache_folder() / f"{name}.py"
    with FileLock(path.with_suffix(".lock")):
        if not path.exists():
            write_text(path, text)
        return _imported(name, path)


def _imported(name: str, path: Path) -> ModuleType:
    """Import a file as a module of this name."""
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def _parts(wrenches: Sequence[Any], channel: int) -> dict[str, str]:
    """Values for the fields of the templates; an effect may be in the list more than once."""
    distinct = list(dict.fromkeys(wrenches))
    wrench_calls, acts = "", 0
    for wrench in wrenches:
        end = acts + 1 + len(wrench.parameters)
        values = textwrap.fill(", ".join(f"p[{k}]" for k in range(acts + 1, end)), MAX_COLUMNS)
        wrench_calls += WRENCH_TEMPLATE.format(
            id=wrench.id,
            acts=acts,
            values=textwrap.indent(values, INDENT),
            at="reading" if wrench.reads() else "at",
            reading=_reading(wrench, channel) if wrench.reads() else "",
        )
        acts, channel = end, channel + len(wrench.channels)
    imports = {f"from {w.__module__} import {w.__name__}{_alias(w, distinct)}\n" for w in distinct}
    return {
        "names": ", ".join(wrench.id for wrench in distinct) or "no further effects",
        "imports": "".join(sorted(imports | set(KERNEL_IMPORTS.splitlines(keepends=True)))),
        "kernels": "".join(_kernel(w, distinct) for w in distinct),
        "wrench_calls": wrench_calls,
    }


def _kernel(wrench: Any, distinct: Sequence[Any]) -> str:
    """Source lines that name the kernel of an effect and the types of its arguments."""
    name = _name(wrench, distinct)
    types = CHANNELS_TEMPLATE.format(id=wrench.id, name=name) if wrench.channels else ""
    return KERNEL_TEMPLATE.format(id=wrench.id, name=name) + types


def _reading(wrench: Any, first: int) -> str:
    """Source lines that read actuators and channels; `first` is the index of its first channel."""
    values = [f"acting[first_channel(layout) + {first + k}]" for k in range(len(wrench.channels))]
    return READING_CALL.format(
        channels=f"{wrench.id}_channels({', '.join(values)})" if values else "0.0"
    )


def _name(wrench: Any, distinct: Sequence[Any]) -> str:
    """Name of a class in the module: where two have the same name, their ids are appended."""
    namesakes = [cls for cls in distinct if cls.__name__ == wrench.__name__]
    return wrench.__name__ if len(namesakes) == 1 else f"{wrench.__name__}_{wrench.id}"


def _alias(wrench: Any, distinct: Sequence[Any]) -> str:
    """The `as` clause of the import of a class, where two have the same name; else empty."""
    name = _name(wrench, distinct)
    return "" if name == wrench.__name__ else f" as {name}"
