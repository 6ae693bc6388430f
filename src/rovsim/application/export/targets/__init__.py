"""The simulators that a model can be written for: one file each, found by looking into this folder.

A target declares `TITLE` (what people call it), `SUFFIX` of its files, `SOURCE` (where its format
and its equations are documented), `TAKES` (what drives the vehicle there, one sentence) and these
functions (without `further`, what `hold` leaves out is all):

    hold(effect) -> (effect, why)    what it can hold of an effect; why not the rest (empty: all)
    further(model) -> [OmittedPart]  what else it leaves out of a model whose effects it can hold
    text(equation, notes) -> str     the file; `notes` are lines that stand in it as comments
"""

from dataclasses import dataclass
from functools import cache
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import Callable, Sequence

from rovsim.application.export.equation import Equation
from rovsim.application.export.holding import Hold, OmittedPart
from rovsim.core.errors import unlisted
from rovsim.dynamics.model import Model


@dataclass(frozen=True)
class Target:
    """One simulator; what its attributes mean is said in the docstring of this package."""

    name: str
    title: str
    suffix: str
    source: str
    takes: str
    hold: Hold
    further: Callable[[Model], Sequence[OmittedPart]]
    text: Callable[[Equation, Sequence[str]], str]


@cache
def targets() -> dict[str, Target]:
    """Return every target by its name, which is the name of its module."""
    names = [module.name for module in iter_modules([str(Path(__file__).parent)])]
    return {name: _target(name) for name in names}


def _target(name: str) -> Target:
    m = import_module(f"{__name__}.{name}")
    further = getattr(m, "further", _leave_nothing)
    return Target(name, m.TITLE, m.SUFFIX, m.SOURCE, m.TAKES, m.hold, further, m.text)


def _leave_nothing(model: Model) -> Sequence[OmittedPart]:
    """Stand in where what a target's `hold` leaves out is all."""
    return ()


def target(name: str) -> Target:
    """Return the target of a name.

    Raises:
        BadInput: there is none; the message says which names come close.
    """
    by_name = targets()
    if name in by_name:
        return by_name[name]
    raise unlisted(name, by_name, found=f"unknown simulator '{name}'", where="to")
