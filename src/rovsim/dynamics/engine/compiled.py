"""Compiled engines: one generated module per list of wrench effects, cached on disk by Numba.

Closures do not cache, modules do. The module's name is a digest of everything it is compiled from,
so an edited kernel never meets an old engine.
"""

import hashlib
import importlib.util
import inspect
import os
import sys
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, Sequence

import numba
from filelock import FileLock
from platformdirs import user_cache_path

from rovsim.core.files import write_text

FOLDER = Path(__file__).parent
PARTS = "integration", "observer"  # what uses the equation


def cache_folder() -> Path:
    """Where engines are kept: $ROVSIM_CACHE, or the user's cache folder."""
    return Path(os.environ.get("ROVSIM_CACHE") or user_cache_path("rovsim")) / "engines"


def engine(wrenches: Sequence[Any]) -> ModuleType:
    """The compiled equation of motion with these wrench effects, in this order."""
    return _engine(tuple(wrenches))


@cache
def _engine(wrenches: tuple[Any, ...]) -> ModuleType:
    equation = _replaced("equation", "extra", _chain(wrenches))
    source = equation + "".join(_replaced(part, "equation", "") for part in PARTS)
    name = f"rovsim_engine_{_digest(source, wrenches)}"
    path = cache_folder() / f"{name}.py"
    with FileLock(_made(path.parent) / f"{name}.lock"):
        if not path.exists():
            write_text(path, source)
        return _imported(name, path, wrenches)


def _replaced(template: str, mark: str, text: str) -> str:
    """A template file in which what stands between two marks is replaced."""
    before, rest = (FOLDER / f"{template}.py").read_text(encoding="utf-8").split(f"# <{mark}>")
    return before + text + rest.split(f"# </{mark}>")[1]


def _made(folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def _imported(name: str, path: Path, wrenches: tuple[Any, ...]) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    module.__dict__["WRENCHES"] = wrenches
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def _chain(wrenches: tuple[Any, ...]) -> str:
    """Source of `extra`: every kernel gets its slice of p as a named tuple."""
    lines, at = [], 0
    for i, wrench in enumerate(wrenches):
        count = len(wrench.parameters)
        values = "".join(f"p[{k}], " for k in range(at, at + count))
        lines.append(f"    tau = add6(tau, 1.0, kernel_{i}(at, Named_{i}({values})))")
        at += count
    names = [
        f"Named_{i}, kernel_{i} = WRENCHES[{i}].named_parameters(), "
        f"inline_internal(WRENCHES[{i}].wrench)  # {wrench.id}"
        for i, wrench in enumerate(wrenches)
    ]
    head = ["", *names, "", "", "@inline_internal", "def extra(at, p):"]
    start = "    tau = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)"
    return "\n".join([*head, start, *lines, "    return tau"])


def _digest(source: str, wrenches: tuple[Any, ...]) -> str:
    """Digest of the engine's source, of all that its kernels may call, and of Numba."""
    from rovsim.dynamics.learned.predictor import FILES

    package = FOLDER.parent
    files = {*package.glob("engine/*.py"), *package.glob("effects/*.py"), *FILES}
    files |= {Path(str(inspect.getsourcefile(wrench))) for wrench in wrenches}
    content = hashlib.sha256(f"{source}{numba.__version__}".encode())
    for file in sorted(files):
        content.update(file.read_bytes())
    return content.hexdigest()[:16]
