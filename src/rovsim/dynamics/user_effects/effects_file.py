"""A user's own effects: read from a file, and checked before anything is simulated with them."""

import hashlib
import inspect
import os
import re
import sys
import traceback
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, Mapping

from rovsim.core.errors import nearest
from rovsim.core.files import read_text
from rovsim.dynamics.effects.base import Effect, Wrench
from rovsim.dynamics.effects.base.kernels import compiled_alone, line_that_raises, mentions
from rovsim.dynamics.user_effects.declarations import REQUIRED_TEXTS, find_faults, refused
from rovsim.dynamics.user_effects.trials import TRIALS


def read_effects(path: Path, taken: Mapping[str, Any]) -> dict[str, type[Effect]]:
    """Effects that a file declares, by id.

    Raises:
        BadInput: it cannot be read or run, declares no effect, or an id that is taken.
    """
    path = Path(os.path.expanduser(path)).resolve()
    return check_effects(vars(_run(path, read_text(path))), path, taken)


@cache
def _run(path: Path, text: str) -> ModuleType:
    """Run the text of a file as a module, never from a stale byte-code file.

    The name of the module is a digest of the text: compiled engines import it by this name,
    wherever the file is.
    """
    module = ModuleType(f"rovsim_own_{hashlib.sha256(text.encode()).hexdigest()[:12]}")
    module.__file__ = str(path)
    sys.modules[module.__name__] = module  # where Python looks for the source of a class
    try:
        exec(compile(text, str(path), "exec"), vars(module))
    except SyntaxError as error:
        raise refused(f"{error.msg}", f"{path}, line {error.lineno}", "valid Python") from None
    except (Exception, SystemExit) as error:
        lines = [
            f.lineno for f in traceback.extract_tb(error.__traceback__) if f.filename == str(path)
        ]
        fault = f"{type(error).__name__}: {error}"
        raise refused(fault, f"{path}, line {lines[-1]}", "a file that runs by itself") from None
    return module


def check_effects(
    content: Mapping[str, Any], where: object, taken: Mapping[str, Any]
) -> dict[str, type[Effect]]:
    """Return the effects among the members of a module, after checking each of them.

    Raises:
        BadInput: there is none, or one is incomplete, cannot be compiled, or has an id that is
            already in `taken`.
    """
    name = content.get("__name__")
    classes = [
        value
        for value in content.values()
        if inspect.isclass(value) and issubclass(value, Effect) and name in (None, value.__module__)
    ]
    if not classes:
        raise refused("declares no effect", where, "a class on top of Wrench or another kind")
    by_id: dict[str, type[Effect]] = {}
    for cls in classes:
        _check(cls, f"{where}, class {cls.__name__}", {**taken, **by_id})
        by_id[cls.id] = cls
    return by_id


def _check(cls: type[Effect], where: str, taken: Mapping[str, Any]) -> None:
    """Refuse a class that is incomplete, or has wrong declarations, a taken id or a bad kernel."""
    if not issubclass(cls, tuple(TRIALS)):
        raise refused("acts nowhere", where, "a class on top of Wrench or another kind")
    missing = [
        name for name in ("id", *REQUIRED_TEXTS) if not isinstance(getattr(cls, name, None), str)
    ]
    missing += [] if cls.__doc__ else ["docstring"]
    missing += [] if getattr(cls, "parameters", ()) else ["parameters"]
    missing += sorted(cls.__abstractmethods__)
    if missing:
        names = ", ".join(f"'{name}'" for name in missing)
        raise refused(
            f"has no {names}",
            where,
            "a docstring, id, equation, neglects, source, parameters and the method of its kind",
        )
    if not re.fullmatch(r"[a-z][a-z0-9_]*", cls.id):
        raise refused(f"the id is '{cls.id}'", where, "lower-case letters, digits and _")
    if cls.id in taken:
        raise refused(f"the id '{cls.id}' is taken", where, "an id that no other effect has")
    for fault, expected in find_faults(cls):
        raise refused(fault, where, expected)
    if issubclass(cls, Wrench):
        _check_kernel(cls, where)


def _check_kernel(cls: type[Wrench], where: str) -> None:
    """Compile the kernel alone, and refuse it if that fails: an engine's errors would be long."""
    from numba import typeof, types
    from numba.core.errors import NumbaError, UnsupportedBytecodeError

    from rovsim.dynamics.engine.kernel_inputs import example_reading
    from rovsim.dynamics.engine.types import EXAMPLE

    wrench = inspect.getattr_static(cls, "wrench")
    if not isinstance(wrench, staticmethod):
        raise refused("'wrench' has no @staticmethod", where, "@staticmethod def wrench(at, p)")
    _refuse_in_loop(cls, where)
    p = cls.named_parameters()(*(0.0 for _ in cls.parameters))
    kernel = compiled_alone(cls)
    at = example_reading(cls.example_channels()) if cls.reads() else EXAMPLE
    try:
        kernel.compile((typeof(at), typeof(p)))
    except (NumbaError, UnsupportedBytecodeError, TypeError, AttributeError) as error:
        raise refused(
            f"'wrench' does not compile: {_reason(str(error))}",
            where,
            "arithmetic on the numbers of `at` and `p`, functions of math, if, @inlined helpers",
            _name_meant(error, at, p),
        ) from None
    returned = kernel.nopython_signatures[0].return_type
    real = (types.Float, types.Integer)
    numbers = [isinstance(element, real) for element in getattr(returned, "types", ())]
    if len(numbers) != 6 or not all(numbers):
        raise refused(f"'wrench' returns {returned}", where, "six numbers: X, Y, Z, K, M, N")


def _name_meant(error: Exception, *given: Any) -> str:
    """Ask which name was meant, where a kernel does not compile for one that is unknown.

    Args:
        error: that was raised when the kernel was compiled.
        given: the named tuples that the kernel is called with.
    """
    if isinstance(error, AttributeError) and error.name:  # of a module, such as math
        return nearest(error.name, [name for name in dir(error.obj) if name[0] != "_"])
    unknown = re.search(r"Unknown attribute '(\w+)' of type (\w+)", str(error))
    if unknown and unknown[1] == "channels":
        return "Declare 'channels' in the class."
    records = [part for record in given for part in (record, *record) if hasattr(part, "_fields")]
    fields = {type(record).__name__: record._fields for record in records}
    return nearest(unknown[1], fields[unknown[2]]) if unknown and unknown[2] in fields else ""


def _refuse_in_loop(cls: type[Wrench], where: str) -> None:
    """Refuse a kernel that raises or prints: it compiles, but cannot be used in a simulation."""
    line = line_that_raises(cls.wrench)
    if line is not None:
        raise refused(
            f"'wrench' raises an error or asserts (line {line})",
            where,
            "a wrench at every state: nobody hears of an error inside the simulation",
        )
    if mentions(cls.wrench, "print"):
        raise refused("'wrench' prints", where, "a wrench alone: it is called at every step")


def _reason(text: str) -> str:
    """The cause and the line in an error message of Numba, without the rest of its report."""
    lines = [line.strip() for line in re.sub(r"\x1b\[[0-9;]*m", "", text).splitlines()]
    messages = [
        line for line in lines if line and not line.startswith(("Failed in", "- ", ">>>", "Th"))
    ]
    line = re.search(r", line (\d+)", text)
    cause = (messages[0].rstrip(":.") if messages else lines[0]).partition(" of type ")[0]
    return cause + (f" (line {line[1]})" if line else "")
