"""The simulators that a model can be written for: one file each, found by looking into this folder.

A target declares `TITLE` (what people call it), `SUFFIX` of its files, `SOURCE` (where its format
and its equations are documented), `TAKES` (what drives the vehicle there, one sentence) and three
functions:

    hold(effect) -> (effect, why)    what it holds of an effect; why it does not hold the rest
    further(model) -> [Left, ...]    what is left out beside that, of a model whose effects it holds
    text(equation, notes) -> str     the file; `notes` are lines that stand in it as comments
"""

from dataclasses import dataclass
from functools import cache
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import Callable, Sequence

from rovsim.application.export.equation import Equation
from rovsim.application.export.holding import Hold, Left
from rovsim.core.errors import unlisted
from rovsim.dynamics.model import Model


@dataclass(frozen=True)
class Target:
    """One simulator."""

    name: str
    title: str
    suffix: str
    source: str
    takes: str
    hold: Hold
    further: Callable[[Model], Sequence[Left]]
    text: Callable[[Equation, Sequence[str]], str]


@cache
def targets() -> dict[str, Target]:
    """Every target, by its name, which is that of its file."""
    names = [module.name for module in iter_modules([str(Path(__file__).parent)])]
    return {name: _target(name) for name in names}


def _target(name: str) -> Target:
    m = import_module(f"{__name__}.{name}")
    return Target(name, m.TITLE, m.SUFFIX, m.SOURCE, m.TAKES, m.hold, m.further, m.text)


def target(name: str) -> Target:
    """The target of a name.

    Raises:
        BadInput: there is none; names the nearest.
    """
    known = targets()
    if name in known:
        return known[name]
    raise unlisted(name, known, found=f"unknown simulator '{name}'", where="to")
