"""The catalogue of effects, found by looking: every module here, and installed entry points."""

import importlib
import pkgutil
from functools import cache
from importlib.metadata import entry_points
from typing import Iterable

from rovsim.effects.base import Effect
from rovsim.errors import BadInput, nearest


@cache
def catalogue() -> dict[str, type[Effect]]:
    """Every known effect by its id."""
    for module in pkgutil.iter_modules(__path__):
        importlib.import_module(f"{__name__}.{module.name}")
    for entry in entry_points(group="rovsim.effects"):
        entry.load()
    return {cls.id: cls for cls in sorted(_concrete(Effect), key=lambda cls: cls.id)}


def _concrete(cls: type[Effect]) -> Iterable[type[Effect]]:
    if getattr(cls, "id", None) and cls.listed:
        yield cls
    for inner in cls.__subclasses__():
        yield from _concrete(inner)


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
        expected="an id of the catalogue",
        remedy=nearest(name, known),
    )
