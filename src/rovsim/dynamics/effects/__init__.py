"""The catalogue of effects: every module here, installed entry points, and files a user names."""

import importlib
import pkgutil
from functools import cache
from importlib.metadata import entry_points
from pathlib import Path
from types import ModuleType
from typing import Iterable, Sequence

from rovsim.core.errors import BadInput, nearest
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.effects.user_files import checked_effects, read_effects

_named: dict[str, type[Effect]] = {}  # of the files that `use_effect_files` was given last


def catalogue() -> dict[str, type[Effect]]:
    """Every known effect by its id."""
    return dict(sorted((built_in() | installed() | _named).items()))


@cache
def built_in() -> dict[str, type[Effect]]:
    """The effects of this package."""
    for module in pkgutil.iter_modules(__path__):
        importlib.import_module(f"{__name__}.{module.name}")
    found = (c for c in _concrete(Effect) if c.__module__.startswith(f"{__name__}."))
    return {cls.id: cls for cls in found}


def _concrete(cls: type[Effect]) -> Iterable[type[Effect]]:
    if getattr(cls, "id", None) and cls.listed:
        yield cls
    for inner in cls.__subclasses__():
        yield from _concrete(inner)


@cache
def installed() -> dict[str, type[Effect]]:
    """Effects of installed packages: the entry points `rovsim.effects`, a class or a module each.

    Raises:
        BadInput: one of them is not an effect, or its id is taken.
    """
    found: dict[str, type[Effect]] = {}
    for entry in entry_points(group="rovsim.effects"):
        where = f"entry point {entry.name} = {entry.value}"
        try:
            loaded = entry.load()
        except Exception as error:
            raise BadInput(
                f"cannot be imported ({type(error).__name__}: {error})",
                where=where,
                expected="a class or a module of effects",
                remedy="Correct that package, or remove it.",
            ) from None
        content = vars(loaded) if isinstance(loaded, ModuleType) else {entry.name: loaded}
        found |= checked_effects(content, where, built_in() | found)
    return found


def use_effect_files(paths: Sequence[Path]) -> None:
    """From now on the catalogue holds the effects of these files, and of no other files.

    Raises:
        BadInput: a file that cannot be read or run, or one without a complete effect.
    """
    found: dict[str, type[Effect]] = {}
    for path in paths:
        found |= read_effects(path, built_in() | installed() | found)
    _named.clear()
    _named.update(found)


def effect(name: str) -> type[Effect]:
    """The effect with this id.

    Raises:
        BadInput: there is none; names the nearest.
    """
    known = catalogue()
    if name in known:
        return known[name]
    raise BadInput(
        f"unknown effect '{name}'",
        where="effects",
        expected="an id of the catalogue, or one that effects_file=FILE.py declares",
        remedy=nearest(name, known),
    )
