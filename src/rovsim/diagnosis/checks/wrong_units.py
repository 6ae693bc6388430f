"""Values so far from the vehicle file that a unit is likelier to be wrong than the file.

How far files are off is known in proportion, from published sets
(`estimation/file_effects.py`), so distances are those of logarithms. What a file states as
little is off by a scale of the parameter at least.
"""

from typing import Iterator, Sequence

import numpy as np

from rovsim.core.signs import minus
from rovsim.dynamics.effects.base import Parameter
from rovsim.dynamics.effects.thrusters import ThrusterGain
from rovsim.dynamics.model import Model
from rovsim.estimation.file_effects import GAIN, ONE_GAIN, SHARE, spread_of_file
from rovsim.estimation.observer.hypothesis import Term

WIDTHS = 10.0  # such distances of two files: a factor of 20 of drag or added mass, 2.7 of thrust


def list_absurd(base: Model, terms: Sequence[Term]) -> list[str]:
    """Values that no vehicle file is off by, as `effect.parameter` and how large each is.

    Less drag or added mass than stated is none: a file may well state too much of one of several.
    """
    return [
        one for term in terms for told in (_tell_gain, _tell_stated) for one in told(base, term)
    ]


def _tell_gain(base: Model, term: Term) -> Iterator[str]:
    for name in ONE_GAIN if term.id == ThrusterGain.id else ():
        gain = term.effect[name]  # below zero: reversed, another fault
        if abs(np.log(max(abs(gain), 1e-12))) > WIDTHS * GAIN:
            yield f"{term.id}.{name} is {minus(f'{gain:.2g}')}"


def _tell_stated(base: Model, term: Term) -> Iterator[str]:
    stated = base.body.stated.get(term.id, np.zeros(len(term.effect.parameters)))
    for parameter, own in zip(term.effect.parameters, stated.tolist(), strict=True):
        total = own + term.effect[parameter.name]
        if own > 0.0 and total > _highest(base, term, parameter):
            yield (
                f"{term.id}.{parameter.name} comes to {total:.3g}, {total / own:.0f} times what "
                "the vehicle file states"
            )


def _highest(base: Model, term: Term, parameter: Parameter) -> float:
    share = SHARE[term.id]
    spread = spread_of_file(base, type(term.effect), parameter) * parameter.scale
    return spread / share * float(np.exp(WIDTHS * share))
