"""Find values so far from the vehicle file that a wrong unit is likelier than a wrong file.

How far files usually are off is known as a relative error (`estimation/file_effects.py`), so values
are compared by their logarithms. Where a file states a small value, the scale of the parameter
counts as its usual error at least.
"""

from typing import Iterator, Sequence

import numpy as np

from rovsim.core.signs import minus
from rovsim.dynamics.effects.base import Parameter
from rovsim.dynamics.effects.thrusters import ThrusterGain
from rovsim.dynamics.model import Model
from rovsim.estimation.file_effects import (
    FILE_RELATIVE_STDS,
    GAIN_RELATIVE_STD,
    ONE_GAIN,
    spread_of_file,
)
from rovsim.estimation.observer.hypothesis import Term

MAX_ERROR_STDS = 10.0  # usual relative errors: a factor of 20 of drag or added mass, 2.7 of thrust


def list_absurd(base: Model, terms: Sequence[Term]) -> list[str]:
    """List values that no vehicle file is wrong by, as half sentences.

    Drag or added mass that is much less than stated is not listed: a file may well state too much
    of one of several values.

    Args:
        base: says what the vehicle file states.
        terms: accepted effects at their fitted values.

    Returns:
        For each value, `effect.parameter` and how large it is.
    """
    return [
        text
        for term in terms
        for describe in (_tell_gain, _tell_stated)
        for text in describe(base, term)
    ]


def _tell_gain(base: Model, term: Term) -> Iterator[str]:
    """Yield the common gain of the thrusters, if it is absurdly far from 1 either way."""
    for name in ONE_GAIN if term.id == ThrusterGain.id else ():
        gain = term.effect[name]  # negative: reversed thrusters, which is another fault
        if abs(np.log(max(abs(gain), 1e-12))) > MAX_ERROR_STDS * GAIN_RELATIVE_STD:
            yield f"{term.id}.{name} is {minus(f'{gain:.2g}')}"


def _tell_stated(base: Model, term: Term) -> Iterator[str]:
    """Yield the values of a term that are absurdly far above what the file states."""
    values = base.body.stated.get(term.id, np.zeros(len(term.effect.parameters)))
    for parameter, nominal in zip(term.effect.parameters, values.tolist(), strict=True):
        total = nominal + term.effect[parameter.name]
        if nominal > 0.0 and total > _find_highest(base, term, parameter):
            yield (
                f"{term.id}.{parameter.name} comes to {total:.3g}, {total / nominal:.0f} times "
                "what the vehicle file states"
            )


def _find_highest(base: Model, term: Term, parameter: Parameter) -> float:
    """Highest value of a parameter, in its unit, that is not absurd."""
    share = FILE_RELATIVE_STDS[term.id]
    spread = spread_of_file(base, type(term.effect), parameter) * parameter.scale
    return spread / share * float(np.exp(MAX_ERROR_STDS * share))
